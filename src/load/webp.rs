//! Checks a WebP image before it is decoded: it must be a single image of one size, whose prefix codes take little memory.
//!
//! The decoder makes tables of the prefix codes of lossless colours, and of alpha, with no regard to a limit: a file of some megabytes can
//! ask for gigabytes, however few pixels its image has. But all codes precede the pixels. So of long data only as many bytes are decoded first
//! as codes may take; if that gives a pixel, the codes end there.
//!
//! Source: RFC 9649, section 2.

use geometry::casts::{to_u32, to_usize};
use std::io::Cursor;

use image::ImageDecoder;
use image::codecs::webp::WebPDecoder;

/// The most memory that the decoder takes for a byte of prefix codes, in bytes: a table of 4 KiB for codes that are described in ten bytes,
/// and 32 bytes for each long code, 16 of which are described in a byte. Codes that were made to take the most come to 487.
const PER_CODE_BYTE: u64 = 512;
/// The greatest width and height of a lossless image in px.
const LARGEST: u32 = 1 << 14;
const ANIMATED: &str = "it is a WebP animation; save one of its images";
/// What pixels are before they are decoded.
const UNTOUCHED: u8 = 0x5b;

/// Checks a file, whose prefix codes may take so much memory, in bytes. A file of another format passes, and so does one that is cut off: the
/// decoder says what is missing.
///
/// # Errors
/// A clause for an animation, for a file that says two sizes, and for prefix codes that may take more memory.
pub(super) fn check(file: &[u8], memory: u64) -> Result<(), String> {
    let chunks = file.strip_prefix(b"RIFF").and_then(|rest| rest.get(4..)?.strip_prefix(b"WEBP"));
    let (mut rest, mut canvas) = (chunks.unwrap_or_default(), None);
    while let Some((&[a, b, c, d, length @ ..], data)) = rest.split_first_chunk::<8>() {
        let length = u32::from_le_bytes(length) as usize;
        check_chunk(&[a, b, c, d], &data[..length.min(data.len())], &mut canvas, memory)?;
        // A file that doesn't begin with a canvas has one chunk.
        if canvas.is_none() {
            break;
        }
        rest = data.get(length + length % 2..).unwrap_or_default();
    }
    Ok(())
}

/// Checks a chunk of a file with this canvas, if that is known by now.
fn check_chunk(kind: &[u8; 4], data: &[u8], canvas: &mut Option<[u32; 2]>, memory: u64) -> Result<(), String> {
    match (kind, data) {
        (b"VP8X", [flags, ..]) if flags & 2 != 0 => Err(ANIMATED.to_owned()),
        (b"ANMF", _) => Err(ANIMATED.to_owned()),
        (b"VP8X", &[_, _, _, _, w0, w1, w2, h0, h1, h2, ..]) => {
            *canvas = Some([[w0, w1, w2, 0], [h0, h1, h2, 0]].map(|side| u32::from_le_bytes(side) + 1));
            Ok(())
        }
        (b"VP8 ", &[_, _, _, _, _, _, w0, w1, h0, h1, ..]) => {
            agree(*canvas, [[w0, w1], [h0, h1]].map(|side| u32::from(u16::from_le_bytes(side)) & 0x3fff))
        }
        (b"VP8L", &[_, a, b, c, d, ref codes @ ..]) => {
            let sizes = u32::from_le_bytes([a, b, c, d]);
            let size = [sizes, sizes >> 14].map(|side| (side & 0x3fff) + 1);
            agree(*canvas, size)?;
            check_codes(codes, size, memory)
        }
        // Alpha may also be stored as it is.
        (b"ALPH", [kind, codes @ ..]) if kind & 3 == 1 => {
            canvas.map_or(Ok(()), |size| check_codes(codes, size, memory))
        }
        _ => Ok(()),
    }
}

/// Checks that an image has the size of its canvas, for which memory is counted.
fn agree(canvas: Option<[u32; 2]>, size: [u32; 2]) -> Result<(), String> {
    match canvas {
        Some([a, b]) if [a, b] != size => {
            let [c, d] = size;
            Err(format!("it says {a} x {b} px, but the image in it has {c} x {d}"))
        }
        _ => Ok(()),
    }
}

/// Checks how much memory the prefix codes of an image take. `data` is what comes behind the image's header.
fn check_codes(data: &[u8], size: [u32; 2], memory: u64) -> Result<(), String> {
    let pixels = 4 * u64::from(size[0]) * u64::from(size[1]);
    // An image that is too large is refused for that.
    if size.iter().any(|&side| side > LARGEST) || pixels > memory {
        return Ok(());
    }
    let codes = data.get(..=to_usize(memory / PER_CODE_BYTE));
    if codes.is_some_and(|codes| !has_pixels(size, codes)) {
        let allowed = memory >> 20;
        return Err(format!(
            "its prefix codes may take more memory than the {allowed} MiB that files of this size may take (--max-memory allows \
             more); save it as a PNG image"
        ));
    }
    Ok(())
}

/// Whether the start of a lossless image's data gives any pixel.
fn has_pixels(size: [u32; 2], data: &[u8]) -> bool {
    // With alpha the decoder writes into the given pixels, and not into some that it drops if data is missing.
    let header = (size[0] - 1) | (size[1] - 1) << 14 | 1 << 28;
    let length = (to_u32(data.len()) + 5).to_le_bytes();
    let file = [&b"RIFF"[..], &length, b"WEBPVP8L", &length, &[0x2f], &header.to_le_bytes(), data].concat();
    let Ok(decoder) = WebPDecoder::new(Cursor::new(file)) else { return false };
    let mut pixels = vec![UNTOUCHED; to_usize(decoder.total_bytes())];
    decoder.read_image(&mut pixels).is_ok() || pixels.iter().any(|&byte| byte != UNTOUCHED)
}

#[cfg(test)]
mod tests {
    use documents::webp::of_groups;
    use image::{ImageFormat, RgbImage, RgbaImage};

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

    /// The data of alpha that is stored in a file like the colours of this one.
    fn alpha(lossless: &[u8]) -> Vec<u8> {
        [&[1], &lossless[12 + 8 + 5..]].concat()
    }

    /// The chunk of a canvas of this size, which has less than 256 px a side.
    fn canvas(side: u8) -> [u8; 10] {
        [0, 0, 0, 0, side - 1, 0, 0, side - 1, 0, 0]
    }

    fn lossy(side: u8) -> [u8; 10] {
        [0, 0, 0, 0x9d, 1, 0x2a, side, 0, side, 0]
    }

    #[test]
    fn codes_that_may_take_too_much_are_refused_before_they_are_decoded() {
        // 60 KB, of which the decoder makes 21 MB of tables.
        let groups = of_groups(1000);
        assert_eq!(check(&groups, 32 << 20), Ok(()));
        let said = "its prefix codes may take more memory than the 16 MiB that files of this size may take (--max-memory allows \
                    more); save it as a PNG image";
        assert_eq!(check(&groups, 16 << 20), Err(said.to_owned()));
        let with_alpha = file(&[(b"VP8X", &canvas(4)), (b"ALPH", &alpha(&groups)), (b"VP8 ", &lossy(4))]);
        assert_eq!(check(&with_alpha, 16 << 20), Err(said.to_owned()));
        assert_eq!(check(&with_alpha, 32 << 20), Ok(()));
        let stored = file(&[(b"VP8X", &canvas(4)), (b"ALPH", &[0; 60_000]), (b"VP8 ", &lossy(4))]);
        assert_eq!(check(&stored, 16 << 20), Ok(()));
        assert_eq!(check(&groups[..groups.len() / 2], 32 << 20), Ok(()), "the decoder says that it is cut off");
    }

    #[test]
    fn large_images_of_few_codes_pass() {
        let mut random = fastrand::Rng::with_seed(7);
        for has_alpha in [false, true] {
            let mut bytes = Cursor::new(Vec::new());
            let noise =
                |length: usize, random: &mut fastrand::Rng| (0..length).map(|_| random.u8(..)).collect::<Vec<u8>>();
            let image: image::DynamicImage = if has_alpha {
                RgbaImage::from_raw(200, 200, noise(160_000, &mut random)).expect("four bytes a px").into()
            } else {
                RgbImage::from_raw(200, 200, noise(120_000, &mut random)).expect("three bytes a px").into()
            };
            image.write_to(&mut bytes, ImageFormat::WebP).expect("in memory");
            let bytes = bytes.into_inner();
            // Its codes may take 8 KiB.
            assert!(bytes.len() > 100_000);
            assert_eq!(check(&bytes, 4 << 20), Ok(()));
            let with_alpha = file(&[(b"VP8X", &canvas(200)), (b"ALPH", &alpha(&bytes)), (b"VP8 ", &lossy(200))]);
            assert_eq!(check(&with_alpha, 4 << 20), Ok(()));
            let large = check(&bytes, 100 << 10);
            assert_eq!(large, Ok(()), "its size is for others to refuse");
        }
    }

    #[test]
    fn two_sizes_and_animations_are_refused() {
        let two = file(&[(b"VP8X", &canvas(32)), (b"VP8 ", &lossy(33))]);
        assert_eq!(check(&two, 1 << 20), Err("it says 32 x 32 px, but the image in it has 33 x 33".to_owned()));
        assert_eq!(check(&file(&[(b"VP8X", &canvas(32)), (b"VP8 ", &lossy(32))]), 1 << 20), Ok(()));
        let moving = file(&[(b"VP8X", &[2, 0, 0, 0, 31, 0, 0, 15, 0, 0])]);
        let frames = file(&[(b"VP8X", &canvas(32)), (b"ANMF", &[])]);
        assert!(check(&moving, 1 << 20).is_err() && check(&frames, 1 << 20).is_err());
        assert_eq!([check(b"no WebP image", 0), check(&file(&[]), 0)], [Ok(()), Ok(())]);
    }
}
