//! Reads numbers of any width from bytes, the lowest bit of each byte first.

/// A position in bytes, counted in bits.
pub(super) struct Bits<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Bits<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// Returns the next `count` bits, up to 32, without moving on. Behind the end all bits are 0.
    pub(super) fn peek(&self, count: u32) -> u32 {
        let rest = self.bytes.get(self.at / 8..).unwrap_or(&[]);
        let mut eight = [0; 8];
        let length = rest.len().min(8);
        eight[..length].copy_from_slice(&rest[..length]);
        let bits = u64::from_le_bytes(eight) >> (self.at % 8);
        (bits & ((1 << count) - 1)) as u32
    }

    pub(super) fn skip(&mut self, count: u32) {
        self.at += count as usize;
    }

    /// Returns the next `count` bits, up to 32.
    pub(super) fn take(&mut self, count: u32) -> u32 {
        let bits = self.peek(count);
        self.skip(count);
        bits
    }

    /// Returns whether more was read than there is.
    pub(super) fn is_past_end(&self) -> bool {
        self.at > 8 * self.bytes.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_counted_from_the_lowest() {
        let mut bits = Bits::new(&[0b1010_0110, 0xff, 0x12, 0x34, 0x56]);
        assert_eq!([bits.take(3), bits.take(5), bits.take(4)], [0b110, 0b10100, 0xf]);
        assert_eq!((bits.peek(28), bits.is_past_end()), (0x563_412f, false));
        bits.skip(28);
        assert_eq!((bits.take(0), bits.is_past_end(), bits.take(32), bits.is_past_end()), (0, false, 0, true));
    }
}
