//! Textures whose image is that of an extension.

use base64::prelude::{BASE64_STANDARD, Engine};

use super::files::textured;
use super::*;
use crate::ktx2::tests::{ETC1S, UASTC_ZSTD};

/// The name of a texture's extension, and an image that it may have.
const BASISU: &str = "KHR_texture_basisu";
const WEBP: &str = "EXT_texture_webp";

fn image(bytes: &[u8]) -> Value {
    json!({ "uri": format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(bytes)) })
}

/// A WebP image of two px.
pub(super) fn webp() -> Vec<u8> {
    let pixels = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 0, 0, 255, 128]).expect("8 bytes");
    let mut bytes = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut bytes, image::ImageFormat::WebP).expect("in memory");
    bytes.into_inner()
}

/// A triangle whose texture has these images, the first in `source` and the others in extensions.
pub(super) fn extended(source: Option<&[u8]>, extensions: &[(&str, &[u8])]) -> Draft {
    let mut draft = textured(json!({}));
    let (mut images, mut texture) = (Vec::new(), json!({ "extensions": {} }));
    for (name, bytes) in extensions {
        texture["extensions"][name] = json!({ "source": images.len() });
        images.push(image(bytes));
    }
    if let Some(bytes) = source {
        texture["source"] = json!(images.len());
        images.push(image(bytes));
    }
    (draft.root["textures"], draft.root["images"]) = (json!([texture]), json!(images));
    draft
}

/// The size of the base colour's image, and the warnings.
fn read(draft: &Draft) -> (Option<[u32; 2]>, Vec<String>) {
    let loaded = draft.read().expect("a triangle");
    (loaded.mesh.materials[0].texture.as_ref().map(|texture| texture.size), loaded.warnings)
}

#[test]
fn images_of_extensions_are_read() {
    for (name, bytes, size) in [(WEBP, &webp()[..], [2, 1]), (BASISU, ETC1S, [8, 8]), (BASISU, UASTC_ZSTD, [8, 8])] {
        let mut draft = extended(None, &[(name, bytes)]);
        draft.root["extensionsUsed"] = json!([name]);
        draft.root["extensionsRequired"] = json!([name]);
        assert_eq!(read(&draft), (Some(size), Vec::new()), "{name}");
    }
    let draft = extended(None, &[(WEBP, &webp())]);
    let texture = draft.read().expect("a triangle").mesh.materials[0].texture.clone().expect("a texture");
    assert_eq!(texture.rgba, [255, 0, 0, 255, 0, 0, 255, 128]);
}

#[test]
fn the_image_of_an_extension_comes_first() {
    assert_eq!(read(&extended(Some(&webp()), &[(BASISU, ETC1S)])), (Some([8, 8]), Vec::new()));
    assert_eq!(read(&extended(None, &[(WEBP, &webp()), (BASISU, ETC1S)])), (Some([8, 8]), Vec::new()));
}

#[test]
fn other_images_take_the_place_of_broken_ones() {
    let (size, warnings) = read(&extended(Some(&webp()), &[(BASISU, &ETC1S[..200])]));
    assert_eq!((size, warnings.len()), (Some([2, 1]), 1), "{warnings:?}");
    let expected =
        "the texture of material \"skin\" can't be used, and the texture's other image takes its place: level 0";
    assert!(warnings[0].starts_with(expected), "{warnings:?}");
    let (size, warnings) = read(&extended(Some(b"nothing"), &[(WEBP, b"RIFF"), (BASISU, b"none")]));
    assert_eq!((size, warnings.len()), (None, 2), "{warnings:?}");
    assert!(warnings[0].ends_with("(2 times)."), "{warnings:?}");
    assert!(warnings[1].starts_with("the texture of material \"skin\" is left out"), "{warnings:?}");
    let mut wrong = extended(Some(&webp()), &[(WEBP, &webp())]);
    wrong.root["textures"][0]["extensions"][WEBP]["source"] = json!(9);
    let (size, warnings) = read(&wrong);
    assert_eq!((size, warnings.len()), (Some([2, 1]), 1));
    assert!(warnings[0].contains("/textures/0/extensions/EXT_texture_webp/source is 9"), "{warnings:?}");
}

#[test]
fn images_that_do_not_fit_are_left_out_before_they_are_decoded() {
    // A plain image of 16384 x 16384 px compressed by Zstandard, of which nothing is there.
    let mut large = crate::ktx2::tests::plain(37, [16384, 16384], &[0; 40]);
    large[44] = 2;
    large[96..104].copy_from_slice(&(1_u64 << 30).to_le_bytes());
    let (size, warnings) = read(&extended(None, &[(BASISU, &large)]));
    assert!(size.is_none() && warnings[0].contains("its image of 16384 x 16384 px would take"), "{warnings:?}");
}
