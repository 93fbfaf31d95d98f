//! What a tessellation did, measured on what was really emitted.

mod cracks;
mod folds;
mod picture;
mod rims;
mod survey;

pub use cracks::{CrackedEdge, Cracks, ulp};
pub use picture::{CompareError, Comparison, compare};
pub use rims::{AskedFactors, EdgeSide, RimPoint, Rims};
pub use survey::{Measured, Survey};
