//! How much one picture differs from another.

use image::{RgbImage, RgbaImage};
use thiserror::Error;

use super::pixel_differences::PixelDifferences;

/// Two pictures compared.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// 0 for the same picture, 1 for nothing in common: one minus the mean of structural similarity (luma) and colour
    /// difference (chroma) over all px.
    pub difference: f64,
    /// The largest mean of the differences of a tile of 8 x 8 px, in steps of 255; signs cancel, and px at edges count as equal.
    pub largest_tile: f64,
    /// How many px differ by more than the step from everything beside them in the other picture; at edges by more than two of
    /// four samples make, too.
    pub px_beyond: u64,
    /// A picture of the differences, black where there are none. Px beyond the step are white.
    pub map: RgbImage,
}

/// How much pictures of the same scene may differ. The defaults are chosen by the pairs of pictures in `tests/gpu/reference.rs`,
/// which the manual lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PictureTolerance {
    /// The largest [`Comparison::difference`].
    pub difference: f64,
    /// The largest [`Comparison::largest_tile`], in steps of 255.
    pub tile: f64,
    /// The step beyond which px are counted, of 255.
    pub step: f32,
    /// The most [`Comparison::px_beyond`].
    pub px: u64,
}

impl Default for PictureTolerance {
    fn default() -> Self {
        Self { difference: 0.01, tile: 2.0, step: 4.0, px: 0 }
    }
}

impl Comparison {
    /// Whether both pictures show the same: the one place that decides it.
    pub(crate) fn is_same(&self, tolerance: &PictureTolerance) -> bool {
        self.excesses(tolerance).is_empty()
    }

    /// What is more than the tolerance allows, as clauses for a message.
    pub(super) fn excesses(&self, tolerance: &PictureTolerance) -> Vec<String> {
        let PictureTolerance { difference, tile, step, px } = *tolerance;
        let mut excesses = Vec::new();
        if self.difference > difference {
            excesses.push(format!("by {:.4}, more than {difference}", self.difference));
        }
        if self.largest_tile > tile {
            excesses.push(format!("by {:.2} steps in a tile of 8 x 8 px, more than {tile}", self.largest_tile));
        }
        if self.px_beyond > px {
            excesses.push(format!("by more than {step} steps in {} px, more than {px}", self.px_beyond));
        }
        excesses
    }
}

#[derive(Clone, Debug, Error, PartialEq)]
pub enum CompareError {
    #[error("it has {2} x {3} px, and the picture {0} x {1} px: render at the reference's size (--size {2}x{3})")]
    Sizes(u32, u32, u32, u32),
    #[error("the pictures could not be compared: {0}")]
    Failed(String),
}

/// The difference of a px's channels, of 255, that is ignored. Drivers round the last bits of shading differently; in smooth
/// shades, structural similarity would count that as another structure, though nobody sees it.
const ROUNDING: u8 = 1;

/// Compares two pictures by colour, with the usual step: see [`compare_by`].
///
/// # Errors
/// The sizes differ.
pub fn compare(picture: &RgbaImage, reference: &RgbaImage) -> Result<Comparison, CompareError> {
    compare_by(picture, reference, PictureTolerance::default().step)
}

/// Compares two pictures by colour; they have no transparency. Px whose channels all differ by at most 1 of 255 are equal for
/// structural similarity; px that differ by more than `step` of 255 are counted.
///
/// # Errors
/// The sizes differ.
pub(crate) fn compare_by(picture: &RgbaImage, reference: &RgbaImage, step: f32) -> Result<Comparison, CompareError> {
    let ((w, h), (rw, rh)) = (picture.dimensions(), reference.dimensions());
    if (w, h) != (rw, rh) {
        return Err(CompareError::Sizes(w, h, rw, rh));
    }
    let [own, reference] =
        [picture, reference].map(|picture| image::DynamicImage::ImageRgba8(picture.clone()).to_rgb8());
    let PixelDifferences { largest_tile, is_beyond } = PixelDifferences::new(&own, &reference, step);
    let px_beyond = is_beyond.iter().filter(|is_beyond| **is_beyond).count() as u64;
    let rounded = RgbImage::from_fn(w, h, |x, y| {
        let (own, other) = (own.get_pixel(x, y), reference.get_pixel(x, y));
        let is_same = (0..3).all(|channel| own[channel].abs_diff(other[channel]) <= ROUNDING);
        if is_same { *other } else { *own }
    });
    if rounded == reference {
        // Rounding gives equal pictures a similarity that isn't quite 1.
        return Ok(Comparison { difference: 0.0, largest_tile, px_beyond, map: RgbImage::new(w, h) });
    }
    let result = image_compare::rgb_hybrid_compare(&rounded, &reference)
        .map_err(|error| CompareError::Failed(error.to_string()))?;
    let mut map = result.image.to_color_map().to_rgb8();
    map.pixels_mut().zip(&is_beyond).filter(|(_, is_beyond)| **is_beyond).for_each(|(pixel, _)| pixel.0 = [255; 3]);
    Ok(Comparison { difference: (1.0 - result.score).max(0.0), largest_tile, px_beyond, map })
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
        assert_eq!((same.difference, same.largest_tile, same.px_beyond), (0.0, 0.0, 0));
        assert!(same.is_same(&PictureTolerance { difference: 0.0, tile: 0.0, step: 0.0, px: 0 }));
        let mut changed = picture.clone();
        for x in 20..40 {
            changed.put_pixel(x, 24, image::Rgba([255, 255, 255, 255]));
        }
        assert!(compare(&changed, &picture).expect("one size").difference > 0.01);
        let small = RgbaImage::new(10, 10);
        assert_eq!(compare(&small, &picture).err(), Some(CompareError::Sizes(10, 10, 64, 48)));
    }
}
