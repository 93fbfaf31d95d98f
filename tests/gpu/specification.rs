//! Pictures of materials with maps in an even light, against sums over directions of what glTF says: its specification, appendix B, and
//! the extensions KHR_materials_specular, KHR_materials_clearcoat and KHR_materials_pbrSpecularGlossiness. Nothing of the code that
//! draws is used for the sums.

use std::f64::consts::PI;

use geometry::mesh::{Look, MapUv, Slot};
use glam::{DVec3, Vec2, dvec3, vec3};
use gpu::Timing;
use inspect::render::Target;
use inspect::render::layout::{linear, srgb};

use crate::layers::camera_of;
use crate::looks::square_of;
use crate::materials::{SIDE, assert_near, at, evenly_lit, image, look_with, map, material, studio};

/// How bright the light is on all sides.
const LIGHT: f32 = 0.5;
/// The split sum, light that meets several microfacets, and the rounding of two images.
const STEPS: u8 = 4;

/// A material in the words of the specifications.
struct Told {
    base_color: DVec3,
    roughness: f64,
    /// Of a dielectric's reflection head-on, before its strength.
    f0: DVec3,
    specular: f64,
    clearcoat: f64,
    clearcoat_roughness: f64,
}

/// Microfacets of appendix B: their distribution, times visibility.
fn specular_brdf(alpha: f64, to_light: DVec3, to_eye: DVec3) -> f64 {
    let half_way = (to_light + to_eye).normalize();
    let square = alpha * alpha;
    let distribution = square / (PI * (half_way.z * half_way.z * (square - 1.0) + 1.0).powi(2));
    let visibility = |cosine: f64| 1.0 / (cosine + (square + (1.0 - square) * cosine * cosine).sqrt());
    distribution * visibility(to_light.z) * visibility(to_eye.z)
}

fn schlick(f0: DVec3, cosine: f64) -> DVec3 {
    f0 + (1.0 - f0) * (1.0 - cosine).powi(5)
}

/// What a flat surface, whose normal is +z, reflects of light that comes from one side.
fn brdf(told: &Told, to_light: DVec3, to_eye: DVec3) -> DVec3 {
    let across = (to_light + to_eye).normalize().dot(to_eye);
    let fresnel = told.specular * schlick(told.f0, across);
    let layer = specular_brdf(told.roughness.powi(2), to_light, to_eye);
    let dielectric = (1.0 - fresnel.max_element()) * told.base_color / PI + fresnel * layer;
    let coat = specular_brdf(told.clearcoat_roughness.powi(2).max(1e-3), to_light, to_eye);
    dielectric.lerp(DVec3::splat(coat), told.clearcoat * schlick(DVec3::splat(0.04), to_eye.z).x)
}

/// What it reflects of an even light, towards an eye at that cosine.
fn reflected(told: &Told, cosine: f64) -> DVec3 {
    const HEIGHTS: u32 = 400;
    const TURNS: u32 = 800;
    let to_eye = dvec3((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let mut sum = DVec3::ZERO;
    for height in 0..HEIGHTS {
        let z = (f64::from(height) + 0.5) / f64::from(HEIGHTS);
        let radius = (1.0 - z * z).sqrt();
        for turn in 0..TURNS {
            let (sin, cos) = (2.0 * PI * (f64::from(turn) + 0.5) / f64::from(TURNS)).sin_cos();
            sum += z * brdf(told, dvec3(radius * cos, radius * sin, z), to_eye);
        }
    }
    sum * 2.0 * PI / f64::from(HEIGHTS * TURNS)
}

/// The colour of a surface that is seen at that cosine, in an even light.
fn seen(look: &Look, base_color: [f32; 3], cosine: f32) -> [u8; 3] {
    let engine = evenly_lit(LIGHT);
    let normal = vec3((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let mesh = square_of(material(base_color, look.clone()), normal, Vec2::ONE);
    let target = Target::new(&engine.gpu, [SIDE; 2]).expect("a small picture");
    let (mut scene, camera) = camera_of(&engine, &mesh, &target);
    engine.draw(&mut scene, &target, &camera, &studio(), &mut Timing::Off).expect("a draw");
    at(&target.read(&engine.gpu).expect("a readback"), [0.45, 0.52])
}

#[test]
fn maps_reflect_what_their_specifications_say() {
    let base_color = [0.1, 0.3, 0.6];
    let texel = |look: Look, slot, texel: [u8; 4]| look_with(slot, map(image([1, 1], &[texel]), MapUv::Own), look);
    let color = [190, 150, 60];
    let [r, g, b] = color;
    let f0 = DVec3::from(linear(color).map(f64::from));
    let part = |byte: u8| f64::from(byte) / 255.0;
    let plain = Told {
        base_color: DVec3::from(base_color.map(f64::from)),
        roughness: 0.5,
        f0: DVec3::splat(0.04),
        specular: 1.0,
        clearcoat: 0.0,
        clearcoat_roughness: 0.0,
    };
    // As a reader makes it of specular and glossiness.
    let glossy = Look { roughness: 1.0, ior: 0.0, ..Look::default() };
    let glossy =
        texel(texel(glossy, Slot::SpecularColor, [r, g, b, 140]), Slot::MetallicRoughness, [255, 115, 255, 255]);
    let tinted = Look { roughness: 0.4, ior: 2.4, ..Look::default() };
    let tinted = texel(texel(tinted, Slot::SpecularColor, [r, g, b, 9]), Slot::Specular, [9, 9, 9, 160]);
    let coated = Look { roughness: 0.9, clearcoat: 1.0, clearcoat_roughness: 0.8, ..Look::default() };
    let coated = texel(texel(coated, Slot::Clearcoat, [200, 9, 9, 9]), Slot::ClearcoatRoughness, [9, 128, 9, 9]);
    let root = 1.4_f64 / 3.4;
    for (name, look, told) in [
        ("glossy", glossy, Told { roughness: part(115), f0, ..plain }),
        ("tinted", tinted, Told { roughness: 0.4, f0: root * root * f0, specular: part(160), ..plain }),
        (
            "coated",
            coated,
            Told { roughness: 0.9, clearcoat: part(200), clearcoat_roughness: 0.8 * part(128), ..plain },
        ),
    ] {
        for cosine in [0.95, 0.7, 0.4] {
            let expected = reflected(&told, cosine) * f64::from(LIGHT);
            let expected = expected.to_array().map(|channel| srgb(channel as f32));
            assert_near(seen(&look, base_color, cosine as f32), expected, STEPS, &format!("{name} at {cosine}"));
        }
    }
}
