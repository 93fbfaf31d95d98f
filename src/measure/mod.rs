//! Measurements on what a tessellation emitted. They return edges, points and numbers, and draw nothing.

mod accuracy;
mod agreement;
mod asked_factors;
mod cracks;
mod deviation_field;
mod folds;
mod indices;
mod outlines;
mod screen_error;
mod sizes;
mod survey;
mod sweep;
mod visitor;

pub use accuracy::{Accuracy, AccuracyMeasurement, AccuracyOptions, Angles, Distances, WorstPoint};
pub use agreement::{Agreement, Disagreement, Order};
pub use asked_factors::AskedFactors;
pub use cracks::{CrackedEdge, Cracks};
pub use deviation_field::{DeviationField, DeviationMeasurement, DeviationTarget, MOST_TRIANGLES};
pub use indices::{IndexDifference, Meaning, index_differences};
pub use outlines::{EdgeSide, OutlinePoint, Outlines, patch_edges};
pub use screen_error::{ScreenError, ScreenErrorMeasurement};
pub use sizes::{SMALL_PX, Sizes};
pub use survey::{Culled, Measured, Survey};
pub use sweep::{SWEEP_STEP, Sweep, SweepStep, sweep};
pub use visitor::{EmittedChunk, Visitor};
