//! Cube maps on the CPU: light by direction, with mip levels.

use glam::{Vec2, Vec3, vec2};

use super::prefilter::cube_direction;

/// Linear RGB for every direction, on six faces, from level to level at half the width.
pub struct CubeMap {
    /// Width of a face of the first level, in texels. It is a power of two.
    pub size: u32,
    /// The texels of each level, face by face in the order of WebGPU, each row by row from the top.
    pub levels: Vec<Vec<Vec3>>,
}

impl CubeMap {
    /// Takes the mean of four directions for each texel of the first level, and the mean of four texels for those of the others.
    pub fn new(size: u32, radiance: impl Fn(Vec3) -> Vec3) -> Self {
        let size = size.next_power_of_two();
        let mean = |face, x: u32, y: u32| {
            let spots = [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)];
            let at = |(right, down)| face_place(vec2(x as f32 + right, y as f32 + down), size);
            spots.map(|spot| radiance(cube_direction(face, at(spot)).normalize())).iter().sum::<Vec3>() / 4.0
        };
        let first: Vec<Vec3> = texels(size).map(|(face, x, y)| mean(face, x, y)).collect();
        let next = |(level, width): &(Vec<Vec3>, usize)| (*width > 1).then(|| (halved(level, *width), width / 2));
        let levels = std::iter::successors(Some((first, size as usize)), next).map(|(level, _)| level).collect();
        Self { size, levels }
    }

    /// The light of the first level's texels: direction, solid angle in sr, and linear RGB.
    pub fn lights(&self) -> impl Iterator<Item = (Vec3, f32, Vec3)> {
        let first = self.levels.first().into_iter().flatten();
        texels(self.size).zip(first).map(|((face, x, y), &light)| {
            let at = face_place(vec2(x as f32, y as f32) + 0.5, self.size);
            let texel = 4.0 / (self.size as f32 * self.size as f32);
            // A texel is smaller the farther it is from the face's middle, and it is seen more and more from the side.
            let solid_angle = texel / (1.0 + at.length_squared()).powf(1.5);
            (cube_direction(face, at).normalize(), solid_angle, light)
        })
    }
}

/// A place on a face, from texels to -1 to 1.
pub(crate) fn face_place(texel: Vec2, size: u32) -> Vec2 {
    texel * (2.0 / size as f32) - 1.0
}

/// Face, column and row of every texel of a level, in the order of [`CubeMap::levels`].
pub fn texels(size: u32) -> impl Iterator<Item = (u32, u32, u32)> {
    (0..6).flat_map(move |face| (0..size).flat_map(move |y| (0..size).map(move |x| (face, x, y))))
}

/// The next level of one whose faces are `width` texels wide.
fn halved(level: &[Vec3], width: usize) -> Vec<Vec3> {
    let half = width / 2;
    let mean = |(face, x, y): (u32, u32, u32)| {
        let first = (face as usize * width + 2 * y as usize) * width + 2 * x as usize;
        (level[first] + level[first + 1] + level[first + width] + level[first + width + 1]) / 4.0
    };
    texels(half as u32).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;

    #[test]
    fn solid_angles_add_up_to_the_sphere() {
        let map = CubeMap::new(32, |_| Vec3::ONE);
        let sum: f32 = map.lights().map(|(_, solid_angle, _)| solid_angle).sum();
        assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-3, "{sum}");
    }
}
