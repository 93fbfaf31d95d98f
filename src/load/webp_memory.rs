//! Computes how much memory it takes to decode a WebP image in addition to its pixels.
//!
//! Source: RFC 9649, section 2.

use std::io::{self, Error, ErrorKind, Read, Seek, SeekFrom};

use super::webp_tables::table_bytes;

/// The memory that any image takes, in bytes: tables, and rows at the borders of blocks.
const ALWAYS: u64 = 1 << 20;

/// Returns how much memory decoding takes beside the pixels, in bytes, or 0 for a file of another format. Afterwards the file is at
/// its start.
///
/// Planes, coefficients and pixels are bounded by the size of the image. The tables of prefix codes of lossless images are counted in the
/// file, unless the rest takes more than `most` bytes already.
///
/// # Errors
/// The errors of reading; and [`ErrorKind::InvalidData`], with a clause, for an animation, for a file that says two sizes, and for prefix
/// codes that are broken.
pub(super) fn webp_bytes(file: &mut (impl Read + Seek), most: u64) -> io::Result<u64> {
    file.seek(SeekFrom::Start(0))?;
    let bytes = bytes(file, most).or_else(|error| match error.kind() {
        // The decoder says what is missing.
        ErrorKind::UnexpectedEof => Ok(0),
        _ => Err(error),
    })?;
    file.seek(SeekFrom::Start(0))?;
    Ok(bytes)
}

fn bytes(file: &mut (impl Read + Seek), most: u64) -> io::Result<u64> {
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
        match image.look_at([a, b, c, d], file) {
            // The chunks before it count all the same.
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => break,
            seen => seen?,
        }
        image.note_codes([a, b, c, d], at + 8, size.min(length - at - 8));
        if at == 12 && [a, b, c, d] != *b"VP8X" {
            break;
        }
        at += 8 + size + size % 2;
        file.seek(SeekFrom::Start(at))?;
    }
    let bytes = image.bytes(length);
    Ok(if bytes > most { bytes } else { bytes.saturating_add(image.table_bytes(file)?) })
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
    /// Where the first chunks of lossless colours and of alpha are, and how many bytes of them there are.
    coded: [Option<[u64; 2]>; 2],
}

/// The bytes before the transforms: in a chunk of lossless colours, and in one of alpha.
const HEADERS: [usize; 2] = [5, 1];

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

    fn note_codes(&mut self, name: [u8; 4], start: u64, size: u64) {
        let chunk = match &name {
            b"VP8L" => 0,
            b"ALPH" => 1,
            _ => return,
        };
        self.coded[chunk].get_or_insert([start, size]);
    }

    /// The bytes of the tables of prefix codes. One chunk is decoded after the other.
    fn table_bytes(&self, file: &mut (impl Read + Seek)) -> io::Result<u64> {
        let mut most = 0;
        for (header, [start, size]) in
            HEADERS.into_iter().zip(self.coded).filter_map(|(header, at)| Some((header, at?)))
        {
            file.seek(SeekFrom::Start(start))?;
            let mut data = Vec::new();
            file.by_ref().take(size).read_to_end(&mut data)?;
            let Some((header, codes)) = data.split_at_checked(header) else { continue };
            // Alpha that isn't compressed has no codes.
            if header.len() == 1 && header[0] & 3 != 1 {
                continue;
            }
            let broken = |clause| Error::new(ErrorKind::InvalidData, clause);
            most = most.max(table_bytes(codes, self.size.map(|side| side as usize)).map_err(broken)?);
        }
        Ok(most)
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
        let others = if self.lossless || self.alpha { 6 * px } else { 0 };
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
        webp_bytes(&mut Cursor::new(file(chunks)), u64::MAX).map_err(|error| error.to_string())
    }

    const CANVAS: [u8; 10] = [0, 0, 0, 0, 31, 0, 0, 15, 0, 0];
    const LOSSY: [u8; 10] = [0, 0, 0, 0x9d, 1, 0x2a, 32, 0, 16, 0];

    #[test]
    fn memory_depends_on_what_is_decoded() {
        let lossy = of(&[(b"VP8 ", &LOSSY)]).expect("a size");
        assert_eq!(lossy, ALWAYS + 30 + 2 * 512);
        let with_alpha = of(&[(b"VP8X", &CANVAS), (b"ALPH", &[0]), (b"VP8 ", &LOSSY)]).expect("a size");
        assert_eq!(with_alpha, ALWAYS + 58 + 8 * 512);
        // No transform, no cache, one group of five codes of the symbol 0.
        let codes = [0b1000_1000, 0b1000_1000, 0b0000_1000];
        let lossless = [&[0x2f, 31, 192, 3, 0], &codes[..]].concat();
        assert_eq!(of(&[(b"VP8L", &lossless)]), Ok(ALWAYS + 28 + 6 * 512 + 840));
        let with_more = of(&[(b"VP8X", &CANVAS), (b"VP8L", &lossless), (b"VP8L", &[0x2f])]);
        assert_eq!(with_more, Ok(ALWAYS + 56 + 6 * 512 + 840), "the first chunk is decoded, whatever comes behind it");
        assert_eq!(webp_bytes(&mut Cursor::new(b"no WebP image"), u64::MAX).expect("in memory"), 0);
    }

    #[test]
    fn broken_codes_are_refused_unless_the_image_is_too_large_anyway() {
        let image = [(b"VP8L", &[0x2f, 31, 192, 3, 0][..])];
        let said = of(&image).expect_err("no codes");
        assert_eq!(said, "its image can't be decoded: its prefix codes are broken or cut off");
        let bytes = webp_bytes(&mut Cursor::new(file(&image)), 5000).expect("a size");
        assert_eq!(bytes, ALWAYS + 26 + 6 * 512);
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
