//! What every kind of exact surface implements.

use glam::DVec3;

use super::{Nearest, Sample};

/// A surface that is known exactly: its nearest points, its extent, and a parametrisation by charts over unit squares.
pub(super) trait Surface: Send + Sync {
    /// Returns the point nearest to `p`: of several, one whose normal faces as `facing` does.
    fn closest(&self, p: DVec3, facing: DVec3) -> Nearest;

    /// Returns the least and the greatest coordinates.
    fn extent(&self) -> [DVec3; 2];

    /// Returns the number of charts.
    fn charts(&self) -> usize {
        1
    }

    /// Returns the point at `s` and `t` (0 to 1) of a chart, and the surface's area there per area of the unit square.
    fn at(&self, chart: usize, s: f64, t: f64) -> (Sample, f64);

    /// Returns lengths that the second derivatives by s twice, by s and t, and by t twice nowhere exceed in a chart.
    fn bends(&self, chart: usize) -> [f64; 3];
}
