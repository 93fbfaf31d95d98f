//! Counts of the corners that were repaired while a mesh was built.

use serde::Serialize;

/// Numbers of triangle corners that were repaired. A corner that six triangles use counts six times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Repairs {
    /// Corners without a normal, which got a smooth one.
    pub normals_made: u32,
    /// Corners whose normal was zero or not finite, which got a smooth one.
    pub normals_replaced: u32,
    /// Corners whose normal was scaled to unit length.
    pub normals_rescaled: u32,
    /// Corners with a coordinate below f32's smallest normal number, about 1.2e-38, which became 0.
    pub denormals: u32,
}

impl Repairs {
    /// Adds what was repaired in other corners.
    pub(crate) fn add(&mut self, other: &Self) {
        self.normals_made += other.normals_made;
        self.normals_replaced += other.normals_replaced;
        self.normals_rescaled += other.normals_rescaled;
        self.denormals += other.denormals;
    }
}
