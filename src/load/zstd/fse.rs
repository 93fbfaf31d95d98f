//! Finite state entropy: symbols whose codes may have parts of a bit.
//!
//! Source: RFC 8878, section 4.1.

use super::backward_bits::BackwardBits;
use super::{BROKEN, Fault, Reader};
use crate::bits::Bits;

/// A table of states.
#[derive(Clone)]
pub(super) struct Table {
    cells: Vec<Cell>,
    /// The number of states is 2 to the power of this.
    accuracy: u32,
}

/// A state: its symbol, and the next state, which is `base` and a number of `bits` bits.
#[derive(Clone, Copy, Default)]
struct Cell {
    symbol: u8,
    bits: u32,
    base: u32,
}

impl Table {
    /// Reads a table, of symbols up to `most`.
    pub(super) fn read(reader: &mut Reader, most: usize, most_accuracy: u32) -> Result<Self, Fault> {
        let mut bits = Bits::new(reader.0);
        let accuracy = bits.take(4) + 5;
        if accuracy > most_accuracy {
            return Err(BROKEN);
        }
        let mut counts: Vec<i32> = Vec::new();
        let mut left = 1 << accuracy;
        while left > 0 {
            let count = probability(&mut bits, left);
            left -= count.abs();
            counts.push(count);
            while counts.last() == Some(&0) {
                let zeros = bits.take(2);
                counts.extend((0..zeros).map(|_| 0));
                if zeros < 3 || counts.len() > most {
                    break;
                }
            }
            if left < 0 || counts.len() > most + 1 {
                return Err(BROKEN);
            }
        }
        reader.take(bits.bytes_read())?;
        Self::of(&counts, accuracy)
    }

    /// Makes the table in which each symbol has so many states; -1 is one state, with all bits.
    pub(super) fn of(counts: &[i32], accuracy: u32) -> Result<Self, Fault> {
        let size = 1_usize << accuracy;
        let mut symbols = vec![0; size];
        let mut end = size;
        for symbol in (0..counts.len()).filter(|&symbol| counts[symbol] < 0) {
            end = end.checked_sub(1).ok_or(BROKEN)?;
            symbols[end] = symbol as u8;
        }
        let mut at = 0;
        for (symbol, &count) in counts.iter().enumerate() {
            for _ in 0..count.max(0) {
                symbols[at] = symbol as u8;
                at = (at + (size >> 1) + (size >> 3) + 3) % size;
                while at >= end && end > 0 {
                    at = (at + (size >> 1) + (size >> 3) + 3) % size;
                }
            }
        }
        if at != 0 {
            return Err(BROKEN);
        }
        let mut next: Vec<u32> = counts.iter().map(|count| count.unsigned_abs()).collect();
        let cell = |symbol: u8| {
            let number = &mut next[usize::from(symbol)];
            let bits = accuracy - (*number).max(1).ilog2();
            let base = (*number << bits) - size as u32;
            *number += 1;
            Cell { symbol, bits, base }
        };
        Ok(Self { cells: symbols.into_iter().map(cell).collect(), accuracy })
    }

    /// Makes a table of one symbol, which takes no bits.
    pub(super) fn of_one(symbol: u8) -> Self {
        Self { cells: vec![Cell { symbol, ..Cell::default() }], accuracy: 0 }
    }

    /// Reads the first state.
    pub(super) fn start(&self, bits: &mut BackwardBits) -> usize {
        bits.take(self.accuracy) as usize
    }

    pub(super) fn symbol(&self, state: usize) -> u8 {
        self.cells[state].symbol
    }

    pub(super) fn next(&self, state: usize, bits: &mut BackwardBits) -> usize {
        let cell = self.cells[state];
        (cell.base + bits.take(cell.bits)) as usize
    }
}

/// Reads how many of the states that are left a symbol has. Small numbers have one bit less where not all would be possible.
fn probability(bits: &mut Bits, left: i32) -> i32 {
    let most = left as u32 + 1;
    let width = most.ilog2() + 1;
    let short = (1 << width) - 1 - most;
    let low = bits.peek(width - 1);
    let value = if low < short {
        bits.skip(width - 1);
        low
    } else {
        let value = bits.take(width);
        if value >> (width - 1) == 1 { value - short } else { value }
    };
    value as i32 - 1
}
