//! An environment's cube map as the pass blurs it, and as samplers read it.

use glam::{Vec2, Vec3, Vec4, vec2};

use crate::render::blur_levels::{ENVIRONMENT_LEVELS, SAMPLE_COUNT, roughness_of_level};
use crate::render::cube_map::{CubeMap, face_place, texels};
use crate::render::prefilter::{cube_direction, directions_across, hammersley, light_and_density, sample_level};

/// Twin of `blurred` in `shaders/pass_prefilter.wgsl`: what a level of that roughness has in a direction.
pub fn blurred(source: &CubeMap, normal: Vec3, roughness: f32) -> Vec3 {
    if roughness == 0.0 {
        return source.sample(normal, 0.0);
    }
    let across = directions_across(normal);
    let mut sum = Vec4::ZERO;
    for index in 0..SAMPLE_COUNT {
        let light = light_and_density(hammersley(index, SAMPLE_COUNT), roughness * roughness);
        if light.z > 0.0 {
            let direction = across[0] * light.x + across[1] * light.y + normal * light.z;
            let level = sample_level(light.w, SAMPLE_COUNT, source.size as f32);
            sum += light.z * source.sample(direction, level).extend(1.0);
        }
    }
    sum.truncate() / sum.w
}

/// All levels as the pass makes them from a source of the same size.
pub fn prefiltered(source: &CubeMap) -> CubeMap {
    let levels = (0..ENVIRONMENT_LEVELS).map(|level| {
        let size = source.size >> level;
        let roughness = roughness_of_level(level);
        let texel = |(face, x, y)| {
            let at = face_place(vec2(x as f32, y as f32) + 0.5, size);
            blurred(source, cube_direction(face, at).normalize(), roughness)
        };
        texels(size).map(texel).collect()
    });
    CubeMap { size: source.size, levels: levels.collect() }
}

impl CubeMap {
    /// What a sampler gives that blends texels and levels, also across the borders of faces.
    pub fn sample(&self, direction: Vec3, level: f32) -> Vec3 {
        let level = level.clamp(0.0, self.levels.len() as f32 - 1.0);
        let below = level.floor();
        let near = self.sample_level(direction, below as usize);
        if level == below { near } else { near.lerp(self.sample_level(direction, below as usize + 1), level - below) }
    }

    fn sample_level(&self, direction: Vec3, level: usize) -> Vec3 {
        let size = self.size >> level;
        let (face, at) = face_of(direction);
        let texel = (at + 1.0) * (size as f32 / 2.0) - 0.5;
        let (low, part) = (texel.floor(), texel - texel.floor());
        let corner = |x: f32, y: f32| self.texel(face, low + vec2(x, y), level);
        let upper = corner(0.0, 0.0).lerp(corner(1.0, 0.0), part.x);
        upper.lerp(corner(0.0, 1.0).lerp(corner(1.0, 1.0), part.x), part.y)
    }

    /// A texel of a face, or the one beside it on the next face if it lies beyond the border.
    fn texel(&self, face: u32, at: Vec2, level: usize) -> Vec3 {
        let size = self.size >> level;
        let place = face_place(at + 0.5, size);
        let (face, place) = face_of(cube_direction(face, place));
        let texel = ((place + 1.0) * (size as f32 / 2.0)).floor().clamp(Vec2::ZERO, Vec2::splat(size as f32 - 1.0));
        self.levels[level][((face * size + texel.y as u32) * size + texel.x as u32) as usize]
    }
}

/// The face that a direction meets, and the place on it, the inverse of [`cube_direction`].
fn face_of(direction: Vec3) -> (u32, Vec2) {
    let Vec3 { x, y, z } = direction;
    let size = direction.abs();
    if size.x >= size.y && size.x >= size.z {
        (u32::from(x < 0.0), vec2(-z * x.signum(), -y) / size.x)
    } else if size.y >= size.z {
        (2 + u32::from(y < 0.0), vec2(x, z * y.signum()) / size.y)
    } else {
        (4 + u32::from(z < 0.0), vec2(x * z.signum(), -y) / size.z)
    }
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;

    #[test]
    fn a_direction_meets_the_place_that_it_was_made_for() {
        for (face, x, y) in texels(8) {
            let at = face_place(vec2(x as f32 + 0.3, y as f32 + 0.6), 8);
            let (met, place) = face_of(cube_direction(face, at));
            assert_eq!(met, face);
            assert!(place.distance(at) < 1e-6);
        }
    }

    #[test]
    fn samples_follow_what_the_map_was_made_of_and_join_at_borders() {
        let radiance = |direction: Vec3| 0.5 + 0.5 * direction;
        let map = CubeMap::new(64, radiance);
        assert_eq!(map.levels.len(), 7);
        for direction in [vec3(0.3, 0.9, 0.1), vec3(1.0, 0.999, 0.0), vec3(-1.0, 0.2, -1.001), vec3(0.1, -0.2, 0.9)] {
            let direction = direction.normalize();
            assert!(map.sample(direction, 0.0).distance(radiance(direction)) < 0.005, "{direction}");
            let nearby = map.sample((direction + vec3(0.0, 2e-3, 1e-3)).normalize(), 1.0);
            assert!(map.sample(direction, 1.0).distance(nearby) < 0.01, "{direction}");
        }
        assert!(map.sample(Vec3::X, 6.0).distance(vec3(0.9, 0.5, 0.5)) < 0.1);
    }
}
