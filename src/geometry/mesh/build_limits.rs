//! Limits on building a mesh: the number of triangles, and memory. Code that builds a mesh asks for memory before it
//! allocates, so that a loader can refuse a file that needs too much.

use crate::progress::Cancelled;

/// The greatest number of triangles of a mesh. Its sides are numbered with two bits of extra information each, which
/// must fit into 32 bits (see [`super::Side`]).
pub const MAX_TRIANGLES: u64 = 1 << 27;
const _: () = assert!(6 * MAX_TRIANGLES <= 1 << 32);

/// Why a mesh, or something that is made from one, could not be built.
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
    "would take at least {} MiB of memory, but files of this size may take only {} (--max-memory allows more)",
    needed.div_ceil(1 << 20),
    size_text(*allowed)
)]
pub struct MemoryRefused {
    /// The bytes that would be in use if the request were granted.
    pub needed: u64,
    /// The bytes that may be in use.
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

/// An account of memory, in bytes, that is asked before each allocation and refuses what is too much. Memory that is
/// *held* stays in use; memory that is *borrowed* is returned at the end of a scope (see [`Borrowed`]), all at once.
pub trait MemoryAccount {
    /// Asks for memory that stays in use until it is [released](Self::release).
    ///
    /// # Errors
    /// [`MemoryRefused`].
    fn hold(&self, bytes: u64) -> Result<(), MemoryRefused>;

    /// Returns memory that was held.
    fn release(&self, bytes: u64);

    /// Asks for memory that is returned at the end of the innermost scope.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    fn borrow(&self, bytes: u64) -> Result<(), MemoryRefused>;

    /// Returns how many bytes are borrowed now.
    fn borrowed(&self) -> u64;

    /// Returns what was borrowed in a scope.
    fn give_back(&self, scope: &Borrowed);

    /// Holds `new` bytes in place of `old` ones. Both are in use for a moment.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    fn exchange(&self, old: u64, new: u64) -> Result<(), MemoryRefused> {
        self.hold(new)?;
        self.release(old);
        Ok(())
    }
}

/// An account that refuses nothing, for meshes whose size no file determines.
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

    fn give_back(&self, _: &Borrowed) {}
}

/// A scope of borrowed memory: when it is dropped, all that was borrowed since it began is returned. What was borrowed before, by
/// whoever called, stays borrowed.
pub struct Borrowed<'a> {
    account: &'a dyn MemoryAccount,
    before: u64,
}

impl<'a> Borrowed<'a> {
    /// Begins a scope.
    pub fn from(account: &'a dyn MemoryAccount) -> Self {
        Self { account, before: account.borrowed() }
    }

    /// How many bytes were borrowed when it began.
    pub fn before(&self) -> u64 {
        self.before
    }
}

impl Drop for Borrowed<'_> {
    fn drop(&mut self) {
        self.account.give_back(self);
    }
}

/// Returns the result of `work`, and gives back what that borrows.
pub fn borrowing<T>(account: &dyn MemoryAccount, work: impl FnOnce() -> T) -> T {
    let _scope = Borrowed::from(account);
    work()
}

#[cfg(test)]
pub mod tests {
    use std::cell::Cell;

    use super::*;

    /// An account that keeps count.
    #[derive(Debug)]
    pub struct Counted {
        pub allowed: u64,
        pub held: Cell<u64>,
        pub borrowed: Cell<u64>,
        /// The sum of all that was borrowed.
        pub lent: Cell<u64>,
    }

    impl Default for Counted {
        fn default() -> Self {
            Self { allowed: u64::MAX, held: Cell::default(), borrowed: Cell::default(), lent: Cell::default() }
        }
    }

    impl Counted {
        fn ask(&self, bytes: u64) -> Result<(), MemoryRefused> {
            let needed = self.held.get() + self.borrowed.get() + bytes;
            if needed > self.allowed { Err(MemoryRefused { needed, allowed: self.allowed }) } else { Ok(()) }
        }
    }

    impl MemoryAccount for Counted {
        fn hold(&self, bytes: u64) -> Result<(), MemoryRefused> {
            self.ask(bytes)?;
            self.held.update(|held| held + bytes);
            Ok(())
        }

        fn release(&self, bytes: u64) {
            self.held.update(|held| held.saturating_sub(bytes));
        }

        fn borrow(&self, bytes: u64) -> Result<(), MemoryRefused> {
            self.ask(bytes)?;
            self.borrowed.update(|borrowed| borrowed + bytes);
            self.lent.update(|lent| lent + bytes);
            Ok(())
        }

        fn borrowed(&self) -> u64 {
            self.borrowed.get()
        }

        fn give_back(&self, scope: &Borrowed) {
            self.borrowed.set(scope.before());
        }
    }
}
