//! The prefix code of literals.
//!
//! Source: RFC 8878, section 4.2.

use super::backward_bits::BackwardBits;
use super::fse::Table;
use super::{BROKEN, Fault, Reader};

/// The greatest length of a code, in bits.
const LONGEST: u32 = 11;

/// For every number of [`Self::width`] bits, the symbol whose code begins it, and the code's length.
pub(super) struct Huffman {
    cells: Vec<(u8, u32)>,
    width: u32,
}

impl Huffman {
    /// Reads the weights of the symbols, of which the last one follows from the others.
    pub(super) fn read(reader: &mut Reader) -> Result<Self, Fault> {
        let header = usize::from(reader.byte()?);
        let mut weights = match header.checked_sub(127) {
            None => packed(reader.take(header)?)?,
            Some(count) => {
                let bytes = reader.take(count.div_ceil(2))?;
                bytes.iter().flat_map(|byte| [byte >> 4, byte & 15]).take(count).collect()
            }
        };
        let shares =
            |weight: &u8| if *weight == 0 { 0 } else { 1_u32.checked_shl(u32::from(*weight) - 1).unwrap_or(0) };
        let sum: u32 = weights.iter().map(shares).sum();
        let width = sum.checked_ilog2().ok_or(BROKEN)? + 1;
        let rest = (1 << width) - sum;
        if width > LONGEST || !rest.is_power_of_two() || weights.len() > 255 {
            return Err(BROKEN);
        }
        weights.push(rest.ilog2() as u8 + 1);
        let mut symbols: Vec<_> = (0..weights.len()).filter(|&symbol| weights[symbol] > 0).collect();
        symbols.sort_by_key(|&symbol| weights[symbol]);
        let mut cells = Vec::with_capacity(1 << width);
        for symbol in symbols {
            let weight = weights[symbol];
            let cell = (symbol as u8, width + 1 - u32::from(weight));
            cells.extend((0..shares(&weight)).map(|_| cell));
        }
        Ok(Self { cells, width })
    }

    /// Adds `count` symbols, which must take all of the bytes.
    pub(super) fn decode(&self, bytes: &[u8], count: usize, to: &mut Vec<u8>) -> Result<(), Fault> {
        let mut bits = BackwardBits::new(bytes)?;
        for _ in 0..count {
            let (symbol, length) = self.cells[bits.peek(self.width) as usize];
            bits.skip(length);
            to.push(symbol);
        }
        if bits.is_at_end() { Ok(()) } else { Err(BROKEN) }
    }
}

/// Reads weights that are coded by a table with two states in turn, until there are no bits for another state.
fn packed(bytes: &[u8]) -> Result<Vec<u8>, Fault> {
    let mut reader = Reader(bytes);
    let table = Table::read(&mut reader, 12, 6)?;
    let mut bits = BackwardBits::new(reader.0)?;
    let mut states = [table.start(&mut bits), table.start(&mut bits)];
    let mut weights = Vec::new();
    if bits.is_past_end() {
        return Err(BROKEN);
    }
    loop {
        weights.push(table.symbol(states[0]));
        states[0] = table.next(states[0], &mut bits);
        if bits.is_past_end() {
            weights.push(table.symbol(states[1]));
            return Ok(weights);
        }
        states.swap(0, 1);
        if weights.len() > 255 {
            return Err(BROKEN);
        }
    }
}
