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
        let parts = [
            self.place.map(|place| format!(", at {}", numbers(place))),
            self.direction.map(|direction| format!(", towards {}", numbers(direction))),
            self.range.map(|range| format!(", up to {}", exact(range))),
            self.cone.map(|cone| format!(", cone {} degrees", cone.map(exact).join(" to "))),
        ];
        writeln!(f, "{}", parts.into_iter().flatten().collect::<String>())
    }
}
