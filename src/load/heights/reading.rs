//! Reads a height image: first its size, to check the memory that it takes, then its pixels row by row.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use image::{ColorType, ImageDecoder, ImageError, ImageFormat, ImageReader};
use png::{BitDepth, DecodingError};

use super::{HeightError, MAX_SIZE};
use crate::files::{file_reason, open_file};
use crate::images::{decoding_bytes, metadata_limits};
use crate::memory_budget::Budget;
use crate::webp;
use geometry::casts::to_usize;
use geometry::mesh::build_limits::{Borrowed, MemoryRefused, borrowing};
use geometry::mesh::heights::HeightMap;
use geometry::progress::{Cancelled, Progress};

/// The bytes before a PNG image's width and height, which have 4 bytes each.
const PNG_START: &[u8; 16] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";

/// Reads a PNG, JPEG or WebP image. A PNG is read row by row, so that a large image takes no more memory than its map; a
/// JPEG, a WebP, and an interlaced PNG, is decoded whole. The file's size is added to the budget. `beside` is how many
/// bytes heights take beside their map.
///
/// # Errors
/// If the file isn't such an image, or the image is too large, or `progress` was cancelled.
pub(super) fn read_map(
    path: &Path,
    beside: u64,
    budget: &Budget,
    progress: &Progress,
) -> Result<HeightMap, HeightError> {
    progress.check()?;
    let image = ImageFile { path, beside, budget, progress };
    let unread = |error: io::Error| image.fail(file_reason(&error));
    let no_file = || image.fail("it is not a file; choose a PNG, JPEG or WebP image".to_owned());
    let (mut file, about) = open_file(path).map_err(unread)?.ok_or_else(no_file)?;
    let size = png_size(&mut file).map_err(unread)?;
    image.check(size.unwrap_or_default())?;
    let length = about.len();
    // If rows are read one by one, they set the progress, and the number of bytes read doesn't.
    let told = size.is_none().then(|| progress.part(0.0, 0.6));
    let mut reader = BufReader::new(ProgressReader { file, length, read: 0, progress, told });
    if size.is_some() && !is_interlaced(&mut reader).map_err(unread)? {
        return image.read_rows(reader, length);
    }
    image.read_whole(reader, length)
}

/// Computes the brightness of pixels of 8 or 16 bits a channel, with the weights of Rec. 709 and no transfer function,
/// since heights aren't light. Gray images keep their values with all bits.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub(super) fn map_of_px(
    size: [u32; 2],
    color: ColorType,
    bytes: &[u8],
    progress: &Progress,
) -> Result<HeightMap, Cancelled> {
    let line = usize::from(color.bytes_per_pixel()) * size[0] as usize;
    if line == 0 || size[1] == 0 || bytes.len() != line * size[1] as usize {
        return Ok(HeightMap::new([0, 0], Vec::new()));
    }
    let mut lines = bytes.chunks_exact(line);
    let [channels, depth] = [color.channel_count(), color.bytes_per_pixel() / color.channel_count()];
    HeightMap::build(size, progress, |out| {
        let line = lines.next().unwrap_or_default();
        brighten(line, channels.into(), depth == 2, u16::from_ne_bytes, out);
        Ok(())
    })
}

/// Computes the brightness of each pixel of a row with `channels` channels of 8 bits, or of 16 bits if `is_wide`.
fn brighten(line: &[u8], channels: usize, is_wide: bool, of_bytes: fn([u8; 2]) -> u16, out: &mut [f32]) {
    let channel = |px: &[u8], index: usize| match is_wide {
        true => f32::from(of_bytes([px[2 * index], px[2 * index + 1]])) / 65535.0,
        false => f32::from(px[index]) / 255.0,
    };
    for (height, px) in out.iter_mut().zip(line.chunks_exact(if is_wide { 2 * channels } else { channels })) {
        *height = if channels < 3 { channel(px, 0) } else { brightness([0, 1, 2].map(|k| channel(px, k))) };
    }
}

fn brightness([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// An image file that is being read, with what reading it needs.
struct ImageFile<'a> {
    path: &'a Path,
    beside: u64,
    budget: &'a Budget,
    progress: &'a Progress,
}

impl ImageFile<'_> {
    fn fail(&self, reason: String) -> HeightError {
        HeightError::Image { path: self.path.to_owned(), reason }
    }

    fn check(&self, size: [u32; 2]) -> Result<[u32; 2], HeightError> {
        match size.iter().any(|&side| side > MAX_SIZE) {
            true => Err(HeightError::TooLarge { path: self.path.to_owned(), size }),
            false => Ok(size),
        }
    }

    /// Returns the cancellation if the job was cancelled, since that stops reading with some error; otherwise `error`.
    fn stopped_or(&self, error: HeightError) -> HeightError {
        self.progress.check().map_or_else(HeightError::from, |()| error)
    }

    /// Reads a PNG image that isn't interlaced.
    fn read_rows(&self, reader: BufReader<ProgressReader>, length: u64) -> Result<HeightMap, HeightError> {
        let undecoded = |error: DecodingError| self.stopped_or(self.fail(error.to_string()));
        let mut decoder = png::Decoder::new(reader);
        decoder.set_ignore_iccp_chunk(true);
        decoder.set_ignore_text_chunk(true);
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(undecoded)?;
        let size = self.check(reader.info().size().into())?;
        self.budget.allow(length);
        self.afford(size, length, 0, 0)?;
        let (color, depth) = reader.output_color_type();
        let line = reader.output_line_size(size[0]).ok_or_else(|| self.fail("its rows are too long".to_owned()))?;
        let mut line = vec![0; line];
        HeightMap::build(size, self.progress, |out| {
            reader.read_row(&mut line).map_err(undecoded)?;
            brighten(&line, color.samples(), depth == BitDepth::Sixteen, u16::from_be_bytes, out);
            Ok(())
        })
    }

    /// Reads any image by decoding all its pixels at once.
    fn read_whole(&self, mut reader: BufReader<ProgressReader>, length: u64) -> Result<HeightMap, HeightError> {
        let undecoded = |error: ImageError| match error {
            ImageError::Unsupported(_) => self.fail("choose a PNG, JPEG or WebP image".to_owned()),
            error => self.stopped_or(self.fail(error.to_string())),
        };
        let unread = |error: io::Error| self.stopped_or(self.fail(error.to_string()));
        self.budget.allow(length);
        webp::check(&mut reader, self.budget.allowed()).map_err(unread)?;
        let mut reader = ImageReader::new(reader).with_guessed_format().map_err(unread)?;
        let decoding = Borrowed::from(self.budget);
        if reader.format() == Some(ImageFormat::Png) {
            reader.limits(metadata_limits(self.budget));
        }
        let decoder = reader.into_decoder().map_err(undecoded)?;
        let size = self.check(decoder.dimensions().into())?;
        let (color, count) = (decoder.color_type(), decoder.total_bytes());
        // What decoding takes is freed before a map is made from the pixels. A JPEG decoder also keeps the file's bytes.
        self.afford(size, length, count, decoding_bytes(&decoder) - count)?;
        let mut bytes = vec![0; to_usize(count)];
        decoder.read_image(&mut bytes).map_err(undecoded)?;
        drop(decoding);
        Ok(map_of_px(size, color, &bytes, &self.progress.part(0.6, 1.0))?)
    }

    /// Checks that the budget has room for an image of this size: `px` bytes of decoded pixels, `decoding` bytes while
    /// it is decoded, and the map, which is held.
    fn afford(&self, size: [u32; 2], length: u64, px: u64, decoding: u64) -> Result<(), HeightError> {
        let kept = HeightMap::bytes_to_build(size).saturating_add(self.beside);
        let too_much = |refused: MemoryRefused| HeightError::TooMuch {
            path: self.path.to_owned(),
            size,
            reason: refused.to_string(),
        };
        // A decoder keeps the file's bytes too.
        let all = px.saturating_add(kept.max(decoding)).saturating_add(length);
        borrowing(self.budget, || self.budget.borrow(all)).map_err(too_much)?;
        self.budget.hold(kept).map_err(too_much)
    }
}

/// Returns the size in the header of a PNG image, or none for another file. Afterwards the file is at its start.
fn png_size(file: &mut File) -> io::Result<Option<[u32; 2]>> {
    let mut start = Vec::new();
    file.by_ref().take(24).read_to_end(&mut start)?;
    file.seek(SeekFrom::Start(0))?;
    let numbers = start.strip_prefix(PNG_START).and_then(|rest| rest.as_chunks::<4>().0.first_chunk::<2>());
    Ok(numbers.map(|numbers| numbers.map(u32::from_be_bytes)))
}

/// Returns whether the header of a PNG image says that it is interlaced. Afterwards the file is at its start.
fn is_interlaced(file: &mut (impl Read + Seek)) -> io::Result<bool> {
    let mut start = Vec::new();
    file.by_ref().take(29).read_to_end(&mut start)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(start.get(28).is_some_and(|&order| order != 0))
}

/// A file that stops reading once the job was cancelled, and reports how much of it was read if `told` is set.
struct ProgressReader<'a> {
    file: File,
    length: u64,
    read: u64,
    progress: &'a Progress,
    told: Option<Progress>,
}

impl Read for ProgressReader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.progress.check().map_err(io::Error::other)?;
        let count = self.file.read(buffer)?;
        self.read += count as u64;
        if let Some(told) = &self.told {
            told.set(self.read as f32 / self.length.max(1) as f32);
        }
        Ok(count)
    }
}

impl Seek for ProgressReader<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.read = self.file.seek(to)?;
        Ok(self.read)
    }
}

#[cfg(test)]
mod tests {

    use image::{DynamicImage, ImageBuffer, Luma, Rgb, RgbImage};

    use super::*;

    /// Writes a file into a folder.
    fn write(folder: &tempfile::TempDir, name: &str, bytes: &[u8]) -> std::path::PathBuf {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("a writable temporary folder");
        path
    }

    fn of(image: &DynamicImage) -> HeightMap {
        let size = [image.width(), image.height()];
        map_of_px(size, image.color(), image.as_bytes(), &Progress::new()).expect("not cancelled")
    }

    fn png(image: &DynamicImage) -> Vec<u8> {
        let mut bytes = io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).expect("an image in memory");
        bytes.into_inner()
    }

    #[test]
    fn gray_images_keep_sixteen_bits_and_colours_become_brightness() {
        let gray: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_raw(2, 1, vec![1_u16, 65535]).expect("two px");
        let map = of(&gray.into());
        assert_eq!(map.heights[..2], [1.0 / 65535.0, 1.0]);
        let green = RgbImage::from_pixel(1, 1, Rgb([0, 255, 0])).into();
        assert_eq!(of(&green).heights, [0.7152]);
        let wide = ImageBuffer::<Rgb<u16>, _>::from_pixel(1, 1, Rgb([0, 0, 65535])).into();
        assert_eq!(of(&wide).heights, [0.0722]);
    }

    #[test]
    fn a_file_gives_the_px_that_it_has() {
        let image: DynamicImage = RgbImage::from_fn(9, 5, |x, y| Rgb([(20 * x) as u8, (40 * y) as u8, 7])).into();
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        let file = write(&folder, "px.png", &png(&image));
        let progress = Progress::new();
        assert_eq!(read_map(&file, 0, &Budget::unlimited(), &progress).expect("an image"), of(&image));
        assert!(progress.fraction() > 0.8, "{}", progress.fraction());
        progress.cancel();
        assert!(matches!(read_map(&file, 0, &Budget::unlimited(), &progress), Err(HeightError::Cancelled(Cancelled))));
    }

    #[test]
    fn large_images_are_refused_with_name_size_and_limit() {
        // Only its header, 8 bits gray, 20000 x 20000. Since nothing follows, only the size can have caused the
        // refusal.
        let mut header = PNG_START.to_vec();
        header.extend([20_000_u32, 20_000].map(u32::to_be_bytes).as_flattened());
        header.extend([8, 0, 0, 0, 0]);
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        let file = write(&folder, "large.png", &header);
        let error = read_map(&file, 0, &Budget::unlimited(), &Progress::new()).expect_err("too large").to_string();
        let expected = "has 20000 x 20000 px, but at most 16384 px a side are read; scale it to 4096 px a side or less";
        assert!(error.ends_with(expected) && error.contains("large.png"), "{error}");
        // One pixel more than is read; the decoder itself would read it.
        let wide = DynamicImage::new_luma8(MAX_SIZE + 1, 1);
        let file = write(&folder, "wide.png", &png(&wide));
        let error = read_map(&file, 0, &Budget::unlimited(), &Progress::new()).expect_err("too large").to_string();
        assert!(error.contains("has 16385 x 1 px"), "{error}");
    }
}
