//! Canonical prefix codes (Huffman 1952): codes of one length are consecutive numbers, in the order of their symbols. In the data each
//! code begins with its highest bit.
//!
//! Source of how BasisLZ stores a code: KTX 2.0 specification, appendix "BasisLZ", section on Huffman coding.

use super::bits::Bits;

/// The greatest length of a code, in bits.
const LONGEST: usize = 16;

/// A canonical prefix code. The default has no symbols, and nothing can be read with it.
#[derive(Debug, Default)]
pub(super) struct PrefixCode {
    /// How many codes have each length.
    counts: [u32; LONGEST + 1],
    /// The symbols by the length of their codes, then by number.
    symbols: Vec<u16>,
}

impl PrefixCode {
    /// Makes the code in which each symbol's code has this length, 0 for symbols without one; none if there is no such code. A single
    /// symbol's code is followed by others that stand for nothing.
    pub(super) fn new(lengths: &[u8]) -> Option<Self> {
        let mut counts = [0; LONGEST + 1];
        let mut symbols: Vec<_> = (0..lengths.len() as u16).filter(|&symbol| lengths[symbol as usize] > 0).collect();
        symbols.sort_by_key(|&symbol| lengths[symbol as usize]);
        for &symbol in &symbols {
            counts[usize::from(lengths[symbol as usize])] += 1;
        }
        let room = 1 << LONGEST;
        let taken: u32 = counts.iter().enumerate().map(|(length, count)| count << (LONGEST - length)).sum();
        (taken == room || symbols.len() == 1).then_some(Self { counts, symbols })
    }

    /// Reads a symbol; none if no code begins like the bits.
    pub(super) fn symbol(&self, bits: &mut Bits) -> Option<u32> {
        let ahead = bits.peek(LONGEST as u32);
        let (mut code, mut first, mut before) = (0, 0, 0);
        for length in 1..=LONGEST {
            // Codes are stored with their highest bit first.
            code = code << 1 | (ahead >> (length - 1)) & 1;
            let count = self.counts[length];
            if code < first + count {
                bits.skip(length as u32);
                return Some(self.symbols[(before + code - first) as usize].into());
            }
            first = (first + count) << 1;
            before += count;
        }
        None
    }
}

/// The order in which lengths of the codes of lengths are stored.
const ORDER: [usize; 21] = [17, 18, 19, 20, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15, 16];

/// Reads a code; none if the data is wrong. A code without symbols is one that nothing can be read with.
pub(super) fn read_code(bits: &mut Bits) -> Option<PrefixCode> {
    let count = bits.take(14) as usize;
    if count == 0 {
        return Some(PrefixCode::default());
    }
    let used = bits.take(5) as usize;
    let mut lengths = [0; 21];
    for &place in ORDER.get(..used)? {
        lengths[place] = bits.take(3) as u8;
    }
    let of_lengths = PrefixCode::new(&lengths)?;
    let mut lengths = Vec::with_capacity(count);
    while lengths.len() < count {
        let (length, times) = match of_lengths.symbol(bits)? {
            17 => (0, 3 + bits.take(3)),
            18 => (0, 11 + bits.take(7)),
            19 => (*lengths.last()?, 3 + bits.take(2)),
            20 => (*lengths.last()?, 7 + bits.take(7)),
            length => (length as u8, 1),
        };
        lengths.extend((0..times).map(|_| length));
    }
    if lengths.len() > count || bits.is_past_end() {
        return None;
    }
    PrefixCode::new(&lengths)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_codes_come_first() {
        // a: 10, b: 0, c: 110, d: 111; the first bit of a code is the lowest.
        let code = PrefixCode::new(&[2, 1, 3, 3]).expect("a complete code");
        let mut bits = Bits::new(&[0b1110_1101, 0b10]);
        let symbols: Vec<_> = (0..4).map(|_| code.symbol(&mut bits)).collect();
        assert_eq!(symbols, [Some(0), Some(2), Some(3), Some(1)]);
    }

    #[test]
    fn codes_that_are_not_complete_are_refused() {
        let is_refused = |lengths: &[u8]| PrefixCode::new(lengths).is_none();
        assert!(is_refused(&[1, 2]) && is_refused(&[1, 1, 1]) && is_refused(&[0]));
        let one = PrefixCode::new(&[0, 1]).expect("one symbol needs no other");
        assert_eq!([0, 1].map(|byte| one.symbol(&mut Bits::new(&[byte]))), [Some(1), None]);
        assert_eq!(PrefixCode::default().symbol(&mut Bits::new(&[0])), None);
    }
}
