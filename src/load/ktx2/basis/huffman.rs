//! Reads the prefix codes of BasisLZ.
//!
//! Source: KTX 2.0 specification, appendix "BasisLZ", section on Huffman coding.

use super::bits::Bits;
use super::prefix_code::PrefixCode;

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
