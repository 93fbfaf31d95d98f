use std::io::Cursor;

use image::ImageFormat;

use super::*;

use documents::webp::{BitWriter, of_groups};

/// The bytes of the header, and of the chunk before it.
const HEADER: usize = 12 + 8 + 5;
/// The tables of a group whose five codes have 4 KiB each.
const LARGE: u64 = BYTES_A_GROUP + 5 * (BLOCKS + 4096);

fn decodes(file: &[u8]) -> bool {
    image::load(Cursor::new(file), ImageFormat::WebP).is_ok()
}

#[test]
fn places_nearby_are_those_of_the_standard() {
    // Section 5.2.2 gives (0, 1), (1, 0), (1, 1), (-1, 1) as the first, and (-7, 6), (8, 5), (7, 7), (-7, 7), (8, 6), (8, 7) as the last.
    let places = nearby(100);
    assert_eq!(places.len(), NEARBY);
    assert_eq!(places[..4], [100, 1, 101, 99]);
    assert_eq!(places[114..], [593, 508, 707, 693, 608, 708]);
    assert_eq!(nearby(2)[3], 1, "a place behind the present one counts as the last one");
}

#[test]
fn tables_are_counted_before_they_are_made() {
    for groups in [1, 7, 1000] {
        let file = of_groups(groups);
        assert_eq!(table_bytes(&file[HEADER..], [4, 4]), Ok(u64::from(groups) * LARGE), "{groups} groups");
        assert!(decodes(&file), "{groups} groups");
    }
    let cut = of_groups(1000);
    assert_eq!(table_bytes(&cut[HEADER..cut.len() / 2], [4, 4]), Err(BROKEN));
}

/// Writes a code in which each symbol has this length, 0 for symbols without a code.
fn full_code(bits: &mut BitWriter, symbols: usize, lengths: &[(usize, u32)]) {
    // Not short. All lengths from 0 to 15 have codes of 4 bits, the repetitions none.
    bits.number(1, 0);
    bits.number(4, 15);
    ORDER.into_iter().for_each(|length| bits.number(3, if length < 16 { 4 } else { 0 }));
    bits.number(1, 0);
    for symbol in 0..symbols {
        let length = lengths.iter().find(|(own, _)| *own == symbol).map_or(0, |(_, length)| *length);
        bits.code(4, length);
    }
}

#[test]
fn numbers_of_groups_are_read_with_their_cache_and_what_they_repeat() {
    let mut bits = BitWriter::default();
    // A table of 16 colours, of which each px has two. Then no cache, and a number of a group for each block of 4 x 4.
    bits.number(3, 0b111);
    bits.number(8, 15);
    bits.number(1, 0);
    (0..5).for_each(|_| bits.single(0));
    bits.number(3, 0b100);
    bits.number(3, 0);
    // The image of 4 x 2 numbers has a cache of two colours.
    bits.number(1, 1);
    bits.number(4, 1);
    let kept = 0x1e35_a7bd_u32.wrapping_mul(3 << 8) >> 31;
    full_code(&mut bits, 282, &[(0, 2), (3, 2), (256, 2), (280 + kept as usize, 2)]);
    (0..3).for_each(|_| bits.single(0));
    // The only distance is that of the place above.
    bits.single(0);
    let [zero, three, repeated, cached] = [0, 1, 2, 3];
    [zero, three, cached, zero, repeated, repeated, cached, three].into_iter().for_each(|code| bits.code(2, code));
    for _ in 0..4 {
        full_code(&mut bits, 280, &[(0, 1), (1, 2), (2, 2)]);
        full_code(&mut bits, 256, &(0..256).map(|symbol| (symbol, 8)).collect::<Vec<_>>());
        // The last twelve codes are longer than the table's.
        let lengths: Vec<_> = (0..9).map(|symbol| (symbol, symbol as u32 + 1)).chain([(9, 11)]).collect();
        let long = (10..13).map(|symbol| (symbol, 11));
        full_code(&mut bits, 256, &lengths.into_iter().chain(long).collect::<Vec<_>>());
        bits.single(255);
        // Short, two symbols of which the first has 1 bit.
        bits.number(3, 0b011);
        bits.number(1, 1);
        bits.number(8, 0);
    }
    (0..200).for_each(|_| bits.number(32, 0));
    let file = bits.file([32, 8]);
    let tables = [4 << 2, 4 << 8, (4 << 10) + 4 * BYTES_A_LONG_SYMBOL, 4 << 1].map(|table| BLOCKS + table);
    let expected = 4 * (BYTES_A_GROUP + tables.iter().sum::<u64>());
    assert_eq!(table_bytes(&file[HEADER..], [32, 8]), Ok(expected));
    assert!(decodes(&file));
}

#[test]
fn what_encoders_write_is_counted() {
    for side in [1, 5, 200] {
        let image =
            image::RgbaImage::from_fn(side, side, |x, y| image::Rgba([(x * 7) as u8, y as u8, (x ^ y) as u8, 9]));
        let mut file = Cursor::new(Vec::new());
        image.write_to(&mut file, ImageFormat::WebP).expect("in memory");
        let bytes = table_bytes(&file.into_inner()[HEADER..], [side as usize; 2]).expect("a whole image");
        assert!(bytes <= LARGE + 5 * 280 * BYTES_A_LONG_SYMBOL, "{side}: {bytes}");
    }
}

#[test]
fn data_that_is_none_is_refused() {
    for data in [&[][..], &[0xff; 40], &[0; 40], &[0b0000_0011, 0, 0]] {
        assert_eq!(table_bytes(data, [16384; 2]), Err(BROKEN), "{data:?}");
    }
}
