//! How far one picture is from another.

use image::{RgbImage, RgbaImage};
use thiserror::Error;

/// Two pictures compared.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// 0 for the same picture, 1 for nothing in common: one minus the mean of structural similarity (luma) and colour
    /// difference (chroma) over all px.
    pub difference: f64,
    /// Where they differ, and in what: black where they don't.
    pub map: RgbImage,
}

#[derive(Clone, Debug, Error, PartialEq)]
pub enum CompareError {
    #[error("the pictures are {0} x {1} px and {2} x {3} px: render at the reference's size (--size {2}x{3})")]
    Sizes(u32, u32, u32, u32),
    #[error("the pictures could not be compared: {0}")]
    Failed(String),
}

/// Compares by colour alone; the pictures have no transparency.
///
/// # Errors
/// Sizes that differ.
pub fn compare(picture: &RgbaImage, reference: &RgbaImage) -> Result<Comparison, CompareError> {
    let ((w, h), (rw, rh)) = (picture.dimensions(), reference.dimensions());
    if (w, h) != (rw, rh) {
        return Err(CompareError::Sizes(w, h, rw, rh));
    }
    let rgb = |image: &RgbaImage| image::DynamicImage::ImageRgba8(image.clone()).to_rgb8();
    let result = image_compare::rgb_hybrid_compare(&rgb(picture), &rgb(reference))
        .map_err(|error| CompareError::Failed(error.to_string()))?;
    Ok(Comparison { difference: (1.0 - result.score).max(0.0), map: result.image.to_color_map().to_rgb8() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_itself_and_nothing_else() {
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
