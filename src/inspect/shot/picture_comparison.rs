//! How much one picture differs from another.

use image::{GrayImage, Luma, RgbaImage};
use thiserror::Error;

/// The side of the squares over which differences are averaged, in px.
const SQUARE: usize = 8;

/// Two pictures compared, in steps of 255 of the channel that differs most. Transparency is a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// How many px differ.
    pub px: u64,
    /// The largest difference of a px.
    pub largest: u8,
    /// The largest mean of the differences in a square of 8 x 8 px. Signs cancel, so noise hardly counts.
    pub worst_square: f64,
}

/// The pictures have these sizes.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("it has {2} x {3} px, and the picture {0} x {1} px: render at the reference's size (--size {2}x{3})")]
pub struct CompareError(u32, u32, u32, u32);

/// Compares two pictures px by px.
///
/// # Errors
/// The sizes differ.
pub fn compare(picture: &RgbaImage, reference: &RgbaImage) -> Result<Comparison, CompareError> {
    let ((w, h), (rw, rh)) = (picture.dimensions(), reference.dimensions());
    if (w, h) != (rw, rh) {
        return Err(CompareError(w, h, rw, rh));
    }
    let differences = || picture.pixels().zip(reference.pixels()).map(|(own, other)| largest_step(own.0, other.0));
    let means = (0..4).map(|channel| largest_mean(picture, reference, channel));
    Ok(Comparison {
        px: differences().filter(|&step| step > 0).count() as u64,
        largest: differences().max().unwrap_or(0),
        worst_square: means.fold(0.0, f64::max),
    })
}

/// How bright the smallest difference is in a picture of differences, in steps of 255.
pub(crate) const DIFFERENCE_FLOOR: u8 = 64;

/// A picture of the differences between pictures of one size: px that differ by more than so many steps are grey to white,
/// and all others black.
pub(crate) fn difference_picture(picture: &RgbaImage, reference: &RgbaImage, steps: f32) -> GrayImage {
    GrayImage::from_fn(picture.width(), picture.height(), |x, y| {
        let step = largest_step(picture.get_pixel(x, y).0, reference.get_pixel(x, y).0);
        Luma([if f32::from(step) > steps { step.saturating_add(DIFFERENCE_FLOOR) } else { 0 }])
    })
}

fn largest_step(own: [u8; 4], other: [u8; 4]) -> u8 {
    (0..4).map(|channel| own[channel].abs_diff(other[channel])).fold(0, u8::max)
}

/// The largest mean of a channel's differences in a square. One that is higher or wider than the picture is cut.
fn largest_mean(picture: &RgbaImage, reference: &RgbaImage, channel: usize) -> f64 {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let (across, down) = (SQUARE.min(width).max(1), SQUARE.min(height).max(1));
    let difference = |x: usize, y: usize| {
        let at = 4 * (y * width + x) + channel;
        i32::from(picture.as_raw()[at]) - i32::from(reference.as_raw()[at])
    };
    // Sums of the last rows.
    let mut columns = vec![0; width];
    let mut largest = 0;
    for y in 0..height {
        for (x, sum) in columns.iter_mut().enumerate() {
            *sum += difference(x, y) - if y >= down { difference(x, y - down) } else { 0 };
        }
        if y + 1 >= down {
            let sums = columns.windows(across).map(|columns| columns.iter().sum::<i32>().abs());
            largest = sums.fold(largest, i32::max);
        }
    }
    f64::from(largest) / (across * down) as f64
}

#[cfg(test)]
mod tests {
    use image::Rgba;

    use super::*;

    fn shades() -> RgbaImage {
        RgbaImage::from_fn(64, 48, |x, y| Rgba([x as u8 * 3, y as u8 * 5, 90, 255]))
    }

    fn changed(change: impl Fn(u32, u32, &mut Rgba<u8>)) -> Comparison {
        let mut picture = shades();
        picture.enumerate_pixels_mut().for_each(|(x, y, pixel)| change(x, y, pixel));
        compare(&picture, &shades()).expect("one size")
    }

    #[test]
    fn every_px_counts_and_the_worst_square_is_a_mean() {
        assert_eq!(changed(|_, _, _| ()), Comparison { px: 0, largest: 0, worst_square: 0.0 });
        let one = changed(|x, y, pixel| pixel[2] += 64 * u8::from((x, y) == (63, 47)));
        assert_eq!(one, Comparison { px: 1, largest: 64, worst_square: 1.0 });
        let row = changed(|x, y, pixel| pixel[2] -= 16 * u8::from(y == 0 && x < 12));
        assert_eq!(row, Comparison { px: 12, largest: 16, worst_square: 2.0 });
        let clear = changed(|_, _, pixel| pixel[3] = 252);
        assert_eq!(clear, Comparison { px: 64 * 48, largest: 3, worst_square: 3.0 });
    }

    #[test]
    fn noise_cancels_and_what_all_px_have_in_common_does_not() {
        let noise = changed(|x, y, pixel| pixel[2] = 89 + 2 * ((x + y) % 2) as u8);
        assert_eq!((noise.px, noise.largest, noise.worst_square), (64 * 48, 1, 0.0));
        assert_eq!(changed(|_, _, pixel| pixel[2] += 2).worst_square, 2.0);
    }

    #[test]
    fn pictures_of_any_size_are_compared_and_of_two_sizes_are_not() {
        for (width, height) in [(1, 1), (3, 2), (8, 8), (9, 31), (40, 1)] {
            let [own, other] = [10, 200].map(|level| RgbaImage::from_pixel(width, height, Rgba([level; 4])));
            assert_eq!(compare(&own, &other).expect("one size").worst_square, 190.0, "{width} x {height}");
        }
        assert_eq!(compare(&RgbaImage::new(10, 10), &shades()), Err(CompareError(10, 10, 64, 48)));
    }

    #[test]
    fn the_picture_of_the_differences_is_bright_where_px_differ_by_more_than_the_steps() {
        let mut picture = shades();
        picture.get_pixel_mut(3, 5)[2] += 1;
        picture.get_pixel_mut(9, 5)[2] -= 90;
        let bright = |steps| {
            let map = difference_picture(&picture, &shades(), steps);
            (map.get_pixel(3, 5)[0], map.get_pixel(9, 5)[0], map.pixels().filter(|pixel| pixel[0] > 0).count())
        };
        assert_eq!((bright(0.0), bright(1.4)), ((65, 154, 2), (0, 154, 1)));
    }
}
