//! The cameras that cases are seen from.

use glam::{Vec2, Vec3, vec2};

use super::CaseView;
use geometry::mesh::Bounds;
use inspect::reference_shape::radical_inverse;
use inspect::render::Camera;

/// The size of the picture that screen measurements refer to: width and height in px.
pub(super) const SIZE: [u32; 2] = [320, 240];

/// The same as a viewport for cameras.
pub fn viewport() -> Vec2 {
    vec2(SIZE[0] as f32, SIZE[1] as f32)
}

/// Camera `index` of a fixed sequence of cameras all around the mesh, near and far, and inside it. Every eighth one is
/// orthographic. It uses Halton's low-discrepancy sequence, so that even the first few cameras differ much.
pub fn random(bounds: &Bounds, index: u32) -> Camera {
    let [turn, height, depth, x, y] = [2, 3, 5, 7, 11].map(|base| radical_inverse(base, index as usize + 1) as f32);
    let radius = bounds.radius();
    Camera {
        target: bounds.center() + radius * Vec3::new(x - 0.5, y - 0.5, depth - 0.5),
        azimuth: 360.0 * turn,
        elevation: (2.0 * height - 1.0).asin().to_degrees().clamp(-89.0, 89.0),
        distance: radius * (0.25 + 6.0 * depth * depth),
        orthographic: index % 8 == 7,
        ..Camera::default()
    }
}

/// The camera that a case's picture is taken with.
pub(super) fn camera(bounds: &Bounds, view: &CaseView, viewport: Vec2) -> Camera {
    let mut camera = Camera::framing(bounds, viewport);
    (camera.azimuth, camera.elevation) = (view.azimuth, view.elevation);
    if view.distance > 0.0 {
        camera.distance = view.distance * bounds.radius();
        camera.target = bounds.center() + bounds.radius() * Vec3::from(view.target);
    }
    camera
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn some_cameras_are_inside_and_most_are_not() {
        let bounds = Bounds::new([Vec3::NEG_ONE, Vec3::ONE].into_iter());
        let cameras: Vec<_> = (0..200).map(|index| random(&bounds, index)).collect();
        let inside = cameras.iter().filter(|camera| camera.eye().length() < bounds.radius()).count();
        assert!((10..120).contains(&inside), "{inside}");
        assert!(cameras.iter().all(|camera| camera.distance > 0.0 && camera.elevation.abs() < 90.0));
    }
}
