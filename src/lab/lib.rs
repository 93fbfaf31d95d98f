//! What takes many runs: comparisons with other programs' meshes, charts, stability, galleries, and checks of folders.

pub mod chart;
pub mod check;
pub mod compare;
pub mod gallery;
pub mod stability;
