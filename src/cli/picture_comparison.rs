//! How much one picture differs from another.

use image::{Rgb, RgbImage, RgbaImage};
use thiserror::Error;

/// Two pictures compared.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// 0 for the same picture, 1 for nothing in common: one minus the mean of structural similarity (luma) and colour
    /// difference (chroma) over all px.
    pub difference: f64,
    /// A picture of the differences, black where there are none.
    pub map: RgbImage,
}

#[derive(Clone, Debug, Error, PartialEq)]
pub enum CompareError {
    #[error("the pictures are {0} x {1} px and {2} x {3} px: render at the reference's size (--size {2}x{3})")]
    Sizes(u32, u32, u32, u32),
    #[error("the pictures could not be compared: {0}")]
    Failed(String),
}

/// The difference of a px's channels, of 255, that is ignored. Drivers round the last bits of shading differently; in smooth
/// shades, structural similarity would count that as another structure, though nobody sees it.
const ROUNDING: u8 = 1;

/// Compares two pictures by colour; they have no transparency. Px whose channels all differ by at most 1 of 255 are equal.
///
/// # Errors
/// The sizes differ.
pub fn compare(picture: &RgbaImage, reference: &RgbaImage) -> Result<Comparison, CompareError> {
    let ((w, h), (rw, rh)) = (picture.dimensions(), reference.dimensions());
    if (w, h) != (rw, rh) {
        return Err(CompareError::Sizes(w, h, rw, rh));
    }
    let reference = image::DynamicImage::ImageRgba8(reference.clone()).to_rgb8();
    let rounded = RgbImage::from_fn(w, h, |x, y| {
        let (own, other) = (picture.get_pixel(x, y), reference.get_pixel(x, y));
        let is_same = (0..3).all(|channel| own[channel].abs_diff(other[channel]) <= ROUNDING);
        if is_same { *other } else { Rgb([own[0], own[1], own[2]]) }
    });
    let result = image_compare::rgb_hybrid_compare(&rounded, &reference)
        .map_err(|error| CompareError::Failed(error.to_string()))?;
    Ok(Comparison { difference: (1.0 - result.score).max(0.0), map: result.image.to_color_map().to_rgb8() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_of_one_level_is_ignored_and_of_two_is_not() {
        let shades =
            |up: u8| RgbaImage::from_fn(64, 48, |x, y| image::Rgba([x as u8 + up * (y as u8 & 1), 80, 90, 255]));
        let difference = |up| compare(&shades(up), &shades(0)).expect("one size").difference;
        assert!(difference(1) < 1e-9 && difference(2) > 0.01, "{} {}", difference(1), difference(2));
    }

    #[test]
    fn only_equal_pictures_have_no_difference() {
        let picture = RgbaImage::from_fn(64, 48, |x, y| image::Rgba([x as u8 * 3, y as u8 * 5, 90, 255]));
        let same = compare(&picture, &picture).expect("one size");
        assert!(same.difference < 1e-9, "{}", same.difference);
        let mut changed = picture.clone();
        for x in 20..40 {
            changed.put_pixel(x, 24, image::Rgba([255, 255, 255, 255]));
        }
        assert!(compare(&changed, &picture).expect("one size").difference > 0.01);
        let small = RgbaImage::new(10, 10);
        assert_eq!(compare(&small, &picture).err(), Some(CompareError::Sizes(10, 10, 64, 48)));
    }
}
