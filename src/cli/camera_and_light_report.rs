//! What `pnaen info` says about the cameras and the lights of a file.

use std::fmt;

use serde::Serialize;

use super::material_report::numbers;
use geometry::mesh::{FileCamera, Light, LightKind, Projection};
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
        write!(f, "camera        {}: {}", shown(&self.name), self.kind)?;
        if let Some(angle) = self.field_of_view {
            write!(f, ", {} degrees high", exact(angle))?;
        }
        if let Some(height) = self.height {
            write!(f, ", {} high", exact(height))?;
        }
        writeln!(f, ", at {}, towards {}", numbers(&self.place), numbers(&self.direction))
    }
}

/// A light in numbers.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LightInfo {
    /// `directional`, `point` or `spot`.
    pub kind: &'static str,
    /// Linear RGB in cd; of a directional light in lx.
    pub intensity: [f32; 3],
    /// In object units; none for a directional light.
    pub place: Option<[f32; 3]>,
    /// The unit direction that it shines in; none for a point light.
    pub direction: Option<[f32; 3]>,
    /// The distance at which it ends, in object units.
    pub range: Option<f32>,
    /// The inner and the outer angle of a spot light's cone from its direction, in degrees.
    pub cone: Option<[f32; 2]>,
}

impl LightInfo {
    pub(super) fn new(light: &Light) -> Self {
        let (kind, range, cone) = match light.kind {
            LightKind::Directional => ("directional", None, None),
            LightKind::Point { range } => ("point", range, None),
            LightKind::Spot { range, inner, outer } => ("spot", range, Some([inner, outer].map(f32::to_degrees))),
        };
        Self {
            kind,
            intensity: light.intensity.into(),
            place: (light.kind != LightKind::Directional).then(|| light.place.into()),
            direction: (kind != "point").then(|| light.direction.into()),
            range,
            cone,
        }
    }
}

impl fmt::Display for LightInfo {
    /// Writes it on one line.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let unit = if self.kind == "directional" { "lx" } else { "cd" };
        write!(f, "light         {}, {} {unit}", self.kind, numbers(&self.intensity))?;
        let parts = [
            self.place.map(|place| format!(", at {}", numbers(&place))),
            self.direction.map(|direction| format!(", towards {}", numbers(&direction))),
            self.range.map(|range| format!(", up to {}", exact(range))),
            self.cone.map(|cone| format!(", cone {} degrees", cone.map(exact).join(" to "))),
        ];
        writeln!(f, "{}", parts.into_iter().flatten().collect::<String>())
    }
}
