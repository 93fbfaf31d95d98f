//! Panoramas: pictures of all directions, longitude across and latitude down.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

/// A panorama in linear RGB.
pub(super) struct Panorama {
    width: usize,
    height: usize,
    pixels: Vec<Vec3>,
}

impl Panorama {
    /// Takes `size` (width and height) pixels, row by row from the top, and halves them until at most `most_rows` are left. What
    /// isn't a number, or is negative, counts as black, and so do pixels that are missing.
    pub(super) fn new(size: [u32; 2], pixels: &[[f32; 3]], most_rows: usize) -> Self {
        let [width, height] = size.map(|length| length.max(1) as usize);
        let sound = |value: f32| if value.is_finite() { value.clamp(0.0, 65504.0) } else { 0.0 };
        let mut pixels: Vec<Vec3> = pixels.iter().take(width * height).map(|rgb| rgb.map(sound).into()).collect();
        pixels.resize(width * height, Vec3::ZERO);
        let mut panorama = Self { width, height, pixels };
        while panorama.height > most_rows && panorama.width > 1 {
            panorama = panorama.halved();
        }
        panorama
    }

    /// The means of 2 x 2 pixels. An odd last row or column counts twice.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mean = |x: usize, y: usize| {
            let sum: Vec3 = [(0, 0), (1, 0), (0, 1), (1, 1)]
                .map(|(right, down)| self.pixel(2 * x + right, 2 * y + down))
                .iter()
                .sum();
            sum / 4.0
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
        Self { width, height, pixels }
    }

    fn pixel(&self, x: usize, y: usize) -> Vec3 {
        self.pixels[y.min(self.height - 1) * self.width + x.min(self.width - 1)]
    }

    /// The light from a unit direction. The panorama's middle is at -Z, +X is to the right of it, and +Y is at the top.
    pub(super) fn light_from(&self, direction: Vec3) -> Vec3 {
        let across = (0.5 + direction.x.atan2(-direction.z) / TAU) * self.width as f32 - 0.5;
        let down = direction.y.clamp(-1.0, 1.0).acos() / PI * self.height as f32 - 0.5;
        let (left, top) = (across.floor(), down.floor());
        let column = |index: f32| (index as i64).rem_euclid(self.width as i64) as usize;
        let row = |index: f32| index.max(0.0) as usize;
        let blend = |y| self.pixel(column(left), y).lerp(self.pixel(column(left + 1.0), y), across - left);
        blend(row(top)).lerp(blend(row(top + 1.0)), down - top)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each pixel has its direction as a colour.
    fn directions(size: [u32; 2]) -> Vec<[f32; 3]> {
        let [width, height] = size;
        let color = |index: u32| {
            let (longitude, latitude) = (
                ((index % width) as f32 + 0.5) / width as f32 * TAU - PI,
                (0.5 - ((index / width) as f32 + 0.5) / height as f32) * PI,
            );
            let direction =
                Vec3::new(longitude.sin() * latitude.cos(), latitude.sin(), -longitude.cos() * latitude.cos());
            (0.5 + 0.5 * direction).to_array()
        };
        (0..width * height).map(color).collect()
    }

    #[test]
    fn a_direction_finds_its_pixel_also_in_a_smaller_copy() {
        let pixels = directions([256, 128]);
        for most_rows in [128, 64] {
            let panorama = Panorama::new([256, 128], &pixels, most_rows);
            for direction in
                [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, Vec3::new(0.3, 0.4, -0.866)]
            {
                let found = panorama.light_from(direction.normalize());
                assert!(found.distance(0.5 + 0.5 * direction.normalize()) < 0.03, "{direction}: {found}");
            }
        }
    }

    #[test]
    fn broken_panoramas_are_black_where_they_are_broken() {
        let panorama = Panorama::new([2, 1], &[[f32::NAN, -1.0, f32::INFINITY]], 16);
        assert_eq!(panorama.light_from(Vec3::X), Vec3::ZERO);
        assert_eq!(Panorama::new([0, 0], &[], 16).light_from(Vec3::Y), Vec3::ZERO);
    }
}
