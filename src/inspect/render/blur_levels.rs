//! The levels of an environment's cube map, each blurred as a surface of one roughness reflects it.

use glam::{Vec3, Vec4, vec2};

use super::cube_map::{CubeMap, face_place, texels};
use super::prefilter::{cube_direction, directions_across, hammersley, light_and_density, sample_level};

/// Levels of an environment's cube map; `ENVIRONMENT_LEVELS` in `shaders/environment.wgsl`.
pub const ENVIRONMENT_LEVELS: u32 = 6;

/// Directions that a texel is blurred from.
pub(crate) const SAMPLE_COUNT: u32 = 256;

/// The roughness that a level is blurred by, the inverse of `level_of_roughness` in `shaders/environment.wgsl`.
pub fn roughness_of_level(level: u32) -> f32 {
    (level as f32 / (ENVIRONMENT_LEVELS - 1) as f32).powf(1.5)
}

/// Twin of `level_of_roughness` in `shaders/environment.wgsl`.
pub fn level_of_roughness(roughness: f32) -> f32 {
    (ENVIRONMENT_LEVELS - 1) as f32 * roughness.powf(2.0 / 3.0)
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
