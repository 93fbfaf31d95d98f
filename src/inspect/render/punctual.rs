//! Lights of a file on the device: `shaders/punctual.wgsl` explains them.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use geometry::mesh::{Light, LightKind, MOST_LIGHTS};
use gpu::{Gpu, uniform_buffer};

/// A light as shaders have it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PunctualLight {
    pub origin: Vec4,
    pub intensity: Vec3,
    pub inverse_range: f32,
    pub direction: Vec3,
    pub cone_scale: f32,
    pub cone_offset: f32,
    pub _pad: [f32; 3],
}

impl From<&Light> for PunctualLight {
    fn from(light: &Light) -> Self {
        let place = light.place.extend(1.0);
        let (origin, range, [cone_scale, cone_offset]) = match light.kind {
            LightKind::Directional => ((-light.direction).extend(0.0), None, [0.0, 1.0]),
            LightKind::Point { range } => (place, range, [0.0, 1.0]),
            LightKind::Spot { range, inner, outer } => (place, range, cone(inner, outer)),
        };
        Self {
            origin,
            intensity: light.intensity,
            inverse_range: range.map_or(0.0, f32::recip),
            direction: light.direction,
            cone_scale,
            cone_offset,
            _pad: [0.0; 3],
        }
    }
}

/// Scale and offset of a spot light's cone, by its inner and outer angle in radians (KHR_lights_punctual, section "Inner and
/// Outer Cone Angles").
fn cone(inner: f32, outer: f32) -> [f32; 2] {
    let scale = 1.0 / (inner.cos() - outer.cos()).max(0.001);
    [scale, -outer.cos() * scale]
}

/// Uploads the lights of a mesh, of which shaders read as many as their pipeline says.
pub(super) fn upload_lights(gpu: &Gpu, lights: &[Light]) -> wgpu::Buffer {
    let mut packed = [PunctualLight::zeroed(); MOST_LIGHTS];
    packed.iter_mut().zip(lights).for_each(|(packed, light)| *packed = light.into());
    uniform_buffer(gpu, "lights", bytemuck::cast_slice(&packed))
}
