//! An environment's cubes as the passes make them, and as samplers read them; and functions of `shaders/prefilter.wgsl`.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, Vec4, vec2, vec3, vec4};

use crate::render::blur_levels::{ENVIRONMENT_LEVELS, IRRADIANCE_LEVEL, SAMPLE_COUNT, roughness_of_level};
use crate::render::cube_map::{CubeMap, face_place, texels};
use crate::render::irradiance::LightPart;
use crate::render::prefilter::{cube_direction, hammersley};

/// Two directions that are orthogonal to a unit vector and to each other (Duff et al. 2017, listing 3).
pub fn directions_across(normal: Vec3) -> [Vec3; 2] {
    let side = if normal.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    [
        vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
        vec3(b, side + normal.y * normal.y * a, -normal.y),
    ]
}

/// A light's direction seen along the normal (z) of a GGX surface, by way of its microfacets (Walter et al. 2007, equations 35
/// and 36), and the square root of its density times 4 (w).
pub fn light_and_density(point: Vec2, alpha: f32) -> Vec4 {
    let square = alpha * alpha;
    let cosine_squared = (1.0 - point.x) / (1.0 + (square - 1.0) * point.x);
    let sine_squared = square * point.x / (1.0 + (square - 1.0) * point.x);
    let angle = 2.0 * PI * point.y;
    let along = 2.0 * (cosine_squared * sine_squared).sqrt();
    let spread = cosine_squared * square + sine_squared;
    vec4(along * angle.cos(), along * angle.sin(), cosine_squared - sine_squared, alpha / (PI.sqrt() * spread))
}

/// The level of the source whose texels are as large as a sample of that density, times 2 (Krivanek and Colbert 2008, section
/// 3). `size` is the size of a face, in texels.
pub fn sample_level(root_density: f32, count: u32, size: f32) -> f32 {
    let texels = (24.0 / PI).sqrt() * size / (root_density * (count as f32).sqrt());
    texels.log2().max(0.0)
}

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

/// Twin of `gathered` in `shaders/pass_prefilter.wgsl`: irradiance divided by pi.
pub fn gathered(parts: &[LightPart], normal: Vec3) -> Vec3 {
    let sum: Vec4 = parts.iter().map(|part| normal.extend(0.0).dot(part.direction).max(0.0) * part.light).sum();
    sum.truncate().min(Vec3::splat(65504.0))
}

/// The level of irradiance as the pass makes it beside a cube of this size.
pub fn irradiance_map(parts: &[LightPart], size: u32) -> CubeMap {
    let size = size >> IRRADIANCE_LEVEL;
    let texel = |(face, x, y)| {
        let at = face_place(vec2(x as f32, y as f32) + 0.5, size);
        gathered(parts, cube_direction(face, at).normalize())
    };
    CubeMap { size, levels: vec![texels(size).map(texel).collect()] }
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
