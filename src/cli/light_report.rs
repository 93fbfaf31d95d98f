//! What `pnaen info` says about the lights of a file.

use std::fmt;

use serde::Serialize;

use geometry::mesh::{Light, LightKind};
use geometry::numbers::exact;

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
        let numbers = |numbers: [f32; 3]| numbers.map(exact).join(" ");
        let unit = if self.kind == "directional" { "lx" } else { "cd" };
        write!(f, "light         {}, {} {unit}", self.kind, numbers(self.intensity))?;
        if let Some(place) = self.place {
            write!(f, ", at {}", numbers(place))?;
        }
        if let Some(direction) = self.direction {
            write!(f, ", towards {}", numbers(direction))?;
        }
        if let Some(range) = self.range {
            write!(f, ", up to {}", exact(range))?;
        }
        if let Some([inner, outer]) = self.cone {
            write!(f, ", cone {} to {} degrees", exact(inner), exact(outer))?;
        }
        writeln!(f)
    }
}
