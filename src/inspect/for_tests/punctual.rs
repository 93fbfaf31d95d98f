//! Lights of a file: twin of `shaders/punctual.wgsl`, which explains them.

use glam::{Vec3, Vec4Swizzles};

use crate::render::punctual::PunctualLight;

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

#[cfg(test)]
mod tests {
    use std::f32::consts::{FRAC_PI_4, PI};

    use geometry::mesh::{Light, LightKind};
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
