//! Panoramas that are written in code read back, and broken ones get a sentence; `docs/hostile/environments.md` lists them.

use documents::panoramas::{open_exr_file, radiance_file};
use std::path::Path;

use fastrand::Rng;
use glam::Vec3;

use super::*;
use crate::hostile_files::{is_expected, mentions, page, unhung};

/// Small files of both formats, for a fuzzer.
pub fn seeds() -> Vec<(&'static str, String, Vec<u8>)> {
    let seed = |name: &str, bytes| ("panorama", name.to_owned(), bytes);
    let flat = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X 4\n".to_vec();
    vec![
        seed("runs.hdr", radiance_file([16, 8], &pixels([16, 8]))),
        seed("flat.hdr", [flat, [128, 64, 32, 129].repeat(8)].concat()),
        seed("lines.exr", open_exr_file([8, 4], &pixels([8, 4]))),
        seed("high.exr", open_exr_file([1, 3], &[[0.0; 3], [1e30, 0.5, 2.0], [-1.0, f32::INFINITY, f32::NAN]])),
    ]
}

fn read(bytes: &[u8]) -> Result<EnvironmentFile, EnvironmentFault> {
    let bytes = bytes.to_vec();
    unhung(move || EnvironmentFile::read(&bytes, &Limits::default(), &Progress::new()))
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

enum Gets {
    /// An error (see [`is_expected`]).
    Refused(&'static str),
    /// A panorama, and a warning with these parts (see [`mentions`]).
    Repaired(&'static str),
}
use Gets::{Refused, Repaired};

/// A Radiance file with this line of dimensions, and with these bytes after it.
fn with_dimensions(line: &str, rest: &[u8]) -> Vec<u8> {
    [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n", line.as_bytes(), b"\n", rest].concat()
}

/// An OpenEXR file, with another value of an attribute that is in the header.
fn with_attribute(name: &str, value: &[u8]) -> Vec<u8> {
    let mut bytes = open_exr_file([32, 16], &pixels([32, 16]));
    let name = [name.as_bytes(), b"\0"].concat();
    let start = bytes.windows(name.len()).position(|own| own == name).expect("an attribute") + name.len();
    let kind = bytes[start..].iter().position(|byte| *byte == 0).expect("the name of its type");
    let at = start + kind + 1 + 4;
    bytes[at..at + value.len()].copy_from_slice(value);
    bytes
}

fn window(corners: [i32; 4]) -> Vec<u8> {
    corners.iter().flat_map(|corner| corner.to_le_bytes()).collect()
}

fn cases() -> Vec<(Vec<u8>, Gets)> {
    let size = [32, 16];
    let (radiance, open_exr) = (radiance_file(size, &pixels(size)), open_exr_file(size, &pixels(size)));
    let odd = |value: f32| {
        let mut pixels = pixels(size);
        pixels[3][1] = value;
        open_exr_file(size, &pixels)
    };
    let cut = |bytes: &[u8], part: usize| bytes[..bytes.len() * part / 4].to_vec();
    vec![
        (Vec::new(), Refused("Unknown | .hdr | .exr")),
        (b"\x89PNG\r\n\x1a\n".to_vec(), Refused("Unknown | .hdr | .exr")),
        (b"#?RADIANCE".to_vec(), Refused("Undecoded | header")),
        (b"#?RADIANCE\n".to_vec(), Refused("Undecoded | header")),
        (b"#?RADIANCE\nEXPOSURE=bright\n\n-Y 1 +X 1\n".to_vec(), Refused("Undecoded | EXPOSURE")),
        (with_dimensions("+X 4 +Y 4", &[]), Refused("Undecoded")),
        (with_dimensions("-Y 4", &[]), Refused("Undecoded")),
        (with_dimensions("-Y 4 +X -4", &[]), Refused("Undecoded")),
        (with_dimensions("-Y 0 +X 4", &[]), Refused("Empty | 4 x 0")),
        (with_dimensions("-Y 4294967295 +X 4294967295", &[]), Refused("Undecoded | too large")),
        (with_dimensions("-Y 16385 +X 16385", &[]), Refused("TooLarge | 16385 x 16385 | 16384")),
        (with_dimensions("-Y 8192 +X 16384", &[]), Refused("TooMuch | 16384 x 8192 | 1921 | 512")),
        (with_dimensions("-Y 4 +X 8", &[]), Refused("Short")),
        (with_dimensions("-Y 1 +X 8", &[1, 1, 1, 255]), Refused("Undecoded")),
        (with_dimensions("-Y 1 +X 8", &[2, 2, 0, 8, 255, 0]), Refused("Undecoded")),
        (cut(&radiance, 3), Refused("Short")),
        (b"\x76\x2f\x31\x01".to_vec(), Refused("Short")),
        (b"\x76\x2f\x31\x01\x03\0\0\0".to_vec(), Refused("Undecoded")),
        (cut(&open_exr, 1), Refused("Short")),
        (cut(&open_exr, 3), Refused("Short")),
        (with_attribute("displayWindow", &window([0, 0, 8191, 4095])), Refused("TooMuch | 8192 x 4096 | 769 | 512")),
        (with_attribute("displayWindow", &window([0, 0, 99_999, 15])), Refused("TooLarge | 100000 x 16 | 16384")),
        (with_attribute("displayWindow", &window([0, 0, -2, 15])), Repaired("3 x 16 | twice")),
        (with_attribute("displayWindow", &window([i32::MIN, 0, i32::MAX, 15])), Refused("Undecoded")),
        (with_attribute("dataWindow", &window([0, 0, i32::MAX - 1, 15])), Refused("Undecoded | data window")),
        (with_attribute("dataWindow", &window([0, 0, 31, i32::MAX - 1])), Refused("Undecoded")),
        (with_attribute("dataWindow", &window([5, 5, 1, 1])), Refused("Undecoded")),
        (with_attribute("compression", &[99]), Refused("Undecoded")),
        (odd(f32::NAN), Repaired("NaN | 0 | 1")),
        (odd(-2.0), Repaired("negative | 0 | 1")),
        (odd(f32::INFINITY), Repaired("infinite | 65504 | 1")),
        (odd(f32::NEG_INFINITY), Repaired("negative | 0 | 1")),
        (radiance_file([8, 8], &pixels([8, 8])), Repaired("8 x 8 | twice")),
    ]
}

/// The answer to a file, or what is wrong with it.
fn answer((bytes, gets): &(Vec<u8>, Gets)) -> Result<String, String> {
    let result = read(bytes);
    match (&result, gets) {
        (Err(error), Refused(expected)) if is_expected(error, expected) => return Ok(error.to_string()),
        (Ok(file), Repaired(parts)) => {
            if let [warning] = &file.warnings[..]
                && mentions(warning, parts)
            {
                return Ok(format!("is read, with a warning: {warning}"));
            }
        }
        _ => {}
    }
    let (Refused(expected) | Repaired(expected)) = gets;
    let got = result.map(|file| file.warnings).map_err(|error| format!("{error:?}"));
    Err(format!("{}\n  got {got:?}\n  instead of {expected:?}", page::shown(bytes)))
}

#[test]
fn every_hostile_file_gets_its_error_or_warning() {
    let cases = cases();
    let answers: Vec<_> = cases.iter().map(answer).collect();
    let wrong: Vec<_> = answers.iter().filter_map(|answer| answer.as_ref().err()).map(String::as_str).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let rows: Vec<_> =
        cases.iter().zip(answers).filter_map(|((bytes, _), answer)| Some((page::shown(bytes), answer.ok()?))).collect();
    page::hold("environments.md", "Hostile Radiance and OpenEXR files", &rows);
}

/// Changed bits, ends and numbers: each copy is a panorama without odd numbers, or gets a sentence.
#[test]
fn mutated_copies_are_read_or_refused() {
    let copies = std::env::var("PNAEN_MUTATIONS").ok().and_then(|copies| copies.parse().ok()).unwrap_or(300);
    let size = [32, 16];
    let originals = [radiance_file(size, &pixels(size)), open_exr_file(size, &pixels(size)), tiled(), small_radiance()];
    let (mut random, mut refused) = (Rng::with_seed(1), 0);
    for i in 0..copies {
        let mut bytes = originals[i % originals.len()].clone();
        for _ in 0..=random.usize(..4) {
            // Headers decide the most.
            let end = if random.bool() { bytes.len().min(400) } else { bytes.len() };
            let at = random.usize(..end.max(1));
            match random.usize(..6) {
                0 => bytes.truncate(at),
                1 | 2 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << random.usize(..8)),
                3 => {
                    let number = [0, u32::MAX, 1 << 30, 1 << 16, f32::NAN.to_bits()][random.usize(..5)];
                    bytes.iter_mut().skip(at).zip(number.to_le_bytes()).for_each(|(byte, new)| *byte = new);
                }
                4 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = random.u8(..)),
                _ => bytes.insert(at.min(bytes.len()), random.u8(..)),
            }
        }
        match read(&bytes) {
            Ok(file) => {
                let is_sound = |light: &Vec3| light.is_finite() && light.min_element() >= 0.0;
                assert!(file.panorama.pixels().iter().all(is_sound));
            }
            Err(fault) => {
                let message = fault.to_string();
                assert!(message.len() < 400 && !message.contains(char::is_control), "{message}");
                refused += 1;
            }
        }
    }
    println!("{copies} copies: {refused} refused");
    assert!(refused > copies / 10 && refused < copies, "{refused} of {copies} were refused");
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
