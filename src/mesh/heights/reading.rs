//! A height image from its file: how large it is before memory is taken for it, then its px, row by row.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use image::{ColorType, ImageDecoder, ImageError, ImageReader};

use super::{HeightError, HeightMap, MAX_SIZE};
use crate::mesh::load::open_file;
use crate::mesh::progress::{Cancelled, Progress};

/// What comes before a PNG image's width and height, of 4 bytes each.
const PNG_START: &[u8; 16] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";

impl HeightMap {
    /// Reads a PNG or JPEG image.
    ///
    /// # Errors
    /// It is no such image, or a larger one than is read; or `progress` was cancelled.
    pub(super) fn read(path: &Path, progress: &Progress) -> Result<Self, HeightError> {
        let (size, color, bytes) = decode(path, &progress.part(0.0, 0.6))?;
        Ok(Self::of_px(size, color, &bytes, &progress.part(0.6, 1.0))?)
    }

    /// The brightness of px as they are stored, 8 or 16 bits a channel: the weights of Rec. 709, and no transfer function,
    /// since heights are no light. Gray images give their gray, in all its bits.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub(super) fn of_px(
        size: [u32; 2],
        color: ColorType,
        bytes: &[u8],
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let (channels, px) = (usize::from(color.channel_count()), usize::from(color.bytes_per_pixel()));
        let line = px * size[0] as usize;
        if line == 0 || size[1] == 0 || bytes.len() != line * size[1] as usize {
            return Ok(Self::new([0, 0], Vec::new()));
        }
        let channel = |px: &[u8], index: usize| match px.len() / channels {
            2 => f32::from(u16::from_ne_bytes([px[2 * index], px[2 * index + 1]])) / 65535.0,
            _ => f32::from(px[index]) / 255.0,
        };
        Self::build(size, progress, |y, out| {
            for (height, px) in out.iter_mut().zip(bytes[y * line..(y + 1) * line].chunks_exact(px)) {
                *height = if channels < 3 { channel(px, 0) } else { brightness([0, 1, 2].map(|k| channel(px, k))) };
            }
        })
    }
}

fn brightness([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// An image's width and height, and its px as its file has them.
fn decode(path: &Path, progress: &Progress) -> Result<([u32; 2], ColorType, Vec<u8>), HeightError> {
    let fail = |reason: String| HeightError::Image { path: path.to_owned(), reason };
    let unread = |error: io::Error| fail(error.to_string());
    // Reading stops with an error where the job was told to stop.
    let undecoded = |error: ImageError| match (progress.check(), error) {
        (Err(cancelled), _) => cancelled.into(),
        (_, ImageError::Unsupported(_)) => fail("choose a PNG or JPEG image".to_owned()),
        (_, error) => fail(error.to_string()),
    };
    let check = |size: [u32; 2]| match size.iter().any(|&side| side > MAX_SIZE) {
        true => Err(HeightError::TooLarge { path: path.to_owned(), size }),
        false => Ok(size),
    };
    progress.check()?;
    let no_file = || fail("it is not a file; choose a PNG or JPEG image".to_owned());
    let (mut file, about) = open_file(path).map_err(unread)?.ok_or_else(no_file)?;
    // A PNG decoder reads and keeps all that stands before the px; what is too large is refused before.
    check(png_size(&mut file).map_err(unread)?.unwrap_or_default())?;
    let watched = Watched { file, length: about.len(), read: 0, progress };
    let reader = ImageReader::new(BufReader::new(watched)).with_guessed_format().map_err(unread)?;
    let decoder = reader.into_decoder().map_err(undecoded)?;
    let size = check(decoder.dimensions().into())?;
    let (color, count) = (decoder.color_type(), decoder.total_bytes());
    let no_memory = || HeightError::NoMemory { path: path.to_owned(), size, mebibytes: count.div_ceil(1 << 20) };
    let mut bytes = Vec::new();
    let room = usize::try_from(count).map_err(|_| no_memory())?;
    bytes.try_reserve_exact(room).map_err(|_| no_memory())?;
    bytes.resize(room, 0);
    decoder.read_image(&mut bytes).map_err(undecoded)?;
    Ok((size, color, bytes))
}

/// What a PNG image says of its size first of all; none of another file. The file is at its start again.
fn png_size(file: &mut File) -> io::Result<Option<[u32; 2]>> {
    let mut start = Vec::new();
    file.by_ref().take(24).read_to_end(&mut start)?;
    file.seek(SeekFrom::Start(0))?;
    let numbers = start.strip_prefix(PNG_START).and_then(|rest| rest.as_chunks::<4>().0.first_chunk::<2>());
    Ok(numbers.map(|numbers| numbers.map(u32::from_be_bytes)))
}

/// A file that knows how much of it was read, and reads no further once the job was told to stop.
struct Watched<'a> {
    file: File,
    length: u64,
    read: u64,
    progress: &'a Progress,
}

impl Read for Watched<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.progress.check().map_err(io::Error::other)?;
        let count = self.file.read(buffer)?;
        self.read += count as u64;
        self.progress.set(self.read as f32 / self.length.max(1) as f32);
        Ok(count)
    }
}

impl Seek for Watched<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.read = self.file.seek(to)?;
        Ok(self.read)
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use image::{DynamicImage, ImageBuffer, Luma, Rgb, RgbImage};

    use super::*;

    /// A file in the temporary folder, gone with its test.
    struct Temporary(std::path::PathBuf);

    impl Temporary {
        fn new(name: &str, bytes: &[u8]) -> Self {
            let path = std::env::temp_dir().join(format!("pnaen-{}-{name}", std::process::id()));
            std::fs::write(&path, bytes).expect("a writable temporary folder");
            Self(path)
        }
    }

    impl Drop for Temporary {
        fn drop(&mut self) {
            let _ = std::fs::remove_file(&self.0);
        }
    }

    fn of(image: &DynamicImage) -> HeightMap {
        let size = [image.width(), image.height()];
        HeightMap::of_px(size, image.color(), image.as_bytes(), &Progress::new()).expect("nobody cancels")
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
        let file = Temporary::new("px.png", &png(&image));
        let progress = Progress::new();
        assert_eq!(HeightMap::read(&file.0, &progress).expect("an image"), of(&image));
        assert!(progress.fraction() > 0.8, "{}", progress.fraction());
        progress.cancel();
        assert!(matches!(HeightMap::read(&file.0, &progress), Err(HeightError::Cancelled(Cancelled))));
    }

    #[test]
    fn what_is_too_large_is_refused_at_once_by_name_size_and_limit() {
        // Its header alone: 8 bits gray, 20000 x 20000; nothing follows, so that nothing else can have refused it.
        let mut header = PNG_START.to_vec();
        header.extend([20_000_u32, 20_000].map(u32::to_be_bytes).as_flattened());
        header.extend([8, 0, 0, 0, 0]);
        let start = Instant::now();
        let file = Temporary::new("large.png", &header);
        let error = HeightMap::read(&file.0, &Progress::new()).expect_err("too large").to_string();
        assert!(start.elapsed() < Duration::from_millis(100), "{:?}", start.elapsed());
        let expected =
            "is 20000 x 20000 px large, and at most 16384 px a side are read; scale it to 4096 px a side or less";
        assert!(error.ends_with(expected) && error.contains("large.png"), "{error}");
        // One px more than is read, with a decoder that would take it.
        let wide = DynamicImage::new_luma8(MAX_SIZE + 1, 1);
        let file = Temporary::new("wide.png", &png(&wide));
        let error = HeightMap::read(&file.0, &Progress::new()).expect_err("too large").to_string();
        assert!(error.contains("is 16385 x 1 px large"), "{error}");
    }
}
