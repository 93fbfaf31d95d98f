//! The two costs of a setting: time, or triangles.

use super::{Probe, Row};

/// A cost of a setting: time in ms, or triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    #[default]
    Ms,
    Triangles,
}

impl Cost {
    pub fn of(self, row: &Row) -> f64 {
        self.of_probe(&row.probe)
    }

    pub fn of_probe(self, probe: &Probe) -> f64 {
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
