//! Domain points and triangles of a patch. Each is computed from its number alone, without a walk over the patch, so
//! that a GPU can compute every vertex and every triangle in an invocation of its own. Twin: `shaders/domain.wgsl`.
//!
//! The patch consists of an outline of three edge rows, and of rings inside. Rings are numbered inwards from 1; each
//! has three sides of equal numbers of segments, which are all cut from one row, the inside row. A ring's side `k` ends
//! on the first point of the next side. If the number of segments inside is even, the last ring is a single point, the
//! centre. If it is odd, the last ring is a triangle. Other patterns are in `subtriangulation.rs` and `rows.rs`.
//!
//! Source: D3D11.3 Functional Specification, sections 11.7.5 to 11.7.14. Coordinates are 16.16 fixed point.

use super::connectivity::{regular_triangle, transition_before_middle};
use super::domain_row::{DomainRow, domain_row, row_location};
use super::factors::{
    FIXED_HALF, FIXED_ONE, PatchFactors, half_segments, inside_segments, odd_parity, patch_has_rows, patch_is_minimal,
    patch_is_subtriangulated, segments,
};
use super::rings::{TransitionStep, ring_point, rings_before};
use super::rows::{numbered_rows, row_plan, row_point, row_triangle, row_triangle_places};
use super::subtriangulation::{subtriangulation_point, subtriangulation_triangle};

/// Two thirds in 16.16 fixed point, rounded down as in the specification.
pub const FIXED_TWO_THIRDS: u32 = 0xaaaa;

/// The pattern in which a patch is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PatternKind {
    /// An outline with rings inside.
    Rings,
    /// One triangle.
    Minimal,
    Subtriangulated,
    Rows,
}

/// A patch's factors, prepared for [`domain_point`] and [`domain_triangle`].
#[derive(Clone, Copy, Debug)]
pub struct DomainPlan {
    factors: PatchFactors,
    kind: PatternKind,
    /// The numbers of the first points of the second and of the third edge.
    start1: u32,
    start2: u32,
    /// The number of points on the outline.
    outer: u32,
    /// The number of segments inside.
    n: u32,
    /// The inside row, from which rings are cut.
    row: DomainRow,
}

/// Prepares the pattern of a patch that isn't culled.
pub fn domain_plan(factors: PatchFactors) -> DomainPlan {
    let row = domain_row(factors.inside);
    let start1 = segments(factors.outside[0]);
    let start2 = start1 + segments(factors.outside[1]);
    let outer = start2 + segments(factors.outside[2]);
    let rings = DomainPlan {
        factors,
        kind: PatternKind::Rings,
        start1,
        start2,
        outer,
        n: inside_segments(factors.inside),
        row,
    };
    if patch_is_subtriangulated(factors) {
        return DomainPlan { kind: PatternKind::Subtriangulated, n: segments(factors.inside), ..rings };
    }
    if patch_has_rows(factors) {
        return DomainPlan { kind: PatternKind::Rows, ..rings };
    }
    if patch_is_minimal(factors) { DomainPlan { kind: PatternKind::Minimal, ..rings } } else { rings }
}

/// Returns (U, V) of domain point `i`, below `point_count(factors)`, in 16.16 fixed point; W = 1 - U - V.
pub fn domain_point(plan: &DomainPlan, i: u32) -> [u32; 2] {
    if plan.kind == PatternKind::Subtriangulated {
        return subtriangulation_point(plan.n, i);
    }
    if i < plan.outer {
        return outer_point(plan, i);
    }
    if plan.kind == PatternKind::Rows {
        return row_point(&numbered_rows(plan.factors), i - plan.outer);
    }
    inner_point(plan.row, plan.n, i - plan.outer)
}

/// Returns point `i` of the outline, which starts at V == 1 with the edge U == 0. Each edge's last point is the next
/// one's first.
fn outer_point(plan: &DomainPlan, i: u32) -> [u32; 2] {
    // Choose the row first, so that on a GPU the points of all three edges take the same branch.
    let side = u32::from(i >= plan.start1) + u32::from(i >= plan.start2);
    let word = plan.factors.outside[side as usize];
    let p = match side {
        0 => plan.start1 - i,
        1 => i - plan.start1,
        _ => plan.outer - i,
    };
    let x = row_location(domain_row(word), p);
    match side {
        0 => [0, x],
        1 => [x, 0],
        _ => [x, FIXED_ONE - x],
    }
}

/// Returns point `i` of the rings inside, which are cut from `row` with `n` segments.
fn inner_point(row: DomainRow, n: u32, i: u32) -> [u32; 2] {
    let rings = rings_before(n - 1, i / 3);
    let ring = rings + 1;
    let side_length = n - 2 * ring;
    if side_length == 0 {
        return [0x5555, 0x5555];
    }
    let in_ring = i - 3 * rings * (n - 1 - rings);
    let side = u32::from(in_ring >= side_length) + u32::from(in_ring >= 2 * side_length);
    let p = in_ring - side * side_length;

    let across = (row_location(row, ring) * FIXED_TWO_THIRDS + FIXED_HALF) >> 16;
    let along = row_location(row, if side == 1 { ring + p } else { n - ring - p }) - ((across + 1) >> 1);
    match side {
        0 => [across, along],
        1 => [along, across],
        _ => [along, FIXED_ONE - along - across],
    }
}

/// Returns the corners of triangle `t`, below `triangle_count(factors)`, as point numbers, clockwise.
pub fn domain_triangle(plan: &DomainPlan, t: u32) -> [u32; 3] {
    match plan.kind {
        PatternKind::Minimal => return [0, 1, 2],
        PatternKind::Subtriangulated => return subtriangulation_triangle(plan.n, t),
        PatternKind::Rows => return row_triangle(&numbered_rows(plan.factors), t),
        PatternKind::Rings => {}
    }
    let transition = plan.outer + 3 * (plan.n - 2);
    if t < transition { transition_triangle(plan, t) } else { regular_triangle(plan.outer, plan.n, t - transition) }
}

/// Returns (U, V) of the corners of triangle `t`, in 16.16 fixed point. Those of rows are counted in another order than that of
/// [`domain_triangle`].
pub(crate) fn domain_triangle_places(plan: &DomainPlan, t: u32) -> [[u32; 2]; 3] {
    if plan.kind == PatternKind::Rows {
        return row_triangle_places(&row_plan(plan.factors), t);
    }
    domain_triangle(plan, t).map(|i| domain_point(plan, i))
}

/// Returns triangle `t` between an edge and the first ring. The second half of a side mirrors the first.
pub(super) fn transition_step(row: DomainRow, inner_segments: u32, edge: u32, t: u32) -> TransitionStep {
    let inner_half = row.half - row.odd;
    let outer_half = half_segments(edge) - odd_parity(edge);
    let outer_segments = segments(edge);
    let total = inner_segments + outer_segments;
    let before = inner_half - 1 + outer_half;
    let after_middle = t + before >= total;
    if t >= before && !after_middle {
        // In the middle there is a triangle if the inside is odd, then one if the edge is odd.
        let along_inner = t == before && row.odd == 1;
        return TransitionStep {
            inner: inner_half - 1 + (t - before),
            outer: outer_half,
            along_inner,
            inner_first: true,
        };
    }
    let step = transition_before_middle(inner_half, outer_half, if after_middle { total - 1 - t } else { t });
    if !after_middle {
        return step;
    }
    TransitionStep {
        inner: inner_segments - step.inner - u32::from(step.along_inner),
        outer: outer_segments - step.outer - u32::from(!step.along_inner),
        along_inner: step.along_inner,
        inner_first: step.inner_first,
    }
}

/// Returns triangle `t` of those between the outline and the first ring, whose numbers of segments may differ.
fn transition_triangle(plan: &DomainPlan, t: u32) -> [u32; 3] {
    let inner_segments = plan.n - 2;
    let (start1, start2, outer) = (plan.start1, plan.start2, plan.outer);
    let side = u32::from(t >= start1 + inner_segments) + u32::from(t >= start2 + 2 * inner_segments);
    let side_start = match side {
        0 => 0,
        1 => start1,
        _ => start2,
    };
    let edge = plan.factors.outside[side as usize];

    let step = transition_step(plan.row, inner_segments, edge, t - side_start - side * inner_segments);
    let inner_point = |p| ring_point(outer, 3 * inner_segments, side * inner_segments + p);
    step.triangle(inner_point, |p| ring_point(0, outer, side_start + p))
}

#[cfg(test)]
mod serial_tests;
#[cfg(test)]
pub(super) mod tests;
