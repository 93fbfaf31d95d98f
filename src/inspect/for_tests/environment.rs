//! The light from all around: functions of `shaders/environment.wgsl`, which explains them.

use glam::{Vec3, Vec4};
use gpu::{Gpu, GpuError};

use super::reflectance::{LookAt, dominant_direction, stretched_alphas};
use crate::render::blur_levels::ENVIRONMENT_LEVELS;
use crate::render::cube_map::CubeMap;
use crate::render::dfg::{DFG_SIZE, dfg_table};
use crate::render::environment::{ENVIRONMENT_SIZE, Environment};
use crate::render::irradiance::light_parts;

impl Environment {
    /// The same light (linear RGB) from all sides, under which a white surface that absorbs nothing can't be seen.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn uniform(gpu: &Gpu, light: [f32; 3]) -> Result<Self, GpuError> {
        let light = CubeMap::new(ENVIRONMENT_SIZE, |_| light.into());
        Self::new(gpu, &light, &light_parts(light.lights()))
    }
}

pub fn level_of_roughness(roughness: f32) -> f32 {
    (ENVIRONMENT_LEVELS - 1) as f32 * roughness.powf(2.0 / 3.0)
}

/// Twin of `long_reflection`: `radiance` is the light from a direction, blurred as a roughness says.
pub fn long_reflection(look: &LookAt, normal: Vec3, to_eye: Vec3, radiance: impl Fn(Vec3, f32) -> Vec3) -> Vec3 {
    const LEANS: u32 = 16;
    let squares = stretched_alphas(look) * stretched_alphas(look);
    let more = (squares.x - squares.y).max(0.0);
    let roughness = (squares.y + more / (LEANS * LEANS) as f32).sqrt().sqrt();
    let mut sum = Vec4::ZERO;
    for index in 0..LEANS {
        let sine = (2 * index + 1) as f32 / LEANS as f32 - 1.0;
        let slope = more.sqrt() * sine / (1.0 - sine * sine).sqrt();
        let direction = dominant_direction((normal - slope * look.direction).normalize(), to_eye, roughness);
        sum += normal.dot(direction).max(1e-4) * radiance(direction, roughness).extend(1.0);
    }
    sum.truncate() / sum.w
}

pub fn environment_dfg(facing: f32, roughness: f32) -> [f32; 2] {
    let [first, second, ..] = dfg_texel(facing, roughness);
    [first, second]
}

fn dfg_texel(facing: f32, roughness: f32) -> [f32; 4] {
    let table = dfg_table();
    let last = DFG_SIZE as usize - 1;
    let split = |part: f32| {
        let at = part.clamp(0.0, 1.0) * last as f32;
        let low = (at as usize).min(last - 1);
        (low, at - low as f32)
    };
    let ((x, right), (y, down)) = (split(facing), split(roughness));
    std::array::from_fn(|factor| {
        let entry = |x: usize, y: usize| table[y * (last + 1) + x][factor];
        let row = |y: usize| entry(x, y) * (1.0 - right) + entry(x + 1, y) * right;
        row(y) * (1.0 - down) + row(y + 1) * down
    })
}

pub fn environment_sheen(facing: f32, roughness: f32) -> f32 {
    dfg_texel(facing, roughness)[2]
}
