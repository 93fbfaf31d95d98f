//! The levels of an environment's cube map, each blurred as a surface of one roughness reflects it.

/// Levels of an environment's cube map; `ENVIRONMENT_LEVELS` in `shaders/environment.wgsl`.
pub const ENVIRONMENT_LEVELS: u32 = 6;

/// The level of the second cube that has irradiance; the same in `shaders/environment.wgsl`.
pub(crate) const IRRADIANCE_LEVEL: u32 = 1;

/// Directions that a texel is blurred from.
pub(crate) const SAMPLE_COUNT: u32 = 256;

/// The roughness that a level is blurred by, the inverse of `level_of_roughness` in `shaders/environment.wgsl`.
pub fn roughness_of_level(level: u32) -> f32 {
    (level as f32 / (ENVIRONMENT_LEVELS - 1) as f32).powf(1.5)
}
