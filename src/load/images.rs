//! Decodes the images of textures, within the memory that a load may take.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};

use super::jpeg_memory::{coefficient_bytes, most_coefficient_bytes};
use super::ktx2::{self, Ktx2};
use super::memory_budget::Budget;
use super::webp_memory::webp_bytes;
use crate::mesh::Texture;
use crate::mesh::build_limits::{MemoryAccount, MemoryRefused};

/// The greatest width and height of a texture, in px, that common GPUs support.
const MAX_SIZE: u32 = 16384;

/// The greatest amount of memory for an image's colour profile and text, in bytes.
const MAX_METADATA: u64 = 16 << 20;

/// Borrows memory for the parts of a PNG image other than its pixels, and returns it as limits for the decoder. The
/// colour profile isn't used, but may unpack to a thousand times its size.
pub(super) fn metadata_limits(budget: &Budget) -> Limits {
    let mut limits = Limits::default();
    let bytes = (budget.left() / 8).min(MAX_METADATA);
    // While a buffer grows, the old and the new one are both in memory.
    limits.max_alloc = Some(if budget.borrow(bytes).is_ok() { bytes / 2 } else { 0 });
    limits
}

/// Decodes a PNG, JPEG, WebP or KTX2 image (its first bytes tell which) to RGBA, unless its header says that it is too large.
///
/// # Errors
/// A clause that says what is wrong.
pub(super) fn decode_texture(bytes: &[u8], budget: &Budget) -> Result<Texture, String> {
    if ktx2::is_ktx2(bytes) {
        return decode_ktx2(bytes, budget);
    }
    let undecoded = |error: ImageError| format!("its image can't be decoded: {error}");
    let of_webp = webp_bytes(&mut Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let known = coefficient_bytes(&mut Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string())?;
    if reader.format() == Some(ImageFormat::Png) {
        reader.limits(metadata_limits(budget));
    }
    let is_jpeg = reader.format() == Some(ImageFormat::Jpeg);
    let mut decoder = reader.into_decoder().map_err(undecoded)?;
    let size @ [width, height] = decoder.dimensions().into();
    check_size(size)?;
    let px = u64::from(width) * u64::from(height);
    let too_large = |refused| too_large(size, refused);
    budget.borrow(decoder.total_bytes()).map_err(too_large)?;
    // The decoder frees them before the pixels are converted to RGBA.
    let working = if is_jpeg { known.unwrap_or_else(|| most_coefficient_bytes(size)) } else { of_webp };
    budget.hold(working).map_err(too_large)?;
    budget.release(working);
    budget.hold(px * 4).map_err(too_large)?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(budget.left().max(1 << 20).saturating_add(decoder.total_bytes()));
    decoder.set_limits(limits).map_err(undecoded)?;
    let pixels = DynamicImage::from_decoder(decoder).map_err(undecoded)?.into_rgba8();
    Ok(Texture { size: pixels.dimensions().into(), rgba: pixels.into_raw() })
}

fn decode_ktx2(bytes: &[u8], budget: &Budget) -> Result<Texture, String> {
    let file = Ktx2::read(bytes)?;
    check_size(file.size)?;
    let px = file.size.map(u64::from).into_iter().product::<u64>();
    let too_large = |refused| too_large(file.size, refused);
    let borrowed = budget.borrowed();
    budget.borrow(file.working_bytes()).map_err(too_large)?;
    budget.hold(px * 4).map_err(too_large)?;
    let decoded = file.decode().inspect_err(|_| budget.release(px * 4));
    budget.give_back_to(borrowed);
    Ok(Texture { size: file.size, rgba: decoded? })
}

fn check_size([width, height]: [u32; 2]) -> Result<(), String> {
    let advice = "scale it to 4096 px a side or less";
    match width.max(height) > MAX_SIZE {
        true => {
            Err(format!("its image has {width} x {height} px, but at most {MAX_SIZE} px a side are read; {advice}"))
        }
        false => Ok(()),
    }
}

fn too_large([width, height]: [u32; 2], refused: MemoryRefused) -> String {
    format!("its image of {width} x {height} px {refused}; scale it down")
}
