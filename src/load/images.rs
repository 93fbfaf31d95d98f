//! Decodes the images of textures, within the memory that a load may take.

use std::io::{BufRead, Cursor, Seek};

use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};

use super::ktx2::{self, Ktx2};
use super::memory_budget::Budget;
use super::webp;
use geometry::casts::to_usize;
use geometry::mesh::Texture;
use geometry::mesh::build_limits::{Borrowed, MemoryRefused, borrowing};
use geometry::mesh::mipmap::{MipFilter, RowHalver, halved, level_size};

/// The greatest width and height of an image that is read, in px.
pub(super) const MAX_SIZE: u32 = 16384;

/// The greatest amount of memory for an image's colour profile and text, in bytes.
const MAX_METADATA: u64 = 16 << 20;

/// Borrows memory for the parts of a PNG image other than its pixels, and returns it as limits for the decoder. The
/// colour profile isn't used, but may unpack to a thousand times its size.
fn metadata_limits(budget: &Budget) -> Limits {
    let mut limits = Limits::default();
    let bytes = (budget.left() / 8).min(MAX_METADATA);
    // While a buffer grows, the old and the new one are both in memory.
    limits.max_alloc = Some(if budget.borrow(bytes).is_ok() { bytes / 2 } else { 0 });
    limits
}

/// Returns the width and height of a PNG, JPEG, WebP, TGA, BMP or KTX2 image in px, without decoding it; none if it isn't one that
/// is read.
pub(super) fn texture_size(bytes: &[u8]) -> Option<[u32; 2]> {
    if ktx2::is_ktx2(bytes) {
        return Ktx2::read(bytes).ok().map(|file| file.size).filter(|size| check_size("", *size).is_ok());
    }
    let size = match png_header(bytes) {
        Some((size, _)) => size,
        None => decoder(Cursor::new(bytes), bytes, &Budget::unlimited()).ok()?.dimensions().into(),
    };
    check_size("", size).is_ok().then_some(size)
}

/// Decodes a PNG, JPEG, WebP, TGA, BMP or KTX2 image (its first bytes tell which) to RGBA, unless its header says that it is too
/// large, and halves it so many times.
///
/// # Errors
/// A clause that says what is wrong.
pub(super) fn decode_halved(
    bytes: &[u8],
    halvings: u32,
    filter: MipFilter,
    budget: &Budget,
) -> Result<Texture, String> {
    let decode = if ktx2::is_ktx2(bytes) { decode_ktx2 } else { decode_file };
    let texture = borrowing(budget, || decode(bytes, halvings, filter, budget))?;
    let refused = |refused| too_large(texture.size, refused);
    budget.hold(decoded_bytes(texture.size)).map_err(refused)?;
    Ok(texture)
}

/// The size of a decoded texture, in bytes.
pub(super) fn decoded_bytes([width, height]: [u32; 2]) -> u64 {
    4 * u64::from(width) * u64::from(height)
}

/// Returns how much memory it takes to decode an image and to convert it to RGBA, in bytes. Some decoders take up to 8 bytes a pixel beside
/// the decoded image, for the coefficients of a progressive JPEG image say, but less than twice as much as this in all.
pub(super) fn decoding_bytes(decoder: &impl ImageDecoder) -> u64 {
    decoder.total_bytes().saturating_add(decoded_bytes(decoder.dimensions().into()))
}

/// Whether the first bytes of a file are those of an image that is read.
pub(super) fn is_image(start: &[u8]) -> bool {
    image::guess_format(start).is_ok() || ktx2::is_ktx2(start) || may_be_tga(start)
}

/// Prepares to decode an image of the format that its first bytes show, all but KTX2: `source` reads `bytes`. What a PNG has
/// beside its px is borrowed.
pub(super) fn decoder<'a, R: BufRead + Seek + 'a>(
    source: R,
    bytes: &[u8],
    budget: &Budget,
) -> Result<impl ImageDecoder + use<'a, R>, ImageError> {
    let mut reader = ImageReader::new(source).with_guessed_format()?;
    match reader.format() {
        Some(ImageFormat::Png) => reader.limits(metadata_limits(budget)),
        None if may_be_tga(bytes) => reader.set_format(ImageFormat::Tga),
        _ => {}
    }
    reader.into_decoder()
}

/// Whether a header can be that of a TGA image, which has no signature: what it says of its colour map, of its kind, and of the bits of a
/// pixel (Truevision, TGA File Format Specification 2.0).
fn may_be_tga(bytes: &[u8]) -> bool {
    bytes.first_chunk::<18>().is_some_and(|header| {
        header[1] <= 1 && matches!(header[2], 1..=3 | 9..=11) && matches!(header[16], 8 | 15 | 16 | 24 | 32)
    })
}

/// Decodes a PNG, JPEG, WebP, TGA or BMP image. All memory is borrowed.
fn decode_file(bytes: &[u8], halvings: u32, filter: MipFilter, budget: &Budget) -> Result<Texture, String> {
    let undecoded = |error: ImageError| format!("its image can't be decoded: {error}");
    webp::check(bytes, budget.allowed())?;
    let whole = Borrowed::from(budget);
    let mut decoder = decoder(Cursor::new(bytes), bytes, budget).map_err(undecoded)?;
    let size = decoder.dimensions().into();
    check_size("its image", size)?;
    let has_rows = png_header(bytes).is_some_and(|(_, is_interlaced)| !is_interlaced);
    let room = budget.borrow(decoding_bytes(&decoder));
    if has_rows && (halvings > 0 || room.is_err()) {
        drop(decoder);
        drop(whole);
        return decode_rows(bytes, halvings, filter, budget);
    }
    room.map_err(|refused| too_large(size, refused))?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(budget.left().max(1 << 20).saturating_add(decoder.total_bytes()));
    decoder.set_limits(limits).map_err(undecoded)?;
    let pixels = DynamicImage::from_decoder(decoder).map_err(undecoded)?.into_rgba8();
    let whole = Texture { size: pixels.dimensions().into(), rgba: pixels.into_raw() };
    Ok((0..halvings).fold(whole, |texture, _| halved(&texture, filter)))
}

/// Decodes a PNG image that isn't interlaced row by row, so that it takes little more memory than the smaller image. All memory is
/// borrowed.
fn decode_rows(bytes: &[u8], halvings: u32, filter: MipFilter, budget: &Budget) -> Result<Texture, String> {
    let undecoded = |error: png::DecodingError| format!("its image can't be decoded: {error}");
    let most = metadata_limits(budget).max_alloc.unwrap_or(0);
    let limits = png::Limits { bytes: usize::try_from(most).unwrap_or(usize::MAX) };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_ignore_text_chunk(true);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(undecoded)?;
    let size = reader.info().size().into();
    check_size("its image", size)?;
    let (color, depth) = reader.output_color_type();
    let line = reader.output_line_size(size[0]).ok_or("its rows are too long")?;
    let made = level_size(size, halvings);
    // The decoder keeps two rows, this keeps one, and each halving three.
    let rows = 3 * line as u64 + 8 * decoded_bytes([size[0], 1]);
    budget.borrow(decoded_bytes(made).saturating_add(rows)).map_err(|refused| too_large(size, refused))?;
    let mut line = vec![0; line];
    let mut halvers: Vec<_> = (0..halvings).map(|level| RowHalver::new(level_size(size, level), filter)).collect();
    let mut rgba = Vec::with_capacity(to_usize(decoded_bytes(made)));
    for _ in 0..size[1] {
        reader.read_row(&mut line).map_err(undecoded)?;
        let row = rgba_row(&line, color, depth == png::BitDepth::Sixteen);
        let row = halvers.iter_mut().try_fold(row, |row, halver| halver.push(row));
        rgba.extend(row.unwrap_or_default());
    }
    Ok(Texture { size: made, rgba })
}

/// Converts a row of pixels of 8 or 16 bits a channel to RGBA of 8 bits.
#[expect(clippy::cast_possible_truncation, reason = "at most 255")]
fn rgba_row(line: &[u8], color: png::ColorType, is_wide: bool) -> Vec<u8> {
    let (channels, width) = (color.samples(), if is_wide { 2 } else { 1 });
    let channel = |px: &[u8], index: usize| match is_wide {
        // 65535 is 257 times 255.
        true => ((u32::from(u16::from_be_bytes([px[2 * index], px[2 * index + 1]])) + 128) / 257) as u8,
        false => px[index],
    };
    let pixels = line.chunks_exact(channels * width);
    let rgba = pixels.flat_map(|px| match channels {
        1 => [channel(px, 0), channel(px, 0), channel(px, 0), 255],
        2 => [channel(px, 0), channel(px, 0), channel(px, 0), channel(px, 1)],
        3 => [channel(px, 0), channel(px, 1), channel(px, 2), 255],
        _ => [0, 1, 2, 3].map(|index| channel(px, index)),
    });
    rgba.collect()
}

/// Decodes a level of a KTX2 image, and halves it if the file doesn't have the one that is needed. All memory is borrowed.
fn decode_ktx2(bytes: &[u8], halvings: u32, filter: MipFilter, budget: &Budget) -> Result<Texture, String> {
    let file = Ktx2::read(bytes)?;
    check_size("its image", file.size)?;
    let level = halvings.min(file.level_count().saturating_sub(1));
    let size = level_size(file.size, level);
    let needed = file.working_bytes(level).saturating_add(decoded_bytes(size));
    // A smaller level is made while the one before is still there.
    let more = if halvings > level { decoded_bytes(level_size(size, 1)) } else { 0 };
    budget.borrow(needed.saturating_add(more)).map_err(|refused| too_large(file.size, refused))?;
    let decoded = Texture { size, rgba: file.decode(level)? };
    Ok((level..halvings).fold(decoded, |texture, _| halved(&texture, filter)))
}

/// Returns the width and height in the header of a PNG image in px, and whether it is interlaced; none for another file.
pub(super) fn png_header(bytes: &[u8]) -> Option<([u32; 2], bool)> {
    let header = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR")?.first_chunk::<13>()?;
    let side = |at: usize| u32::from_be_bytes(std::array::from_fn(|k| header[at + k]));
    Some(([side(0), side(4)], header[12] != 0))
}

/// Says what is wrong with an image of this size in px, as a clause that begins with its name.
pub(super) fn check_size(name: &str, [width, height]: [u32; 2]) -> Result<(), String> {
    let advice = "scale it to 4096 px a side or less";
    match width.max(height) > MAX_SIZE {
        true => Err(format!("{name} has {width} x {height} px, but at most {MAX_SIZE} px a side are read; {advice}")),
        false => Ok(()),
    }
}

fn too_large([width, height]: [u32; 2], refused: MemoryRefused) -> String {
    format!("its image of {width} x {height} px {refused}; scale it down")
}

#[cfg(test)]
pub(super) mod tests;
