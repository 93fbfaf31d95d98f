//! The quad domain of Direct3D's tessellator: which points and triangles a patch over the unit square has.
//!
//! The patch consists of an outline of four edge rows, and of rings inside, which are numbered inwards from 1. Side 0 of a ring
//! runs along U == 0 from V == 1 down, side 1 along V == 0, side 2 along U == 1, and side 3 along V == 1 back. Rings are cut from
//! two rows, one along U and one along V. If the shorter one has an even number of segments, the last ring has collapsed to a
//! row of points; if it has an odd number, a strip of one segment's width is left in the last ring. Edges, and the triangles
//! between them and the first ring, are those of the triangle domain.
//!
//! Source: D3D11.3 Functional Specification, section 11.7. Coordinates are 16.16 fixed point.

use super::domain::transition_step;
use super::domain_row::domain_row;
use super::factors::{
    BITS_64, BITS_ONE_AND_HALF_STEP, BITS_ONE_AND_STEP, FACTOR_ODD, FACTOR_VALUE, FIXED_ONE, Partitioning,
    factor_lower_bound, factor_upper_bound, factor_word, inside_word, positive_bits, segments,
};
use super::rings::TransitionStep;

/// A quad's factors as the tessellator uses them: words like those of [`PatchFactors`](super::PatchFactors).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct QuadFactors {
    /// The words of the edges U == 0, V == 0, U == 1 and V == 1.
    pub outside: [u32; 4],
    /// The words of the inside along U and along V.
    pub inside: [u32; 2],
}

impl QuadFactors {
    /// Makes what the tessellator makes of a quad's factors (section 11.7), or nothing if they cull it. `edges` are the factors
    /// of the edges U == 0, V == 0, U == 1 and V == 1, and `inside` those along U and along V.
    ///
    /// The patch is culled if an edge's factor isn't greater than zero. Factors are clamped to what the partitioning allows
    /// and rounded to fixed point. Inside factors never cull: NaN and too small numbers act as the smallest factor.
    /// Partitionings that Direct3D doesn't have act as integer.
    pub fn new(partitioning: Partitioning, edges: [f32; 4], inside: [f32; 2]) -> Option<Self> {
        let edges = edges.map(f32::to_bits);
        if !edges.into_iter().all(positive_bits) {
            return None;
        }
        let low = factor_lower_bound(partitioning);
        let high = factor_upper_bound(partitioning).min(BITS_64);
        let edges = edges.map(|bits| bits.clamp(low, high));
        let inside = inside.map(f32::to_bits).map(|bits| if positive_bits(bits) { bits } else { 0 });
        // An odd patch with any divided side needs a ring inside, though it may have collapsed to the outline.
        let is_divided = edges.into_iter().chain(inside).any(|bits| bits > BITS_ONE_AND_HALF_STEP);
        let needs_ring = partitioning == Partitioning::FractionalOdd && is_divided;
        let inside_low = if needs_ring { BITS_ONE_AND_STEP } else { low };
        Some(Self {
            outside: edges.map(|bits| factor_word(partitioning, bits)),
            inside: inside.map(|bits| inside_word(partitioning, bits.clamp(inside_low, high))),
        })
    }

    /// Whether all factors are 1, so that the patch is two triangles.
    fn is_minimal(&self) -> bool {
        let edges_are_one = self.outside == [FACTOR_ODD | FIXED_ONE; 4];
        edges_are_one && self.inside.iter().all(|word| word & FACTOR_VALUE == FIXED_ONE)
    }

    /// Returns (U, V) of all domain points, in 16.16 fixed point and in the tessellator's order.
    pub fn points(&self) -> Vec<[u32; 2]> {
        if self.is_minimal() {
            return vec![[0, 0], [FIXED_ONE, 0], [FIXED_ONE, FIXED_ONE], [0, FIXED_ONE]];
        }
        let mut points = Vec::new();
        for (side, word) in self.outside.into_iter().enumerate() {
            let along: Vec<_> = domain_row(word).locations().collect();
            push_side(&mut points, side, &along, if side < 2 { 0 } else { FIXED_ONE });
        }
        let [u, v] = self.inside.map(|word| domain_row(word).locations().collect::<Vec<_>>());
        for ring in 1..=(u.len().min(v.len()) - 1) / 2 {
            let (end_u, end_v) = (u.len() - 1 - ring, v.len() - 1 - ring);
            let along = [&v[ring..=end_v], &u[ring..=end_u]];
            let across = [u[ring], v[ring], u[end_u], v[end_v]];
            // Of a row that a ring has collapsed to, one of the first two sides has all points but the last, the other none.
            let is_row = ring == end_u || ring == end_v;
            for side in 0..if is_row { 2 } else { 4 } {
                push_side(&mut points, side, along[side % 2], across[side]);
            }
            if is_row {
                points.push([u[end_u], v[ring]]);
            }
        }
        points
    }

    /// Returns the corners of all triangles, as point numbers, clockwise where U points right and V down, in the tessellator's
    /// order.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        if self.is_minimal() {
            return vec![[0, 1, 3], [1, 2, 3]];
        }
        let mut triangles = Vec::new();
        let rows = self.inside.map(domain_row);
        let [u, v] = self.inside.map(segments);
        let mut around = Ring { start: 0, sides: self.outside.map(segments) };
        for number in 1..=u.min(v) / 2 {
            let (along_u, along_v) = (u - 2 * number, v - 2 * number);
            let ring = Ring { start: around.start + around.first(4), sides: [along_v, along_u, along_v, along_u] };
            for side in 0..4 {
                let (inner, outer) = (ring.first(side), around.first(side));
                for t in 0..ring.sides[side] + around.sides[side] {
                    let step = if number == 1 {
                        transition_step(rows[(side + 1) % 2], ring.sides[side], self.outside[side], t)
                    } else {
                        regular_step(ring.sides[side], t)
                    };
                    triangles.push(step.triangle(|p| ring.point(inner + p), |p| around.point(outer + p)));
                }
            }
            around = ring;
        }
        if u.min(v) % 2 == 1 {
            // The strip's long sides are sides 0 and 2, or if U is longer, 1 and 3. The second runs backwards.
            let side = usize::from(u > v);
            let (first, last, length) = (side as u32, around.first(4) - 1 + side as u32, around.sides[side]);
            let middle = (side == 0 && v % 2 == 1).then_some(length / 2);
            let steps = (0..2 * length).map(|t| strip_step(middle, t));
            let triangle =
                |step: TransitionStep| step.triangle(|p| around.point(last - p), |p| around.point(first + p));
            triangles.extend(steps.map(triangle));
        }
        triangles
    }
}

/// Adds the points of a ring's side, without the last, which is the first of the next side. `along` are the places of all of
/// them from the least to the greatest, and `across` is the place that they share.
fn push_side(points: &mut Vec<[u32; 2]>, side: usize, along: &[u32], across: u32) {
    let place = |&x: &u32| if side % 2 == 1 { [x, across] } else { [across, x] };
    let last = along.len() - 1;
    match side {
        0 | 3 => points.extend(along[1..].iter().rev().map(place)),
        _ => points.extend(along[..last].iter().map(place)),
    }
}

/// The numbers of a ring's points: of the outline, of a closed ring, or of a row that a ring has collapsed to.
#[derive(Clone, Copy, Debug)]
struct Ring {
    /// The number of the first point.
    start: u32,
    /// The segments of the four sides. Those of a row have none on its short sides.
    sides: [u32; 4],
}

impl Ring {
    /// Returns where a side begins on the way around the ring. Side 4 is the end.
    fn first(&self, side: usize) -> u32 {
        self.sides[..side].iter().sum()
    }

    /// Returns the number of the point that is reached after `p` segments around the ring; around a row that is there and back.
    fn point(&self, p: u32) -> u32 {
        let length = self.first(4);
        self.start + if self.sides.contains(&0) { p.min(length - p) } else { p % length }
    }
}

/// Returns triangle `t` between a side of a ring, with this many segments, and the side of the ring around it, which has two
/// more. From the middle on, diagonals are mirrored.
fn regular_step(inner_segments: u32, t: u32) -> TransitionStep {
    let is_odd = t % 2 == 1;
    if t > 2 * inner_segments.div_ceil(2) && t != 2 * inner_segments + 1 {
        return TransitionStep { inner: (t - 1) / 2, outer: t / 2 + 1, along_inner: !is_odd, inner_first: true };
    }
    // The last triangle has a segment of the outer side, like the first.
    let along_inner = is_odd && t != 2 * inner_segments + 1;
    TransitionStep { inner: t / 2, outer: t.div_ceil(2), along_inner, inner_first: false }
}

/// Returns triangle `t` of the strip in the last ring. If it has a middle segment (and both numbers of segments inside are odd),
/// the diagonal there is turned.
fn strip_step(middle: Option<u32>, t: u32) -> TransitionStep {
    let (segment, is_second) = (t / 2, t % 2);
    if middle == Some(segment) {
        return TransitionStep {
            inner: segment + is_second,
            outer: segment,
            along_inner: is_second == 0,
            inner_first: false,
        };
    }
    let inner_first = middle.is_none() || is_second == 1;
    TransitionStep { inner: segment, outer: segment + is_second, along_inner: is_second == 1, inner_first }
}

#[cfg(test)]
mod tests;
