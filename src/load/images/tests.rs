use image::{DynamicImage, ImageBuffer, Luma, LumaA, Rgb, Rgba};

use super::*;

pub(crate) fn decode_texture(bytes: &[u8], budget: &Budget) -> Result<Texture, String> {
    decode_halved(bytes, 0, MipFilter::Colors, budget)
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("in memory");
    bytes.into_inner()
}

fn of(texture: &Texture) -> DynamicImage {
    let [width, height] = texture.size;
    image::RgbaImage::from_raw(width, height, texture.rgba.clone()).expect("4 bytes a px").into()
}

/// An image of noise, always the same.
fn noise(size: [u32; 2]) -> Texture {
    let mut random = fastrand::Rng::with_seed(u64::from(size[0]) << 32 | u64::from(size[1]));
    Texture { size, rgba: (0..4 * size[0] * size[1]).map(|_| random.u8(..)).collect() }
}

#[test]
fn rows_of_every_kind_become_what_the_whole_image_becomes() {
    let number = |x: u32, y: u32, k: u32| (x * 7919 + y * 104_729 + k * 31 + 12_345) as u16;
    let images: [DynamicImage; 6] = [
        of(&noise([9, 5])),
        ImageBuffer::from_fn(9, 5, |x, y| Rgb([0, 1, 2].map(|k| number(x, y, k) as u8))).into(),
        ImageBuffer::from_fn(9, 5, |x, y| Luma([number(x, y, 0)])).into(),
        ImageBuffer::from_fn(9, 5, |x, y| LumaA([0, 1].map(|k| number(x, y, k) as u8))).into(),
        ImageBuffer::from_fn(9, 5, |x, y| Rgba([0, 1, 2, 3].map(|k| number(x, y, k)))).into(),
        ImageBuffer::from_fn(9, 5, |x, y| Luma([number(x, y, 0) as u8])).into(),
    ];
    for image in images {
        let bytes = encoded(&image, ImageFormat::Png);
        let whole = decode_texture(&bytes, &Budget::unlimited()).expect("an image");
        let rows = decode_rows(&bytes, 0, MipFilter::Colors, &Budget::unlimited()).expect("an image");
        assert_eq!((rows.size, rows.rgba), (whole.size, whole.rgba), "{:?}", image.color());
    }
}

#[test]
fn images_are_halved_as_levels_are_made() {
    let source = noise([37, 22]);
    for format in [ImageFormat::Png, ImageFormat::WebP] {
        let bytes = encoded(&of(&source), format);
        assert_eq!(texture_size(&bytes), Some([37, 22]));
        for halvings in 0..7 {
            let budget = Budget::new(0, crate::Limits::default().memory);
            let left = budget.left();
            let made = decode_halved(&bytes, halvings, MipFilter::AlphaWeighted, &budget).expect("an image");
            let expected = (0..halvings).fold(source.clone(), |texture, _| halved(&texture, MipFilter::AlphaWeighted));
            assert_eq!((made.size, &made.rgba), (expected.size, &expected.rgba), "{format:?} {halvings}");
            assert_eq!(left - budget.left(), decoded_bytes(made.size), "what is kept is held");
        }
    }
}

#[test]
fn tga_and_bmp_images_are_read_within_limits() {
    let source = noise([37, 22]);
    for format in [ImageFormat::Tga, ImageFormat::Bmp] {
        let bytes = encoded(&of(&source), format);
        assert_eq!(texture_size(&bytes), Some([37, 22]), "{format:?}");
        let made = decode_texture(&bytes, &Budget::unlimited()).expect("an image");
        assert_eq!((made.size, &made.rgba), (source.size, &source.rgba), "{format:?}");
        for length in [0, 5, 18, 54, bytes.len() / 2] {
            assert!(decode_texture(&bytes[..length], &Budget::unlimited()).is_err(), "{format:?} {length}");
        }
    }
    // A grey image whose rows begin at the bottom, in runs of three and of one px.
    let mut header = [0; 18];
    (header[2], header[12], header[14], header[16]) = (11, 2, 2, 8);
    let runs = [&header[..], &[0x82, 7, 0x00, 9]].concat();
    let rows = [[7, 9], [7, 7]].as_flattened().iter().flat_map(|&grey| [grey, grey, grey, 255]).collect::<Vec<u8>>();
    assert_eq!(decode_texture(&runs, &Budget::unlimited()).map(|own| own.rgba), Ok(rows));
    // A small file that says that it is large.
    (header[13], header[15]) = (0x3f, 0x3f);
    let large = [&header[..], &[0xff; 100]].concat();
    let limits = crate::files::Limits { memory: 64 << 20, ..Default::default() };
    let said = decode_texture(&large, &Budget::new(large.len(), limits.memory)).expect_err("it would take 1 GiB");
    assert!(said.contains("16130 x 16130 px would take"), "{said}");
    assert!(decode_texture(&[0x40; 200], &Budget::unlimited()).is_err(), "no format");
}

#[test]
fn a_png_is_read_in_rows_where_the_whole_image_does_not_fit() {
    let image: DynamicImage = image::RgbImage::from_pixel(2000, 1000, Rgb([9, 8, 7])).into();
    let limits = crate::files::Limits { memory: 10 << 20, ..Default::default() };
    // 8 MB of pixels, and 6 MB of the decoder's if it is decoded whole.
    let decoded = decode_texture(&encoded(&image, ImageFormat::Png), &Budget::new(0, limits.memory));
    assert_eq!(decoded.map(|texture| texture.size), Ok([2000, 1000]));
    let refused = decode_texture(&encoded(&image, ImageFormat::Jpeg), &Budget::new(0, limits.memory));
    assert!(refused.is_err_and(|said| said.contains("2000 x 1000 px would take at least 14 MiB")));
}

#[test]
fn files_that_are_no_images_have_no_size() {
    assert_eq!(texture_size(b"no image"), None);
    assert_eq!(texture_size(b""), None);
    let wide = encoded(&DynamicImage::new_luma8(MAX_SIZE + 1, 1), ImageFormat::Png);
    assert_eq!(texture_size(&wide), None);
}
