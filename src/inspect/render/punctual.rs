//! Lights of a file on the device: twin of `shaders/punctual.wgsl`, which explains them.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4, Vec4Swizzles};

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

/// What reaches a place from a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectLight {
    pub to_light: Vec3,
    pub illuminance: Vec3,
}

pub fn direct_light(light: &PunctualLight, place: Vec3) -> DirectLight {
    let toward = light.origin.xyz() - light.origin.w * place;
    let square = toward.dot(toward).max(1e-12);
    let to_light = toward / square.sqrt();
    let part = square * light.inverse_range * light.inverse_range;
    let attenuation = (1.0 - part * part).clamp(0.0, 1.0) / square;
    let cone = (light.cone_offset - light.cone_scale * to_light.dot(light.direction)).clamp(0.0, 1.0);
    DirectLight { to_light, illuminance: light.intensity * (attenuation * cone * cone) }
}

impl From<&Light> for PunctualLight {
    fn from(light: &Light) -> Self {
        let (range, [cone_scale, cone_offset]) = match light.kind {
            LightKind::Directional => (None, [0.0, 1.0]),
            LightKind::Point { range } => (range, [0.0, 1.0]),
            LightKind::Spot { range, inner, outer } => (range, cone(inner, outer)),
        };
        let origin = match light.kind {
            LightKind::Directional => (-light.direction).extend(0.0),
            _ => light.place.extend(1.0),
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

#[cfg(test)]
mod tests {
    use std::f32::consts::{FRAC_PI_4, PI};

    use glam::vec3;

    use super::*;

    fn light(kind: LightKind) -> PunctualLight {
        let light =
            Light { kind, intensity: vec3(10.0, 20.0, 40.0), place: vec3(0.0, 2.0, 0.0), direction: Vec3::NEG_Y };
        (&light).into()
    }

    /// Illuminance of a surface across the light is intensity divided by the square of the distance.
    #[test]
    fn light_fades_with_the_square_of_the_distance_and_ends_at_the_range() {
        let free = light(LightKind::Point { range: None });
        let found = direct_light(&free, vec3(0.0, -2.0, 0.0));
        assert!(found.to_light.distance(Vec3::Y) < 1e-6);
        assert!(found.illuminance.distance(vec3(10.0, 20.0, 40.0) / 16.0) < 1e-5, "{found:?}");
        let bounded = light(LightKind::Point { range: Some(4.0) });
        let at = |distance: f32| direct_light(&bounded, vec3(0.0, 2.0 - distance, 0.0)).illuminance.x;
        assert!((at(2.0) - 10.0 / 4.0 * (1.0 - 1.0 / 16.0)).abs() < 1e-5, "{}", at(2.0));
        assert_eq!([at(4.0), at(8.0)], [0.0; 2]);
    }

    #[test]
    fn a_direction_is_the_same_everywhere() {
        let sun = light(LightKind::Directional);
        for place in [Vec3::ZERO, vec3(100.0, -7.0, 3.0)] {
            let found = direct_light(&sun, place);
            assert!(
                found.to_light.distance(Vec3::Y) < 1e-6 && found.illuminance.distance(vec3(10.0, 20.0, 40.0)) < 1e-4
            );
        }
    }

    /// Full inside the inner angle, nothing outside the outer one, and a quarter where the cosine is half way.
    #[test]
    fn a_spot_darkens_between_its_angles() {
        let (inner, outer) = (PI / 12.0, FRAC_PI_4);
        let spot = light(LightKind::Spot { range: None, inner, outer });
        let at = |cosine: f32| {
            let angle = cosine.acos();
            let place = vec3(0.0, 2.0, 0.0) + vec3(angle.sin(), -angle.cos(), 0.0);
            direct_light(&spot, place).illuminance.x / 10.0
        };
        let half_way = (inner.cos() + outer.cos()) / 2.0;
        for (cosine, expected) in
            [(1.0, 1.0), (inner.cos() + 1e-4, 1.0), (half_way, 0.25), (outer.cos() - 1e-4, 0.0), (-1.0, 0.0)]
        {
            assert!((at(cosine) - expected).abs() < 1e-3, "{cosine}: {}", at(cosine));
        }
    }
}
