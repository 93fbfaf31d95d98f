//! Reads panoramas of light: Radiance (`.hdr`) and OpenEXR (`.exr`) files.
//!
//! Sources: Ward, "Real Pixels", Graphics Gems II, 1991; "Technical Introduction to OpenEXR", <https://openexr.com>.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use image::codecs::hdr::HdrDecoder;
use image::codecs::openexr::OpenExrDecoder;
use image::{ImageDecoder, ImageError};

use super::format::extension_of;
use super::memory_budget::Budget;
use super::panorama::{Panorama, Repaired};
use super::watched_bytes::watched;
use crate::files::{FileError, Limits, read_file};
use geometry::mesh::MemoryRefused;
use geometry::names::{shown, shown_path};
use geometry::progress::{Cancelled, Progress};

/// The endings of files that can be read, in lower case.
pub const ENVIRONMENT_EXTENSIONS: [&str; 2] = ["hdr", "exr"];

/// The greatest width and height that are read, in px.
const MOST_SIDE: u32 = 16384;

/// The greatest height that is kept, in px; twice as much of the width.
const KEPT_ROWS: usize = 2048;

/// How the files begin: Radiance files by newer and by older programs, and OpenEXR files.
const RADIANCE: &[u8] = b"#?RADIANCE";
const OLD_RADIANCE: &[u8] = b"#?RGBE";
const OPEN_EXR: &[u8] = b"\x76\x2f\x31\x01";

/// The light of a file, and what was repaired.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentFile {
    /// At most 4096 x 2048 px.
    pub panorama: Panorama,
    /// In sentences, after the file's name if it has one.
    pub warnings: Vec<String>,
}

/// Why the light of a file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum EnvironmentError {
    /// Reading was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The file could not be read.
    #[error(transparent)]
    File(FileError),
    /// Something is wrong in the file.
    #[error("{}: {fault}", shown_path(path))]
    Broken { path: PathBuf, fault: EnvironmentFault },
}

/// What is wrong in a file. The message doesn't contain the file's path.
#[derive(Debug, thiserror::Error)]
pub enum EnvironmentFault {
    /// Reading was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// It is no panorama.
    #[error("it begins neither like a Radiance file (.hdr) nor like an OpenEXR file (.exr); choose another file")]
    Unknown,
    /// The decoder refuses it.
    #[error("it can't be decoded: {reason}; save it again as a Radiance or an OpenEXR file with red, green and blue")]
    Undecoded { reason: String },
    /// It has fewer bytes than its header says.
    #[error("it ends too early: the file is cut short; copy or download it again")]
    Short,
    /// It has no pixels.
    #[error("it has {} x {} px, which is no picture; choose another file", size[0], size[1])]
    Empty { size: [u32; 2] },
    /// It is wider or higher than is read.
    #[error("it has {} x {} px, but at most {MOST_SIDE} px a side are read; scale it down", size[0], size[1])]
    TooLarge { size: [u32; 2] },
    /// It would take too much memory.
    #[error(
        "it has {} x {} px and {reason}; scale it to 4096 x 2048 px",
        size[0], size[1]
    )]
    TooMuch { size: [u32; 2], reason: MemoryRefused },
}

impl From<FileError> for EnvironmentError {
    fn from(error: FileError) -> Self {
        match error {
            FileError::Cancelled(cancelled) => cancelled.into(),
            error => Self::File(error),
        }
    }
}

/// Whether a path has the ending of a file of light.
pub fn is_environment(path: &Path) -> bool {
    extension_of(path).is_some_and(|extension| ENVIRONMENT_EXTENSIONS.contains(&&*extension))
}

impl EnvironmentFile {
    /// Width and height of the panorama in px.
    pub fn size(&self) -> [u32; 2] {
        self.panorama.size()
    }

    /// The radiance of all pixels: their red, green and blue, one after another.
    pub fn radiance(&self) -> impl Iterator<Item = f32> {
        self.panorama.pixels().iter().flat_map(|pixel| pixel.to_array())
    }

    /// Reads a file; its first bytes tell the format. Sets `progress` from 0 to 1.
    ///
    /// # Errors
    /// [`EnvironmentError`], whose message says what is wrong and what to do.
    pub fn load(path: &Path, limits: &Limits, progress: &Progress) -> Result<Self, EnvironmentError> {
        progress.set(0.0);
        let broken = |fault| match fault {
            EnvironmentFault::Cancelled(cancelled) => EnvironmentError::Cancelled(cancelled),
            fault => EnvironmentError::Broken { path: path.to_owned(), fault },
        };
        let known = |start: &[u8]| check_start(start).map_err(broken);
        let bytes = read_file(path, limits, known, progress)?;
        let own = Self::read(&bytes, limits, progress).map_err(broken)?;
        let name = shown_path(Path::new(path.file_name().unwrap_or(path.as_os_str())));
        Ok(Self { warnings: own.warnings.iter().map(|warning| format!("{name}: {warning}")).collect(), ..own })
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// [`EnvironmentFault`].
    pub fn read(bytes: &[u8], limits: &Limits, progress: &Progress) -> Result<Self, EnvironmentFault> {
        check_start(bytes)?;
        let budget = Budget::new(bytes.len(), limits.memory);
        let pixels = pixels(bytes, &budget, progress.part(0.0, 0.7));
        // Cancelling stops the decoder with some error.
        progress.check()?;
        let (size, pixels) = pixels?;
        let (panorama, repaired) = Panorama::new(size, pixels);
        progress.set(0.8);
        let panorama = panorama.reduced(KEPT_ROWS);
        progress.check()?;
        progress.set(1.0);
        let warnings = warnings(size, panorama.size(), repaired);
        Ok(Self { panorama, warnings })
    }
}

fn check_start(start: &[u8]) -> Result<(), EnvironmentFault> {
    let is_known = [RADIANCE, OLD_RADIANCE, OPEN_EXR].iter().any(|known| start.starts_with(known));
    if is_known { Ok(()) } else { Err(EnvironmentFault::Unknown) }
}

/// Decodes the pixels, in linear RGB. Returns the size too.
fn pixels(bytes: &[u8], budget: &Budget, progress: Progress) -> Result<([u32; 2], Vec<[f32; 3]>), EnvironmentFault> {
    let reader = watched(bytes, progress);
    if !bytes.starts_with(OPEN_EXR) {
        let decoder = HdrDecoder::with_strictness(reader, !bytes.starts_with(OLD_RADIANCE)).map_err(undecoded)?;
        return decode(decoder, budget, |_| 0);
    }
    let unpacking = unpacking_bytes(bytes)?;
    let decoder = OpenExrDecoder::with_alpha_preference(reader, Some(false)).map_err(undecoded)?;
    // The decoder has a copy of the pixels.
    decode(decoder, budget, |whole| whole.saturating_add(unpacking))
}

/// What unpacking an OpenEXR file takes beside its pixels, in bytes: of a block there are about three copies.
pub(super) fn unpacking_bytes(bytes: &[u8]) -> Result<u64, EnvironmentFault> {
    let headers = MetaData::read_from_buffered(bytes, false).map_err(|error| because(&error.to_string()))?.headers;
    Ok(headers.iter().map(block_bytes).max().unwrap_or(0).saturating_mul(3))
}

/// The size of a decompressed block of an OpenEXR layer, in bytes.
fn block_bytes(header: &Header) -> u64 {
    let pixels = match header.blocks {
        BlockDescription::Tiles(tiles) => {
            (tiles.tile_size.width() as u64).saturating_mul(tiles.tile_size.height() as u64)
        }
        BlockDescription::ScanLines => {
            (header.layer_size.width() as u64).saturating_mul(header.compression.scan_lines_per_block() as u64)
        }
    };
    pixels.saturating_mul(header.channels.bytes_per_pixel as u64)
}

/// Decodes all pixels, if the budget has room for them and for `beside`, which is told their bytes.
fn decode(
    decoder: impl ImageDecoder,
    budget: &Budget,
    beside: impl FnOnce(u64) -> u64,
) -> Result<([u32; 2], Vec<[f32; 3]>), EnvironmentFault> {
    let (width, height) = decoder.dimensions();
    let size = [width, height];
    if size.contains(&0) {
        return Err(EnvironmentFault::Empty { size });
    }
    if size.iter().any(|side| *side > MOST_SIDE) {
        return Err(EnvironmentFault::TooLarge { size });
    }
    let whole = decoder.total_bytes();
    // A panorama that is too large to be kept is halved, and both are there for a while.
    let halved = whole / 4;
    let needed = whole.saturating_add(beside(whole).max(halved));
    budget.hold(needed).map_err(|reason| EnvironmentFault::TooMuch { size, reason })?;
    let mut pixels = vec![[0.0_f32; 3]; width as usize * height as usize];
    decoder.read_image(bytemuck::cast_slice_mut(&mut pixels)).map_err(undecoded)?;
    Ok((size, pixels))
}

/// What the `exr` crate says of a file that ends too early; it has no kind of error for that.
const MISSING_BYTES: &str = "reference to missing bytes";

fn undecoded(error: ImageError) -> EnvironmentFault {
    match error {
        ImageError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => EnvironmentFault::Short,
        error => because(&error.to_string()),
    }
}

fn because(reason: &str) -> EnvironmentFault {
    if reason.ends_with(MISSING_BYTES) {
        return EnvironmentFault::Short;
    }
    EnvironmentFault::Undecoded { reason: shown(reason) }
}

/// Sentences about what was changed.
fn warnings(size: [u32; 2], kept: [u32; 2], repaired: Repaired) -> Vec<String> {
    let [width, height] = size;
    let is_panorama = width == 2 * height;
    let stretched = (!is_panorama).then(|| {
        format!(
            "it has {width} x {height} px; a panorama of all directions is twice as wide as high, so what it shows is stretched."
        )
    });
    let reduced = (kept != size)
        .then(|| format!("it has {width} x {height} px, and was reduced to {} x {} px.", kept[0], kept[1]));
    [stretched, reduced].into_iter().flatten().chain(repaired.sentences()).collect()
}

#[cfg(test)]
pub mod tests;
