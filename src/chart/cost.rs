//! What a setting costs: time, or triangles.

use super::Row;

/// What one pays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Cost {
    #[default]
    Ms,
    Triangles,
}

impl Cost {
    pub(crate) fn of(self, row: &Row) -> f64 {
        self.either(row.time.total(), row.triangles)
    }

    /// Of ms and triangles the one that it is.
    pub(crate) fn either(self, ms: f64, triangles: u64) -> f64 {
        match self {
            Self::Ms => ms,
            Self::Triangles => triangles as f64,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Ms => "Tessellation and drawing, ms",
            Self::Triangles => "Triangles",
        }
    }
}
