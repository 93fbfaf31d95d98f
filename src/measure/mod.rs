//! What a tessellation did, measured on what was really emitted.

mod accuracy;
mod agreement;
mod chart;
mod cracks;
mod deviation;
mod field;
mod folds;
mod indices;
mod picture;
mod rims;
mod sheet;
mod sizes;
mod survey;
mod sweep;

pub use accuracy::{Accuracy, AccuracyOptions, Angles, Distances, Measurement, Place};
pub use agreement::{Agreement, Disagreement, Order};
pub use chart::sweep_chart;
pub use cracks::{CrackedEdge, Cracks, ulp, ulp_at};
pub use deviation::{Deviant, Deviation};
pub use field::{Against, Field, MOST_TRIANGLES, Yardstick};
pub use indices::{IndexDifference, Meaning, index_differences};
pub use picture::{CompareError, Comparison, compare};
pub use rims::{AskedFactors, EdgeSide, RimPoint, Rims, patch_edges};
pub use sheet::sheet;
pub use sizes::{SMALL_PX, ScreenView, Sizes};
pub use survey::{Culled, Measured, Survey};
pub use sweep::{SWEEP_STEP, Sweep, SweepStep, sweep};
