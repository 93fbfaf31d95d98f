//! The worst place of a failed gate: what it is called, and the camera that shows it.

use glam::{Vec2, Vec3, vec2};
use serde::{Serialize, Serializer};

use crate::measure::FoldedPatch;
use crate::render::Camera;
use crate::render::camera::FIELDS_OF_VIEW;
use geometry::mesh::{Bounds, Topology};
use geometry::view::{ScreenView, seen_on_plane};

/// How many times a px of the judged picture is enlarged at most where a leak is shown.
const ENLARGED: f32 = 8.0;
/// A leak is enlarged less if it would be larger than this part of the picture's height.
const OF_HEIGHT: f32 = 0.25;

/// Of a cracked edge a part is shown that is this many times as long as the gap.
const AROUND_GAP: f32 = 16.0;
/// The least part of the edge that is shown.
const LEAST_PART: f32 = 1.0 / 64.0;
/// A fold is shown with a part of the surface that is this many times as long, but at most this many times as wide as a fold that is a
/// needle, so that it is no hair.
const AROUND_FOLD: f32 = 4.0;
const AROUND_NEEDLE: f32 = 16.0;

/// The worst place that a gate found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Where it is and how bad it is there, as the end of a sentence.
    pub text: String,
    /// The mesh's triangles that it lies on.
    pub triangles: Vec<u32>,
    /// Its position in object units, and for leaks in px of the picture.
    #[serde(flatten)]
    pub spot: Spot,
}

/// What a camera is framed on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spot {
    /// A place on an edge.
    Edge(EdgeSpot),
    /// A place on a patch.
    Patch(PatchSpot),
    /// A leak of the judged picture: a px of it, from the picture's top left, how many px leak there, and the edge that is torn there
    /// if it is known.
    Leak { px: Vec2, pixels: u32, torn: Option<EdgeSpot> },
}

/// An edge: the positions of its ends, the direction that it faces, and the place on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeSpot {
    pub ends: [Vec3; 2],
    pub facing: Vec3,
    pub at: Vec3,
}

/// A patch, or a part of it: the place on it, the direction that it faces there, how long the part that is shown is, and whether its
/// back shows it as well as its front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchSpot {
    pub at: Vec3,
    pub facing: Vec3,
    pub size: f32,
    pub both_sides: bool,
}

impl Spot {
    /// The largest fold of a patch, with what is around it, or if it is a needle, its middle.
    pub fn fold(folded: &FoldedPatch) -> Self {
        let whole = PatchSpot::new(folded.largest, folded.place());
        let [a, b, c] = folded.largest;
        let width = (b - a).as_dvec3().cross((c - a).as_dvec3()).length() as f32 / whole.size;
        let size = (AROUND_FOLD * whole.size).min(AROUND_NEEDLE * width);
        Self::Patch(PatchSpot { size, both_sides: true, ..whole })
    }

    /// A camera that shows the spot if nothing hides it. `judged` is the camera of the judged picture, `viewport` that picture's
    /// size in px, and `bounds` are the mesh's.
    pub(super) fn camera(&self, judged: &Camera, viewport: Vec2, bounds: &Bounds) -> Camera {
        match *self {
            Self::Edge(edge) => edge.camera(judged, bounds),
            Self::Patch(PatchSpot { at, facing, size, .. }) => {
                let mut camera = moving(judged);
                camera.frame_at(at, size, facing, bounds);
                camera
            }
            Self::Leak { px, pixels, .. } => {
                let most = OF_HEIGHT * viewport.y / (pixels as f32).sqrt();
                look_closer(judged, px, viewport, bounds, ENLARGED.min(most.max(1.0)))
            }
        }
    }

    /// The position in object units; none for a leak at no known edge.
    pub fn at(&self) -> Option<Vec3> {
        match *self {
            Self::Edge(EdgeSpot { at, .. }) | Self::Patch(PatchSpot { at, .. }) => Some(at),
            Self::Leak { torn, .. } => Some(torn?.at),
        }
    }

    /// The px of a leak, from the top left of the judged picture; none for other places.
    pub fn px(&self) -> Option<Vec2> {
        if let Self::Leak { px, .. } = *self { Some(px) } else { None }
    }
}

impl PatchSpot {
    /// The whole of a patch with these corners, and a place on it.
    pub fn new([a, b, c]: [Vec3; 3], at: Vec3) -> Self {
        let facing = (b - a).as_dvec3().cross((c - a).as_dvec3()).normalize_or_zero().as_vec3();
        let size = a.distance(b).max(b.distance(c)).max(c.distance(a));
        Self { at, facing, size, both_sides: false }
    }
}

impl EdgeSpot {
    /// A place on the edge with this index. Without a position, it is the middle.
    pub fn new(topology: &Topology, index: u32, at: Option<Vec3>) -> Self {
        let edge = &topology.edges[index as usize];
        let ends = topology.edge_points(edge).map(|point| topology.points[point as usize]);
        let at = at.unwrap_or(ends[0] * 0.5 + ends[1] * 0.5);
        Self { ends, facing: topology.edge_facing(edge), at }
    }

    /// The part of the edge around a gap between these two positions, so large that one sees how wide the gap is, and from where it is
    /// widest.
    pub fn at_gap(self, [a, b]: [Vec3; 2]) -> Self {
        let (at, along) = (a * 0.5 + b * 0.5, self.ends[1] - self.ends[0]);
        let (gap, length) = (b - a, along.length());
        let across = gap.normalize_or_zero();
        let facing = (self.facing - across * self.facing.dot(across)).normalize_or(self.facing);
        let part = AROUND_GAP * gap.length() / length;
        if part.is_nan() || part >= 1.0 {
            return Self { facing, at, ..self };
        }
        let half = along * (0.5 * part.max(LEAST_PART));
        Self { ends: [at - half, at + half], facing, at }
    }

    /// A camera that faces the edge.
    pub(super) fn camera(&self, judged: &Camera, bounds: &Bounds) -> Camera {
        let (mut camera, [a, b]) = (moving(judged), self.ends);
        camera.frame_at(a * 0.5 + b * 0.5, a.distance(b), self.facing, bounds);
        camera
    }
}

/// A camera that can be moved: that of an engine's matrix would stay where it is.
fn moving(judged: &Camera) -> Camera {
    Camera { rows: None, ..*judged }
}

/// Written as `at`, three coordinates in object units, and `px`, two in px of the picture. `px` is null but for leaks, and `at` for leaks
/// at no known edge.
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
/// of a perspective camera stays, since a leak is seen from there alone. The picture of a camera that mirrors is mirrored, and its px are
/// those of the mirrored picture.
fn look_closer(judged: &Camera, px: Vec2, viewport: Vec2, bounds: &Bounds, enlarged: f32) -> Camera {
    let px = if judged.is_mirrored() { vec2(viewport.x - px.x, px.y) } else { px };
    let [right, up, _] = judged.axes();
    let view = ScreenView { clip_from_object: judged.clip_from_object(viewport, bounds), viewport };
    let at_target = [Vec3::ZERO, right, up].map(|beside| judged.target + beside * judged.distance);
    let (eye, seen) = (judged.eye(), seen_on_plane(&view, px, at_target).unwrap_or(judged.target));
    let half = (0.5 * judged.field_of_view).to_radians().tan() / enlarged;
    let field_of_view = (2.0 * half.atan().to_degrees()).max(*FIELDS_OF_VIEW.start());
    let camera = Camera { target: seen, field_of_view, ..moving(judged) };
    if judged.orthographic { camera } else { towards(&camera, eye - seen) }
}

/// The camera with its eye so far from its target.
pub(super) fn towards(camera: &Camera, eye_from_target: Vec3) -> Camera {
    let back = eye_from_target.normalize_or_zero();
    Camera {
        distance: eye_from_target.length(),
        azimuth: back.x.atan2(back.z).to_degrees().rem_euclid(360.0),
        elevation: back.y.clamp(-1.0, 1.0).asin().to_degrees(),
        ..*camera
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::view::project;

    #[test]
    fn a_leak_comes_into_the_middle_and_the_eye_stays() {
        let viewport = vec2(640.0, 480.0);
        let bounds = Bounds::new([Vec3::NEG_ONE, Vec3::ONE].into_iter());
        let place = Vec3::new(0.4, -0.3, 0.5);
        for orthographic in [false, true] {
            let judged = Camera { orthographic, ..Camera::framing(&bounds, viewport) };
            let seen = |camera: &Camera, place| project(camera.clip_from_object(viewport, &bounds), viewport, place);
            let px = seen(&judged, place).expect("in front of the eye");
            let leak = |pixels| Spot::Leak { px, pixels, torn: None };
            let camera = leak(4).camera(&judged, viewport, &bounds);
            let now = seen(&camera, place).expect("in front of the eye");
            assert!(now.distance(viewport * 0.5) < 0.5, "{now}");
            assert!(orthographic || camera.eye().distance(judged.eye()) < 1e-4, "{camera:?}");
            let beside = place + judged.axes()[0] * 0.01;
            let apart = |camera| seen(camera, place).zip(seen(camera, beside)).map_or(0.0, |(a, b)| a.distance(b));
            let enlarged = apart(&camera) / apart(&judged);
            assert!((enlarged - ENLARGED).abs() < 0.5, "{enlarged} times");
            // All of a leak that is a third as high as the picture is seen.
            let whole = leak(160 * 160).camera(&judged, viewport, &bounds);
            assert!((apart(&whole) / apart(&judged) - 1.0).abs() < 0.05, "{whole:?}");
        }
    }

    #[test]
    fn a_place_is_written_with_its_position_or_its_px() {
        let place = |spot| Place { text: "there".into(), triangles: vec![3], spot };
        let edge = EdgeSpot { ends: [Vec3::ZERO, Vec3::X], facing: Vec3::Z, at: Vec3::X * 0.5 };
        let written = serde_json::to_value(place(Spot::Edge(edge))).expect("JSON");
        let expected = serde_json::json!({ "text": "there", "triangles": [3], "at": [0.5, 0.0, 0.0], "px": null });
        assert_eq!(written, expected);
        for (torn, at) in [(None, serde_json::Value::Null), (Some(edge), serde_json::json!([0.5, 0.0, 0.0]))] {
            let leak = serde_json::to_value(place(Spot::Leak { px: vec2(3.0, 4.5), pixels: 2, torn })).expect("JSON");
            assert_eq!((&leak["at"], &leak["px"]), (&at, &serde_json::json!([3.0, 4.5])));
        }
    }
}
