//! Height images: reading one takes memory for its map, and at most one row of the image.

use std::io::Cursor;
use std::sync::PoisonError;

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, LineOrder, Vec2, WritableImage,
};
use geometry::mesh::Heights;
use geometry::mesh::heights::HeightMap;
use geometry::mesh::shapes::Shape;
use geometry::progress::Progress;
use image::{DynamicImage, ImageFormat, RgbImage};
use load::Budget;
use load::Limits;
use load::heights::{HeightError, HeightSource};

use super::counting::peak_of;
use super::{ALONE, temporary};

/// Reads an image from a file, checks the memory against what its size allows, and returns how much it took, in bytes.
fn read(name: &str, bytes: &[u8]) -> (Result<Heights, HeightError>, usize) {
    read_within(name, bytes, 1, Limits::default().memory)
}

/// The same of an image that may take so many times what its size and so many bytes allow.
fn read_within(name: &str, bytes: &[u8], times: usize, free: u64) -> (Result<Heights, HeightError>, usize) {
    let file = temporary(name, bytes);
    let (mesh, source) = (Shape::CubeSplit.build(), HeightSource::File(file.to_path_buf()));
    let budget = Budget::from_mesh(&mesh, 0, free);
    let (result, took) = peak_of(|| source.load(&mesh, &[], &mut Vec::new(), &budget, &Progress::new()));
    let allowed = 4 * bytes.len() + free as usize;
    println!("{name}: {} of {} MiB, read: {}", took >> 20, allowed >> 20, result.is_ok());
    assert!(took <= times * allowed, "{name}: {took} of {allowed} bytes");
    (result, took)
}

/// A PNG image of one colour with 16 bits a channel.
fn png(size: [u32; 2]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().expect("in memory");
    let mut rows = writer.stream_writer().expect("in memory");
    for _ in 0..size[1] {
        std::io::Write::write_all(&mut rows, &vec![128; 6 * size[0] as usize]).expect("in memory");
    }
    rows.finish().expect("in memory");
    writer.finish().expect("in memory");
    bytes
}

#[test]
fn a_large_png_takes_little_more_than_its_map() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let side = if std::env::var_os("PNAEN_TRIANGLES").is_some() { 16384 } else { 1024 };
    let (result, took) = read("large.png", &png([8192.max(side), side]));
    let heights = result.expect("an image");
    let map = &heights.maps[0];
    assert_eq!((map.size, map.levels), ([4096, side.min(4096)], 13));
    assert!((map.heights[0] - 128.0 * 257.0 / 65535.0).abs() < 1e-4);
    // The decoded image would take 50 MB.
    let kept = map.heights.len() * 4;
    assert!(took < kept + kept / 4 + (1 << 20), "{took} bytes, {kept} of them kept");
}

/// A JPEG image whose frame header has this size, in px a side, and this marker for its coding.
pub(crate) fn jpeg(side: u16, marker: u8) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = DynamicImage::from(RgbImage::from_fn(600, 600, |x, y| image::Rgb([x as u8, y as u8, 90])));
    image.write_to(&mut bytes, ImageFormat::Jpeg).expect("in memory");
    let mut bytes = bytes.into_inner();
    let frame = bytes.windows(2).position(|pair| pair == [0xff, 0xc0]).expect("a frame");
    let [high, low] = side.to_be_bytes();
    bytes[frame + 1] = marker;
    bytes[frame + 5..frame + 9].copy_from_slice(&[high, low, high, low]);
    bytes
}

#[test]
fn a_jpeg_fits_or_is_refused_with_both_numbers() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let refusal = |side: u16, marker: u8| {
        let (result, took) = read(&format!("{side}-{marker:x}.jpg"), &jpeg(side, marker));
        assert!(took < 4 << 20, "{took}");
        result.expect_err("560 MB of pixels or coefficients").to_string()
    };
    assert!(read("small.jpg", &jpeg(600, 0xc0)).0.is_ok());
    let error = refusal(14000, 0xc0);
    assert!(error.contains("has 14000 x 14000 px and would take at least 13"), "{error}");
    assert!(error.contains("MiB of memory, but files of this size may take only 51"), "{error}");
    assert!(
        error.ends_with("scale it to 4096 px a side or less, or save it as a PNG that isn't interlaced"),
        "{error}"
    );
    // The largest image that fits, with most of its data missing. If it is progressive, its coefficients come to more.
    assert!(read("sequential.jpg", &jpeg(8500, 0xc0)).1 > 200 << 20);
    assert!(read_within("progressive.jpg", &jpeg(8500, 0xc2), 2, Limits::default().memory).1 > 400 << 20);
    let error = refusal(9000, 0xc2);
    assert!(error.contains("has 9000 x 9000 px and would take at least 5"), "{error}");
}

/// A colour profile that unpacks to a thousand times its size is never unpacked, neither in height images nor in
/// textures.
#[test]
fn colour_profiles_are_not_unpacked() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut info = png::Info::with_size(16, 16);
    info.icc_profile = Some(vec![0; 300 << 20].into());
    let mut bytes = Vec::new();
    let mut writer =
        png::Encoder::with_info(&mut bytes, info).and_then(|encoder| encoder.write_header()).expect("in memory");
    writer.write_image_data(&[128; 256]).expect("in memory");
    writer.finish().expect("in memory");
    assert!(bytes.len() < 1 << 20, "{} bytes", bytes.len());
    let (result, took) = read("profile.png", &bytes);
    assert!(result.is_ok() && took < 4 << 20, "{took} bytes");
    let (result, took) = super::measured("profile", super::with_image(&bytes));
    let loaded = result.expect("a mesh, with its texture or without");
    assert!(took < 17, "{took} MiB");
    let (mesh, warnings) = (loaded.mesh, loaded.warnings);
    assert!(mesh.materials[0].texture.is_some() || warnings[0].contains("is left out"), "{warnings:?}");
}

/// A TIFF image of one channel of floating-point numbers with so many bits, or of whole ones with 8, which has these tags too. Its data begin at byte 8.
fn tiff(size: [u32; 2], [bits, compression]: [u32; 2], more: &[(u16, Vec<u32>)], data: &[u8]) -> Vec<u8> {
    let [width, height] = size;
    let all =
        [(256, width), (257, height), (258, bits), (259, compression), (262, 1), (339, if bits == 8 { 1 } else { 3 })];
    let mut tags: Vec<_> = all.map(|(tag, value)| (tag, vec![value])).into_iter().chain(more.iter().cloned()).collect();
    tags.sort();
    let mut bytes = [b"II\x2a\0\0\0\0\0", data].concat();
    // TIFF 6.0: each has its number, its type (4 for 32 bits), how many values there are, and the only one, or where they are.
    let mut directory = (tags.len() as u16).to_le_bytes().to_vec();
    for (tag, values) in &tags {
        let place = if let [value] = values[..] { value } else { bytes.len() as u32 };
        if values.len() > 1 {
            bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        }
        directory.extend([*tag, 4].map(u16::to_le_bytes).as_flattened());
        directory.extend([values.len() as u32, place].map(u32::to_le_bytes).as_flattened());
    }
    let place = bytes.len() as u32;
    bytes[4..8].copy_from_slice(&place.to_le_bytes());
    [&bytes, &directory[..], &[0; 4]].concat()
}

/// Zeros for a TIFF image of compression 32773 (PackBits): each pair of bytes is 128 of them.
fn zeros(count: u32) -> Vec<u8> {
    [0x81, 0].repeat(count as usize / 128)
}

/// What an image of 1024 px a side with one channel may take, while decoding it takes so many bytes beside its pixels.
fn free(decoding: u64) -> u64 {
    4 * 1024 * 1024 + HeightMap::bytes_to_build([1024; 2]).max(decoding) + (128 << 10)
}

#[test]
fn a_tiff_takes_what_is_counted() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let strip = |count: usize| [(273, vec![8]), (278, vec![u32::MAX]), (279, vec![count as u32])];
    let tiles = |[width, height]: [u32; 2], data: &[u8], count: usize| {
        [(322, vec![width]), (323, vec![height]), (324, vec![8; count]), (325, vec![data.len() as u32; count])]
    };
    for bits in [16, 32, 64] {
        let all = zeros(1024 * 1024 * bits / 8);
        let own = zeros(256 * 256 * bits / 8);
        let files = [(strip(all.len()).to_vec(), all), (tiles([256; 2], &own, 16).to_vec(), own)];
        for (tags, data) in files {
            let bytes = tiff([1024; 2], [bits, 32773], &tags, &data);
            let decoding = u64::from(bits / 8) * 1024 * 1024;
            let (result, took) = read_within("px.tif", &bytes, 1, free(decoding));
            let heights = result.expect("an image");
            assert!(heights.maps[0].size == [1024; 2] && took > 4 << 20, "{took} bytes");
        }
    }
    let refused = |tags: &[(u16, Vec<u32>)], own: [u32; 2], data: &[u8]| {
        let (result, took) = read("refused.tif", &tiff([16; 2], own, tags, data));
        assert!(took < data.len() + (1 << 20), "{took} bytes");
        result.expect_err("a refusal").to_string()
    };
    let (data, photo) = (zeros(1 << 16), jpeg(14000, 0xc0));
    // Of numbers that are stored as differences (317), a whole row of a tile is unpacked.
    for (bits, differences) in [(8, 2), (32, 3)] {
        let wide = [&tiles([160 << 20, 16], &data, 1)[..], &[(317, vec![differences])]].concat();
        let said = refused(&wide, [bits, 32773], &data);
        assert!(said.contains("has 16 x 16 px and would take at least 5"), "{said}");
        let said = refused(&strip(photo.len()), [bits, 7], &photo);
        assert!(said.ends_with("its numbers are compressed as JPEG; save it with another compression"), "{said}");
    }
    let many = [&strip(0)[..], &[(277, vec![60_000])]].concat();
    assert!(refused(&many, [32, 1], &[]).contains("; save it with one channel"));
}

/// An OpenEXR image of 1024 px a side with so many layers of one channel.
fn exr(compression: Compression, blocks: Blocks, layers: usize) -> Vec<u8> {
    let size = Vec2(1024, 1024);
    let px = FlatSamples::F32((0..1024 * 1024).map(|i| (i % 797) as f32).collect());
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let layer = |number: usize| {
        let channels = [AnyChannel::new("Y", px.clone())].into_iter().collect();
        Layer::new(size, LayerAttributes::named(&*format!("{number}")), encoding, AnyChannels::sort(channels))
    };
    let layers: Vec<_> = (0..layers).map(layer).collect();
    let mut bytes = Cursor::new(Vec::new());
    let image = Image::from_layers(ImageAttributes::new(IntegerBounds::from_dimensions(size)), layers);
    image.write().to_buffered(&mut bytes).expect("in memory");
    bytes.into_inner()
}

#[test]
fn an_exr_of_one_channel_takes_what_is_counted() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for compression in [Compression::Uncompressed, Compression::ZIP16, Compression::PIZ] {
        let lines = 1024 * compression.scan_lines_per_block() as u64;
        let tiles = |side: usize| (Blocks::Tiles(Vec2(side, side)), (side * side) as u64);
        for (blocks, px) in [(Blocks::ScanLines, lines), tiles(256), tiles(1024)] {
            // Of a block there are about three copies.
            let (result, took) = read_within("px.exr", &exr(compression, blocks, 1), 1, free(3 * 4 * px));
            let heights = result.expect("an image");
            assert!(heights.maps[0].size == [1024; 2] && took > 4 << 20, "{took} bytes");
        }
    }
    let two = exr(Compression::ZIP16, Blocks::ScanLines, 2);
    let mut deep = exr(Compression::ZIP16, Blocks::ScanLines, 1);
    // As if its samples were deep, which bit 11 of its version says too.
    let kind = b"\x0d\0\0\0scanlineimage";
    let place = deep.windows(kind.len()).position(|own| own == kind).expect("its kind");
    deep.splice(place..place + kind.len(), *b"\x0c\0\0\0deepscanline");
    deep[5] |= 8;
    for bytes in [two, deep] {
        let (result, took) = read("refused.exr", &bytes);
        assert!(result.is_err() && took < bytes.len() + (1 << 20), "{took} bytes");
    }
}
