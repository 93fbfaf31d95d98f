//! How surfaces reflect light: twin of `shaders/reflectance.wgsl`, which explains it.

use std::f32::consts::PI;

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, vec2};

use crate::render::sheen::{LEAST_SHEEN_ALPHA, charlie_distribution, charlie_lambda};

/// How much a clear coat reflects head-on.
pub(crate) const COAT_F0: f32 = 0.04;

/// The least square of the perceptual roughness for light from a single direction.
pub(crate) const LEAST_ALPHA: f32 = 0.001;

/// What is known of the material at a place of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LookAt {
    pub base_color: Vec3,
    pub metallic: f32,
    pub specular_color: Vec3,
    pub specular: f32,
    pub coat_normal: Vec3,
    pub coat: f32,
    pub direction: Vec3,
    pub anisotropy: f32,
    pub roughness: f32,
    pub coat_roughness: f32,
    pub ior: f32,
    pub occlusion: f32,
    pub sheen_color: Vec3,
    pub transmission: f32,
    pub sheen_roughness: f32,
    pub sheen_albedo: f32,
    pub _pad: [f32; 2],
}

impl Default for LookAt {
    fn default() -> Self {
        Self {
            base_color: Vec3::ONE,
            metallic: 0.0,
            specular_color: Vec3::ONE,
            specular: 1.0,
            coat_normal: Vec3::Z,
            coat: 0.0,
            direction: Vec3::X,
            anisotropy: 0.0,
            roughness: 0.5,
            coat_roughness: 0.0,
            ior: 1.5,
            occlusion: 1.0,
            sheen_color: Vec3::ZERO,
            transmission: 0.0,
            sheen_roughness: 0.0,
            sheen_albedo: 0.0,
            _pad: [0.0; 2],
        }
    }
}

/// The light from all around that matters at a place.
#[derive(Clone, Copy, Debug, Default)]
pub struct AmbientLight {
    pub diffuse: Vec3,
    pub reflected: Vec3,
    pub coat_reflected: Vec3,
    pub sheen: Vec3,
    pub dfg: Vec2,
    pub coat_dfg: Vec2,
    pub facing: f32,
    pub coat_facing: f32,
}

pub(crate) fn fifth_power(x: f32) -> f32 {
    x * x * x * x * x
}

pub(crate) fn dielectric_f0(look: &LookAt) -> Vec3 {
    let root = (look.ior - 1.0) / (look.ior + 1.0);
    (root * root * look.specular_color).min(Vec3::ONE) * look.specular
}

pub fn largest_component(color: Vec3) -> f32 {
    color.max_element()
}

pub(crate) fn ggx_distribution(normal: Vec3, half_way: Vec3, alphas: Vec2, direction: Vec3) -> f32 {
    let cosine = normal.dot(half_way).max(0.0);
    let across = normal.cross(half_way);
    let (aside, ratio) = (across.dot(direction), alphas.x / alphas.y);
    let spread =
        cosine * cosine * alphas.x * alphas.x + across.length_squared() + (ratio * ratio - 1.0) * aside * aside;
    ratio * alphas.x * alphas.x / (PI * spread * spread)
}

pub(crate) fn ggx_visibility(lit: f32, facing: f32, alphas: Vec2, along: Vec2) -> f32 {
    let square = alphas.y * alphas.y;
    let more = (alphas.x * alphas.x - square) * along * along;
    let eye_part = lit * (facing * facing * (1.0 - square) + square + more.y).sqrt();
    let light_part = facing * (lit * lit * (1.0 - square) + square + more.x).sqrt();
    0.5 / (eye_part + light_part).max(1e-7)
}

pub fn stretched_alphas(look: &LookAt) -> Vec2 {
    let alpha = look.roughness * look.roughness;
    vec2(alpha + (1.0 - alpha) * look.anisotropy * look.anisotropy, alpha)
}

pub fn mean_roughness(look: &LookAt) -> f32 {
    if look.anisotropy <= 0.0 {
        return look.roughness;
    }
    (0.5 * stretched_alphas(look).length_squared()).sqrt().sqrt()
}

pub(crate) fn albedo_at_once(f0: Vec3, f90: f32, dfg: Vec2) -> Vec3 {
    f0 * dfg.x + f90 * dfg.y
}

pub(crate) fn albedo_of_more(f0: Vec3, f90: f32, dfg: Vec2) -> Vec3 {
    let missing = 1.0 - dfg.x - dfg.y;
    let average = f0 + (f90 - f0) / 21.0;
    missing * albedo_at_once(f0, f90, dfg) * average / (1.0 - missing * average)
}

pub(crate) fn unoccluded_reflection(occlusion: f32, facing: f32, roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    let base = (facing + occlusion).max(0.0);
    (base.powf((-16.0 * alpha - 1.0).exp2()) - 1.0 + occlusion).clamp(0.0, 1.0)
}

pub fn dominant_direction(normal: Vec3, to_eye: Vec3, roughness: f32) -> Vec3 {
    let alpha = roughness * roughness;
    let mirrored = (1.0 - alpha) * ((1.0 - alpha).sqrt() + alpha);
    normal.lerp(2.0 * normal.dot(to_eye) * normal - to_eye, mirrored).normalize()
}

pub fn coat_albedo(look: &LookAt, coat_dfg: Vec2) -> f32 {
    let f0 = Vec3::splat(COAT_F0);
    look.coat * (albedo_at_once(f0, 1.0, coat_dfg).x + albedo_of_more(f0, 1.0, coat_dfg).x)
}

pub fn sheen_direction(normal: Vec3, to_eye: Vec3) -> Vec3 {
    let between = normal + to_eye;
    between / between.length_squared().max(1e-12).sqrt()
}

pub fn has_sheen(look: &LookAt) -> bool {
    largest_component(look.sheen_color) > 0.0
}

pub(crate) fn sheen_scaling(look: &LookAt) -> f32 {
    1.0 - largest_component(look.sheen_color) * look.sheen_albedo.min(1.0)
}

pub fn reflect_ambient(look: &LookAt, light: &AmbientLight) -> Vec3 {
    let diffuse = light.diffuse * look.occlusion;
    let reflected = light.reflected * unoccluded_reflection(look.occlusion, light.facing, look.roughness);
    let f0 = dielectric_f0(look);
    let once = albedo_at_once(f0, look.specular, light.dfg);
    let more = albedo_of_more(f0, look.specular, light.dfg);
    let left = (1.0 - largest_component(once + more)).max(0.0);
    let dielectric = once * reflected + (more + left * (1.0 - look.transmission) * look.base_color) * diffuse;
    let metal = albedo_at_once(look.base_color, 1.0, light.dfg) * reflected
        + albedo_of_more(look.base_color, 1.0, light.dfg) * diffuse;
    let mut base = dielectric.lerp(metal, look.metallic);
    if has_sheen(look) {
        let sheen = look.sheen_color * light.sheen * (look.occlusion * look.sheen_albedo.min(1.0));
        base = base * sheen_scaling(look) + sheen;
    }
    if look.coat <= 0.0 {
        return base;
    }
    let coat_f0 = Vec3::splat(COAT_F0);
    let coat_reflected =
        light.coat_reflected * unoccluded_reflection(look.occlusion, light.coat_facing, look.coat_roughness);
    let coat = albedo_at_once(coat_f0, 1.0, light.coat_dfg) * coat_reflected
        + albedo_of_more(coat_f0, 1.0, light.coat_dfg) * diffuse;
    base * (1.0 - coat_albedo(look, light.coat_dfg)) + look.coat * coat
}

pub fn transmitted(look: &LookAt, dfg: Vec2, coat_dfg: Vec2) -> Vec3 {
    let f0 = dielectric_f0(look);
    let reflected = albedo_at_once(f0, look.specular, dfg) + albedo_of_more(f0, look.specular, dfg);
    let left = (1.0 - largest_component(reflected)).max(0.0);
    let through = (1.0 - look.metallic) * look.transmission * left * look.base_color;
    through * (sheen_scaling(look) * (1.0 - coat_albedo(look, coat_dfg)))
}

pub fn direct_reflection(look: &LookAt, normal: Vec3, to_eye: Vec3, to_light: Vec3) -> Vec3 {
    let half_way = (to_eye + to_light).normalize();
    let schlick = fifth_power(1.0 - half_way.dot(to_eye).clamp(0.0, 1.0));
    let mut base = direct_base_reflection(look, normal, to_eye, to_light, half_way, schlick);
    if has_sheen(look) {
        base = base * sheen_scaling(look) + look.sheen_color * direct_sheen(look, normal, to_eye, to_light, half_way);
    }
    if look.coat <= 0.0 {
        return base;
    }
    let coat_fresnel = COAT_F0 + (1.0 - COAT_F0) * fifth_power(1.0 - look.coat_normal.dot(to_eye).abs());
    let coat = look.coat * coat_fresnel;
    let coat_alphas = Vec2::splat(look.coat_roughness * look.coat_roughness);
    base * (1.0 - coat) + coat * direct_lobe(look.coat_normal, to_eye, to_light, half_way, coat_alphas, look.direction)
}

pub(crate) fn direct_lobe(
    normal: Vec3,
    to_eye: Vec3,
    to_light: Vec3,
    half_way: Vec3,
    alphas: Vec2,
    direction: Vec3,
) -> f32 {
    let (lit, facing) = (normal.dot(to_light), normal.dot(to_eye));
    if lit <= 0.0 || facing <= 0.0 {
        return 0.0;
    }
    let rough = alphas.max(Vec2::splat(LEAST_ALPHA));
    let along = vec2(direction.dot(to_light), direction.dot(to_eye));
    ggx_distribution(normal, half_way, rough, direction) * ggx_visibility(lit, facing, rough, along) * lit
}

/// Twin of the function in `shaders/sheen.wgsl`.
pub(crate) fn charlie_visibility(lit: f32, facing: f32, alpha: f32) -> f32 {
    0.25 / (facing * (1.0 + charlie_lambda(facing, alpha) + charlie_lambda(lit, alpha)))
}

pub(crate) fn direct_sheen(look: &LookAt, normal: Vec3, to_eye: Vec3, to_light: Vec3, half_way: Vec3) -> f32 {
    let (lit, facing) = (normal.dot(to_light), normal.dot(to_eye));
    if lit <= 0.0 || facing <= 0.0 {
        return 0.0;
    }
    let alpha = (look.sheen_roughness * look.sheen_roughness).max(LEAST_SHEEN_ALPHA);
    let sine = normal.cross(half_way).length().min(1.0);
    let lobe = charlie_distribution(sine, alpha) * charlie_visibility(lit, facing, alpha);
    lobe / look.sheen_albedo.max(1.0)
}

pub(crate) fn direct_base_reflection(
    look: &LookAt,
    normal: Vec3,
    to_eye: Vec3,
    to_light: Vec3,
    half_way: Vec3,
    schlick: f32,
) -> Vec3 {
    let lobe = direct_lobe(normal, to_eye, to_light, half_way, stretched_alphas(look), look.direction);
    let f0 = dielectric_f0(look);
    let fresnel = f0 + (look.specular - f0) * schlick;
    let lit = if normal.dot(to_eye) > 0.0 { normal.dot(to_light).max(0.0) } else { 0.0 };
    let left = (1.0 - largest_component(fresnel)) * (1.0 - look.transmission);
    let dielectric = look.base_color * (left * lit / PI) + fresnel * lobe;
    let metal = (look.base_color + (1.0 - look.base_color) * schlick) * lobe;
    dielectric.lerp(metal, look.metallic)
}
