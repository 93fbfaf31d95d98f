//! KTX2 files: those of the reference encoder of Basis Universal, and such as are put together here.

use super::*;
use crate::images::tests::decode_texture;
use crate::memory_budget::Budget;

/// Files that `basisu` 2.1 made: four squares of one colour each, whose right half has an alpha of 64 in those with alpha; and
/// a ramp of 13 x 7 px. The PNG files beside them are what `basisu` decodes them to.
pub(crate) const ETC1S: &[u8] = include_bytes!("basis/tests/flat-etc1s.ktx2");
pub(crate) const ETC1S_ALPHA: &[u8] = include_bytes!("basis/tests/alpha-etc1s.ktx2");
const ETC1S_LEVELS: &[u8] = include_bytes!("basis/tests/ramp-etc1s-m.ktx2");
const UASTC: &[u8] = include_bytes!("basis/tests/ramp-uastc.ktx2");
pub(crate) const UASTC_ZSTD: &[u8] = include_bytes!("basis/tests/alpha-uastc-z.ktx2");

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

#[test]
fn basis_universal_is_decoded_to_the_bits_of_the_reference() {
    let files = [
        (ETC1S, &include_bytes!("basis/tests/flat-etc1s.png")[..]),
        (ETC1S_ALPHA, include_bytes!("basis/tests/alpha-etc1s.png")),
        (ETC1S_LEVELS, include_bytes!("basis/tests/ramp-etc1s-m.png")),
        (UASTC, include_bytes!("basis/tests/ramp-uastc.png")),
        (UASTC_ZSTD, include_bytes!("basis/tests/alpha-uastc-z.png")),
    ];
    for (i, (file, reference)) in files.into_iter().enumerate() {
        let expected = image::load_from_memory(reference).expect("a PNG image").into_rgba8();
        assert_eq!(decoded(file).as_deref(), Ok(&expected.as_raw()[..]), "file {i}");
    }
}

#[test]
fn colours_and_alpha_are_near_those_that_were_encoded() {
    let squares = [[[200, 40, 24], [24, 160, 56]], [[40, 56, 200], [240, 240, 240]]];
    for (file, least_alpha) in [(ETC1S, 255), (ETC1S_ALPHA, 64), (UASTC_ZSTD, 64)] {
        for (i, px) in decoded(file).expect("a good file").chunks_exact(4).enumerate() {
            let [r, g, b] = squares[i / 32][i % 8 / 4];
            let alpha = if i % 8 < 4 { 255 } else { least_alpha };
            let is_near = px.iter().zip([r, g, b, alpha]).all(|(own, expected): (&u8, u8)| own.abs_diff(expected) <= 8);
            assert!(is_near, "{i}: {px:?}");
        }
    }
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
        (with(&good, 40, 2), "its KTX2 header ends at byte 116 of 112"),
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
            same += usize::from(
                decode_texture(&changed, &Budget::new(file.len(), crate::Limits::default().memory)).is_ok(),
            );
        }
        assert!(same > 0 && same < 8 * file.len(), "{same}");
    }
}
