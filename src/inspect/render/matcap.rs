//! Matcaps that are made in code: pictures of lit spheres, and how they are bound in place of a material.

use glam::{Vec3, vec3};

use super::layout::{self, srgb};
use super::materials::Materials;
use super::textures::{ImageUse, linear_sampler, upload};
use crate::settings::Matcap;
use geometry::mesh::Texture;
use geometry::mesh::mipmap::MipFilter;
use gpu::{Gpu, GpuError, Lazy, bind_group, uniform_buffer};

/// The sides of a matcap's picture, in px.
const SIDE: u32 = 512;

/// How far the sphere reaches, as a part of half of the picture: filters need a margin. The same in `shaders/draw_looks.wgsl`.
pub const MATCAP_REACH: f32 = 0.98;

/// Matcaps on the device, each made when it is first needed.
#[derive(Default)]
pub(super) struct Matcaps([Lazy<wgpu::BindGroup>; Matcap::ALL.len()]);

impl Matcaps {
    /// The bind group that stands for every material's.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn group(&self, gpu: &Gpu, materials: &Materials, matcap: Matcap) -> Result<&wgpu::BindGroup, GpuError> {
        self.0[matcap as usize].get_or_try_make(|| sphere_group(gpu, materials, &picture(matcap)))
    }
}

/// A picture of a lit sphere on the device, in place of those that are made in code.
#[derive(Clone)]
pub struct MatcapPicture(pub(super) wgpu::BindGroup);

/// Uploads a picture of a lit sphere.
///
/// # Errors
/// Out of memory, or a lost device.
pub(super) fn sphere_group(gpu: &Gpu, materials: &Materials, picture: &Texture) -> Result<wgpu::BindGroup, GpuError> {
    // Nothing of the material is seen.
    let constants = uniform_buffer(gpu, "matcap", &[0; size_of::<layout::Material>()]);
    let sampler = linear_sampler(gpu, "matcap");
    let view = upload(gpu, &materials.mipmaps, picture, ImageUse::new(MipFilter::Colors))?;
    let bound = [
        (0, constants.as_entire_binding()),
        (1, wgpu::BindingResource::TextureView(&view)),
        (2, wgpu::BindingResource::Sampler(&sampler)),
    ];
    Ok(bind_group(gpu, "matcap", &materials.layout, bound))
}

/// The picture of a sphere. Outside the sphere it goes on as on its outline.
pub fn picture(matcap: Matcap) -> Texture {
    let place = |i: u32| ((i as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0) / MATCAP_REACH;
    let colors = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| color(matcap, normal_at(place(x), -place(y)))));
    let rgba = colors.flat_map(|color| [srgb(color.x), srgb(color.y), srgb(color.z), 255]).collect();
    Texture { size: [SIDE; 2], rgba }
}

/// The normal of a sphere where it is seen at x (right) and y (up), from -1 to 1, by an eye far out on z.
fn normal_at(x: f32, y: f32) -> Vec3 {
    let out = x.hypot(y).max(1.0);
    let (x, y) = (x / out, y / out);
    vec3(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())
}

/// The colour of a matcap's sphere where it has this normal, in linear light.
fn color(matcap: Matcap, normal: Vec3) -> Vec3 {
    match matcap {
        Matcap::RedClay => red_clay(normal),
        Matcap::Chrome => chrome(normal),
        Matcap::Pearl => pearl(normal),
        Matcap::TwoTone => two_tone(normal),
    }
}

/// A smooth step from 0 below `from` to 1 above `to`.
fn step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A highlight of Blinn and Phong towards the eye, of a light in this direction.
fn highlight(normal: Vec3, light: Vec3, sharpness: f32) -> f32 {
    normal.dot((light.normalize() + Vec3::Z).normalize()).max(0.0).powf(sharpness)
}

fn red_clay(normal: Vec3) -> Vec3 {
    let light = vec3(-0.45, 0.75, 0.55).normalize();
    // Light that wraps around the sphere, as it does where it enters the surface.
    let lit = ((normal.dot(light) + 0.35) / 1.35).max(0.0).powf(1.4);
    let sky = 0.5 + 0.5 * normal.y;
    let base = vec3(0.42, 0.105, 0.062) * (0.10 + 0.14 * sky + 0.95 * lit);
    let sheen = vec3(1.0, 0.72, 0.6) * (0.16 * highlight(normal, light, 14.0) + 0.05 * highlight(normal, light, 60.0));
    // Dark outlines set parts of the mesh off from each other.
    (base + sheen) * (0.45 + 0.55 * step(0.0, 0.45, normal.z))
}

fn chrome(normal: Vec3) -> Vec3 {
    let seen = 2.0 * normal.z * normal - Vec3::Z;
    let up = seen.y;
    let sky = vec3(0.30, 0.38, 0.50).lerp(vec3(0.86, 0.90, 0.96), step(0.9, 0.02, up));
    let ground = vec3(0.025, 0.024, 0.026).lerp(vec3(0.20, 0.18, 0.16), step(-0.05, -0.9, up));
    let all = ground.lerp(sky, step(-0.015, 0.015, up));
    // A large lamp at the upper left, and a long one at the right.
    let lamp = |x: f32, y: f32, width: f32, height: f32| {
        let along = |place: f32, middle: f32, half: f32| step(half, 0.85 * half, (place - middle).abs());
        along(seen.x, x, width) * along(seen.y, y, height)
    };
    let lamps = lamp(-0.45, 0.55, 0.22, 0.18).max(lamp(0.72, 0.25, 0.07, 0.45)) * step(-0.2, 0.1, seen.z);
    all.lerp(Vec3::splat(1.0), lamps) * (0.75 + 0.25 * step(0.0, 0.3, normal.z))
}

fn pearl(normal: Vec3) -> Vec3 {
    let light = vec3(-0.35, 0.8, 0.6).normalize();
    let lit = 0.5 + 0.5 * normal.dot(light);
    // Thin layers reflect other colours at other angles.
    let turn = std::f32::consts::TAU * (1.15 * normal.z + 0.12 * normal.x);
    let tint = vec3(turn.cos(), (turn - 2.1).cos(), (turn + 2.1).cos());
    let body = vec3(0.80, 0.755, 0.72) * (0.16 + 0.72 * lit.powf(1.5));
    let layers = body + tint * 0.055 * (1.0 - normal.z).sqrt() * (0.35 + lit);
    layers + Vec3::splat(0.14 * highlight(normal, light, 22.0))
}

fn two_tone(normal: Vec3) -> Vec3 {
    // The line where both lights meet leans a little, so that it doesn't run along upright edges.
    let side = normal.dot(vec3(-0.94, 0.28, 0.18).normalize());
    let cool = vec3(0.018, 0.055, 0.12) + vec3(0.10, 0.24, 0.38) * (-side).max(0.0);
    let warm = vec3(0.52, 0.30, 0.14) + vec3(0.42, 0.34, 0.24) * side.max(0.0);
    cool.lerp(warm, step(-0.16, 0.22, side)) * (0.7 + 0.3 * step(0.0, 0.5, normal.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matcaps_differ_are_smooth_and_none_is_darker_than_what_can_be_seen() {
        let pictures: Vec<_> = Matcap::ALL.iter().map(|&matcap| (matcap, picture(matcap))).collect();
        for (index, (matcap, own)) in pictures.iter().enumerate() {
            assert!(pictures[..index].iter().all(|(_, other)| other.rgba != own.rgba), "{matcap:?}");
            let at = |x: u32, y: u32| own.rgba[4 * (y * SIDE + x) as usize..][..3].to_vec();
            let brightest = own.rgba.iter().step_by(4).max();
            assert!(brightest > Some(&150), "{matcap:?}: {brightest:?}");
            // Beyond the outline the picture goes on, so that filters don't reach anything else.
            assert_eq!(at(0, SIDE / 2), at(4, SIDE / 2), "{matcap:?}");
            assert!(own.rgba.iter().skip(3).step_by(4).all(|alpha| *alpha == 255), "{matcap:?}");
            if *matcap != Matcap::Chrome {
                let jump = |a: Vec<u8>, b: Vec<u8>| a.iter().zip(&b).map(|(a, b)| a.abs_diff(*b)).max();
                let worst = (0..SIDE - 1).map(|x| jump(at(x, SIDE / 2), at(x + 1, SIDE / 2))).max().flatten();
                assert!(worst < Some(12), "{matcap:?}: {worst:?}");
            }
        }
    }

    #[test]
    fn normals_of_the_picture_are_unit_vectors_also_outside() {
        for (x, y) in [(0.0, 0.0), (0.6, 0.0), (-0.6, 0.64), (2.0, -2.0)] {
            let normal = normal_at(x, y);
            assert!((normal.length() - 1.0).abs() < 1e-6 && normal.z >= 0.0, "{normal}");
        }
        assert_eq!(normal_at(0.6, 0.0), vec3(0.6, 0.0, 0.8));
    }
}
