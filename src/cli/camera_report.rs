//! What `pnaen info` says about the cameras of a file.

use std::fmt;

use serde::Serialize;

use geometry::mesh::{FileCamera, Projection};
use geometry::names::shown;
use geometry::numbers::exact;

/// A camera in numbers.
#[derive(Clone, Debug, Serialize)]
pub(super) struct CameraInfo {
    pub name: String,
    /// `perspective` or `orthographic`.
    pub kind: &'static str,
    /// Vertical, in degrees; none for an orthographic camera.
    pub field_of_view: Option<f32>,
    /// The height that it shows, in object units; none for a perspective camera.
    pub height: Option<f32>,
    /// In object units.
    pub place: [f32; 3],
    /// The unit direction that it looks in.
    pub direction: [f32; 3],
}

impl CameraInfo {
    pub(super) fn new(camera: &FileCamera) -> Self {
        let (kind, field_of_view, height) = match camera.projection {
            Projection::Perspective(angle) => ("perspective", Some(angle.to_degrees()), None),
            Projection::Orthographic(half) => ("orthographic", None, Some(2.0 * half)),
        };
        let [_, _, back] = camera.axes;
        // Without the sign of zeros.
        let direction = back.to_array().map(|number| 0.0 - number);
        Self { name: camera.name.clone(), kind, field_of_view, height, place: camera.eye.into(), direction }
    }
}

impl fmt::Display for CameraInfo {
    /// Writes it on one line.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let numbers = |numbers: [f32; 3]| numbers.map(exact).join(" ");
        write!(f, "camera        {}: {}", shown(&self.name), self.kind)?;
        if let Some(angle) = self.field_of_view {
            write!(f, ", {} degrees high", exact(angle))?;
        }
        if let Some(height) = self.height {
            write!(f, ", {} high", exact(height))?;
        }
        writeln!(f, ", at {}, towards {}", numbers(self.place), numbers(self.direction))
    }
}
