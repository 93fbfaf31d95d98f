//! What a tessellation did, measured on what was really emitted.

mod chart;
mod cracks;
mod picture;
mod sweep;

pub use chart::{CHART_RANGE, ChartError, sweep_chart};
pub use cracks::{CrackedEdge, Cracks, Rims, ulp};
pub use picture::{CompareError, Comparison, compare};
pub use sweep::{SWEEP_STEP, Sweep, SweepStep, sweep};
