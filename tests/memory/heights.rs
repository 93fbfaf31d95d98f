//! Height images: reading one takes memory for its map, and at most one row of the image.

use std::io::Cursor;
use std::sync::PoisonError;

use geometry::mesh::Heights;
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
    read_within(name, bytes, 1)
}

/// The same of an image that may take so many times what its size allows.
fn read_within(name: &str, bytes: &[u8], times: usize) -> (Result<Heights, HeightError>, usize) {
    let file = temporary(name, bytes);
    let (mesh, source) = (Shape::CubeSplit.build(), HeightSource::File(file.to_path_buf()));
    let budget = Budget::from_mesh(&mesh, 0, Limits::default().memory);
    let (result, took) = peak_of(|| source.load(&mesh, &[], &mut Vec::new(), &budget, &Progress::new()));
    let allowed = 4 * bytes.len() + Limits::default().memory as usize;
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
    assert!(read_within("progressive.jpg", &jpeg(8500, 0xc2), 2).1 > 400 << 20);
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
