//! The constants that all draws of a picture read.

use super::ground::Ground;
use super::halves::HalfPlace;
use super::layout::{COMPARED_BIT, Frame, SECTION_BIT, overlay_bits};
use super::section::clip_from_object;
use super::{Camera, Scene, Target, Usual};
use crate::settings::{Colors, Settings, SurfaceUnit};
use gpu::{Gpu, uniform_buffer};

/// Uploads the constants of a picture of a scene, or of a half of it at this place. Scales are for what
/// is `usual`, which both halves share.
pub(super) fn frame(
    gpu: &Gpu,
    scene: &Scene,
    usual: &Usual,
    target: &Target,
    camera: &Camera,
    settings: &Settings,
    place: &HalfPlace,
) -> wgpu::Buffer {
    let viewport = target.viewport();
    let [right, up, back] = camera.axes();
    let eye = if camera.orthographic { back.extend(0.0) } else { camera.eye().extend(1.0) };
    let scale = usual.scale(settings, scene.known_deviation().map(|known| known.scale));
    let is_of_texels = settings.overlays.colors == Colors::TexelDensity;
    let (sine, cosine) = settings.zebra_direction.to_radians().sin_cos();
    let in_px = settings.deviation_in == SurfaceUnit::Px;
    let section = if settings.section.is_some() { SECTION_BIT } else { 0 };
    let compared = if settings.shows_difference() { COMPARED_BIT } else { 0 };
    let ground = Ground::under(&scene.bounds);
    let frame = Frame {
        clip_from_object: clip_from_object(camera, viewport, &scene.bounds, settings).to_cols_array_2d(),
        key_light: (up * 0.7 + back - right * 0.5).normalize().extend(0.0).to_array(),
        fill_light: (up * 0.8 + back * 0.4 + right * 0.5).normalize().extend(0.0).to_array(),
        eye: eye.to_array(),
        viewport: viewport.to_array(),
        overlays: overlay_bits(&settings.overlays) | section | compared,
        ulp: scene.ulp,
        convention: settings.tessellation.convention as u32,
        scale_least: scale.least,
        scale_most: scale.most,
        px_per_unit: if in_px { camera.px_where_w_is_1(viewport.y) } else { 0.0 },
        ground: ground.middle.extend(ground.spacing).to_array(),
        scale: scale.colors.map(|[r, g, b]| [r, g, b, 0].map(|byte| f32::from(byte) / 255.0)),
        left: place.area[0] as f32,
        coarseness: target.coarseness as f32,
        shift: place.shift as f32,
        kind: if is_of_texels { settings.texel_density_per as u32 } else { settings.curvature_kind as u32 },
        zebra_axis: [cosine, sine],
        zebra_stripes: settings.zebra_stripes,
        checker_squares: settings.checker_squares.round(),
    };
    uniform_buffer(gpu, "frame", bytemuck::bytes_of(&frame))
}
