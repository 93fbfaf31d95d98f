//! The two costs of a setting: time, or triangles.

use super::Probe;

/// A cost of a setting: time in ms, or triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    #[default]
    Ms,
    Triangles,
}

impl Cost {
    pub fn of(self, probe: &Probe) -> f64 {
        match self {
            Self::Ms => probe.time.total(),
            Self::Triangles => probe.triangles as f64,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Ms => "Tessellation and drawing, ms",
            Self::Triangles => "Triangles",
        }
    }
}
