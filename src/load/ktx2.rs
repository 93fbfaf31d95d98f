//! Reads images of KTX 2.0 files: Basis Universal (ETC1S and UASTC), and plain RGB and RGBA of 8 bits. Of a file with mip levels
//! any one can be read.
//!
//! Sources: KTX 2.0 specification, <https://registry.khronos.org/KTX/specs/2.0/ktxspec.v2.html>, sections 3 and 4; Khronos,
//! `KHR_texture_basisu`, <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_texture_basisu>.

mod basis;
#[cfg(test)]
pub(super) mod tests;
mod zstandard;

use geometry::casts::{to_u32, to_usize};
use std::borrow::Cow;

use geometry::mesh::mipmap::level_size;

/// The first bytes of every file.
const START: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";
/// The length of what precedes the list of levels, and of a level's entry, in bytes.
const HEADER: u64 = 80;
const LEVEL: u64 = 24;
/// The most levels that a file of less than 2^31 px a side can have.
const MOST_LEVELS: u32 = 31;

/// A file whose header has been read: it has one image, whose levels are in the file.
pub(super) struct Ktx2<'a> {
    bytes: &'a [u8],
    /// Width and height in px.
    pub size: [u32; 2],
    codec: Codec,
    is_zstd: bool,
    /// The largest first.
    levels: Vec<Level<'a>>,
    /// Where the data that all levels share is.
    global: [u64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Codec {
    /// With a slice of alpha.
    Etc1s(bool),
    Uastc,
    /// Numbers of 8 bits, so many a pixel.
    Plain(usize),
}

/// The data of a level.
struct Level<'a> {
    bytes: &'a [u8],
    /// Its length once it is decompressed, in bytes.
    length: u64,
}

/// Returns whether bytes begin as a KTX 2.0 file does.
pub(super) fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(&START)
}

impl<'a> Ktx2<'a> {
    /// Reads the header. Sizes and places are checked, nothing is decoded.
    ///
    /// # Errors
    /// A clause that says what is wrong.
    pub(super) fn read(bytes: &'a [u8]) -> Result<Self, String> {
        let word = |at: usize| -> Result<u32, String> {
            let word = bytes.get(at..).and_then(|rest| rest.first_chunk());
            word.map(|word| u32::from_le_bytes(*word)).ok_or_else(|| short("its KTX2 header", at as u64 + 4, bytes))
        };
        let long = |at: usize| Ok::<_, String>(u64::from(word(at)?) | u64::from(word(at + 4)?) << 32);
        let (format, [width, height]) = (word(12)?, [word(20)?, word(24)?]);
        let (depth, layers, faces, count, scheme) = (word(28)?, word(32)?, word(36)?, word(40)?, word(44)?);
        if width == 0 || height == 0 {
            return Err(format!("its KTX2 header says {width} x {height} px"));
        }
        if depth > 1 || layers > 1 || faces != 1 {
            return Err(format!(
                "its KTX2 header says depth {depth}, {layers} layers and {faces} faces; only single images are read"
            ));
        }
        if count > MOST_LEVELS {
            return Err(format!("its KTX2 header says {count} levels, but at most {MOST_LEVELS} are possible"));
        }
        let codec = codec(bytes, format, word(48)?, word(52)?)?;
        let is_zstd = match (scheme, codec) {
            (1, Codec::Etc1s(_)) => false,
            (0, Codec::Uastc | Codec::Plain(_)) => false,
            (2, Codec::Uastc | Codec::Plain(_)) => true,
            _ => return Err(format!("its KTX2 header says supercompression {scheme}, which isn't read for {codec}")),
        };
        let mut file =
            Self { bytes, size: [width, height], codec, is_zstd, levels: Vec::new(), global: [long(64)?, long(72)?] };
        for level in 0..count.max(1) {
            let at = to_usize(HEADER + LEVEL * u64::from(level));
            file.add_level(long(at)?, long(at + 8)?, long(at + 16)?)?;
        }
        if matches!(codec, Codec::Etc1s(_)) {
            part(bytes, file.global, "its KTX2 codebooks")?;
        }
        Ok(file)
    }

    fn add_level(&mut self, offset: u64, length: u64, unpacked: u64) -> Result<(), String> {
        let level = self.level_count();
        let name = format!("level {level} of its KTX2 file");
        let bytes = part(self.bytes, [offset, length], &name)?;
        let length = if self.is_zstd { unpacked } else { length };
        if let Some(needed) = self.data_bytes(level).filter(|needed| *needed != length) {
            return Err(format!("{name} has {length} bytes, but its {} needs {needed}", self.codec));
        }
        self.levels.push(Level { bytes, length });
        Ok(())
    }

    /// Returns how many bytes the data of a level has; none if its size doesn't say.
    fn data_bytes(&self, level: u32) -> Option<u64> {
        let sides = level_size(self.size, level).map(u64::from);
        let blocks = sides.map(|side| side.div_ceil(4));
        match self.codec {
            Codec::Etc1s(_) => None,
            Codec::Uastc => Some((blocks[0] * blocks[1]).saturating_mul(basis::UASTC_BLOCK as u64)),
            Codec::Plain(width) => Some((sides[0] * sides[1]).saturating_mul(width as u64)),
        }
    }

    /// Returns how many levels the file has: at least one.
    pub(super) fn level_count(&self) -> u32 {
        to_u32(self.levels.len())
    }

    /// Returns how much memory it takes to decode a level that the file has beside its pixels, in bytes.
    pub(super) fn working_bytes(&self, level: u32) -> u64 {
        match self.codec {
            // The codebooks' entries have at most 8 bytes, and there are at most 65,535 of each; the rest is a few rows.
            Codec::Etc1s(_) => (1 << 20) + 16 * u64::from(self.size[0]),
            _ if self.is_zstd => self.levels[level as usize].length + zstandard::WORKING_BYTES,
            _ => 0,
        }
    }

    /// Decodes a level that the file has to RGBA, row by row. The caller has made sure that there is memory for it, and for
    /// [`Self::working_bytes`].
    ///
    /// # Errors
    /// A clause that says what is wrong.
    pub(super) fn decode(&self, index: u32) -> Result<Vec<u8>, String> {
        let (level, size) = (&self.levels[index as usize], level_size(self.size, index));
        let data = if self.is_zstd {
            let unpacked = zstandard::decompress(level.bytes, to_usize(level.length));
            unpacked.map(Cow::Owned).map_err(|reason| format!("its Zstandard data {reason}"))?
        } else {
            Cow::Borrowed(level.bytes)
        };
        match self.codec {
            Codec::Plain(width) => Ok(rgba(&data, width)),
            Codec::Uastc => basis::uastc(&data, size),
            Codec::Etc1s(has_alpha) => {
                let global = part(self.bytes, self.global, "its KTX2 codebooks")?;
                basis::etc1s(&data, size, global, [index as usize, self.levels.len()], has_alpha)
            }
        }
    }
}

impl std::fmt::Display for Codec {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(match self {
            Self::Etc1s(_) => "ETC1S",
            Self::Uastc => "UASTC",
            Self::Plain(3) => "R8G8B8",
            Self::Plain(_) => "R8G8B8A8",
        })
    }
}

/// Reads how a file's data is stored: from the format (a `VkFormat`), or from the data format descriptor if that is 0.
fn codec(bytes: &[u8], format: u32, offset: u32, length: u32) -> Result<Codec, String> {
    match format {
        23 | 29 => return Ok(Codec::Plain(3)),
        37 | 43 => return Ok(Codec::Plain(4)),
        0 => {}
        _ => return Err(format!("its KTX2 format is VkFormat {format}; only {READ} are read")),
    }
    let descriptor = part(bytes, [offset, length].map(u64::from), "its KTX2 data format descriptor")?;
    // After the length of all follows one block: 24 bytes, then 16 for each sample.
    let (&[model, ..], Some(samples)) = (descriptor.get(12..).unwrap_or(&[]), descriptor.len().checked_sub(28)) else {
        return Err(format!("its KTX2 data format descriptor has {length} bytes, but needs at least 44"));
    };
    match (model, samples / 16) {
        (163, 1) => Ok(Codec::Etc1s(false)),
        (163, 2) => Ok(Codec::Etc1s(true)),
        (166, 1) => Ok(Codec::Uastc),
        _ => Err(format!("its KTX2 data has colour model {model} with {} samples; only {READ} are read", samples / 16)),
    }
}

const READ: &str = "ETC1S, UASTC, R8G8B8 and R8G8B8A8";

/// Returns the bytes at an offset, of a length.
fn part<'a>(bytes: &'a [u8], [offset, length]: [u64; 2], what: &str) -> Result<&'a [u8], String> {
    let end = offset.saturating_add(length);
    let range = usize::try_from(offset).ok().zip(usize::try_from(end).ok());
    range.and_then(|(start, end)| bytes.get(start..end)).ok_or_else(|| short(what, end, bytes))
}

fn short(what: &str, end: u64, bytes: &[u8]) -> String {
    format!("{what} ends at byte {end} of {}", bytes.len())
}

/// Returns RGBA of numbers that have 3 or 4 components.
fn rgba(data: &[u8], width: usize) -> Vec<u8> {
    match width {
        3 => data.as_chunks().0.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect(),
        _ => data.to_vec(),
    }
}
