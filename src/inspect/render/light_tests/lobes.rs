//! Lobes of light from a single direction, held against integrals.

use std::f32::consts::PI;

use glam::{DVec3, Vec2, Vec3, vec2, vec3};

use super::{cosines, dfg, eye_at, facets, roughnesses, white_light};
use crate::for_tests::reflectance::{
    LookAt, albedo_at_once, direct_lobe, direct_reflection, fifth_power, ggx_distribution, mean_roughness,
    reflect_ambient, stretched_alphas,
};
use crate::render::prefilter::hammersley;

/// An integral over all directions above the surface, from microfacets: what the lobe gives, and Schlick's part of it. With an
/// estimate of its error.
fn lobe_integral(to_eye: Vec3, roughness: f32) -> ([f32; 2], f32) {
    const COUNT: u32 = 4096;
    let alpha = roughness * roughness;
    let alphas = Vec2::splat(alpha);
    let (mut sums, mut squares) = ([0.0_f64; 2], 0.0_f64);
    for half_way in facets(Vec3::Z, alpha, COUNT) {
        let across = to_eye.dot(half_way);
        let to_light = 2.0 * across * half_way - to_eye;
        if across <= 0.0 || to_light.z <= 0.0 {
            continue;
        }
        let density = ggx_distribution(Vec3::Z, half_way, alphas, Vec3::ZERO) * half_way.z / (4.0 * across);
        let value = f64::from(direct_lobe(Vec3::Z, to_eye, to_light, half_way, alphas, Vec3::ZERO) / density);
        sums[0] += value;
        sums[1] += value * f64::from(fifth_power(1.0 - across));
        squares += value * value;
    }
    let count = f64::from(COUNT);
    let variance = (squares / count - (sums[0] / count).powi(2)).max(0.0);
    (sums.map(|sum| (sum / count) as f32), (variance / count).sqrt() as f32)
}

/// The table comes from microfacets that the eye sees and the integral from all microfacets, so only the lobe is common.
#[test]
fn the_table_holds_the_integral_of_the_lobe() {
    for cosine in cosines() {
        for roughness in roughnesses().filter(|&roughness| roughness > 0.05) {
            let ([all, schlick], error) = lobe_integral(eye_at(cosine), roughness);
            let table = dfg(cosine, roughness);
            let off = (table.x + table.y - all).abs().max((table.y - schlick).abs());
            assert!(off < 2.0 * error + 0.004, "{cosine} {roughness}: {table} {all} {schlick} {error}");
        }
    }
}

/// A closed form: the roughest surface seen head-on reflects 1 - ln 2.
#[test]
fn the_roughest_surface_reflects_what_its_closed_form_says() {
    let table = dfg(1.0, 1.0);
    assert!((table.x + table.y - (1.0 - 2.0_f32.ln())).abs() < 1e-3, "{table}");
}

#[test]
fn a_mirror_reflects_all() {
    for cosine in cosines() {
        let (table, schlick) = (dfg(cosine, 0.0), fifth_power(1.0 - cosine));
        assert!((table.x + table.y - 1.0).abs() < 1e-3, "{cosine}: {table}");
        assert!((table.y - schlick).abs() < 0.01, "{cosine}: {table} {schlick}");
    }
}

/// Microfacets cover the surface (Walter et al. 2007, equation 4).
#[test]
fn microfacets_seen_from_above_have_the_area_of_the_surface() {
    const COUNT: u32 = 65_536;
    for roughness in [0.3, 0.5, 0.8, 1.0] {
        let sum: f64 = hemisphere(COUNT)
            .map(|facet| {
                f64::from(ggx_distribution(Vec3::Z, facet, Vec2::splat(roughness * roughness), Vec3::ZERO) * facet.z)
            })
            .sum();
        let area = sum * 2.0 * std::f64::consts::PI / f64::from(COUNT);
        assert!((area - 1.0).abs() < 0.01, "{roughness}: {area}");
    }
}

/// Directions that are spread evenly over the half above the surface.
pub(super) fn hemisphere(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |index| {
        let point = hammersley(index, count);
        let height = point.x + 0.5 / count as f32;
        let ((y, x), radius) = ((2.0 * PI * point.y).sin_cos(), (1.0 - height * height).sqrt());
        vec3(radius * x, radius * y, height)
    })
}

/// Light from all directions at once, one by one.
fn reflected_of_all(look: &LookAt, to_eye: Vec3) -> Vec3 {
    const COUNT: u32 = 16_384;
    let sum: Vec3 = hemisphere(COUNT).map(|to_light| direct_reflection(look, Vec3::Z, to_eye, to_light)).sum();
    sum * (2.0 * PI / COUNT as f32)
}

/// Light from single directions lacks what meets several microfacets.
#[test]
fn light_from_all_directions_one_by_one_is_what_metal_reflects_at_once() {
    for cosine in [0.2, 0.5, 0.8, 1.0] {
        for roughness in [0.4, 0.6, 1.0] {
            let look = LookAt { base_color: vec3(0.8, 0.4, 0.1), metallic: 1.0, roughness, ..LookAt::default() };
            let ambient = albedo_at_once(look.base_color, 1.0, dfg(cosine, roughness));
            let summed = reflected_of_all(&look, eye_at(cosine));
            assert!(ambient.distance(summed) < 0.006, "{cosine} {roughness}: {ambient} {summed}");
        }
    }
}

/// Light that gets into plastic is what all microfacets together leave, and with light from a single direction, what those leave
/// that mirror it. Unless it is seen from the side, both are about the same.
#[test]
fn light_from_all_directions_one_by_one_is_nearly_what_plastic_reflects() {
    for cosine in [0.5, 0.8, 1.0] {
        for roughness in [0.3, 0.5] {
            for coat in [0.0, 1.0] {
                let base_color = vec3(0.8, 0.4, 0.1);
                let look = LookAt { base_color, roughness, coat, coat_roughness: 0.4, ..LookAt::default() };
                let ambient = reflect_ambient(&look, &white_light(cosine, roughness, 0.4));
                let summed = reflected_of_all(&look, eye_at(cosine));
                assert!(ambient.distance(summed) < 0.06, "{cosine} {look:?}: {ambient} {summed}");
            }
        }
    }
}

/// White metal with highlights that are longer along x.
fn brushed(roughness: f32, anisotropy: f32) -> LookAt {
    LookAt { metallic: 1.0, roughness, anisotropy, direction: Vec3::X, ..LookAt::default() }
}

#[test]
fn microfacets_of_long_highlights_have_the_area_of_the_surface() {
    const COUNT: u32 = 65_536;
    for alphas in [vec2(1.0, 0.3), vec2(0.6, 0.2), vec2(0.5, 0.5)] {
        let facets = hemisphere(COUNT).map(|facet| ggx_distribution(Vec3::Z, facet, alphas, Vec3::X) * facet.z);
        let area = facets.map(f64::from).sum::<f64>() * 2.0 * std::f64::consts::PI / f64::from(COUNT);
        assert!((area - 1.0).abs() < 0.01, "{alphas}: {area}");
    }
}

/// The formulas of KHR_materials_anisotropy, section "Implementation", in f64.
fn told_lobe(alphas: Vec2, to_eye: DVec3, to_light: DVec3) -> f64 {
    let (at, ab) = (f64::from(alphas.x), f64::from(alphas.y));
    let half_way = (to_eye + to_light).normalize();
    let product = at * ab;
    let f = DVec3::new(ab * half_way.x, at * half_way.y, product * half_way.z);
    let w = product / f.dot(f);
    let distribution = product * w * w / std::f64::consts::PI;
    let scaled = |v: DVec3| DVec3::new(at * v.x, ab * v.y, v.z).length();
    let visibility = 0.5 / (to_light.z * scaled(to_eye) + to_eye.z * scaled(to_light));
    distribution * visibility * to_light.z
}

#[test]
fn long_highlights_are_what_their_specification_says() {
    for (roughness, anisotropy) in [(0.3, 0.5), (0.5, 1.0), (0.8, 0.3), (0.6, 0.0)] {
        let alphas = stretched_alphas(&brushed(roughness, anisotropy));
        for (to_eye, to_light) in [
            (vec3(0.3, 0.2, 0.8), vec3(-0.5, 0.1, 0.6)),
            (vec3(0.7, -0.1, 0.3), vec3(0.2, 0.6, 0.5)),
            (vec3(0.0, 0.0, 1.0), vec3(0.9, 0.0, 0.2)),
        ] {
            let (to_eye, to_light) = (to_eye.normalize(), to_light.normalize());
            let half_way = (to_eye + to_light).normalize();
            let found = f64::from(direct_lobe(Vec3::Z, to_eye, to_light, half_way, alphas, Vec3::X));
            let told = told_lobe(alphas, to_eye.as_dvec3(), to_light.as_dvec3());
            assert!((found - told).abs() < 1e-4 * told, "{alphas} {to_eye} {to_light}: {found} {told}");
        }
    }
}

/// Long highlights reflect about as much as round ones of the mean roughness, and never more than all light.
#[test]
fn long_highlights_reflect_about_what_the_table_says_and_no_more_than_they_get() {
    for (roughness, anisotropy) in [(0.4, 0.6), (0.4, 1.0), (0.6, 0.8)] {
        let look = brushed(roughness, anisotropy);
        for cosine in [0.4, 0.7, 1.0] {
            let along = eye_at(cosine);
            for to_eye in [along, vec3(0.0, along.x, along.z)] {
                let summed = reflected_of_all(&look, to_eye).x;
                let table = dfg(cosine, mean_roughness(&look));
                let table = table.x + table.y;
                assert!(summed < 1.005 && (summed - table).abs() < 0.12, "{look:?} {to_eye}: {summed} {table}");
            }
        }
    }
}

#[test]
fn highlights_of_strength_0_are_round() {
    let (eye, light) = (eye_at(0.7), vec3(-0.3, 0.8, 0.4).normalize());
    let seen = |direction| {
        let look = LookAt { direction, coat: 0.5, coat_roughness: 0.3, metallic: 0.5, ..brushed(0.4, 0.0) };
        direct_reflection(&look, Vec3::Z, eye, light)
    };
    assert!([Vec3::X, Vec3::Y, Vec3::ZERO].into_iter().all(|direction| seen(direction) == seen(Vec3::X)));
    assert_eq!(mean_roughness(&brushed(0.37, 0.0)), 0.37);
}

/// Light that runs backwards is reflected alike, but for the coat, whose Fresnel term the extension takes from the eye.
#[test]
fn reflection_is_the_same_in_both_directions() {
    for anisotropy in [0.0, 0.7] {
        let look = LookAt { base_color: vec3(0.9, 0.5, 0.2), metallic: 0.4, ..brushed(0.3, anisotropy) };
        for (eye, light) in [(0.9, 0.3), (0.2, 0.7), (0.5, 0.5)] {
            let (eye, light) = (eye_at(eye), Vec3::new(-0.3, 0.8, light).normalize());
            let there = direct_reflection(&look, Vec3::Z, eye, light) / light.z;
            let back = direct_reflection(&look, Vec3::Z, light, eye) / eye.z;
            assert!(there.distance(back) < 1e-4 * there.length(), "{there} {back}");
        }
    }
}

#[test]
fn light_from_behind_and_eyes_behind_see_nothing() {
    let look = LookAt::default();
    let (above, below) = (vec3(0.0, 0.6, 0.8), vec3(0.0, 0.6, -0.8));
    assert_eq!(direct_reflection(&look, Vec3::Z, above, below), Vec3::ZERO);
    assert_eq!(direct_reflection(&look, Vec3::Z, below, above), Vec3::ZERO);
}
