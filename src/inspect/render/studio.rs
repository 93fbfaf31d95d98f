//! The light of a photographer's studio, made in code: soft boxes above, at the front left and on the right, in a grey room.

use glam::{Vec2, Vec3, vec2, vec3};

/// A soft box: a rectangle that glows, at distance 1 from the object.
struct SoftBox {
    /// Unit direction to its middle, and the direction along its width.
    middle: Vec3,
    along: Vec3,
    /// Half its width and height, in distances.
    half_size: Vec2,
    /// Linear RGB of its middle.
    light: Vec3,
}

/// How far the light of a box reaches beyond its edge, and how round its corners are, in distances.
const SOFT_EDGE: f32 = 0.06;
const CORNER: f32 = 0.1;

/// How bright a box is at its corners, where its middle is 1.
const AT_CORNERS: f32 = 0.7;

impl SoftBox {
    /// What it adds to the light from a direction.
    fn light_from(&self, direction: Vec3) -> Vec3 {
        let away = direction.dot(self.middle);
        if away <= 0.0 {
            return Vec3::ZERO;
        }
        let up = self.middle.cross(self.along);
        let place = vec2(direction.dot(self.along), direction.dot(up)) / away;
        let beyond = place.abs() - self.half_size + CORNER;
        let distance = beyond.max(Vec2::ZERO).length() + beyond.max_element().min(0.0) - CORNER;
        let inside = 1.0 - smooth_step(distance / SOFT_EDGE);
        let from_middle = (place / self.half_size).length_squared() / 2.0;
        self.light * inside * (1.0 + (AT_CORNERS - 1.0) * from_middle.min(1.0))
    }
}

/// 0 at -1 and below, 1 at 1 and above, smooth between.
fn smooth_step(x: f32) -> f32 {
    let part = (0.5 + 0.5 * x).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}

/// The radiance that comes from a unit direction, in linear RGB.
pub fn studio_light(direction: Vec3) -> Vec3 {
    let side = |azimuth: f32| {
        let (sine, cosine) = azimuth.to_radians().sin_cos();
        (vec3(sine, 0.1, cosine).normalize(), vec3(cosine, 0.0, -sine))
    };
    let strip = |azimuth: f32, half_size, light| {
        let (middle, along) = side(azimuth);
        SoftBox { middle, along, half_size, light }
    };
    let boxes = [
        SoftBox { middle: Vec3::Y, along: Vec3::X, half_size: vec2(0.85, 0.7), light: vec3(1.6, 1.6, 1.6) },
        strip(-45.0, vec2(0.38, 0.62), vec3(2.05, 2.1, 2.17)),
        strip(95.0, vec2(0.26, 0.62), vec3(1.6, 1.56, 1.51)),
    ];
    boxes.iter().map(|soft_box| soft_box.light_from(direction)).sum::<Vec3>() + room(direction)
}

/// The room: grey, with a dim floor that is lighter towards the horizon.
fn room(direction: Vec3) -> Vec3 {
    let (floor, wall, ceiling) = (vec3(0.203, 0.2, 0.197), vec3(0.33, 0.33, 0.335), vec3(0.14, 0.14, 0.143));
    if direction.y < 0.0 {
        wall.lerp(floor, smooth_step((-direction.y - 0.2) / 0.2))
    } else {
        wall.lerp(ceiling, smooth_step(2.0 * direction.y - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::super::cube_map::CubeMap;
    use super::super::irradiance::light_parts;
    use super::*;
    use crate::for_tests::prefiltered::gathered;

    #[test]
    fn the_light_is_positive_soft_and_nearly_grey() {
        let map = CubeMap::new(64, studio_light);
        for (direction, _, light) in map.lights() {
            assert!(light.min_element() > 0.05 && light.max_element() < 3.0, "{direction}: {light}");
            assert!(light.max_element() < 1.2 * light.min_element(), "{direction}: {light}");
        }
    }

    /// The lights that move with the camera give 0.62 of the cosine towards the key light, 0.22 of a soft fill, and 0.04. Under the tone
    /// curve, which darkens what is not bright, the studio looks about as bright if it is a third brighter.
    #[test]
    fn a_matte_white_sphere_is_a_third_brighter_than_under_the_lights_of_the_camera() {
        let parts = light_parts(CubeMap::new(64, studio_light).lights());
        let (right, up, back) = (Vec3::X, Vec3::Y, Vec3::Z);
        let (key, fill) =
            ((up * 0.7 + back - right * 0.5).normalize(), (up * 0.8 + back * 0.4 + right * 0.5).normalize());
        let (mut studio, mut camera, mut count) = (0.0, 0.0, 0.0);
        for (normal, ..) in CubeMap::new(16, |_| Vec3::ZERO).lights().filter(|(normal, ..)| normal.z > 0.0) {
            studio += gathered(&parts, normal).element_sum() / 3.0 * normal.z;
            camera += (0.62 * normal.dot(key).max(0.0) + 0.22 * (0.5 + 0.5 * normal.dot(fill)) + 0.04) * normal.z;
            count += normal.z;
        }
        let [studio, camera] = [studio / count, camera / count];
        assert!((studio / camera - 1.33).abs() < 0.1, "{studio} {camera}");
    }
}
