//! The sequences of a block: each copies some literals, then repeats what stands some way before.
//!
//! Source: RFC 8878, sections 3.1.1.3.2 and 3.1.1.4 to 3.1.1.5; the tables of section 3.1.1.3.2.2.

use super::backward_bits::BackwardBits;
use super::fse::Table;
use super::{BROKEN, Fault, Output, Reader};

/// The default table of a kind of number, and what may be read in its place.
struct Kind {
    counts: &'static [i32],
    accuracy: u32,
    most_symbol: usize,
    most_accuracy: u32,
}

const LITERALS: Kind = Kind {
    counts: &[
        4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1, -1, -1, -1, -1,
    ],
    accuracy: 6,
    most_symbol: 35,
    most_accuracy: 9,
};
const OFFSETS: Kind = Kind {
    counts: &[1, 1, 1, 1, 1, 1, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1],
    accuracy: 5,
    most_symbol: 31,
    most_accuracy: 8,
};
const MATCHES: Kind = Kind {
    counts: &[
        1, 4, 3, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
        1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1, -1,
    ],
    accuracy: 6,
    most_symbol: 52,
    most_accuracy: 9,
};

/// The bits that follow the codes of lengths of literals from 16 on, and of matches from 32 on.
const LITERAL_BITS: [u32; 20] = [1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];
const MATCH_BITS: [u32; 21] = [1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// The tables and offsets that the next block may use again.
pub(super) struct Sequences {
    literals: Option<Table>,
    offsets: Option<Table>,
    matches: Option<Table>,
    last_offsets: [usize; 3],
}

impl Default for Sequences {
    fn default() -> Self {
        Self { literals: None, offsets: None, matches: None, last_offsets: [1, 4, 8] }
    }
}

impl Kind {
    /// Reads a table as the block says: the default, one symbol, a table of its own, or the last one again.
    fn update(&self, table: &mut Option<Table>, mode: u8, reader: &mut Reader) -> Result<(), Fault> {
        *table = Some(match mode {
            0 => Table::of(self.counts, self.accuracy)?,
            1 => Table::of_one(reader.byte()?),
            2 => Table::read(reader, self.most_symbol, self.most_accuracy)?,
            _ => table.take().ok_or(BROKEN)?,
        });
        Ok(())
    }
}

impl Sequences {
    /// Carries out the sequences of a block, and adds the literals that are left.
    pub(super) fn run(&mut self, mut reader: Reader, mut literals: &[u8], output: &mut Output) -> Result<(), Fault> {
        let first = usize::from(reader.byte()?);
        let count = match first {
            0..128 => first,
            128..255 => ((first - 128) << 8) + usize::from(reader.byte()?),
            _ => reader.number(2)? as usize + 0x7f00,
        };
        if count == 0 {
            return if reader.0.is_empty() { output.push(literals) } else { Err(BROKEN) };
        }
        let modes = reader.byte()?;
        LITERALS.update(&mut self.literals, modes >> 6, &mut reader)?;
        OFFSETS.update(&mut self.offsets, modes >> 4 & 3, &mut reader)?;
        MATCHES.update(&mut self.matches, modes >> 2 & 3, &mut reader)?;
        let (Some(of_literals), Some(of_offsets), Some(of_matches)) = (&self.literals, &self.offsets, &self.matches)
        else {
            return Err(BROKEN);
        };
        let mut bits = BackwardBits::new(reader.0)?;
        let (mut a, mut b, mut c) =
            (of_literals.start(&mut bits), of_offsets.start(&mut bits), of_matches.start(&mut bits));
        for i in 0..count {
            let offset = of_offsets.symbol(b);
            if offset > 31 {
                return Err(BROKEN);
            }
            let offset = (1_usize << offset) + bits.take(offset.into()) as usize;
            let repeated = length(of_matches.symbol(c), 32, &MATCH_BITS, &mut bits)? + 3;
            let copied = length(of_literals.symbol(a), 16, &LITERAL_BITS, &mut bits)?;
            let offset = used_offset(&mut self.last_offsets, offset, copied)?;
            let (now, rest) = literals.split_at_checked(copied).ok_or(BROKEN)?;
            literals = rest;
            output.push(now)?;
            output.repeat(offset, repeated)?;
            if i + 1 < count {
                a = of_literals.next(a, &mut bits);
                c = of_matches.next(c, &mut bits);
                b = of_offsets.next(b, &mut bits);
            }
            if bits.is_past_end() {
                return Err(BROKEN);
            }
        }
        if !bits.is_at_end() {
            return Err(BROKEN);
        }
        output.push(literals)
    }
}

/// Reads the rest of a length. Up to `direct` the code is the length; behind, the ranges follow each other.
fn length(code: u8, direct: usize, widths: &[u32], bits: &mut BackwardBits) -> Result<usize, Fault> {
    let Some(place) = usize::from(code).checked_sub(direct) else { return Ok(code.into()) };
    let width = *widths.get(place).ok_or(BROKEN)?;
    let base: usize = direct + widths[..place].iter().map(|width| 1 << width).sum::<usize>();
    Ok(base + bits.take(width) as usize)
}

/// Returns the offset that a value stands for: from 4 on 3 less, otherwise one of the last three, which it moves to the front.
fn used_offset(last: &mut [usize; 3], value: usize, copied: usize) -> Result<usize, Fault> {
    let place = if copied == 0 { value } else { value - 1 };
    let (offset, place) = match place {
        _ if value > 3 => (value - 3, 2),
        3 => (last[0] - 1, 2),
        place => (last[place], place),
    };
    if offset == 0 {
        return Err(BROKEN);
    }
    last[..=place].rotate_right(1);
    last[0] = offset;
    Ok(offset)
}
