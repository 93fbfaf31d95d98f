//! Cuts pictures open along a plane: what is before it isn't drawn. The plane takes the place of the near plane of the view, or of
//! the far one if the eye is on the side that stays, so that no shader knows of it (Lengyel, "Oblique View Frustum Depth Projection
//! and Clipping", Journal of Game Development 1(2), 2005).

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::Camera;
use crate::settings::Settings;
use geometry::mesh::Bounds;

/// How far the plane must be from being seen edge-on, where it would leave no depths: as a part of the bounding radius, or of the
/// length of a normal.
const LEAST: f32 = 1e-3;

/// The matrix from object units to clip space for a picture with these settings: that of the camera, with the section if there is one.
pub fn clip_from_object(camera: &Camera, viewport: Vec2, bounds: &Bounds, settings: &Settings) -> Mat4 {
    let clip = camera.clip_from_object(viewport, bounds);
    let Some(axis) = settings.section else { return clip };
    let mut normal = axis.direction();
    let place = bounds.min.lerp(bounds.max, settings.section_at);
    let back = camera.axes()[2];
    if camera.orthographic && normal.dot(back).abs() < LEAST {
        normal = (normal + 2.0 * LEAST * back).normalize();
    }
    let mut offset = -normal.dot(place);
    let mut toward_eye = if camera.orthographic { normal.dot(back) } else { normal.dot(camera.eye()) + offset };
    let least = LEAST * bounds.radius();
    if !camera.orthographic && toward_eye.abs() < least {
        offset += least - toward_eye;
        toward_eye = least;
    }
    with_plane(clip, normal.extend(offset), toward_eye >= 0.0, camera.frustum(viewport, bounds))
}

/// The matrix with other depths, which are in range only where `plane` times a point is positive. `stays` says whether the eye is
/// there; `frustum` holds all that is drawn.
fn with_plane(clip: Mat4, plane: Vec4, stays: bool, frustum: [[Vec3; 4]; 2]) -> Mat4 {
    let rows = clip.transpose();
    let corners = frustum.as_flattened().iter().map(|corner| corner.extend(1.0));
    let most = corners.map(|corner| plane.dot(corner) / rows.w_axis.dot(corner)).fold(f32::MIN_POSITIVE, f32::max);
    let depth = plane / most;
    let z_axis = if stays { depth } else { rows.w_axis - depth };
    Mat4 { z_axis, ..rows }.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::SectionAxis;
    use glam::vec2;

    #[test]
    fn what_is_before_the_plane_is_out_of_the_range_of_depths_and_the_rest_keeps_its_order() {
        let bounds = Bounds::new([-1.0, 1.0].into_iter().map(Vec3::splat));
        let viewport = vec2(640.0, 480.0);
        let mut random = fastrand::Rng::with_seed(5);
        let mut seen = [0, 0];
        for round in 0..4000 {
            let mut camera = Camera::framing(&bounds, viewport);
            camera.azimuth = 360.0 * random.f32();
            camera.elevation = 170.0 * random.f32() - 85.0;
            camera.orthographic = round % 2 == 0;
            camera.distance *= 0.3 + random.f32();
            let section = Some(SectionAxis::ALL[random.usize(..6)]);
            let settings = Settings { section, section_at: random.f32(), ..Settings::default() };
            let [cut, whole] =
                [settings, Settings::default()].map(|own| clip_from_object(&camera, viewport, &bounds, &own));
            let normal = section.map_or(Vec3::X, SectionAxis::direction);
            let place = bounds.min.lerp(bounds.max, settings.section_at);
            let point = || Vec3::from([(); 3].map(|()| 2.0 * random.f32() - 1.0));
            let points: Vec<_> = std::iter::repeat_with(point).take(40).collect();
            for &point in &points {
                let [at, before] = [cut, whole].map(|matrix| matrix * point.extend(1.0));
                assert_eq!([at.x, at.y, at.w], [before.x, before.y, before.w]);
                let distance = normal.dot(point - place);
                let is_in_view = before.w > camera.distance * 0.01 && before.truncate().abs().max_element() < before.w;
                if is_in_view && distance.abs() > 0.01 {
                    let stays = at.z >= 0.0 && at.z <= at.w;
                    assert_eq!(stays, distance > 0.0, "{camera:?}, {section:?}, {point}: {at} of {before}");
                    seen[usize::from(stays)] += 1;
                }
                // Toward the eye, depths are larger, as they are without a section.
                let toward = if camera.orthographic { camera.axes()[2] } else { (camera.eye() - point).normalize() };
                let nearer = cut * (point + 0.1 * toward).extend(1.0);
                let is_seen = is_in_view && nearer.w > 0.0;
                assert!(!is_seen || nearer.z / nearer.w > at.z / at.w, "{camera:?}, {section:?}, {at}, {nearer}");
            }
        }
        assert!(seen.iter().all(|&points| points > 10_000), "{seen:?}");
    }
}
