//! Counts the tables that a decoder makes of the prefix codes of a lossless WebP image. There are five for each of up to 65,536 groups,
//! and a file can ask for a table of 4 KiB with about 12 bytes. How many there are stands in images that come before the codes, so
//! that these are decoded here; the pixels behind the codes aren't.
//!
//! Source: RFC 9649, sections 3 to 6 of its specification of the lossless bitstream.

use super::bits::Bits;
use super::prefix_code::PrefixCode;

/// How many symbols the five codes of a group have, without those of a cache of colours: green with lengths, red, blue, alpha, and
/// distances.
const ALPHABETS: [usize; 5] = [256 + LENGTHS, 256, 256, 256, 40];
const LENGTHS: usize = 24;
/// The order in which lengths of the codes of lengths are stored.
const ORDER: [usize; 19] = [17, 18, 0, 1, 2, 3, 4, 5, 16, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
/// Distances from 1 to this are places nearby, in the order of section 5.2.2 of the standard.
const NEARBY: usize = 120;

/// The decoder's table for codes of up to so many bits has four bytes for each number of that length.
const TABLE_BITS: usize = 10;
/// Two nodes of 16 bytes for each symbol whose code is longer.
const BYTES_A_LONG_SYMBOL: u64 = 32;
/// What an allocator takes for two blocks of memory, and two of three nodes, in bytes.
const BLOCKS: u64 = 96;
/// The bytes of a group without its tables. While their list grows, the old and the new one are both in memory, and the new one has
/// room for twice as many.
const BYTES_A_GROUP: u64 = 3 * 5 * 56;

/// What is wrong with the data.
const BROKEN: &str = "its image can't be decoded: its prefix codes are broken or cut off";

/// Returns how many bytes of tables a decoder makes for an image of this width and height in px. `data` begins with the transforms,
/// behind the header. The memory that this takes itself is less than a byte for each px.
///
/// # Errors
/// A clause, if the data ends before the last code, or is broken before that.
pub(super) fn table_bytes(data: &[u8], [width, height]: [usize; 2]) -> Result<u64, &'static str> {
    let mut bits = Bits::new(data);
    let counted = Reader { bits: &mut bits }.all(width, height);
    counted.filter(|_| !bits.is_past_end()).ok_or(BROKEN)
}

struct Reader<'a, 'b> {
    bits: &'a mut Bits<'b>,
}

/// The codes of a group.
type Group = [PrefixCode; 5];

impl Reader<'_, '_> {
    fn all(&mut self, mut width: usize, height: usize) -> Option<u64> {
        let mut seen = [false; 4];
        while self.bits.take(1) == 1 {
            let kind = self.bits.take(2) as usize;
            if std::mem::replace(&mut seen[kind], true) {
                return None;
            }
            match kind {
                // Predictors and the transform of colours have a px for each block.
                0 | 1 => {
                    let block = self.bits.take(3) + 2;
                    self.image(width.div_ceil(1 << block), height.div_ceil(1 << block))?;
                }
                // Green is subtracted from red and blue.
                2 => {}
                // A table of colours. A px of the image holds several indices into a small one.
                _ => {
                    let colors = self.bits.take(8) as usize + 1;
                    self.image(colors, 1)?;
                    width = width.div_ceil(match colors {
                        ..=2 => 8,
                        3..=4 => 4,
                        5..=16 => 2,
                        _ => 1,
                    });
                }
            }
        }
        let cache = self.cache()?;
        let mut groups = 1;
        if self.bits.take(1) == 1 {
            let block = self.bits.take(3) + 2;
            let numbers = self.image(width.div_ceil(1 << block), height.div_ceil(1 << block))?;
            // The number of a group is in red and green.
            groups += numbers.into_iter().map(|px| px >> 8 & 0xffff).max()?;
        }
        let mut bytes = 0;
        for _ in 0..groups {
            let group = self.group(cache)?;
            bytes += BYTES_A_GROUP + group.iter().map(bytes_of).sum::<u64>();
        }
        Some(bytes)
    }

    /// The number of bits of an index into a cache of colours; none if there is no cache.
    fn cache(&mut self) -> Option<Option<u32>> {
        if self.bits.take(1) == 0 {
            return Some(None);
        }
        let bits = self.bits.take(4);
        (1..=11).contains(&bits).then_some(Some(bits))
    }

    fn group(&mut self, cache: Option<u32>) -> Option<Group> {
        let mut group = Group::default();
        for (index, (code, symbols)) in group.iter_mut().zip(ALPHABETS).enumerate() {
            let of_cache = cache.filter(|_| index == 0).map_or(0, |bits| 1 << bits);
            *code = self.code(symbols + of_cache)?;
        }
        Some(group)
    }

    fn code(&mut self, symbols: usize) -> Option<PrefixCode> {
        if self.bits.take(1) == 1 {
            let has_two = self.bits.take(1) == 1;
            let width = 1 + 7 * self.bits.take(1);
            let first = self.bits.take(width) as u16;
            let second = if has_two { Some(self.bits.take(8) as u16) } else { None };
            let is_known = |symbol: u16| usize::from(symbol) < symbols;
            let is_whole = is_known(first) && second.is_none_or(is_known);
            return is_whole.then(|| PrefixCode::short(first, second));
        }
        let mut lengths = vec![0; symbols];
        self.read_lengths(&mut lengths)?;
        if self.bits.is_past_end() { None } else { PrefixCode::of(&lengths) }
    }

    /// Reads the lengths of codes, which are themselves in a prefix code.
    fn read_lengths(&mut self, lengths: &mut [u8]) -> Option<()> {
        let mut own = [0; 19];
        let count = 4 + self.bits.take(4) as usize;
        for &place in ORDER.get(..count)? {
            own[place] = self.bits.take(3) as u8;
        }
        let of_lengths = PrefixCode::of(&own)?;
        let mut left = lengths.len();
        if self.bits.take(1) == 1 {
            let width = 2 + 2 * self.bits.take(3);
            left = 2 + self.bits.take(width) as usize;
            if left > lengths.len() {
                return None;
            }
        }
        let (mut at, mut last) = (0, 8);
        while at < lengths.len() && left > 0 {
            left -= 1;
            let (length, times) = match read(&of_lengths, self.bits)? {
                16 => (last, 3 + self.bits.take(2)),
                17 => (0, 3 + self.bits.take(3)),
                18 => (0, 11 + self.bits.take(7)),
                length => (length as u8, 1),
            };
            let end = at + times as usize;
            lengths.get_mut(at..end)?.fill(length);
            (at, last) = (end, if length > 0 { length } else { last });
        }
        Some(())
    }

    /// Decodes an image that has one group of codes. Its px are alpha, red, green and blue, the highest byte first.
    fn image(&mut self, width: usize, height: usize) -> Option<Vec<u32>> {
        let cache_bits = self.cache()?;
        let mut cache = Cache::of(cache_bits);
        let [greens, reds, blues, alphas, distances] = self.group(cache_bits)?;
        let (nearby, count) = (nearby(width), width * height);
        let mut image: Vec<u32> = Vec::with_capacity(count);
        while image.len() < count {
            let begun = image.len();
            match read(&greens, self.bits)? {
                green @ 0..256 => {
                    let [red, blue, alpha] =
                        [read(&reds, self.bits)?, read(&blues, self.bits)?, read(&alphas, self.bits)?];
                    image.push(alpha << 24 | red << 16 | green << 8 | blue);
                }
                green @ 256..CACHED => {
                    let length = self.number(green - 256);
                    let distance = read(&distances, self.bits)?;
                    let distance = self.number(distance);
                    let back = nearby.get(distance - 1).copied().unwrap_or_else(|| distance - NEARBY);
                    if back > begun || length > count - begun {
                        return None;
                    }
                    (0..length).for_each(|_| image.push(image[image.len() - back]));
                }
                green => image.push(*cache.colors.get((green - CACHED) as usize)?),
            }
            if self.bits.is_past_end() {
                return None;
            }
            image[begun..].iter().for_each(|&px| cache.keep(px));
        }
        Some(image)
    }

    /// The number from 1 on that a symbol and the bits behind it stand for: a length or a distance.
    fn number(&mut self, symbol: u32) -> usize {
        if symbol < 4 {
            return symbol as usize + 1;
        }
        let width = (symbol - 2) >> 1;
        (((2 + (symbol & 1)) << width) + self.bits.take(width)) as usize + 1
    }
}

/// The symbols of green from this one on are colours of the cache.
const CACHED: u32 = ALPHABETS[0] as u32;

/// Reads a symbol. One that is alone takes no bits.
fn read(code: &PrefixCode, bits: &mut Bits) -> Option<u32> {
    match code.single() {
        Some(symbol) => Some(symbol.into()),
        None => code.symbol(bits),
    }
}

/// The bytes of the tables that the decoder makes for a code.
fn bytes_of(code: &PrefixCode) -> u64 {
    if code.single().is_some() {
        return 0;
    }
    let (long, longest) = code.longer_than(TABLE_BITS);
    BLOCKS + (4 << longest.min(TABLE_BITS)) + BYTES_A_LONG_SYMBOL * u64::from(long)
}

/// How many px before the present one the places nearby are, in an image of this width. The nearest come first; of places that are equally
/// near, those in columns nearby, and left of these those on the right.
fn nearby(width: usize) -> Vec<usize> {
    let columns = |row: i64| if row == 0 { 1..=8 } else { -7..=8 };
    let mut places: Vec<_> = (0..8).flat_map(|row| columns(row).map(move |column: i64| (column, row))).collect();
    places.sort_by_key(|&(column, row)| (column * column + row * row, column.abs(), column < 0));
    places.into_iter().map(|(column, row)| (column + row * width as i64).max(1) as usize).collect()
}

/// The colours that were seen last, by a hash.
struct Cache {
    shift: u32,
    colors: Vec<u32>,
}

impl Cache {
    fn of(bits: Option<u32>) -> Self {
        Self { shift: 32 - bits.unwrap_or(0), colors: vec![0; bits.map_or(0, |bits| 1 << bits)] }
    }

    fn keep(&mut self, px: u32) {
        if !self.colors.is_empty() {
            self.colors[(0x1e35_a7bd_u32.wrapping_mul(px) >> self.shift) as usize] = px;
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
