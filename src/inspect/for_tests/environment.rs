//! The light from all around: functions of `shaders/environment.wgsl`, which explains them.

use glam::{Vec3, Vec4};
use gpu::{Gpu, GpuError};

use super::reflectance::{LookAt, dominant_direction, stretched_alphas};
use crate::render::blur_levels::ENVIRONMENT_LEVELS;
use crate::render::cube_map::CubeMap;
use crate::render::dfg::{DFG_SIZE, dfg_table};
use crate::render::environment::{ENVIRONMENT_SIZE, Environment};
use crate::render::irradiance::{Irradiance, terms};

impl Environment {
    /// The same light (linear RGB) from all sides, under which a white surface that absorbs nothing can't be seen.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn uniform(gpu: &Gpu, light: [f32; 3]) -> Result<Self, GpuError> {
        Self::new(gpu, &CubeMap::new(ENVIRONMENT_SIZE, |_| light.into()))
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

/// Twin of `environment_irradiance`, of a light that isn't turned.
pub fn irradiance_of(coefficients: &Irradiance, normal: Vec3) -> Vec3 {
    let sum: Vec3 = coefficients.iter().zip(terms(normal)).map(|(&color, term)| color * term).sum();
    sum.max(Vec3::ZERO)
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

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;
    use crate::render::irradiance::irradiance;

    /// The integral over all texels.
    fn integrated(map: &CubeMap, normal: Vec3) -> Vec3 {
        map.lights().map(|(direction, angle, light)| light * (direction.dot(normal).max(0.0) * angle / PI)).sum()
    }

    #[test]
    fn an_even_light_gives_itself() {
        let map = CubeMap::new(32, |_| Vec3::new(1.0, 0.5, 0.25));
        let coefficients = irradiance(&map);
        for (normal, ..) in CubeMap::new(2, |_| Vec3::ZERO).lights() {
            assert!(irradiance_of(&coefficients, normal).distance(Vec3::new(1.0, 0.5, 0.25)) < 1e-3);
        }
    }

    /// Harmonics of degree 2 and less are exact, but for the texels.
    #[test]
    fn smooth_lights_give_their_integral() {
        let map =
            CubeMap::new(32, |d| Vec3::new(1.0 + 0.5 * d.y, 1.0 + d.x * d.z, 1.0 + 0.4 * d.x * d.x - 0.3 * d.z * d.y));
        let coefficients = irradiance(&map);
        for (normal, ..) in CubeMap::new(4, |_| Vec3::ZERO).lights() {
            let (found, exact) = (irradiance_of(&coefficients, normal), integrated(&map, normal));
            assert!(found.distance(exact) < 3e-3, "{normal}: {found} {exact}");
        }
    }
}
