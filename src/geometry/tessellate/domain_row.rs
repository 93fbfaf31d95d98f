//! Rows of points: where the points of an edge, or of a side of a ring, lie between its ends. Twin: `shaders/domain_row.wgsl`.
//!
//! Source: D3D11.3 Functional Specification, sections 11.7.5 to 11.7.14. Coordinates are 16.16 fixed point.

use super::factors::{FIXED_HALF, FIXED_ONE, half_factor, half_segments, odd_parity};

/// A row of points, prepared for [`row_location`].
///
/// It is a blend of two uniform rows: the one with the whole part of `half_factor` segments in each half, and the one
/// with one segment more in each half. `fraction` is the weight of the finer row, in 16.16 fixed point. Its new point
/// grows out of point `split` of each half.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DomainRow {
    /// Segments in half the row, rounded up.
    pub(super) half: u32,
    /// 1 if the row has an odd number of segments, else 0.
    pub(super) odd: u32,
    fraction: u32,
    split: u32,
    /// The lengths of a segment of both uniform rows, in 16.16 fixed point.
    coarse_step: u32,
    fine_step: u32,
}

impl DomainRow {
    /// Returns where all points lie, in order: see [`row_location`].
    pub(super) fn locations(self) -> impl Iterator<Item = u32> {
        (0..=2 * self.half - self.odd).map(move |p| row_location(self, p))
    }
}

/// Returns the length of one of `segments` equal segments in 16.16 fixed point: 1 / segments, rounded half up. There
/// are at most 128 segments.
///
/// It is the integer part of an f32 quotient, since GPUs divide f32 numbers many times faster than integers. The 0.5
/// that is added keeps the quotient further from integers than the 2.5 ULP by which WGSL lets it be wrong.
pub(super) fn segment_length(segments: u32) -> u32 {
    (((2 * FIXED_ONE + segments) as f32 + 0.5) / (2 * segments) as f32) as u32
}

/// Clears the highest set bit of a number, which must not be zero.
fn drop_top_bit(value: u32) -> u32 {
    value ^ (1 << value.ilog2())
}

/// Returns the point of each half after which the next new point grows. New points come in the order of a breadth-first
/// bisection.
fn row_split(whole: u32, odd: u32) -> u32 {
    let v = whole - odd;
    if v == 0 { 0 } else { 2 * drop_top_bit(v) + 1 }
}

/// Prepares the row of a factor's word.
pub(crate) fn domain_row(word: u32) -> DomainRow {
    let factor = half_factor(word);
    let whole = factor >> 16;
    let odd = odd_parity(word);
    let fraction = factor & 0xffff;
    let half = half_segments(word);
    DomainRow {
        half,
        odd,
        fraction,
        split: if fraction == 0 { u32::MAX } else { row_split(whole, odd) },
        coarse_step: segment_length(2 * whole - odd),
        fine_step: segment_length(2 * half - odd),
    }
}

/// Returns where point `p` of a row lies, from 0 to 1 in 16.16 fixed point. Rows are symmetric to the last bit.
pub(crate) fn row_location(row: DomainRow, p: u32) -> u32 {
    if row.odd == 0 && p == row.half {
        return FIXED_HALF;
    }
    let mirrored = p >= row.half;
    let fine = if mirrored { 2 * row.half - row.odd - p } else { p };
    let coarse = if fine > row.split { fine - 1 } else { fine };
    let coarse_part = coarse * row.coarse_step * (FIXED_ONE - row.fraction);
    let fine_part = fine * row.fine_step * row.fraction;
    let x = (coarse_part + fine_part + FIXED_HALF) >> 16;
    if mirrored { FIXED_ONE - x } else { x }
}

/// Returns where point `p` of a row of so many equal segments, at most 127, lies: as [`row_location`] of a whole factor. `step` is
/// the [`segment_length`].
pub(super) fn whole_location(segments: u32, step: u32, p: u32) -> u32 {
    if 2 * p == segments {
        return FIXED_HALF;
    }
    if 2 * p > segments { FIXED_ONE - (segments - p) * step } else { p * step }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_equal_segments_lie_where_those_of_whole_factors_do() {
        for segments in 1..=127 {
            let row = domain_row(segments << 16 | segments << 31);
            let step = segment_length(segments);
            for p in 0..=segments {
                assert_eq!(whole_location(segments, step, p), row_location(row, p), "point {p} of {segments}");
            }
        }
    }
}
