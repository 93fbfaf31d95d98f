//! Decompresses Zstandard, to a length that is known beforehand: what would be longer is refused, so that data can't ask for more
//! memory than its file says. (The decoders that crates offer let one block of some bytes grow to gigabytes, or are in C.)
//! Dictionaries aren't supported.
//!
//! Source: RFC 8878, section 3.1.1 (frames and blocks) and 4 (entropy coding).

mod backward_bits;
mod fse;
mod huffman;
mod sequences;
mod xxh64;

use sequences::Sequences;
use xxh64::xxh64;

/// The most memory that decompressing takes beside the result, in bytes: literals of a block, and tables.
pub(super) const WORKING_BYTES: u64 = 1 << 19;
const MAGIC: [u8; 4] = 0xfd2f_b528_u32.to_le_bytes();
/// The greatest length of a block, in bytes.
const BLOCK: usize = 128 << 10;

/// Why data can't be decompressed, as the end of a clause.
type Fault = &'static str;

const SHORT: Fault = "ends early";
const BROKEN: Fault = "is broken";
const LONG: Fault = "decompresses to more than its file says";

/// Bytes that are read from the front.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(SHORT)?;
        self.0 = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, Fault> {
        Ok(self.take(1)?[0])
    }

    /// Reads a number of up to 8 bytes, the lowest first.
    fn number(&mut self, bytes: usize) -> Result<u64, Fault> {
        Ok(self.take(bytes)?.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }
}

/// The result so far, which never gets longer than it should.
struct Output {
    bytes: Vec<u8>,
    length: usize,
}

impl Output {
    fn check(&self, more: usize) -> Result<(), Fault> {
        if more <= self.length - self.bytes.len() { Ok(()) } else { Err(LONG) }
    }

    fn push(&mut self, bytes: &[u8]) -> Result<(), Fault> {
        self.check(bytes.len())?;
        self.bytes.extend_from_slice(bytes);
        Ok(())
    }

    /// Repeats bytes from `offset` bytes before the end, which may reach into those that it adds.
    fn repeat(&mut self, offset: usize, length: usize) -> Result<(), Fault> {
        self.check(length)?;
        let start = self.bytes.len().checked_sub(offset).filter(|_| offset > 0).ok_or(BROKEN)?;
        if length <= offset {
            self.bytes.extend_from_within(start..start + length);
        } else {
            (start..start + length).for_each(|i| self.bytes.push(self.bytes[i]));
        }
        Ok(())
    }
}

/// What a block takes over from the blocks before.
#[derive(Default)]
struct State {
    huffman: Option<huffman::Huffman>,
    sequences: Sequences,
}

/// Decompresses one frame to `length` bytes, and no more.
///
/// # Errors
/// The end of a clause that begins with the data.
pub(super) fn decompress(bytes: &[u8], length: usize) -> Result<Vec<u8>, Fault> {
    let mut reader = Reader(bytes);
    let has_checksum = header(&mut reader)?;
    let mut output = Output { bytes: Vec::with_capacity(length), length };
    let mut state = State::default();
    loop {
        let header = reader.number(3)? as usize;
        let size = header >> 3;
        match header >> 1 & 3 {
            0 => output.push(reader.take(size)?)?,
            1 => {
                let byte = reader.byte()?;
                output.check(size)?;
                output.bytes.resize(output.bytes.len() + size, byte);
            }
            2 if size <= BLOCK => compressed(reader.take(size)?, &mut state, &mut output)?,
            _ => return Err(BROKEN),
        }
        if header & 1 == 1 {
            break;
        }
    }
    if output.bytes.len() < length {
        return Err("decompresses to less than its file says");
    }
    // The lower half of the hash.
    if has_checksum && reader.number(4)? != xxh64(&output.bytes) & 0xffff_ffff {
        return Err("has another checksum than its content");
    }
    Ok(output.bytes)
}

/// Reads what precedes a frame's blocks. The size of its window doesn't matter: all of the result is at hand. Returns whether a
/// checksum of the content follows these.
fn header(reader: &mut Reader) -> Result<bool, Fault> {
    if reader.take(4)? != MAGIC {
        return Err("doesn't begin as a frame does");
    }
    let descriptor = reader.byte()?;
    let is_single = descriptor >> 5 & 1 == 1;
    if descriptor & 8 != 0 {
        return Err(BROKEN);
    }
    let window = usize::from(!is_single);
    let dictionary = [0, 1, 2, 4][usize::from(descriptor & 3)];
    let size = [usize::from(is_single), 2, 4, 8][usize::from(descriptor >> 6)];
    reader.take(window)?;
    if reader.number(dictionary)? != 0 {
        return Err("needs a dictionary");
    }
    reader.take(size)?;
    Ok(descriptor & 4 != 0)
}

/// Decompresses a block: its literals, then the sequences that copy literals and repeat what was there before.
fn compressed(block: &[u8], state: &mut State, output: &mut Output) -> Result<(), Fault> {
    let mut reader = Reader(block);
    let literals = literals(&mut reader, &mut state.huffman)?;
    state.sequences.run(reader, &literals, output)
}

fn literals(reader: &mut Reader, known: &mut Option<huffman::Huffman>) -> Result<Vec<u8>, Fault> {
    let first = *reader.0.first().ok_or(SHORT)?;
    let (kind, format) = (first & 3, usize::from(first >> 2 & 3));
    if kind < 2 {
        let (bytes, shift) = [(1, 3), (2, 4), (1, 3), (3, 4)][format];
        let size = (reader.number(bytes)? >> shift) as usize;
        return match kind {
            _ if size > BLOCK => Err(BROKEN),
            0 => Ok(reader.take(size)?.to_vec()),
            _ => Ok(vec![reader.byte()?; size]),
        };
    }
    let (bytes, width) = [(3, 10), (3, 10), (4, 14), (5, 18)][format];
    let sizes = reader.number(bytes)? >> 4;
    let [size, packed] = [sizes, sizes >> width].map(|size| size as usize & ((1 << width) - 1));
    if size > BLOCK {
        return Err(BROKEN);
    }
    let mut data = Reader(reader.take(packed)?);
    if kind == 2 {
        *known = Some(huffman::Huffman::read(&mut data)?);
    }
    let code = known.as_ref().ok_or(BROKEN)?;
    let mut literals = Vec::with_capacity(size);
    if format == 0 {
        code.decode(data.0, size, &mut literals)?;
        return Ok(literals);
    }
    let lengths = [data.number(2)?, data.number(2)?, data.number(2)?].map(|length| length as usize);
    let each = size.div_ceil(4);
    for length in lengths {
        code.decode(data.take(length)?, each.min(size - literals.len()), &mut literals)?;
    }
    code.decode(data.0, size - literals.len(), &mut literals)?;
    Ok(literals)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame of these blocks, each with its kind and size, without the size of the whole.
    fn frame(blocks: &[(u32, u32, &[u8])]) -> Vec<u8> {
        let mut bytes = [&MAGIC[..], &[0, 0]].concat();
        for (i, (kind, size, data)) in blocks.iter().enumerate() {
            let last = u32::from(i + 1 == blocks.len());
            bytes.extend(&(size << 3 | kind << 1 | last).to_le_bytes()[..3]);
            bytes.extend(*data);
        }
        bytes
    }

    /// What the reference implementation makes of 64 lines `row 0: 0 0 0`, `row 1: 1 1 1` and so on, at its level 19, with a checksum.
    /// Its literals are coded by Huffman, and all three kinds of numbers of its sequences by tables of their own.
    const ROWS: &[u8] = include_bytes!("zstd/rows.zst");

    fn rows() -> Vec<u8> {
        (0..64).flat_map(|i| format!("row {i}: {} {} {}\n", i * i, i * 7 % 64, i * 13 % 64).into_bytes()).collect()
    }

    #[test]
    fn blocks_of_all_kinds_become_what_they_were() {
        let both = frame(&[(0, 3, b"abc"), (1, 5, b"x")]);
        assert_eq!(decompress(&both, 8), Ok(b"abcxxxxx".to_vec()));
        assert_eq!(decompress(ROWS, rows().len()), Ok(rows()));
    }

    #[test]
    fn lengths_that_lie_are_refused() {
        let long = frame(&[(1, 1 << 20, b"x")]);
        assert_eq!(decompress(&long, (1 << 20) - 1), Err(LONG));
        assert_eq!(decompress(ROWS, rows().len() - 1), Err(LONG));
        assert_eq!(decompress(ROWS, rows().len() + 1), Err("decompresses to less than its file says"));
        assert_eq!(decompress(&frame(&[(3, 0, b"")]), 0), Err(BROKEN));
        assert_eq!(decompress(b"nothing like it", 0), Err("doesn't begin as a frame does"));
        assert_eq!(decompress(&[&MAGIC[..], &[1, 0, 7]].concat(), 0), Err("needs a dictionary"));
    }

    #[test]
    fn data_that_is_cut_or_changed_gives_an_error_or_the_same_bytes() {
        let whole = rows();
        for end in 0..ROWS.len() {
            assert!(decompress(&ROWS[..end], whole.len()).is_err(), "{end}");
        }
        let mut passed = 0;
        for bit in 0..8 * ROWS.len() {
            let mut bytes = ROWS.to_vec();
            bytes[bit / 8] ^= 1 << (bit % 8);
            if let Ok(bytes) = decompress(&bytes, whole.len()) {
                assert!(bytes == whole, "bit {bit}");
                passed += 1;
            }
        }
        // The window's size doesn't matter, say, and neither does the length of a code that nothing uses.
        assert!(passed < ROWS.len() / 10, "{passed} of {} bits", 8 * ROWS.len());
    }

    /// Frames of raw blocks with what the reference implementation writes as checksums.
    #[test]
    fn checksums_are_those_of_the_reference_implementation() {
        for (text, checksum) in [
            ("", 0x51d8_e999_u32),
            ("abc", 0xad77_0999),
            ("abcdefg", 0x2902_822d),
            ("abcdefghijklmnop", 0xca2d_d53d),
            ("abcdefghijklmnopqrstuvwxyz0123456789", 0x1609_b766),
        ] {
            let mut bytes = frame(&[(0, text.len() as u32, text.as_bytes())]);
            bytes[4] |= 4;
            bytes.extend(checksum.to_le_bytes());
            assert_eq!(decompress(&bytes, text.len()), Ok(text.as_bytes().to_vec()), "{text}");
            bytes.push(0);
            let last = bytes.len() - 2;
            bytes[last] ^= 0x80;
            assert_eq!(decompress(&bytes, text.len()), Err("has another checksum than its content"), "{text}");
        }
    }
}
