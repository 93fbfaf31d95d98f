//! The isoline domain of Direct3D's tessellator: lines along U at equal distances in V.
//!
//! Source: D3D11.3 Functional Specification, section 11.7. Coordinates are 16.16 fixed point.

use super::domain_row::{domain_row, row_location};
use super::factors::{
    BITS_64, BITS_ONE, Partitioning, factor_lower_bound, factor_upper_bound, factor_word, positive_bits, segments,
};

/// Factors of isolines as the tessellator uses them: words like those of [`PatchFactors`](super::PatchFactors).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct IsolineFactors {
    /// The word of the number of isolines.
    pub density: u32,
    /// The word of the segments of each isoline.
    pub detail: u32,
}

impl IsolineFactors {
    /// Makes what the tessellator makes of the factors (section 11.7), or nothing if they cull the patch: if one isn't greater
    /// than zero.
    ///
    /// The density is clamped to 1 to 64 and rounded up, whatever the partitioning. The detail is clamped and rounded like
    /// an edge's factor. Partitionings that Direct3D doesn't have act as integer.
    pub fn new(partitioning: Partitioning, density: f32, detail: f32) -> Option<Self> {
        let [density, detail] = [density, detail].map(f32::to_bits);
        let (low, high) = (factor_lower_bound(partitioning), factor_upper_bound(partitioning).min(BITS_64));
        (positive_bits(density) && positive_bits(detail)).then(|| Self {
            density: factor_word(Partitioning::Integer, density.clamp(BITS_ONE, BITS_64)),
            detail: factor_word(partitioning, detail.clamp(low, high)),
        })
    }

    /// Returns (U, V) of all domain points, in 16.16 fixed point, isoline by isoline. There is no isoline at V == 1, so that
    /// patches side by side don't draw it twice.
    pub fn points(&self) -> Vec<[u32; 2]> {
        let (across, along) = (domain_row(self.density), domain_row(self.detail));
        let isolines = (0..segments(self.density)).map(|isoline| row_location(across, isoline));
        isolines.flat_map(|v| along.locations().map(move |u| [u, v])).collect()
    }

    /// Returns the ends of all lines, as point numbers.
    pub fn lines(&self) -> Vec<[u32; 2]> {
        let points = segments(self.detail) + 1;
        let starts = (0..segments(self.density)).map(|isoline| isoline * points);
        starts.flat_map(|start| (start..start + points - 1).map(|point| [point, point + 1])).collect()
    }
}

#[cfg(test)]
mod tests;
