//! Computes how much memory it takes to decode a WebP image in addition to its pixels.
//!
//! Source: RFC 9649, section 2.

use std::io::{self, Error, ErrorKind, Read, Seek, SeekFrom};

/// The memory that any image takes, in bytes: tables, and rows at the borders of blocks.
const ALWAYS: u64 = 1 << 20;

/// Returns how much memory decoding takes beside the pixels, in bytes, or 0 for a file of another format. Afterwards the file is at
/// its start.
///
/// Planes, coefficients and pixels are bounded by the size of the image. The tables of prefix codes of lossless images are not: there
/// are five for each of up to 65,536 groups (RFC 9649, section 6.2.2), and the decoder keeps up to 4 KiB for each, of which a file can
/// ask for one with about 12 bytes. How many there are only decoding tells. They are taken to be 16 times as large as the file, which is
/// more than encoders need; in a file that was made to do harm they may be 340 times as large, and at most 1.3 GiB.
///
/// # Errors
/// The errors of reading; and [`ErrorKind::InvalidData`], with a clause, for an animation, and for a file that says two sizes.
pub(super) fn webp_bytes(file: &mut (impl Read + Seek)) -> io::Result<u64> {
    file.seek(SeekFrom::Start(0))?;
    let bytes = bytes(file).or_else(|error| match error.kind() {
        // The decoder says what is missing.
        ErrorKind::UnexpectedEof => Ok(0),
        _ => Err(error),
    })?;
    file.seek(SeekFrom::Start(0))?;
    Ok(bytes)
}

fn bytes(file: &mut (impl Read + Seek)) -> io::Result<u64> {
    let start: [u8; 12] = taken(file)?;
    if !start.starts_with(b"RIFF") || !start.ends_with(b"WEBP") {
        return Ok(0);
    }
    let length = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(12))?;
    let mut at = 12;
    let mut image = Image::default();
    while at + 8 <= length {
        let [a, b, c, d, sizes @ ..]: [u8; 8] = taken(file)?;
        let size = u64::from(u32::from_le_bytes(sizes));
        image.look_at([a, b, c, d], file)?;
        if at == 12 && [a, b, c, d] != *b"VP8X" {
            break;
        }
        at += 8 + size + size % 2;
        file.seek(SeekFrom::Start(at))?;
    }
    Ok(image.bytes(length))
}

/// What a file's chunks say about its image.
#[derive(Default)]
struct Image {
    /// The size that the decoder makes room for, in px.
    size: [u32; 2],
    /// Whether there is a chunk of lossy colours, of lossless ones, and of alpha.
    lossy: bool,
    lossless: bool,
    alpha: bool,
}

impl Image {
    fn look_at(&mut self, name: [u8; 4], file: &mut impl Read) -> io::Result<()> {
        match &name {
            b"VP8X" => {
                let [flags, _, _, _, w0, w1, w2, h0, h1, h2] = taken(file)?;
                if flags & 2 != 0 {
                    return Err(animated());
                }
                self.size = [[w0, w1, w2, 0], [h0, h1, h2, 0]].map(|side| u32::from_le_bytes(side) + 1);
            }
            b"ANMF" => return Err(animated()),
            b"VP8 " => {
                let [_, _, _, _, _, _, w0, w1, h0, h1] = taken(file)?;
                let size = [[w0, w1], [h0, h1]].map(|side| u32::from(u16::from_le_bytes(side)) & 0x3fff);
                self.agree(size)?;
                self.lossy = true;
            }
            b"VP8L" => {
                let [_, sizes @ ..]: [u8; 5] = taken(file)?;
                let sizes = u32::from_le_bytes(sizes);
                self.agree([sizes, sizes >> 14].map(|side| (side & 0x3fff) + 1))?;
                self.lossless = true;
            }
            b"ALPH" => self.alpha = true,
            _ => {}
        }
        Ok(())
    }

    /// Takes a size, which must be that of the chunk before.
    fn agree(&mut self, size: [u32; 2]) -> io::Result<()> {
        if self.size != [0; 2] && self.size != size {
            let [[a, b], [c, d]] = [self.size, size];
            let said = format!("it says {a} x {b} px, but the image in it has {c} x {d}");
            return Err(Error::new(ErrorKind::InvalidData, said));
        }
        self.size = size;
        Ok(())
    }

    fn bytes(&self, length: u64) -> u64 {
        let px = self.size.into_iter().map(|side| u64::from(side).next_multiple_of(16)).product::<u64>();
        // Lossy colours are decoded to planes, two of which have a quarter of the size. Lossless ones and alpha are decoded to
        // RGBA first, with images of coefficients for squares of 4 px or more.
        let lossy = if self.lossy { 2 * px } else { 0 };
        let others = if self.lossless || self.alpha { 6 * px + 16 * length } else { 0 };
        ALWAYS + length + lossy + others
    }
}

fn animated() -> Error {
    Error::new(ErrorKind::InvalidData, "it is a WebP animation; save one of its images")
}

fn taken<const N: usize>(file: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn file(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut bytes = b"RIFF\0\0\0\0WEBP".to_vec();
        for (name, data) in chunks {
            bytes.extend(*name);
            bytes.extend((data.len() as u32).to_le_bytes());
            bytes.extend(*data);
            bytes.resize(bytes.len().next_multiple_of(2), 0);
        }
        bytes
    }

    fn of(chunks: &[(&[u8; 4], &[u8])]) -> Result<u64, String> {
        webp_bytes(&mut Cursor::new(file(chunks))).map_err(|error| error.to_string())
    }

    const CANVAS: [u8; 10] = [0, 0, 0, 0, 31, 0, 0, 15, 0, 0];
    const LOSSY: [u8; 10] = [0, 0, 0, 0x9d, 1, 0x2a, 32, 0, 16, 0];

    #[test]
    fn memory_depends_on_what_is_decoded() {
        let lossy = of(&[(b"VP8 ", &LOSSY)]).expect("a size");
        assert_eq!(lossy, ALWAYS + 30 + 2 * 512);
        let with_alpha = of(&[(b"VP8X", &CANVAS), (b"ALPH", &[1]), (b"VP8 ", &LOSSY)]).expect("a size");
        assert_eq!(with_alpha, ALWAYS + 17 * 58 + 8 * 512);
        let lossless = of(&[(b"VP8L", &[0x2f, 31, 192, 3, 0])]).expect("a size");
        assert_eq!(lossless, ALWAYS + 17 * 26 + 6 * 512);
        assert_eq!(webp_bytes(&mut Cursor::new(b"no WebP image")).expect("in memory"), 0);
    }

    #[test]
    fn two_sizes_and_animations_are_refused() {
        let lie = [0, 0, 0, 0x9d, 1, 0x2a, 0xff, 0x3f, 0xff, 0x3f];
        let said = of(&[(b"VP8X", &CANVAS), (b"VP8 ", &lie)]).expect_err("two sizes");
        assert_eq!(said, "it says 32 x 16 px, but the image in it has 16383 x 16383");
        let moving = [2, 0, 0, 0, 31, 0, 0, 15, 0, 0];
        assert!(of(&[(b"VP8X", &moving)]).is_err() && of(&[(b"VP8X", &CANVAS), (b"ANMF", &[])]).is_err());
    }
}
