//! Reads images of one channel of floating-point numbers, as which sculpting and painting programs save displacement: TIFF and OpenEXR.
//! `image` has no pixels of that kind.

use std::io::Cursor;

use exr::image::read::read;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, Vec2};
use image::ImageFormat;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{CompressionMethod, SampleFormat, Tag};

use super::{HeightError, ImageFile, map_of_px, unpacking_bytes, watched};
use geometry::casts::{to_f32, to_usize};
use geometry::mesh::heights::HeightMap;

/// The width and height of an image in px, and its numbers row by row from the top.
type Numbers = ([u32; 2], Vec<f32>);

impl ImageFile<'_> {
    /// Reads an image of one channel; none if it is another image, or its header can't be read.
    pub(super) fn read_channel(&self, bytes: &[u8]) -> Result<Option<HeightMap>, HeightError> {
        let read = match image::guess_format(bytes) {
            Ok(ImageFormat::Tiff) => self.read_tiff(bytes)?,
            Ok(ImageFormat::OpenExr) => self.read_exr(bytes)?,
            _ => None,
        };
        let Some((size, px)) = read else { return Ok(None) };
        Ok(Some(map_of_px(size, [1, 4], bytemuck::cast_slice(&px), &self.progress.part(0.6, 1.0))?))
    }

    fn read_tiff(&self, bytes: &[u8]) -> Result<Option<Numbers>, HeightError> {
        let unpacking = self.unpacking_tiff(bytes)?;
        let Ok(mut decoder) = Decoder::new(watched(bytes, self.progress.part(0.0, 0.6))) else { return Ok(None) };
        let formats = decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat);
        let are_floats = matches!(formats, Ok(Some(formats)) if formats == [SampleFormat::IEEEFP.to_u16()]);
        let depth = match decoder.colortype() {
            Ok(ColorType::Gray(bits @ (16 | 32 | 64))) if are_floats => u64::from(bits / 8),
            _ => return Ok(None),
        };
        let size = self.check(decoder.dimensions().map_err(|error| self.undecoded(error))?.into())?;
        let count = size.map(u64::from).iter().product::<u64>();
        // The file's own numbers are held beside those of the picture.
        self.afford(size, bytes, 4 * count, depth * count + unpacking)?;
        let mut limits = Limits::default();
        (limits.decoding_buffer_size, limits.intermediate_buffer_size) = (to_usize(depth * count), usize::MAX);
        let read = decoder.with_limits(limits).read_image();
        let px = match read.map_err(|error| self.undecoded(error))? {
            DecodingResult::F16(px) => px.into_iter().map(|own| own.to_f32()).collect(),
            DecodingResult::F32(px) => px,
            DecodingResult::F64(px) => px.into_iter().map(to_f32).collect(),
            _ => return Ok(None),
        };
        Ok(Some((size, px)))
    }

    /// The bytes that unpacking a TIFF image takes beside its pixels: a row of a tile, which may be wider than the picture. The rest is
    /// unpacked piece by piece, but for JPEG, which would be unpacked whole, however large it is; that fails.
    pub(super) fn unpacking_tiff(&self, bytes: &[u8]) -> Result<u64, HeightError> {
        const MOST_OF_PX: u64 = 32;
        let Ok(mut decoder) = Decoder::new(Cursor::new(bytes)) else { return Ok(0) };
        if decoder.find_tag_unsigned(Tag::Compression).ok().flatten() == Some(CompressionMethod::ModernJPEG.to_u16()) {
            return Err(self.fail("its numbers are compressed as JPEG; save it with another compression".to_owned()));
        }
        Ok(MOST_OF_PX * u64::from(decoder.chunk_dimensions().0))
    }

    /// Reads the only channel of a file, whatever its name; alpha doesn't count.
    fn read_exr(&self, bytes: &[u8]) -> Result<Option<Numbers>, HeightError> {
        let reader = exr::block::read(watched(bytes, self.progress.part(0.0, 0.6)), false);
        let Ok(reader) = reader else { return Ok(None) };
        let layers = reader.headers().iter().filter(|layer| !layer.deep);
        let channels = layers.flat_map(|layer| layer.channels.list.iter().map(move |own| (layer, own.name.clone())));
        let mut channels = channels.filter(|(_, name)| name.to_string().rsplit('.').next() != Some("A"));
        let (Some((layer, name)), None) = (channels.next(), channels.next()) else { return Ok(None) };
        let picture = layer.shared_attributes.display_window;
        let place = layer.own_attributes.layer_position - picture.position;
        let Vec2(width, height) = picture.size;
        let size = self.check([width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX)))?;
        let unpacking = unpacking_bytes(bytes).map_err(|fault| self.fail(fault.to_string()))?;
        self.afford(size, bytes, 4 * width as u64 * height as u64, unpacking)?;
        let channel = read().no_deep_data().largest_resolution_level().specific_channels().required::<f32>(name);
        // The picture is black where the file has no pixels, and pixels beside it don't count.
        let pixels = channel.collect_pixels(
            move |_, _| vec![0.0_f32; width * height],
            move |px: &mut Vec<f32>, at, (own,): (f32,)| {
                let at = (at.to_i32() + place).to_usize("beside the picture");
                if let Some(Vec2(x, y)) = at.ok().filter(|at| at.0 < width && at.1 < height) {
                    px[y * width + x] = own;
                }
            },
        );
        let read = pixels.first_valid_layer().all_attributes().from_chunks(reader);
        Ok(Some((size, read.map_err(|error| self.undecoded(error))?.layer_data.channel_data.pixels)))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use exr::prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer, LayerAttributes,
        WritableImage, f16,
    };
    use tiff::encoder::{Compression, TiffEncoder, colortype};

    use super::*;
    use crate::memory_budget::Budget;
    use geometry::progress::Progress;

    fn read(bytes: &[u8], budget: &Budget) -> Result<HeightMap, String> {
        let image = ImageFile { path: Path::new("numbers"), reserved: 0, budget, progress: &Progress::new() };
        image.decode(bytes).map_err(|error| error.to_string())
    }

    /// The heights of an image, row by row.
    fn heights(bytes: &[u8]) -> Vec<f32> {
        let map = read(bytes, &Budget::unlimited()).expect("an image");
        map.heights[..(map.size[0] * map.size[1]) as usize].to_vec()
    }

    /// A TIFF image of one row and one channel.
    fn tiff(width: u16, bits: u16, format: u16, px: &[u8]) -> Vec<u8> {
        // TIFF 6.0: eleven numbers, each with its tag, its type (3 for 16 bits), how many there are, and itself.
        let tags = [256, 257, 258, 259, 262, 273, 277, 278, 279, 284, 339];
        let values = [width, 1, bits, 1, 1, 146, 1, 1, px.len() as u16, 1, format];
        let mut bytes = b"II\x2a\0\x08\0\0\0\x0b\0".to_vec();
        for (tag, value) in tags.into_iter().zip(values) {
            bytes.extend([tag, 3, 1, 0, value, 0].map(u16::to_le_bytes).as_flattened());
        }
        bytes.extend([0; 4]);
        [&bytes, px].concat()
    }

    /// An OpenEXR layer with these channels.
    fn layer(
        size: (usize, usize),
        attributes: LayerAttributes,
        encoding: Encoding,
        channels: &[(&str, FlatSamples)],
    ) -> Layer<AnyChannels<FlatSamples>> {
        let channels = channels.iter().map(|(name, samples)| AnyChannel::new(*name, samples.clone())).collect();
        Layer::new(size, attributes, encoding, AnyChannels::sort(channels))
    }

    fn exr(size: (usize, usize), encoding: Encoding, channels: &[(&str, FlatSamples)]) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let layer = layer(size, LayerAttributes::named("displacement"), encoding, channels);
        Image::from_layer(layer).write().to_buffered(&mut bytes).expect("in memory");
        bytes.into_inner()
    }

    #[test]
    fn tiff_images_of_one_channel_keep_their_numbers() {
        let px = [0.5, -2.0, f32::NAN, f32::INFINITY, 1e9];
        let expected = [0.5, -2.0, 0.0, 0.0, 65504.0];
        assert_eq!(heights(&tiff(5, 32, 3, px.map(f32::to_le_bytes).as_flattened())), expected);
        assert_eq!(heights(&tiff(5, 64, 3, px.map(|own| f64::from(own).to_le_bytes()).as_flattened())), expected);
        let halves = px.map(|own| f16::from_f32(own).to_le_bytes());
        assert_eq!(heights(&tiff(4, 16, 3, halves[..4].as_flattened())), expected[..4]);
        let px: Vec<f32> = (0..3000).map(|i| (i * 7919 % 3001) as f32 * 1.1 - 1000.0).collect();
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).expect("in memory").with_compression(Compression::Lzw);
        encoder.write_image::<colortype::Gray32Float>(50, 60, &px).expect("in memory");
        let budget = Budget::unlimited();
        assert_eq!(read(bytes.get_ref(), &budget).expect("an image").size, [50, 60]);
        assert_eq!(budget.held(), HeightMap::bytes_to_build([50, 60]), "the map alone");
        assert_eq!(heights(bytes.get_ref()), px);
    }

    #[test]
    fn the_only_channel_of_an_exr_file_is_read_whatever_its_name() {
        let px: Vec<f32> = (0..7000).map(|i| (i % 797) as f32 / 8.0 - 50.0).collect();
        let size = (100, 70);
        let halves = px.iter().map(|own| f16::from_f32(*own)).collect();
        let [floats, halves] = [FlatSamples::F32(px.clone()), FlatSamples::F16(halves)];
        for encoding in [Encoding::UNCOMPRESSED, Encoding::FAST_LOSSLESS] {
            for name in ["Y", "displacement.R", "height"] {
                assert_eq!(heights(&exr(size, encoding, &[(name, floats.clone())])), px, "{name}");
            }
            assert_eq!(heights(&exr(size, encoding, &[("V", halves.clone()), ("A", floats.clone())])), px);
        }
        let whole = FlatSamples::U32(vec![0, 3, 70_000]);
        assert_eq!(heights(&exr((3, 1), Encoding::UNCOMPRESSED, &[("Y", whole)])), [0.0, 3.0, 65504.0]);
        let odd = FlatSamples::F32(vec![f32::NAN, f32::NEG_INFINITY, -1e9]);
        assert_eq!(heights(&exr((3, 1), Encoding::UNCOMPRESSED, &[("Z", odd)])), [0.0, 0.0, -65504.0]);
    }

    #[test]
    fn the_display_window_of_an_exr_file_is_the_picture() {
        let attributes = LayerAttributes { layer_position: Vec2(-1, 1), ..LayerAttributes::named("displacement") };
        let px = FlatSamples::F32((1..=6_u8).map(f32::from).collect());
        let layer = layer((3, 2), attributes, Encoding::UNCOMPRESSED, &[("Y", px)]);
        let window = IntegerBounds::new((0, 0), (4, 2));
        let mut bytes = Cursor::new(Vec::new());
        Image::new(ImageAttributes::new(window), layer).write().to_buffered(&mut bytes).expect("in memory");
        assert_eq!(heights(bytes.get_ref()), [0.0, 0.0, 0.0, 0.0, 2.0, 3.0, 0.0, 0.0]);
    }

    #[test]
    fn other_kinds_of_pixels_are_refused_with_advice() {
        let samples = FlatSamples::F32(vec![0.5]);
        let two = exr((1, 1), Encoding::UNCOMPRESSED, &[("X", samples.clone()), ("Y", samples)]);
        for bytes in [tiff(1, 16, 2, &[0; 2]), two] {
            let said = read(&bytes, &Budget::unlimited()).expect_err("another kind");
            let advice = "; save it with one channel of 32-bit floating-point numbers, or as a 16-bit PNG";
            assert!(said.ends_with(advice), "{said}");
        }
    }

    #[test]
    fn changed_files_are_read_or_refused_within_the_memory() {
        let px = [0.5_f32; 6];
        let exr = exr((3, 2), Encoding::UNCOMPRESSED, &[("Y", FlatSamples::F32(px.to_vec()))]);
        let tiff = tiff(6, 32, 3, px.map(f32::to_le_bytes).as_flattened());
        for bytes in [exr.clone(), tiff] {
            for (place, value) in (0..bytes.len()).flat_map(|place| [0, 1, 0x7f, 0x80, 0xff].map(|own| (place, own))) {
                let mut changed = bytes.clone();
                changed[place] = value;
                let budget = Budget::new(0, 1 << 20);
                let held = read(&changed, &budget).map_or(0, |map| HeightMap::bytes_to_build(map.size));
                assert_eq!(budget.held(), held, "byte {place} as {value}");
            }
            for end in 0..bytes.len() {
                assert!(read(&bytes[..end], &Budget::unlimited()).is_err(), "{end} bytes");
            }
            let said = read(&bytes, &Budget::new(0, 1000)).expect_err("too little memory");
            assert!(said.contains("px and"), "{said}");
        }
        let window = b"displayWindow\0box2i\0";
        let start = exr.windows(window.len()).position(|own| own == window).expect("the display window");
        // After the size of the value, the greatest x follows the least x and y.
        let greatest_x = start + window.len() + 4 + 8;
        let mut wide = exr;
        wide[greatest_x..greatest_x + 4].copy_from_slice(&99_999_i32.to_le_bytes());
        let said = read(&wide, &Budget::unlimited()).expect_err("too wide");
        assert!(said.contains("has 100000 x 2 px, but at most 16384 px a side are read"), "{said}");
    }
}
