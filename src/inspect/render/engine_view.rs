//! Cameras of engines' frames, from their matrices.

use super::Camera;
use super::view_projection::{ViewProjection, ViewProjectionError};
use geometry::mesh::{Bounds, FileCamera, Projection};

impl Camera {
    /// The camera of an engine's frame, of a mesh with these bounds. Its angles and its distance are those of the nearest camera of
    /// ours: they turn the lights of the camera, and say how large a px is.
    ///
    /// # Errors
    /// The matrix isn't that of a view.
    pub fn from_matrix(matrix: &ViewProjection, bounds: &Bounds) -> Result<Self, ViewProjectionError> {
        let rows = matrix.rows()?;
        let axes = rows.axes();
        let (eye, projection) = match rows.eye {
            Some(eye) => (eye, Projection::Perspective(2.0 * rows.half_height().atan())),
            None => {
                let middle = rows.middle_beside(bounds.center()).ok_or(ViewProjectionError::Singular)?;
                let eye = middle + axes[2] * bounds.radius().max(f32::MIN_POSITIVE);
                (eye, Projection::Orthographic(rows.half_height()))
            }
        };
        let file = FileCamera { name: String::new(), eye, axes, projection };
        let camera = Self { rows: Some(rows), ..Self::from_file(&file, bounds) };
        if camera.is_sound() { Ok(camera) } else { Err(ViewProjectionError::TooFar) }
    }
}

#[cfg(test)]
mod tests;
