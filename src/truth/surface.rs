//! What every kind of exact surface implements.

use glam::DVec3;

use super::{Nearest, Sample};

/// A surface that is known exactly: its nearest points, its extent, and a parametrisation by unit squares.
pub(super) trait Surface: Send + Sync {
    /// See [`super::Truth::closest_facing`].
    fn closest(&self, p: DVec3, facing: DVec3) -> Nearest;

    /// Least and greatest coordinates.
    fn extent(&self) -> [DVec3; 2];

    /// How many unit squares together parametrise the surface.
    fn charts(&self) -> usize;

    /// The point at `s` and `t` (0 to 1) of a chart, and the area of the surface there per unit of the square's area.
    fn at(&self, chart: usize, s: f64, t: f64) -> (Sample, f64);
}
