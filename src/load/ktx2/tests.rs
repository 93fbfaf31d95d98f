//! KTX2 files: those of the reference encoder of Basis Universal, and such as are put together here.

use super::*;
use crate::load::images::decode_texture;
use crate::load::memory_budget::Budget;

/// Files that `basisu` 2.1 made of 8 x 8 px in four squares of one colour each, whose right half has an alpha of 64 in those with
/// alpha; and of 13 x 7 px in which red grows along x, green along y, and blue with both.
pub(crate) const ETC1S: &[u8] = include_bytes!("tests/flat-etc1s.ktx2");
pub(crate) const ETC1S_ALPHA: &[u8] = include_bytes!("tests/alpha-etc1s.ktx2");
const ETC1S_LEVELS: &[u8] = include_bytes!("tests/ramp-etc1s-m.ktx2");
pub(crate) const UASTC: &[u8] = include_bytes!("tests/ramp-uastc.ktx2");
pub(crate) const UASTC_ZSTD: &[u8] = include_bytes!("tests/alpha-uastc-z.ktx2");

/// A file of a plain format, with one level.
pub(crate) fn plain(format: u32, size: [u32; 2], data: &[u8]) -> Vec<u8> {
    let words = [format, 1, size[0], size[1], 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let start = [&START[..], words.map(u32::to_le_bytes).as_flattened()].concat();
    let level = [104, data.len() as u64, data.len() as u64].map(u64::to_le_bytes);
    [&start[..], level.as_flattened(), data].concat()
}

/// Puts a number at a place.
pub(crate) fn with(file: &[u8], at: usize, number: u32) -> Vec<u8> {
    let mut changed = file.to_vec();
    changed[at..at + 4].copy_from_slice(&number.to_le_bytes());
    changed
}

fn decoded(file: &[u8]) -> Result<Vec<u8>, String> {
    decode_texture(file, &Budget::unlimited()).map(|texture| texture.rgba)
}

/// Returns the greatest difference of a component to the colours that a file was made of, except alpha.
fn difference(rgba: &[u8], width: usize, color: impl Fn(usize, usize) -> [u8; 3]) -> u8 {
    let of_px = |(i, px): (usize, &[u8])| {
        let expected = color(i % width, i / width);
        (0..3).map(|c| px[c].abs_diff(expected[c])).max().unwrap_or(0)
    };
    rgba.chunks_exact(4).enumerate().map(of_px).max().expect("pixels")
}

fn squares(x: usize, y: usize) -> [u8; 3] {
    [[[200, 40, 24], [24, 160, 56]], [[40, 56, 200], [240, 240, 240]]][y / 4][x / 4]
}

fn ramp(x: usize, y: usize) -> [u8; 3] {
    [20 * x, 30 * y, 7 * x * y % 256].map(|component| component as u8)
}

fn alphas(rgba: &[u8]) -> Vec<u8> {
    rgba.chunks_exact(4).map(|px| px[3]).collect()
}

#[test]
fn etc1s_has_nearly_the_colours_that_were_encoded() {
    let [flat, alpha] = [ETC1S, ETC1S_ALPHA].map(|file| decoded(file).expect("a good file"));
    assert!(difference(&flat, 8, squares) <= 8 && difference(&alpha, 8, squares) <= 8);
    assert_eq!(alphas(&flat), [255; 64]);
    for (i, alpha) in alphas(&alpha).into_iter().enumerate() {
        assert!(alpha.abs_diff(if i % 8 < 4 { 255 } else { 64 }) <= 4, "{i}: {alpha}");
    }
    let levels = decoded(ETC1S_LEVELS).expect("a good file");
    assert_eq!(levels.len(), 13 * 7 * 4);
    assert!(difference(&levels, 13, ramp) <= 48, "a block has one hue alone");
}

#[test]
fn uastc_has_nearly_the_colours_that_were_encoded() {
    let ramped = decoded(UASTC).expect("a good file");
    assert_eq!(ramped.len(), 13 * 7 * 4);
    assert!(difference(&ramped, 13, ramp) <= 12);
    let packed = decoded(UASTC_ZSTD).expect("a good file");
    assert_eq!(difference(&packed, 8, squares), 0);
    assert_eq!(alphas(&packed)[..8], [255, 255, 255, 255, 64, 64, 64, 64]);
}

#[test]
fn blocks_of_uastc_mean_what_the_specification_says() {
    // The mode of one colour.
    let mut solid = [0; 16];
    solid[..5].copy_from_slice(&(0x17_u64 | 0x4433_2211 << 5).to_le_bytes()[..5]);
    assert_eq!(uastc::texels(&solid), Some([[0x11, 0x22, 0x33, 0x44]; 16]));
    // Mode 1: after 6 and 15 bits six endpoints of 8 bits, then weights of 2 bits, the first one without its highest.
    let mut bits = 0x35_u128;
    for (i, end) in [0_u128, 255, 10, 10, 255, 0].into_iter().enumerate() {
        bits |= end << (21 + 8 * i);
    }
    bits |= 0b11_10_01_1 << 69;
    let texels = uastc::texels(&bits.to_le_bytes()).expect("a mode");
    assert_eq!(texels[..4], [[84, 10, 171, 255], [84, 10, 171, 255], [171, 10, 84, 255], [255, 10, 0, 255]]);
    assert_eq!(texels[4..], [[0, 10, 255, 255]; 12]);
    // The code that no mode has.
    assert_eq!(uastc::texels(&[0x45; 16]), None);
}

#[test]
fn plain_formats_are_taken_as_they_are() {
    let rgba = [1, 2, 3, 4, 5, 6, 7, 8];
    for format in [37, 43] {
        assert_eq!(decoded(&plain(format, [2, 1], &rgba)), Ok(rgba.to_vec()));
    }
    for format in [23, 29] {
        assert_eq!(decoded(&plain(format, [1, 2], &rgba[..6])), Ok(vec![1, 2, 3, 255, 4, 5, 6, 255]));
    }
}

#[test]
fn headers_that_lie_are_refused() {
    let good = plain(37, [2, 1], &[9; 8]);
    let cases = [
        (with(&good, 12, 9), "VkFormat 9"),
        (with(&good, 20, 0), "0 x 1 px"),
        (with(&good, 20, 1 << 31), "needs 8589934592"),
        (with(&good, 24, u32::MAX), "needs 34359738360"),
        (with(&good, 28, 2), "depth 2"),
        (with(&good, 32, 7), "7 layers"),
        (with(&good, 36, 6), "6 faces"),
        (with(&good, 40, u32::MAX), "4294967295 levels"),
        (with(&good, 40, 2), "level 1 of its KTX2 file"),
        (with(&good, 44, 3), "supercompression 3"),
        (with(&good, 80, 200), "ends at byte 208 of 112"),
        (with(&good, 84, u32::MAX), "ends at byte"),
        (with(ETC1S, 44, 0), "supercompression 0"),
        (with(ETC1S, 48, 1 << 20), "data format descriptor ends"),
        (with(ETC1S, 52, 8), "has 8 bytes, but needs at least 44"),
        (with(ETC1S, 72, 1 << 30), "codebooks ends"),
        (with(UASTC, 44, 2), "Zstandard data"),
        (with(UASTC, 44, 1), "supercompression 1"),
        (with(UASTC_ZSTD, 96, 1 << 30), "but its UASTC needs 64"),
        (good[..100].to_vec(), "its KTX2 header ends"),
    ];
    for (file, expected) in cases {
        let said = decoded(&file).expect_err(expected);
        assert!(said.contains(expected), "{expected}: {said}");
    }
}

#[test]
fn files_that_are_cut_or_changed_give_an_error_or_pixels() {
    for file in [ETC1S, ETC1S_ALPHA, ETC1S_LEVELS, UASTC, UASTC_ZSTD] {
        for end in 0..file.len() {
            assert!(decoded(&file[..end]).is_err(), "{end} of {}", file.len());
        }
        let mut same = 0;
        for bit in 0..8 * file.len() {
            let mut changed = file.to_vec();
            changed[bit / 8] ^= 1 << (bit % 8);
            same += usize::from(decode_texture(&changed, &Budget::new(file.len(), &crate::files::Limits::default())).is_ok());
        }
        assert!(same > 0 && same < 8 * file.len(), "{same}");
    }
}
