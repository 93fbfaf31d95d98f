//! What a setting costs: time, or triangles.

use super::Row;

/// What one pays.
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

    /// Of ms and triangles the one that it is.
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
