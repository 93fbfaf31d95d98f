//! Panoramas that are written in code read back. Broken ones are in the corpus.

use documents::panoramas::{open_exr_file, radiance_file};
use std::path::Path;

use glam::Vec3;

use std::io::Cursor;

use super::*;

fn read(bytes: &[u8]) -> Result<EnvironmentFile, EnvironmentFault> {
    EnvironmentFile::read(bytes, &Limits::default(), &Progress::new())
}

/// Pixels with a colour of their own each.
fn pixels([width, height]: [u32; 2]) -> Vec<[f32; 3]> {
    let pixel = |x: u32, y: u32| [x as f32 / width as f32, y as f32 / height as f32, 8.0];
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
}

#[test]
fn files_give_the_light_that_they_have() {
    let size = [32, 16];
    let written = pixels(size);
    for (name, bytes, most) in
        [("a.hdr", radiance_file(size, &written), 0.04), ("a.exr", open_exr_file(size, &written), 0.0)]
    {
        let EnvironmentFile { panorama, warnings } = read(&bytes).expect(name);
        assert_eq!((panorama.size(), warnings), (size, Vec::new()));
        let off = |(found, written): (&Vec3, &[f32; 3])| (*found - Vec3::from(*written)).abs().max_element();
        let most_off = panorama.pixels().iter().zip(&written).map(off).fold(0.0, f32::max);
        assert!(most_off <= most, "{name}: {most_off}");
    }
    let old = [b"#?RGBE", &radiance_file(size, &written)[RADIANCE.len()..]].concat();
    assert_eq!(read(&old).expect("an old file").panorama.size(), size);
}

#[test]
fn a_panorama_that_is_too_large_to_be_kept_is_reduced() {
    let size = [4100, 2050];
    // A row of one colour is short.
    let bytes = radiance_file(size, &vec![[0.5, 1.0, 2.0]; 4100 * 2050]);
    let file = EnvironmentFile::read(&bytes, &Limits::default(), &Progress::new()).expect("a panorama");
    assert_eq!(file.panorama.size(), [2050, 1025]);
    assert_eq!(file.panorama.pixels()[77], Vec3::new(0.5, 1.0, 2.0));
    assert_eq!(file.warnings, ["it has 4100 x 2050 px, and was reduced to 2050 x 1025 px."]);
}

#[test]
fn a_file_tells_its_name_and_a_job_that_was_cancelled_reads_nothing() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("wide.HDR");
    std::fs::write(&path, radiance_file([3, 1], &[[1.0; 3]; 3])).expect("a writable temporary folder");
    assert!(is_environment(&path) && !is_environment(Path::new("a.png")));
    let load = |path: &Path, progress: &Progress| EnvironmentFile::load(path, &Limits::default(), progress);
    let progress = Progress::new();
    let warnings = load(&path, &progress).expect("a panorama").warnings;
    assert!(warnings.len() == 1 && warnings[0].starts_with("wide.HDR: it has 3 x 1 px; "), "{warnings:?}");
    assert_eq!(progress.fraction(), 1.0);
    progress.cancel();
    assert!(matches!(load(&path, &progress), Err(EnvironmentError::Cancelled(Cancelled))));
    assert!(matches!(read(b"").err(), Some(EnvironmentFault::Unknown)));
    let progress = Progress::new();
    let bytes = open_exr_file([32, 16], &pixels([32, 16]));
    progress.cancel();
    let cancelled = EnvironmentFile::read(&bytes, &Limits::default(), &progress);
    assert!(matches!(cancelled, Err(EnvironmentFault::Cancelled(Cancelled))));
    let missing = load(&folder.path().join("none.exr"), &Progress::new()).expect_err("no file").to_string();
    assert!(missing.contains("none.exr can't be read: there is no such file"), "{missing}");
    std::fs::write(&path, "v 0 0 0\n").expect("a writable temporary folder");
    let other = load(&path, &Progress::new()).expect_err("no panorama").to_string();
    assert!(other.contains("wide.HDR: it begins neither like a Radiance file (.hdr)"), "{other}");
}

/// An OpenEXR file with tiles and half floats, compressed by wavelets.
fn tiled() -> Vec<u8> {
    use exr::prelude::{
        Blocks, Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels, Vec2,
    };
    use exr::prelude::{WritableImage, f16};
    let half = |value: f32| f16::from_f32(value);
    let channels = SpecificChannels::rgb(|Vec2(x, y)| (half(x as f32), half(y as f32), half(0.5)));
    let encoding = Encoding {
        compression: Compression::PIZ,
        blocks: Blocks::Tiles(Vec2(16, 16)),
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new((48, 24), LayerAttributes::named("sky"), encoding, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).expect("in memory");
    bytes.into_inner()
}

/// A Radiance file whose rows aren't compressed, since they have fewer than 8 px.
fn small_radiance() -> Vec<u8> {
    radiance_file([4, 2], &pixels([4, 2]))
}

#[test]
fn tiles_and_half_floats_are_read() {
    let panorama = read(&tiled()).expect("a panorama").panorama;
    assert_eq!(panorama.size(), [48, 24]);
    assert_eq!(panorama.pixels()[48 * 23 + 40], Vec3::new(40.0, 23.0, 0.5));
    assert_eq!(read(&small_radiance()).expect("a panorama").panorama.size(), [4, 2]);
}
