//! Tests the light on the CPU: lobes against integrals, and the split sum against what it stands for.

mod furnace;
mod irradiance;
mod lobes;
mod sheen;
mod split_sum;

use glam::{Vec2, Vec3, vec2, vec3};

use super::prefilter::hammersley;
use crate::for_tests::environment::environment_dfg;
use crate::for_tests::prefiltered::directions_across;
use crate::for_tests::reflectance::AmbientLight;

/// The cosines 0.05 to 1 at which eyes look, and the roughnesses 0 to 1.
fn cosines() -> impl Iterator<Item = f32> {
    (1..=20).map(|step| step as f32 / 20.0)
}

fn roughnesses() -> impl Iterator<Item = f32> {
    (0..=10).map(|step| step as f32 / 10.0)
}

/// The direction towards an eye at that cosine from the normal +Z.
fn eye_at(cosine: f32) -> Vec3 {
    vec3((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine)
}

fn dfg(facing: f32, roughness: f32) -> Vec2 {
    environment_dfg(facing, roughness).into()
}

/// The light of a room that is 1 on all sides.
fn white_light(facing: f32, roughness: f32, coat_roughness: f32) -> AmbientLight {
    AmbientLight {
        diffuse: Vec3::ONE,
        reflected: Vec3::ONE,
        coat_reflected: Vec3::ONE,
        sheen: Vec3::ONE,
        dfg: dfg(facing, roughness),
        coat_dfg: dfg(facing, coat_roughness),
        facing,
        coat_facing: facing,
    }
}

/// Normals of microfacets of a GGX surface about `normal`, by their density times their cosine.
fn facets(normal: Vec3, alpha: f32, count: u32) -> impl Iterator<Item = Vec3> {
    let across = directions_across(normal);
    (0..count).map(move |index| {
        let point = hammersley(index, count) + vec2(0.5 / count as f32, 0.0);
        let cosine = ((1.0 - point.x) / (1.0 + (alpha * alpha - 1.0) * point.x)).sqrt();
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (y, x) = (std::f32::consts::TAU * point.y).sin_cos();
        across[0] * (sine * x) + across[1] * (sine * y) + normal * cosine
    })
}
