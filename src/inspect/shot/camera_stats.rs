//! The part of stats about the camera: the matrix that a picture was drawn with, as `--view-projection` takes it.

use glam::Vec4;
use serde::Serialize;

use crate::render::Camera;
use geometry::mesh::Bounds;

/// A camera in numbers.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ViewStats {
    /// `perspective` or `orthographic`.
    kind: &'static str,
    /// In object units; none in an orthographic view.
    eye: Option<[f32; 3]>,
    /// The unit direction that it looks in.
    direction: [f32; 3],
    /// The size of the picture, in px.
    viewport: [u32; 2],
    /// From object units to clip space, listed as `matrix_order` says.
    view_projection: [f32; 16],
    matrix_order: &'static str,
    depth: &'static str,
    clip_y: &'static str,
}

impl ViewStats {
    /// The camera that draws a picture of a mesh with these bounds.
    pub(super) fn new(camera: &Camera, viewport: [u32; 2], bounds: &Bounds) -> Self {
        let mut matrix = camera.clip_from_object(viewport.map(|side| side as f32).into(), bounds);
        if camera.is_mirrored() {
            // What was drawn was mirrored afterwards.
            matrix = glam::Mat4::from_diagonal(Vec4::new(-1.0, 1.0, 1.0, 1.0)) * matrix;
        }
        let [_, _, back] = camera.axes();
        // Without the sign of zeros.
        let unsigned = |number: f32| 0.0 + number;
        Self {
            kind: if camera.orthographic { "orthographic" } else { "perspective" },
            eye: (!camera.orthographic).then(|| camera.eye().to_array()),
            direction: back.to_array().map(|number| unsigned(-number)),
            viewport,
            view_projection: matrix.to_cols_array().map(unsigned),
            matrix_order: "column-major",
            depth: "reversed",
            clip_y: "up",
        }
    }
}
