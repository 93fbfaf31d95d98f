//! How much of an even light microfacets reflect at once: the second factor of the split sum (Karis 2013). And how much of it a white
//! sheen reflects.

use std::f32::consts::TAU;
use std::sync::OnceLock;

use glam::{Vec3, vec3};

use super::prefilter::hammersley;
use super::sheen::{LEAST_SHEEN_ALPHA, charlie_distribution, charlie_lambda};

/// Width and height of the table; `DFG_SIZE` in `shaders/environment.wgsl`.
pub(crate) const DFG_SIZE: u32 = 64;

/// Microfacets that an entry is computed from. With four times as many, no entry changes by more than 0.002.
const SAMPLES: u32 = 128;

/// Directions that the sheen of an entry is computed from: cosines, and angles about the normal on one side. With more, no entry of up
/// to 1 changes by more than 0.002.
const SHEEN_SAMPLES: [u32; 2] = [16, 12];

/// The table, computed when it is first needed: [`albedo_factors`], the [albedo of sheen](sheen_albedo) and 0, by the cosine, then by
/// the roughness. The first and the last entry are for 0 and 1.
pub(crate) fn dfg_table() -> &'static [[f32; 4]] {
    static TABLE: OnceLock<Vec<[f32; 4]>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let part = |index: u32| index as f32 / (DFG_SIZE - 1) as f32;
        let row = |roughness| {
            // Smith's lambda of each light.
            let lambda = |root: f32| charlie_lambda(root * root, sheen_alpha(part(roughness)));
            let lambdas: Vec<f32> = sheen_roots().map(lambda).collect();
            (0..DFG_SIZE).map(move |cosine| {
                let [first, second] = albedo_factors(part(cosine), part(roughness), SAMPLES);
                [first, second, sheen_albedo(part(cosine), part(roughness), &lambdas), 0.0]
            })
        };
        (0..DFG_SIZE).flat_map(row).collect()
    })
}

/// The square roots of the cosines of lights that a sheen's albedo is computed from. They lie closer together along the surface, where
/// smooth sheen reflects.
fn sheen_roots() -> impl Iterator<Item = f32> {
    (0..SHEEN_SAMPLES[0]).map(|index| (index as f32 + 0.5) / SHEEN_SAMPLES[0] as f32)
}

fn sheen_alpha(roughness: f32) -> f32 {
    (roughness * roughness).max(LEAST_SHEEN_ALPHA)
}

/// The part of an even light that a white sheen reflects towards an eye at that cosine from the normal. It may exceed 1.
fn sheen_albedo(cosine: f32, roughness: f32, lambdas: &[f32]) -> f32 {
    let (alpha, cosine) = (sheen_alpha(roughness), cosine.max(1e-4));
    let (across, eye_lambda) = ((1.0 - cosine * cosine).max(0.0).sqrt(), charlie_lambda(cosine, alpha));
    let mut sum = 0.0;
    for (root, lambda) in sheen_roots().zip(lambdas) {
        let (light, weight) = (root * root, 2.0 * root);
        let radius = (1.0 - light * light).sqrt();
        for index in 0..SHEEN_SAMPLES[1] {
            let angle = std::f32::consts::PI * (index as f32 + 0.5) / SHEEN_SAMPLES[1] as f32;
            let (y, x) = angle.sin_cos();
            let half_way = vec3(across + radius * x, radius * y, cosine + light).normalize();
            let sine = half_way.truncate().length();
            sum += weight * charlie_distribution(sine, alpha) / (4.0 * cosine * (1.0 + eye_lambda + lambda));
        }
    }
    sum * TAU / (SHEEN_SAMPLES[0] * SHEEN_SAMPLES[1]) as f32
}

/// Factors of f0 and f90 in the part of an even light that GGX microfacets reflect at once, towards an eye at that cosine from the
/// normal. The microfacets are those that the eye sees (Heitz 2018).
fn albedo_factors(cosine: f32, roughness: f32, samples: u32) -> [f32; 2] {
    let alpha = roughness * roughness;
    let cosine = cosine.max(1e-4);
    let to_eye = vec3((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let mut factors = [0.0; 2];
    for index in 0..samples {
        let point = hammersley(index, samples);
        let half_way = seen_facet(to_eye, alpha, [point.x + 0.5 / samples as f32, point.y]);
        let to_light = 2.0 * to_eye.dot(half_way) * half_way - to_eye;
        if to_light.z > 0.0 {
            let (eye_hidden, light_hidden) = (hidden(cosine, alpha), hidden(to_light.z, alpha));
            let weight = (1.0 + eye_hidden) / (1.0 + eye_hidden + light_hidden);
            let schlick = (1.0 - to_eye.dot(half_way).clamp(0.0, 1.0)).powi(5);
            factors[0] += (1.0 - schlick) * weight / samples as f32;
            factors[1] += schlick * weight / samples as f32;
        }
    }
    factors
}

/// Smith's lambda: microfacets that a direction doesn't reach, for each that it does (Heitz 2014, equation 72).
fn hidden(cosine: f32, alpha: f32) -> f32 {
    let tangent_squared = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
    0.5 * ((1.0 + alpha * alpha * tangent_squared).sqrt() - 1.0)
}

/// The normal of a microfacet that the eye sees, for a point of the unit square (Heitz 2018, appendix A).
fn seen_facet(to_eye: Vec3, alpha: f32, [first, second]: [f32; 2]) -> Vec3 {
    let stretched = vec3(alpha * to_eye.x, alpha * to_eye.y, to_eye.z).normalize();
    let across = vec3(-stretched.y, stretched.x, 0.0).try_normalize().unwrap_or(Vec3::X);
    let up = stretched.cross(across);
    let (radius, angle) = (first.sqrt(), TAU * second);
    let x = radius * angle.cos();
    let share = 0.5 * (1.0 + stretched.z);
    let y = (1.0 - share) * (1.0 - x * x).max(0.0).sqrt() + share * radius * angle.sin();
    let facet = across * x + up * y + stretched * (1.0 - x * x - y * y).max(0.0).sqrt();
    vec3(alpha * facet.x, alpha * facet.y, facet.z.max(0.0)).try_normalize().unwrap_or(Vec3::Z)
}
