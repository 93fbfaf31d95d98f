//! How much memory a load takes: a small file can't ask for much.

use std::cell::Cell;

/// What is allowed whatever the files' size, in bytes.
const FREE: u64 = 256 << 20;
/// What each byte of a file allows beyond that, in bytes.
const PER_BYTE: u64 = 4;

/// Counts what is about to be taken, before it is.
pub struct Budget {
    allowed: Cell<u64>,
    /// Taken until the end.
    held: Cell<u64>,
    /// Given back soon.
    passing: Cell<u64>,
}

impl Budget {
    /// For a document's own file of so many bytes, which are held.
    pub fn new(file: usize) -> Self {
        let (allowed, held) = (Cell::new(FREE), Cell::new(file as u64));
        let budget = Self { allowed, held, passing: Cell::new(0) };
        budget.allow(file as u64);
        budget
    }

    /// There is another file of so many bytes.
    pub fn allow(&self, file: u64) {
        self.allowed.set(self.allowed.get().saturating_add(file.saturating_mul(PER_BYTE)));
    }

    /// Takes memory until the end.
    ///
    /// # Errors
    /// A clause: it is more than allowed.
    pub fn hold(&self, bytes: u64) -> Result<(), String> {
        self.check(bytes)?;
        self.held.set(self.held.get() + bytes);
        Ok(())
    }

    /// Takes memory until [`Self::pass`].
    ///
    /// # Errors
    /// A clause: it is more than allowed.
    pub fn borrow(&self, bytes: u64) -> Result<(), String> {
        self.check(bytes)?;
        self.passing.set(self.passing.get() + bytes);
        Ok(())
    }

    /// What is borrowed now.
    pub fn borrowed(&self) -> u64 {
        self.passing.get()
    }

    /// What was borrowed beyond that is free again.
    pub fn pass(&self, borrowed: u64) {
        self.passing.set(borrowed);
    }

    /// What may still be taken.
    pub fn left(&self) -> u64 {
        self.allowed.get().saturating_sub(self.held.get() + self.passing.get())
    }

    fn check(&self, bytes: u64) -> Result<(), String> {
        let needed = (self.held.get() + self.passing.get()).saturating_add(bytes);
        let allowed = self.allowed.get();
        if needed <= allowed {
            return Ok(());
        }
        let (needed, allowed) = (needed.div_ceil(1 << 20), allowed >> 20);
        Err(format!("would take {needed} MiB of memory, and files of this size may take {allowed} MiB"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_bring_their_allowance() {
        let budget = Budget::new(1 << 20);
        assert_eq!(budget.left(), FREE + (3 << 20));
        budget.allow(10 << 20);
        assert_eq!(budget.left(), FREE + (43 << 20));
        assert!(budget.borrow(FREE).is_ok() && budget.hold(43 << 20).is_ok());
        let said = budget.hold(1).unwrap_err();
        assert!(said.contains("would take 301 MiB of memory, and files of this size may take 300 MiB"), "{said}");
        budget.pass(0);
        assert_eq!(budget.left(), FREE);
        assert!(budget.hold(u64::MAX).is_err());
    }
}
