//! Panoramas of light.

use std::io::Cursor;

use image::codecs::hdr::HdrEncoder;
use image::codecs::openexr::OpenExrEncoder;
use image::{ExtendedColorType, ImageEncoder, Rgb};

/// The bytes of a Radiance file with these pixels.
pub fn radiance_file(size: [u32; 2], pixels: &[[f32; 3]]) -> Vec<u8> {
    let pixels: Vec<Rgb<f32>> = pixels.iter().map(|&pixel| Rgb(pixel)).collect();
    let mut bytes = Vec::new();
    HdrEncoder::new(&mut bytes).encode(&pixels, size[0] as usize, size[1] as usize).expect("in memory");
    bytes
}

/// The bytes of an OpenEXR file with these pixels.
pub fn open_exr_file(size: [u32; 2], pixels: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let encoder = OpenExrEncoder::new(&mut bytes);
    encoder.write_image(bytemuck::cast_slice(pixels), size[0], size[1], ExtendedColorType::Rgb32F).expect("in memory");
    bytes.into_inner()
}
