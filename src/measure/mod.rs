//! Measurements on what a tessellation emitted. They return edges, points and numbers, and draw nothing.

mod accuracy;
mod agreement;
mod asked_factors;
mod cracks;
mod deviation_field;
mod distance_transform;
mod folds;
mod indices;
mod mapped_normals;
pub(crate) mod optimum;
mod outlines;
mod points_agreement;
mod screen_error;
mod seams;
mod silhouette;
mod sizes;
mod survey;
mod sweep;
mod visitor;

pub(crate) use accuracy::{Accuracy, AccuracyMeasurement, AccuracyOptions, Angles, Distances, Sampling, WorstPoint};
pub(crate) use agreement::{Agreement, Disagreement, Order};
pub(crate) use asked_factors::AskedFactors;
pub(crate) use cracks::{CrackedEdge, Cracks};
pub(crate) use deviation_field::{DeviationField, DeviationMeasurement, DeviationTarget, MOST_TRIANGLES};
pub(crate) use folds::FoldedPatch;
pub(crate) use indices::{IndexDifference, Meaning, index_differences};
pub(crate) use outlines::{EdgeSide, patch_edges};
pub(crate) use points_agreement::{PointsAgreement, PointsDisagreement};
pub(crate) use screen_error::{PatchesAbove, ScreenError, ScreenErrorMeasurement};
pub(crate) use seams::{SeamTurns, Seams};
pub(crate) use silhouette::{OutlineDistance, OutlineDistances, OutlineOf, SampleGrid, Silhouette};
pub(crate) use sizes::{SMALL_PX, Sizes};
pub(crate) use survey::{Culled, Measured, Survey};
pub(crate) use sweep::{SWEEP_STEP, Sweep, SweepStep, sweep};
pub(crate) use visitor::{EmittedChunk, Visitor};
