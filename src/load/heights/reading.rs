//! Reads a height image: first its size, to check the memory that it takes, then its pixels row by row.

mod one_channel;

use std::fmt::Display;
use std::io::Cursor;
use std::path::Path;

use glam::{Vec3, vec3};
use image::{ImageDecoder, ImageError, ImageFormat, Limits};
use png::{BitDepth, DecodingError};

use super::HeightError;
use crate::environment_file::unpacking_bytes;
use crate::files::{self, FileError, file_reason, read_file};
use crate::images::{check_size, decode_halved, decoded_bytes, decoder, decoding_bytes, is_image, png_header};
use crate::ktx2::is_ktx2;
use crate::memory_budget::Budget;
use crate::watched_bytes::watched;
use crate::webp;
use geometry::casts::to_usize;
use geometry::mesh::build_limits::{Borrowed, MemoryRefused};
use geometry::mesh::heights::{HeightMap, MAX_KEPT};
use geometry::mesh::mipmap::MipFilter;
use geometry::progress::{Cancelled, Progress};

/// The bytes of a file at most: more than the largest image takes without compression.
const LARGEST_FILE: u64 = 4 << 30;

/// What is said of a file of another kind.
const NO_IMAGE: &str = "choose a PNG, JPEG, WebP, TGA, KTX2, TIFF or EXR image";

/// The largest height, positive or negative. Images with floating-point numbers may have heights beyond black and white.
const MOST_HEIGHT: f32 = 65504.0;

/// Reads a PNG, JPEG, WebP, TGA, KTX2, TIFF or EXR image. A PNG is decoded row by row, so that a large image takes no more
/// memory than its file and its map; any other, and an interlaced PNG, is decoded whole. The file's size is added to the budget.
///
/// # Errors
/// If the file isn't such an image, or the image is too large, or `progress` was cancelled.
pub(super) fn read_map(path: &Path, budget: &Budget, progress: &Progress) -> Result<HeightMap, HeightError> {
    let image = ImageFile { path, reserved: 0, budget, progress };
    let check = |start: &[u8]| {
        is_image(start).then_some(()).ok_or_else(|| image.fail(NO_IMAGE.to_owned()))?;
        image.check(png_header(start).map_or([0; 2], |(size, _)| size)).map(|_| ())
    };
    let bytes = read_file(path, &files::Limits { file: LARGEST_FILE, memory: 0 }, check, progress)?;
    budget.allow(bytes.len() as u64);
    image.decode(&bytes)
}

impl From<FileError> for HeightError {
    fn from(error: FileError) -> Self {
        let (path, reason) = match error {
            FileError::Cancelled(cancelled) => return cancelled.into(),
            FileError::NotAFile { path } => (path, format!("it is not a file; {NO_IMAGE}")),
            FileError::Io { path, source } => (path, file_reason(&source)),
            FileError::TooLarge { path, .. } => (path, "it is larger than 4 GiB; choose a smaller image".to_owned()),
            FileError::Changed { path } => {
                (path, "it changed while it was read; open it again once it is whole".to_owned())
            }
        };
        Self::Image { path, reason }
    }
}

/// Computes the brightness of pixels with so many channels of so many bytes (1, 2, or 4 for floating-point numbers), with the
/// weights of Rec. 709 and no transfer function, since heights aren't light. Gray images keep their values with all bits.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub(super) fn map_of_px(
    size: [u32; 2],
    [channels, depth]: [u8; 2],
    bytes: &[u8],
    progress: &Progress,
) -> Result<HeightMap, Cancelled> {
    let line = usize::from(channels) * usize::from(depth) * size[0] as usize;
    if line == 0 || size[1] == 0 || bytes.len() != line * size[1] as usize {
        return Ok(HeightMap::new([0, 0], Vec::new()));
    }
    let mut lines = bytes.chunks_exact(line);
    HeightMap::build(size, progress, |out| {
        let line = lines.next().unwrap_or_default();
        brighten(line, channels.into(), depth, u16::from_ne_bytes, out);
        Ok(())
    })
}

/// Computes the brightness of each pixel of a row with `channels` channels of so many bytes. Four are a floating-point number.
fn brighten(line: &[u8], channels: usize, depth: u8, of_bytes: fn([u8; 2]) -> u16, out: &mut [f32]) {
    let depth = usize::from(depth);
    let channel = |px: &[u8], index: usize| match px[index * depth..][..depth] {
        [a, b, c, d] => Some(f32::from_ne_bytes([a, b, c, d])).filter(|own| own.is_finite()).unwrap_or(0.0),
        [a, b] => f32::from(of_bytes([a, b])) / 65535.0,
        _ => f32::from(px[index]) / 255.0,
    };
    let brightness = |px: &[u8]| vec3(0.2126, 0.7152, 0.0722).dot(Vec3::from([0, 1, 2].map(|k| channel(px, k))));
    for (height, px) in out.iter_mut().zip(line.chunks_exact(depth * channels)) {
        let own = if channels < 3 { channel(px, 0) } else { brightness(px) };
        *height = own.clamp(-MOST_HEIGHT, MOST_HEIGHT);
    }
}

/// An image file that is being read, with what reading it needs.
pub(super) struct ImageFile<'a> {
    /// What errors call it.
    pub path: &'a Path,
    /// The memory that the rest of the load takes, in bytes.
    pub reserved: u64,
    pub budget: &'a Budget,
    pub progress: &'a Progress,
}

impl ImageFile<'_> {
    fn fail(&self, reason: String) -> HeightError {
        HeightError::Image { path: self.path.to_owned(), reason }
    }

    fn check(&self, size: [u32; 2]) -> Result<[u32; 2], HeightError> {
        check_size("it", size).map(|()| size).map_err(|reason| self.fail(reason))
    }

    /// The error of a decoder. Cancelling stops it with some error.
    fn undecoded(&self, error: impl Display) -> HeightError {
        self.progress.check().map_or_else(HeightError::from, |()| self.fail(error.to_string()))
    }

    /// Reads an image in memory; errors are those of [`read_map`].
    pub(super) fn decode(&self, bytes: &[u8]) -> Result<HeightMap, HeightError> {
        let held = self.budget.held();
        let read = match png_header(bytes) {
            Some((_, false)) => self.read_rows(bytes),
            _ if is_ktx2(bytes) => self.read_texture(bytes),
            _ => self.read_channel(bytes).transpose().unwrap_or_else(|| self.read_whole(bytes)),
        };
        // A broken image takes no room from others.
        read.inspect_err(|_| self.budget.release(self.budget.held() - held))
    }

    /// Reads a KTX2 image.
    fn read_texture(&self, bytes: &[u8]) -> Result<HeightMap, HeightError> {
        let texture = decode_halved(bytes, 0, MipFilter::Numbers, self.budget).map_err(|reason| self.fail(reason))?;
        let px = decoded_bytes(texture.size);
        self.budget.release(px);
        self.afford(texture.size, bytes, px, 0)?;
        Ok(map_of_px(texture.size, [4, 1], &texture.rgba, self.progress)?)
    }

    /// Reads a PNG image that isn't interlaced.
    fn read_rows(&self, bytes: &[u8]) -> Result<HeightMap, HeightError> {
        let undecoded = |error: DecodingError| self.fail(error.to_string());
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_ignore_iccp_chunk(true);
        decoder.set_ignore_text_chunk(true);
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(undecoded)?;
        let size = self.check(reader.info().size().into())?;
        self.afford(size, bytes, 0, 0)?;
        let (color, depth) = reader.output_color_type();
        let line = reader.output_line_size(size[0]).ok_or_else(|| self.fail("its rows are too long".to_owned()))?;
        let mut line = vec![0; line];
        HeightMap::build(size, self.progress, |out| {
            reader.read_row(&mut line).map_err(undecoded)?;
            let depth = if depth == BitDepth::Sixteen { 2 } else { 1 };
            brighten(&line, color.samples(), depth, u16::from_be_bytes, out);
            Ok(())
        })
    }

    /// Reads any image by decoding all its pixels at once.
    fn read_whole(&self, bytes: &[u8]) -> Result<HeightMap, HeightError> {
        let format = image::guess_format(bytes).ok();
        let is_deep = matches!(format, Some(ImageFormat::Tiff | ImageFormat::OpenExr | ImageFormat::Hdr));
        let is_unsupported = |error: &ImageError| matches!(error, ImageError::Unsupported(_));
        let undecoded = |error: ImageError| match error {
            _ if !is_image(bytes) => self.undecoded(NO_IMAGE),
            // Two channels, say, aren't decoded. Of EXR the decoder tells it in words alone.
            error if is_deep && (is_unsupported(&error) || error.to_string().contains("rgb channels")) => {
                let advice = "save it with one channel of 32-bit floating-point numbers, or as a 16-bit PNG";
                self.undecoded(format!("{error}; {advice}"))
            }
            error => self.undecoded(error),
        };
        webp::check(bytes, self.budget.allowed()).map_err(|reason| self.fail(reason))?;
        let borrowed = Borrowed::from(self.budget);
        let watched = watched(bytes, self.progress.part(0.0, 0.6));
        let mut decoder = decoder(watched, bytes, self.budget).map_err(undecoded)?;
        let size = self.check(decoder.dimensions().into())?;
        let (color, count) = (decoder.color_type(), decoder.total_bytes());
        let blocks = match format {
            Some(ImageFormat::OpenExr) => unpacking_bytes(bytes).map_err(|fault| self.fail(fault.to_string()))?,
            Some(ImageFormat::Tiff) => self.unpacking_tiff(bytes)?,
            _ => 0,
        };
        let decoding = (decoding_bytes(&decoder) - count).saturating_add(if is_deep { count } else { 0 });
        // What decoding takes is freed before a map is made from the pixels.
        self.afford(size, bytes, count, decoding.saturating_add(blocks))?;
        let mut limits = Limits::default();
        limits.max_alloc = Some(self.budget.left().max(1 << 20).saturating_add(count));
        decoder.set_limits(limits).map_err(undecoded)?;
        let mut px = vec![0; to_usize(count)];
        decoder.read_image(&mut px).map_err(undecoded)?;
        drop(borrowed);
        let channels = color.channel_count();
        let kind = [channels, color.bytes_per_pixel() / channels];
        Ok(map_of_px(size, kind, &px, &self.progress.part(0.6, 1.0))?)
    }

    /// Checks that the budget has room for an image of this size: `px` bytes of decoded pixels, `decoding` bytes while
    /// it is decoded, and the map, which is held.
    fn afford(&self, size: [u32; 2], bytes: &[u8], px: u64, decoding: u64) -> Result<(), HeightError> {
        let kept = HeightMap::bytes_to_build(size);
        let too_much = |refused: MemoryRefused| {
            let ([width, height], side) = (size, format!("scale it to {MAX_KEPT} px a side or less"));
            self.fail(format!(
                "it has {width} x {height} px and {refused}; {side}, or save it as a PNG that isn't interlaced"
            ))
        };
        let all = [px, kept.max(decoding), bytes.len() as u64, self.reserved];
        self.budget.check(all.into_iter().fold(0, u64::saturating_add)).map_err(too_much)?;
        self.budget.hold(kept).map_err(too_much)
    }
}

#[cfg(test)]
mod tests {

    use image::{DynamicImage, ImageBuffer, Luma, Rgb, RgbImage};

    use super::*;
    use crate::images::MAX_SIZE;

    /// Writes a file into a folder.
    fn write(folder: &tempfile::TempDir, name: &str, bytes: &[u8]) -> std::path::PathBuf {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("a writable temporary folder");
        path
    }

    fn of(image: &DynamicImage) -> HeightMap {
        let size = [image.width(), image.height()];
        let (color, channels) = (image.color(), image.color().channel_count());
        let kind = [channels, color.bytes_per_pixel() / channels];
        map_of_px(size, kind, image.as_bytes(), &Progress::new()).expect("not cancelled")
    }

    fn png(image: &DynamicImage) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).expect("an image in memory");
        bytes.into_inner()
    }

    #[test]
    fn gray_images_keep_sixteen_bits_and_colours_become_brightness() {
        let gray: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_raw(2, 1, vec![1_u16, 65535]).expect("two px");
        let map = of(&gray.into());
        assert_eq!(map.heights[..2], [1.0 / 65535.0, 1.0]);
        let green = RgbImage::from_pixel(1, 1, Rgb([0, 255, 0])).into();
        assert_eq!(*of(&green).heights, [0.7152]);
        let wide = ImageBuffer::<Rgb<u16>, _>::from_pixel(1, 1, Rgb([0, 0, 65535])).into();
        assert_eq!(*of(&wide).heights, [0.0722]);
    }

    #[test]
    fn numbers_beyond_black_and_white_stay_and_those_that_are_none_become_black() {
        let px = [2.5, -1.0, f32::NAN, f32::INFINITY, -1e9];
        let px: Vec<f32> = px.into_iter().flat_map(|height| [height; 3]).collect();
        let image = DynamicImage::ImageRgb32F(ImageBuffer::from_raw(5, 1, px).expect("five px"));
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        for format in [image::ImageFormat::OpenExr, image::ImageFormat::Tiff] {
            let mut bytes = Cursor::new(Vec::new());
            image.write_to(&mut bytes, format).expect("an image in memory");
            let file = write(&folder, "px", bytes.get_ref());
            let map = read_map(&file, &Budget::unlimited(), &Progress::new()).expect("an image");
            let expected = [2.5, -1.0, 0.0, 0.0, -MOST_HEIGHT];
            let close = |(own, expected): (&f32, f32)| (own - expected).abs() <= 1e-6 * expected.abs();
            assert!(map.heights.iter().zip(expected).all(close), "{format:?}: {:?}", &map.heights[..5]);
            assert!(map.range[0] == -MOST_HEIGHT && (map.range[1] - 2.5).abs() < 1e-5, "{format:?}: {:?}", map.range);
            let cut = write(&folder, "cut", &bytes.get_ref()[..bytes.get_ref().len() / 2]);
            let said = read_map(&cut, &Budget::unlimited(), &Progress::new()).expect_err("half an image");
            let said = said.to_string();
            assert!(said.contains("can't be read as a height image") && !said.contains("; save it"), "{said}");
        }
        let wide: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_raw(2, 1, vec![1_u16, 65535]).expect("two px");
        let file = folder.path().join("wide.tif");
        wide.save(&file).expect("a writable temporary folder");
        let map = read_map(&file, &Budget::unlimited(), &Progress::new()).expect("an image");
        assert_eq!(map.heights[..2], [1.0 / 65535.0, 1.0], "all 16 bits");
    }

    #[test]
    fn a_file_gives_the_px_that_it_has() {
        let image: DynamicImage = RgbImage::from_fn(9, 5, |x, y| Rgb([(20 * x) as u8, (40 * y) as u8, 7])).into();
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        let file = write(&folder, "px.png", &png(&image));
        let progress = Progress::new();
        assert_eq!(read_map(&file, &Budget::unlimited(), &progress).expect("an image"), of(&image));
        assert!(progress.fraction() > 0.8, "{}", progress.fraction());
        progress.cancel();
        assert!(matches!(read_map(&file, &Budget::unlimited(), &progress), Err(HeightError::Cancelled(Cancelled))));
    }

    #[test]
    fn tga_bmp_and_ktx2_images_are_read() {
        let image: DynamicImage = RgbImage::from_fn(9, 5, |x, y| Rgb([(20 * x) as u8, (40 * y) as u8, 7])).into();
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        let budget = Budget::unlimited();
        for format in [image::ImageFormat::Tga, image::ImageFormat::Bmp] {
            let mut bytes = Cursor::new(Vec::new());
            image.write_to(&mut bytes, format).expect("an image in memory");
            let file = write(&folder, "px", bytes.get_ref());
            assert_eq!(read_map(&file, &budget, &Progress::new()).expect("an image"), of(&image), "{format:?}");
        }
        // 37 is RGBA of 8 bits.
        let held = budget.held();
        let rgba = crate::ktx2::tests::plain(37, [9, 5], image.to_rgba8().as_raw());
        let file = write(&folder, "px", &rgba);
        assert_eq!(read_map(&file, &budget, &Progress::new()).expect("an image"), of(&image));
        assert_eq!(budget.held() - held, HeightMap::bytes_to_build([9, 5]), "the map alone");
        let file = write(&folder, "cut", &rgba[..rgba.len() / 2]);
        assert!(read_map(&file, &budget, &Progress::new()).is_err());
    }

    #[test]
    fn a_broken_image_takes_no_room_from_the_next() {
        let noise = |x: u32, y: u32| Rgb([(x + 64 * y).wrapping_mul(2_654_435_769).to_be_bytes()[0]; 3]);
        let bytes = png(&RgbImage::from_fn(64, 64, noise).into());
        // Room for one, with its file.
        let room = HeightMap::bytes_to_build([64, 64]) + bytes.len() as u64;
        let (budget, progress) = (Budget::new(0, room), Progress::new());
        let image = ImageFile { path: Path::new("noise"), reserved: 0, budget: &budget, progress: &progress };
        let said = image.decode(&bytes[..bytes.len() / 2]).expect_err("half an image").to_string();
        assert!(!said.contains("memory"), "{said}");
        assert_eq!(budget.held(), 0);
        assert!(image.decode(&bytes).is_ok());
        assert!(image.decode(&bytes).is_err(), "two don't fit");
    }

    #[test]
    fn large_images_are_refused_with_name_size_and_limit() {
        // Only its header, 8 bits gray, 20000 x 20000. Since nothing follows, only the size can have caused the
        // refusal.
        let mut header = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
        header.extend([20_000_u32, 20_000].map(u32::to_be_bytes).as_flattened());
        header.extend([8, 0, 0, 0, 0]);
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        let file = write(&folder, "large.png", &header);
        let error = read_map(&file, &Budget::unlimited(), &Progress::new()).expect_err("too large").to_string();
        let expected = "has 20000 x 20000 px, but at most 16384 px a side are read; scale it to 4096 px a side or less";
        assert!(error.ends_with(expected) && error.contains("large.png"), "{error}");
        // One pixel more than is read; the decoder itself would read it.
        let wide = DynamicImage::new_luma8(MAX_SIZE + 1, 1);
        let file = write(&folder, "wide.png", &png(&wide));
        let error = read_map(&file, &Budget::unlimited(), &Progress::new()).expect_err("too large").to_string();
        assert!(error.contains("has 16385 x 1 px"), "{error}");
    }
}
