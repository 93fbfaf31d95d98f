//! The worst place of a failed gate: what it is called, and the camera that shows it.

use glam::{Vec2, Vec3, vec2};
use serde::{Serialize, Serializer};

use crate::mesh::Bounds;
use crate::render::Camera;
use crate::render::camera::FIELDS_OF_VIEW;

/// How many times a px of the judged picture is enlarged at most where a leak is shown.
const ENLARGED: f32 = 8.0;
/// A leak is enlarged less if it would be larger than this part of the picture's height.
const OF_HEIGHT: f32 = 0.25;

/// The worst place that a gate found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Place {
    /// Where it is and how bad it is there, as the end of a sentence.
    pub text: String,
    /// The mesh's triangles that it lies on.
    pub triangles: Vec<u32>,
    /// Its position in object units, or for leaks in px of the picture.
    #[serde(flatten)]
    pub spot: Spot,
}

/// What a camera is framed on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Spot {
    /// An edge: the positions of its ends, the direction that it faces, and the place on it.
    Edge { ends: [Vec3; 2], facing: Vec3, at: Vec3 },
    /// A patch: the positions of its corners, and the place on it.
    Patch { corners: [Vec3; 3], at: Vec3 },
    /// A place of the judged picture, in px from its top left, and how many px there are.
    Px { middle: Vec2, pixels: u32 },
}

impl Spot {
    /// A camera that shows the spot. `judged` is the camera of the judged picture, `viewport` that picture's size in px, and
    /// `bounds` are the mesh's.
    pub(crate) fn camera(&self, judged: &Camera, viewport: Vec2, bounds: &Bounds) -> Camera {
        let mut camera = *judged;
        match *self {
            Self::Edge { ends, facing, .. } => camera.frame_edge(ends, facing, bounds),
            Self::Patch { corners, at } => {
                camera.frame_triangle(corners, bounds);
                camera.target = at;
            }
            Self::Px { middle, pixels } => {
                let most = OF_HEIGHT * viewport.y / (pixels as f32).sqrt();
                look_closer(&mut camera, middle, viewport, ENLARGED.min(most.max(1.0)));
            }
        }
        camera
    }

    /// The position in object units; none for a place of a picture.
    pub(crate) fn at(&self) -> Option<Vec3> {
        match *self {
            Self::Edge { at, .. } | Self::Patch { at, .. } => Some(at),
            Self::Px { .. } => None,
        }
    }

    /// The place of a picture, in px from its top left; none for a position.
    pub(crate) fn px(&self) -> Option<Vec2> {
        if let Self::Px { middle, .. } = *self { Some(middle) } else { None }
    }
}

/// Written as `at`, three coordinates in object units, and `px`, two in px of the picture; one of them is null.
impl Serialize for Spot {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Written {
            at: Option<[f32; 3]>,
            px: Option<[f32; 2]>,
        }
        Written { at: self.at().map(|at| at.to_array()), px: self.px().map(|px| px.to_array()) }.serialize(serializer)
    }
}

/// Turns a perspective camera's eye, or moves an orthographic camera, so that a px comes into the middle, and enlarges it. The eye
/// of a perspective camera stays, since a leak is seen from there alone.
fn look_closer(camera: &mut Camera, px: Vec2, viewport: Vec2, enlarged: f32) {
    let [right, up, _] = camera.axes();
    let unit = camera.units_per_pixel(viewport.y);
    let aside = (px - viewport * 0.5) * vec2(unit, -unit);
    let (eye, seen) = (camera.eye(), camera.target + right * aside.x + up * aside.y);
    camera.target = seen;
    let half = (0.5 * camera.field_of_view).to_radians().tan() / enlarged;
    camera.field_of_view = (2.0 * half.atan().to_degrees()).max(*FIELDS_OF_VIEW.start());
    if !camera.orthographic {
        let back = (eye - seen).normalize_or_zero();
        camera.distance = eye.distance(seen);
        camera.azimuth = back.x.atan2(back.z).to_degrees().rem_euclid(360.0);
        camera.elevation = back.y.clamp(-1.0, 1.0).asin().to_degrees();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::project;

    #[test]
    fn a_leak_comes_into_the_middle_and_the_eye_stays() {
        let viewport = vec2(640.0, 480.0);
        let bounds = Bounds::of([Vec3::NEG_ONE, Vec3::ONE].into_iter());
        let place = Vec3::new(0.4, -0.3, 0.5);
        for orthographic in [false, true] {
            let judged = Camera { orthographic, ..Camera::framing(&bounds, viewport) };
            let seen = |camera: &Camera, place| project(camera.clip_from_object(viewport, &bounds), viewport, place);
            let px = seen(&judged, place).expect("in front of the eye");
            let camera = Spot::Px { middle: px, pixels: 4 }.camera(&judged, viewport, &bounds);
            let now = seen(&camera, place).expect("in front of the eye");
            assert!(now.distance(viewport * 0.5) < 0.5, "{now}");
            assert!(orthographic || camera.eye().distance(judged.eye()) < 1e-4, "{camera:?}");
            let beside = place + judged.axes()[0] * 0.01;
            let apart = |camera| seen(camera, place).zip(seen(camera, beside)).map_or(0.0, |(a, b)| a.distance(b));
            let enlarged = apart(&camera) / apart(&judged);
            assert!((enlarged - ENLARGED).abs() < 0.5, "{enlarged} times");
            // All of a leak that is a third as high as the picture is seen.
            let whole = Spot::Px { middle: px, pixels: 160 * 160 }.camera(&judged, viewport, &bounds);
            assert!((apart(&whole) / apart(&judged) - 1.0).abs() < 0.05, "{whole:?}");
        }
    }

    #[test]
    fn a_place_is_written_with_its_position_or_its_px() {
        let place = |spot| Place { text: "there".into(), triangles: vec![3], spot };
        let edge = Spot::Edge { ends: [Vec3::ZERO, Vec3::X], facing: Vec3::Z, at: Vec3::X * 0.5 };
        let written = serde_json::to_value(place(edge)).expect("JSON");
        let expected = serde_json::json!({ "text": "there", "triangles": [3], "at": [0.5, 0.0, 0.0], "px": null });
        assert_eq!(written, expected);
        let leak = serde_json::to_value(place(Spot::Px { middle: vec2(3.0, 4.5), pixels: 2 })).expect("JSON");
        assert_eq!((&leak["at"], &leak["px"]), (&serde_json::Value::Null, &serde_json::json!([3.0, 4.5])));
    }
}
