//! Limits on building a mesh: the number of triangles, and memory. Code that builds a mesh asks for memory before it
//! allocates, so that a loader can refuse a file that needs too much.

use std::cell::Cell;

use super::Mesh;
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

/// How many bytes of memory each byte of a file allows.
const PER_BYTE: u64 = 4;

/// An account of memory, in bytes, that is asked before each allocation and refuses what is too much: a small file can't ask for
/// much, and a large file only for a multiple of its size. Memory that is *held* stays in use; memory that is *borrowed* is returned
/// at the end of a scope (see [`Borrowed`]), all at once.
pub struct Budget {
    /// How many bytes are allowed whatever the files' size.
    free: u64,
    /// The size of all files.
    files: Cell<u64>,
    /// How many bytes are in use until they are released.
    held: Cell<u64>,
    /// How many bytes are borrowed.
    borrowed: Cell<u64>,
}

impl Budget {
    /// A budget for what is made from a file of so many bytes, which are held: four times as much, and `free` bytes.
    pub fn new(file: usize, free: u64) -> Self {
        let file = file as u64;
        Self { free, files: Cell::new(file), held: Cell::new(file), borrowed: Cell::new(0) }
    }

    /// A budget for what is computed from a mesh, which is held. `files` is the size of all files that it was read from.
    pub fn from_mesh(mesh: &Mesh, files: u64, free: u64) -> Self {
        Self { free, files: Cell::new(files), held: Cell::new(mesh.bytes()), borrowed: Cell::new(0) }
    }

    /// A budget that allows everything, for meshes whose size no file determines.
    pub fn unlimited() -> Self {
        Self::new(0, u64::MAX)
    }

    /// Adds another file of `file` bytes, which allows more memory.
    pub fn allow(&self, file: u64) {
        self.files.update(|files| files.saturating_add(file));
    }

    /// The size of all files.
    pub fn files(&self) -> u64 {
        self.files.get()
    }

    /// How many bytes may be in use.
    pub fn allowed(&self) -> u64 {
        self.free.saturating_add(self.files.get().saturating_mul(PER_BYTE))
    }

    /// How many bytes besides those of the files' size allow so many in all.
    pub fn option_for(&self, bytes: u64) -> u64 {
        bytes.saturating_sub(self.files.get().saturating_mul(PER_BYTE))
    }

    /// How many bytes are held.
    pub fn held(&self) -> u64 {
        self.held.get()
    }

    /// How many bytes are borrowed.
    pub fn borrowed(&self) -> u64 {
        self.borrowed.get()
    }

    /// How many more bytes may be taken.
    pub fn left(&self) -> u64 {
        self.allowed().saturating_sub(self.held.get() + self.borrowed.get())
    }

    /// Asks for memory that stays in use until it is [released](Self::release).
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn hold(&self, bytes: u64) -> Result<(), MemoryRefused> {
        self.check(bytes)?;
        self.held.update(|held| held + bytes);
        Ok(())
    }

    /// Returns memory that was held.
    pub fn release(&self, bytes: u64) {
        self.held.update(|held| held.saturating_sub(bytes));
    }

    /// Holds `new` bytes in place of `old` ones. Both are in use for a moment.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn exchange(&self, old: u64, new: u64) -> Result<(), MemoryRefused> {
        self.hold(new)?;
        self.release(old);
        Ok(())
    }

    /// Asks for memory that is returned at the end of the innermost scope.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn borrow(&self, bytes: u64) -> Result<(), MemoryRefused> {
        self.check(bytes)?;
        self.borrowed.update(|borrowed| borrowed + bytes);
        Ok(())
    }

    /// Checks that there is room for so many bytes more.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn check(&self, bytes: u64) -> Result<(), MemoryRefused> {
        let needed = (self.held.get() + self.borrowed.get()).saturating_add(bytes);
        let allowed = self.allowed();
        if needed <= allowed { Ok(()) } else { Err(MemoryRefused { needed, allowed }) }
    }
}

/// A scope of borrowed memory: when it is dropped, all that was borrowed since it began is returned. What was borrowed before, by
/// whoever called, stays borrowed.
pub struct Borrowed<'a> {
    budget: &'a Budget,
    before: u64,
}

impl<'a> Borrowed<'a> {
    /// Begins a scope.
    pub fn from(budget: &'a Budget) -> Self {
        Self { budget, before: budget.borrowed() }
    }
}

impl Drop for Borrowed<'_> {
    fn drop(&mut self) {
        self.budget.borrowed.set(self.before);
    }
}

/// Returns the result of `work`, and gives back what that borrows.
pub fn borrowing<T>(budget: &Budget, work: impl FnOnce() -> T) -> T {
    let _scope = Borrowed::from(budget);
    work()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_bring_their_allowance() {
        let free = 512 << 20;
        let budget = Budget::new(1 << 20, free);
        assert_eq!(budget.left(), free + (3 << 20));
        budget.allow(10 << 20);
        assert_eq!(budget.left(), free + (43 << 20));
        let scope = Borrowed::from(&budget);
        assert!(budget.borrow(free).is_ok() && budget.hold(43 << 20).is_ok());
        let said = budget.hold(1).unwrap_err().to_string();
        assert!(
            said.contains("would take at least 557 MiB of memory, but files of this size may take only 556 MiB"),
            "{said}"
        );
        assert_eq!(budget.option_for(600 << 20), 556 << 20, "four times eleven MiB of files come to it");
        drop(scope);
        assert_eq!(budget.left(), free);
        assert!(budget.hold(u64::MAX).is_err());
    }

    #[test]
    fn a_limit_of_less_than_a_mebibyte_is_said_in_kibibytes() {
        let said = |allowed| Budget::new(0, allowed).hold(1 << 30).unwrap_err().to_string();
        for (allowed, expected) in [((1 << 20) - 1, "1023 KiB"), (1 << 20, "1 MiB")] {
            assert!(said(allowed).contains(&format!("may take only {expected} (")), "{}", said(allowed));
        }
    }

    #[test]
    fn a_scope_returns_what_was_borrowed_in_it_and_nothing_else() {
        let budget = Budget::unlimited();
        budget.borrow(5).unwrap();
        let outer = Borrowed::from(&budget);
        budget.borrow(10).unwrap();
        assert_eq!(borrowing(&budget, || budget.borrow(20).map(|()| budget.borrowed())), Ok(35));
        assert_eq!(budget.borrowed(), 15);
        drop(outer);
        assert_eq!(budget.borrowed(), 5);
    }
}
