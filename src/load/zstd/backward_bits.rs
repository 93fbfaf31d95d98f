//! Reads numbers from bytes backwards, as they are stored in reverse.

use super::{BROKEN, Fault};

/// Bits that are read from the highest bit of the last byte on; the first 1 only marks the start.
pub(super) struct BackwardBits<'a> {
    bytes: &'a [u8],
    /// How many bits are left; below 0 if more were read than there were.
    left: i64,
}

impl<'a> BackwardBits<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, Fault> {
        let last = *bytes.last().filter(|byte| **byte != 0).ok_or(BROKEN)?;
        Ok(Self { bytes, left: 8 * bytes.len() as i64 - 1 - i64::from(last.leading_zeros()) })
    }

    /// Returns the next `count` bits, up to 32, without moving on. Behind the end all bits are 0.
    pub(super) fn peek(&self, count: u32) -> u32 {
        let start = self.left - i64::from(count);
        let at = start.max(0) as usize;
        let rest = self.bytes.get(at / 8..).unwrap_or(&[]);
        let mut eight = [0; 8];
        let length = rest.len().min(8);
        eight[..length].copy_from_slice(&rest[..length]);
        let missing = (-start).clamp(0, 32);
        let bits = u64::from_le_bytes(eight) >> (at % 8) << missing;
        (bits & ((1 << count) - 1)) as u32
    }

    pub(super) fn skip(&mut self, count: u32) {
        self.left -= i64::from(count);
    }

    pub(super) fn take(&mut self, count: u32) -> u32 {
        let bits = self.peek(count);
        self.skip(count);
        bits
    }

    pub(super) fn is_past_end(&self) -> bool {
        self.left < 0
    }

    /// Returns whether all bits were read, and no more.
    pub(super) fn is_at_end(&self) -> bool {
        self.left == 0
    }
}
