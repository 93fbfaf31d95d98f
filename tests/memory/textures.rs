//! Textures: those that are too large are scaled down to the memory that they may take, and the model is shown.

use documents::package;
use std::io::Cursor;
use std::sync::PoisonError;

use image::{GrayImage, ImageFormat, Luma};
use inspect::engine::Preparation;

use super::bounded::loaded;
use super::{ALONE, bomb, heights, temporary, textures, with_image};
use documents::webp::of_groups;

const MIB: usize = 1 << 20;

/// Loads a file with so much memory beyond four times its size, and checks that it takes no more. Returns the sizes of its
/// textures, and the warnings about them.
fn sizes(name: &str, bytes: &[u8], memory: usize) -> (Vec<Option<[u32; 2]>>, Vec<String>) {
    let file = temporary(name, bytes);
    let (result, took) = loaded(&file, &Preparation::default(), memory as u64);
    let allowed = memory + 4 * bytes.len() + MIB;
    println!("{name}: {took} of {allowed} bytes");
    assert!(took <= allowed, "{name}: {took} of {allowed} bytes");
    let loaded = result.expect("a model whatever its textures are");
    let texture = |material: &geometry::mesh::Material| material.texture.as_ref().map(|texture| texture.size);
    let of_textures = |warning: &String| warning.starts_with("the texture of ");
    let warnings = loaded.warnings.iter().filter(|warning| of_textures(warning)).cloned().collect();
    (loaded.read.materials.iter().map(texture).collect(), warnings)
}

fn encoded(size: [u32; 2], format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = GrayImage::from_fn(size[0], size[1], |x, _| Luma([(x / 64) as u8]));
    image.write_to(&mut bytes, format).expect("in memory");
    bytes.into_inner()
}

#[test]
fn a_texture_that_is_too_wide_is_scaled_down_row_by_row() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let bytes = with_image(&encoded([16384, 256], ImageFormat::Png));
    let (found, warnings) = sizes("wide.glb", &bytes, 64 * MIB);
    assert_eq!(found, [Some([8192, 128])]);
    let said = "is scaled down from 16384 x 256 px to 8192 x 128 px: at most 8192 px a side are shown.";
    assert!(warnings.len() == 1 && warnings[0].ends_with(said), "{warnings:?}");
    // Decoded it has 16 MiB.
    let (found, warnings) = sizes("wide-in-little.glb", &bytes, 3 * MIB);
    assert_eq!(found, [Some([4096, 64])]);
    assert!(
        warnings[0].contains("to 4096 x 64 px: ") && warnings[0].contains("(--max-memory allows more)"),
        "{warnings:?}"
    );
}

#[test]
fn an_image_that_can_not_be_decoded_in_the_memory_is_left_out() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let (found, warnings) = sizes("jpeg.glb", &with_image(&encoded([4096, 1024], ImageFormat::Jpeg)), 3 * MIB);
    assert_eq!(found, [None]);
    assert!(
        warnings.len() == 1 && warnings[0].contains("is left out: its image of 4096 x 1024 px would take"),
        "{warnings:?}"
    );
    // The header of a PNG image of 16384 x 16384 px, with next to no data.
    let mut header = encoded([1, 1], ImageFormat::Png);
    header[16..24].copy_from_slice(&[0, 0, 0x40, 0, 0, 0, 0x40, 0]);
    let crc = crc32(&header[12..29]);
    header[29..33].copy_from_slice(&crc.to_be_bytes());
    let (found, warnings) = sizes("header.glb", &with_image(&header), 20 * MIB);
    assert_eq!(found, [None]);
    assert!(warnings.len() == 1 && warnings[0].contains("is left out: its image can't be decoded"), "{warnings:?}");
}

#[test]
fn tables_of_a_lossless_webp_image_are_counted_before_they_are_made() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    // 5,000 tables of 4 KiB, asked for with 60 KB.
    let bytes = with_image(&of_groups(1000));
    let (found, warnings) = sizes("tables.glb", &bytes, 8 * MIB);
    assert_eq!(found, [None]);
    assert!(
        warnings.len() == 1 && warnings[0].contains("is left out: its prefix codes may take more memory"),
        "{warnings:?}"
    );
    let (found, warnings) = sizes("tables-that-fit.glb", &bytes, 32 * MIB);
    assert_eq!((found, warnings.len()), (vec![Some([4; 2])], 0), "{warnings:?}");
}

/// A KTX2 image of 1024 x 1024 px, 4 MiB, whose Zstandard data decompresses to so many times 128 KiB.
fn zstandard(blocks: usize) -> Vec<u8> {
    let mut data = vec![0x28, 0xb5, 0x2f, 0xfd, 0, 0x58];
    for block in 1..=blocks {
        // A block that repeats the byte 7; the lowest bit says that it is the last.
        data.extend(&((128_u32 << 13) | 2 | u32::from(block == blocks)).to_le_bytes()[..3]);
        data.push(7);
    }
    let words = [37, 1, 1024, 1024, 0, 0, 1, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0_u32];
    let level = [104, data.len() as u64, 4 << 20].map(u64::to_le_bytes);
    [&b"\xabKTX 20\xbb\r\n\x1a\n"[..], words.map(u32::to_le_bytes).as_flattened(), level.as_flattened(), &data].concat()
}

#[test]
fn images_that_decompress_to_more_than_they_say_are_bounded() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let (found, warnings) = sizes("zstandard.glb", &with_image(&zstandard(32)), 16 * MIB);
    assert_eq!((found, warnings.len()), (vec![Some([1024; 2])], 0), "{warnings:?}");
    // A gibibyte in 32 KB.
    let (found, warnings) = sizes("zstandard-bomb.glb", &with_image(&zstandard(8192)), 16 * MIB);
    assert_eq!(found, [None]);
    assert!(warnings.len() == 1 && warnings[0].contains("its Zstandard data can't be decompressed"), "{warnings:?}");
    // Coefficients of a progressive JPEG image, which aren't counted; and all the prefix codes that pass.
    let (loaded, took) = bomb("progressive.glb", with_image(&heights::jpeg(8500, 0xc2)));
    assert!(loaded.is_ok() && took > 400 << 20, "{took}");
    let (loaded, took) = bomb("prefix-codes.glb", with_image(&of_groups(17_000)));
    assert!(loaded.is_ok() && took > 300 << 20, "{took}");
}

/// The checksum of a chunk of a PNG file (PNG specification, annex D).
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 * (crc & 1)))
    })
}

#[test]
fn the_largest_textures_are_scaled_down_first_and_one_warning_says_how_many() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    // Each takes 4 MiB decoded, and 5.3 on the graphics card.
    let bytes = textures(4, 1024);
    let (found, warnings) = sizes("four.glb", &bytes, 15 * MIB);
    assert_eq!(found.iter().flatten().map(|size| size[0]).collect::<Vec<_>>(), [512, 512, 1024, 1024]);
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    let start = "the texture of material \"material 0\" is scaled down from 1024 x 1024 px to 512 x 512 px: ";
    assert!(warning.starts_with(start) && warning.ends_with(" (and 1 more like it)."), "{warning}");
    let (found, warnings) = sizes("four-that-fit.glb", &bytes, 40 * MIB);
    assert_eq!((found, warnings.len()), (vec![Some([1024; 2]); 4], 0));
}

/// A 3MF file with a triangle that shows an image of this size.
fn textured(size: u32) -> Vec<u8> {
    let mut png = Cursor::new(Vec::new());
    let image = image::RgbaImage::from_fn(size, size, |x, _| image::Rgba([(x / 64) as u8, 0, 0, (x % 256) as u8]));
    image.write_to(&mut png, ImageFormat::Png).expect("in memory");
    let mesh = package::mesh([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]]);
    let resources = format!(
        "<m:texture2d id=\"3\" path=\"/a.png\"/><m:texture2dgroup id=\"4\" texid=\"3\"><m:tex2coord u=\"0\" v=\"0\"/>\
         </m:texture2dgroup><object id=\"1\" pid=\"4\" pindex=\"0\">{mesh}</object>"
    );
    let model = package::model(&resources, "<item objectid=\"1\"/>");
    package::zip(&[
        package::Entry::stored("_rels/.rels", package::relationships().as_bytes()),
        package::Entry::deflated(package::MODEL, model.as_bytes()),
        package::Entry::stored("a.png", png.get_ref()),
    ])
}

#[test]
fn images_of_3mf_files_are_scaled_down_until_they_fit() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    // It takes 4 MiB decoded.
    let bytes = textured(1024);
    for (memory, whole) in [(60, true), (3, false)] {
        let (found, _) = sizes("textured.3mf", &bytes, memory * MIB);
        let [Some(size)] = found[..] else { panic!("{memory} MiB: {found:?}") };
        assert_eq!(size == [1024; 2], whole, "{memory} MiB: {found:?}");
    }
}
