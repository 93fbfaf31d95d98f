//! The two costs of a setting: time, or triangles.

use super::Row;

/// A cost of a setting: time in ms, or triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    #[default]
    Ms,
    Triangles,
}

impl Cost {
    pub fn of(self, row: &Row) -> f64 {
        self.either(row.time.total(), row.triangles)
    }

    /// Returns `ms` or `triangles`, whichever this cost is.
    pub fn either(self, ms: f64, triangles: u64) -> f64 {
        match self {
            Self::Ms => ms,
            Self::Triangles => triangles as f64,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Ms => "Tessellation and drawing, ms",
            Self::Triangles => "Triangles",
        }
    }
}
