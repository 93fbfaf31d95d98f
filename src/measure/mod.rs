//! What a tessellation did, measured on what was really emitted.

mod cracks;
mod picture;

pub use cracks::{CrackedEdge, Cracks, Rims, ulp};
pub use picture::{CompareError, Comparison, compare};
