//! Panoramas: pictures of all directions, longitude across and latitude down.

use geometry::casts::to_u32;
use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::notes::counts;

/// The largest number of a half float, in which light is stored on the device.
const MOST_LIGHT: f32 = 65504.0;

/// A panorama in linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    width: usize,
    height: usize,
    /// Row by row from the top. None is negative or infinite.
    pixels: Vec<Vec3>,
}

counts! {
    /// How many numbers of a panorama were replaced, because no light can be so.
    #[derive(PartialEq, Eq)]
    pub struct Repaired {
        not_numbers => "numbers of its pixels that are no numbers (NaN) were replaced by 0";
        negative => "numbers of its pixels that are negative were replaced by 0";
        infinite => "numbers of its pixels that are infinite were replaced by 65504";
    }
}

impl Panorama {
    /// Takes `size` (width and height) pixels, row by row from the top. What can't be light is replaced and counted; pixels that
    /// are missing are black.
    pub fn new(size: [u32; 2], mut pixels: Vec<[f32; 3]>) -> (Self, Repaired) {
        let [width, height] = size.map(|length| length.max(1) as usize);
        let mut repaired = Repaired::default();
        pixels.resize(width * height, [0.0; 3]);
        pixels.as_flattened_mut().iter_mut().for_each(|value| repair(value, &mut repaired));
        (Self { width, height, pixels: bytemuck::allocation::cast_vec(pixels) }, repaired)
    }

    /// The panorama of so many pixels that shows this radiance from each direction.
    pub fn from_radiance(size: [u32; 2], radiance: impl Fn(Vec3) -> Vec3) -> Self {
        let [width, height] = size.map(|length| length.max(1) as usize);
        Self { width, height, pixels: directions(width, height).map(radiance).collect() }
    }

    /// The light of its pixels: unit direction, solid angle in sr, and linear RGB.
    pub fn lights(&self) -> impl Iterator<Item = (Vec3, f32, Vec3)> {
        let on_equator = 2.0 * (0.5 * PI / self.height as f32).sin() * TAU / self.width as f32;
        let solid_angle = move |direction: Vec3| on_equator * direction.x.hypot(direction.z);
        let lights = directions(self.width, self.height).zip(&self.pixels);
        lights.map(move |(direction, &light)| (direction, solid_angle(direction), light))
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [to_u32(self.width), to_u32(self.height)]
    }

    /// Row by row from the top, in linear RGB.
    pub fn pixels(&self) -> &[Vec3] {
        &self.pixels
    }

    /// The same, halved until it has at most `most_rows` rows and twice as many columns.
    pub fn reduced(mut self, most_rows: usize) -> Self {
        while (self.height > most_rows || self.width > 2 * most_rows) && (self.width > 1 || self.height > 1) {
            self = self.halved();
        }
        self
    }

    /// The means of 2 x 2 pixels, by their solid angles. An odd last row or column counts twice.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let length = |row: usize| ((row.min(self.height - 1) as f32 + 0.5) / self.height as f32 * PI).sin();
        let lower_part = |y: usize| length(2 * y + 1) / (length(2 * y) + length(2 * y + 1));
        let lower_parts: Vec<f32> = (0..height).map(lower_part).collect();
        let mean = |x: usize, y: usize| {
            // A half of each, since their sum may be beyond the largest number.
            let [upper, lower] =
                [2 * y, 2 * y + 1].map(|row| 0.5 * self.pixel(2 * x, row) + 0.5 * self.pixel(2 * x + 1, row));
            upper + (lower - upper) * lower_parts[y]
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
        Self { width, height, pixels }
    }

    fn pixel(&self, x: usize, y: usize) -> Vec3 {
        self.pixels[y.min(self.height - 1) * self.width + x.min(self.width - 1)]
    }

    /// The light from a unit direction. The panorama's middle is at -Z, +X is to the right of it, and +Y is at the top.
    #[expect(clippy::cast_possible_truncation, reason = "whole numbers around the picture")]
    pub fn light_from(&self, direction: Vec3) -> Vec3 {
        let across = (0.5 + direction.x.atan2(-direction.z) / TAU) * self.width as f32 - 0.5;
        let down = direction.y.clamp(-1.0, 1.0).acos() / PI * self.height as f32 - 0.5;
        let (left, top) = (across.floor(), down.floor());
        let column = |index: f32| (index as i64).rem_euclid(self.width as i64) as usize;
        let row = |index: f32| index.max(0.0) as usize;
        let blend = |y| self.pixel(column(left), y).lerp(self.pixel(column(left + 1.0), y), across - left);
        blend(row(top)).lerp(blend(row(top + 1.0)), down - top)
    }
}

/// The directions of pixels, row by row from the top.
fn directions(width: usize, height: usize) -> impl Iterator<Item = Vec3> {
    (0..height).flat_map(move |y| {
        let (up, level) = ((0.5 - (y as f32 + 0.5) / height as f32) * PI).sin_cos();
        (0..width).map(move |x| {
            let (right, front) = (((x as f32 + 0.5) / width as f32 - 0.5) * TAU).sin_cos();
            Vec3::new(right * level, up, -front * level)
        })
    })
}

fn repair(value: &mut f32, repaired: &mut Repaired) {
    if value.is_nan() {
        (*value, repaired.not_numbers) = (0.0, repaired.not_numbers + 1);
    } else if *value < 0.0 {
        (*value, repaired.negative) = (0.0, repaired.negative + 1);
    } else if value.is_infinite() {
        (*value, repaired.infinite) = (MOST_LIGHT, repaired.infinite + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_the_brightest_light_is_finite() {
        let (bright, repaired) = Panorama::new([4, 2], vec![[3e38; 3]; 8]);
        assert_eq!((bright.reduced(1).pixels(), repaired), (&[Vec3::splat(3e38); 2][..], Repaired::default()));
    }

    #[test]
    fn a_direction_finds_its_pixel_also_in_a_smaller_copy() {
        // Each pixel has its direction as a colour.
        let whole = Panorama::from_radiance([256, 128], |direction| 0.5 + 0.5 * direction);
        let colors = whole.pixels().iter().map(Vec3::to_array).collect();
        assert_eq!(Panorama::new(whole.size(), colors), (whole.clone(), Repaired::default()));
        for (most_rows, size) in [(128, [256, 128]), (64, [128, 64])] {
            let panorama = whole.clone().reduced(most_rows);
            assert_eq!(panorama.size(), size);
            for direction in
                [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, Vec3::new(0.3, 0.4, -0.866)]
            {
                let found = panorama.light_from(direction.normalize());
                assert!(found.distance(0.5 + 0.5 * direction.normalize()) < 0.03, "{direction}: {found}");
            }
        }
    }

    /// A sun near the zenith, where pixels of two rows differ most.
    #[test]
    fn lights_fill_the_sphere_and_a_smaller_copy_has_as_much_light() {
        let sun = Vec3::new(0.05, 1.0, 0.02).normalize();
        let whole = Panorama::from_radiance([512, 256], |direction| Vec3::splat((direction.dot(sun) > 0.9995).into()));
        let sphere: f32 = whole.lights().map(|(_, solid_angle, _)| solid_angle).sum();
        assert!((sphere / (4.0 * PI) - 1.0).abs() < 1e-3, "{sphere}");
        let all = |panorama: &Panorama| panorama.lights().map(|(_, angle, light)| angle * light.x).sum::<f32>();
        let [of_whole, of_reduced] = [all(&whole), all(&whole.clone().reduced(64))];
        assert!(of_whole > 0.0 && (of_reduced / of_whole - 1.0).abs() < 1e-3, "{of_reduced} {of_whole}");
    }

    #[test]
    fn what_is_no_light_is_replaced_and_counted() {
        let (panorama, repaired) =
            Panorama::new([2, 1], vec![[f32::NAN, -1.0, f32::INFINITY], [1e6, f32::NEG_INFINITY, 0.5]]);
        assert_eq!(panorama.pixels(), [Vec3::new(0.0, 0.0, MOST_LIGHT), Vec3::new(1e6, 0.0, 0.5)]);
        assert_eq!(repaired, Repaired { not_numbers: 1, negative: 2, infinite: 1 });
    }

    #[test]
    fn missing_pixels_are_black_and_a_reduction_ends() {
        assert_eq!(Panorama::new([0, 0], Vec::new()).0.light_from(Vec3::Y), Vec3::ZERO);
        for size in [[1, 1000], [1000, 1], [333, 7]] {
            let reduced = Panorama::new(size, Vec::new()).0.reduced(4).size();
            assert!(reduced[0] <= 8 && reduced[1] <= 4 && reduced.iter().all(|length| *length > 0), "{reduced:?}");
        }
    }
}
