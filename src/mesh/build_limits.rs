//! What limits the building of a mesh: its number of triangles, and memory, which is asked for before it is taken, so that
//! whoever loads files can refuse what is too much.

use crate::progress::Cancelled;

/// The most triangles that a mesh may have: its sides, two for each corner, are numbered in 32 bits (see [`super::Side`]).
pub const MAX_TRIANGLES: u64 = 1 << 27;
const _: () = assert!(6 * MAX_TRIANGLES <= 1 << 32);

/// Why a mesh, or something made of one, was not finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error(transparent)]
    Memory(#[from] MemoryRefused),
    #[error("would have more than {MAX_TRIANGLES} triangles")]
    TooManyTriangles,
}

/// A request for memory that was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "would take at least {} MiB of memory, and files of this size may take {} (--max-memory allows more)",
    needed.div_ceil(1 << 20),
    size_text(*allowed)
)]
pub struct MemoryRefused {
    /// What would be in use with the request granted, in bytes.
    pub needed: u64,
    /// What may be in use, in bytes.
    pub allowed: u64,
}

fn size_text(bytes: u64) -> String {
    if bytes < 1 << 20 { format!("{} KiB", bytes >> 10) } else { format!("{} MiB", bytes >> 20) }
}

impl From<MemoryRefused> for String {
    fn from(refused: MemoryRefused) -> Self {
        refused.to_string()
    }
}

/// Counts bytes that are about to be taken, and refuses what is too much. Held memory stays in use; borrowed memory is
/// given back soon, all at once.
pub trait MemoryAccount {
    /// Takes memory that stays in use, until it is [released](Self::release).
    ///
    /// # Errors
    /// [`MemoryRefused`].
    fn hold(&self, bytes: u64) -> Result<(), MemoryRefused>;

    /// Gives back memory that was held.
    fn release(&self, bytes: u64);

    /// Takes memory that is given back by [`give_back_to`](Self::give_back_to).
    ///
    /// # Errors
    /// [`MemoryRefused`].
    fn borrow(&self, bytes: u64) -> Result<(), MemoryRefused>;

    /// Bytes that are borrowed now.
    fn borrowed(&self) -> u64;

    /// Gives back what was borrowed beyond `borrowed` bytes.
    fn give_back_to(&self, borrowed: u64);

    /// Holds `new` bytes in place of `old` ones; for a moment both are in use.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    fn exchange(&self, old: u64, new: u64) -> Result<(), MemoryRefused> {
        self.hold(new)?;
        self.release(old);
        Ok(())
    }
}

/// Refuses nothing: for meshes that no file asks for.
pub struct Unlimited;

impl MemoryAccount for Unlimited {
    fn hold(&self, _: u64) -> Result<(), MemoryRefused> {
        Ok(())
    }

    fn release(&self, _: u64) {}

    fn borrow(&self, _: u64) -> Result<(), MemoryRefused> {
        Ok(())
    }

    fn borrowed(&self) -> u64 {
        0
    }

    fn give_back_to(&self, _: u64) {}
}
