//! Rows: a pattern in which a patch is cut into strips beside one of its edges. Each point and each triangle is computed from
//! its number alone, as in `domain.rs`. Twin: `shaders/rows.wgsl`.
//!
//! One edge is the *base*; the corner opposite it is the *apex*. Of the other two edges, the *first* runs from the apex to the
//! base's start, with `a` segments, and the *second* from the apex to the base's end, with `b`. Rows are straight lines from
//! the first edge to the second:
//!
//! - There are `n = max(a, b)` of them. Row 0 is the apex, and row `n` is the base with its own `c` segments.
//! - Row `j` between them starts at point `max(1, round(j a / n))` of the first edge and ends at point `max(1, round(j b / n))`
//!   of the second, counted from the apex. Where an edge has fewer than `n` segments, rows share points of it.
//! - It has `ceil(width j / n)` segments of equal length.
//!
//! The strip between two rows is cut into triangles by passing along both of them in steps, so that neither gets ahead of the
//! other by more than half a segment. Rows never meet but in a shared point, so every order of steps would give triangles that
//! don't overlap. Where rows share a point, they begin or end with one triangle instead of two.
//!
//! So the numbers of segments of the three edges, which edge is the base, and `width` say everything. With all of them equal to
//! `n`, the patch is cut into `n * n` equal triangles.

use super::connectivity::row_widths;
use super::domain_row::{domain_row, row_location};
use super::factors::{FIXED_HALF, FIXED_ONE, PatchFactors, row_base, row_count, row_width, segments};
use super::row_widths::widths_through;

/// A patch's rows, prepared for [`row_point`] and [`row_triangle`].
#[derive(Clone, Copy, Debug)]
pub(super) struct RowPlan {
    /// The words of the first and of the second edge, and their numbers of segments.
    edges: [u32; 2],
    a: u32,
    b: u32,
    /// The number of segments of the base.
    c: u32,
    /// The number of rows.
    n: u32,
    width: u32,
    /// Which edge is the base: 0, 1 or 2 for U == 0, V == 0 or W == 0.
    base: u32,
    /// The apex's number, and how many points are on the outline.
    apex: u32,
    outer: u32,
}

/// Returns the larger of 1 and row * segments / rows, rounded half up: where a row after the first starts on an edge. All are
/// at most 64.
///
/// It is the integer part of an f32 quotient, as in `domain.rs`: the 0.5 that is added keeps the quotient further from integers
/// than the 2.5 ULP by which WGSL lets it be wrong.
fn end_place(segments: u32, rows: u32, row: u32) -> u32 {
    let rounded = ((2 * row * segments + rows) as f32 + 0.5) / (2 * rows) as f32;
    (rounded as u32).max(1)
}

/// Returns one of three numbers, from those that follow each other in a circle.
fn in_circle(numbers: [u32; 3], i: u32) -> u32 {
    numbers[(i % 3) as usize]
}

/// Prepares the rows of a patch.
pub(super) fn row_plan(factors: PatchFactors) -> RowPlan {
    let base = row_base(factors);
    let (words, counts) = (factors.outside, factors.outside.map(segments));
    // Edge i runs from corner i + 1 to corner i + 2. So the outline passes the first edge, the base and the second edge.
    RowPlan {
        edges: [in_circle(words, base + 2), in_circle(words, base + 1)],
        a: in_circle(counts, base + 2),
        b: in_circle(counts, base + 1),
        c: in_circle(counts, base),
        n: row_count(factors),
        width: row_width(factors),
        base,
        apex: in_circle([0, counts[0], counts[0] + counts[1]], base + 2),
        outer: counts[0] + counts[1] + counts[2],
    }
}

/// Returns how many points lie inside the patch in rows 1 to `row`, if these have `widths` segments together.
fn points_through(widths: u32, row: u32) -> u32 {
    widths - row
}

/// Returns the number of triangles before the strip below row `row`, which is less than the number of rows.
fn triangles_before(plan: &RowPlan, row: u32) -> u32 {
    if row == 0 {
        return 0;
    }
    let [above, through] = row_widths(plan.n, plan.width, row);
    // Each strip has as many triangles as its two rows have segments, less one for each point that they share.
    above + through + end_place(plan.a, plan.n, row) + end_place(plan.b, plan.n, row) - 2 * row
}

/// Returns point `i` of the outline, counted from the apex.
fn outline_point(plan: &RowPlan, i: u32) -> u32 {
    let point = plan.apex + i;
    if point >= plan.outer { point - plan.outer } else { point }
}

/// A row: its number of segments, where it starts and ends on the outline, counted from the apex, and the number of the point
/// after its first one.
#[derive(Clone, Copy)]
struct PatternRow {
    segments: u32,
    start: u32,
    end: u32,
    inner: u32,
}

/// Returns a row of a patch.
fn row_at(plan: &RowPlan, row: u32) -> PatternRow {
    if row == 0 {
        return PatternRow { segments: 0, start: 0, end: 0, inner: 0 };
    }
    if row == plan.n {
        // The points of the base follow each other on the outline.
        let end = plan.a + plan.c;
        return PatternRow { segments: plan.c, start: plan.a, end, inner: outline_point(plan, plan.a) + 1 };
    }
    let [above, through] = row_widths(plan.n, plan.width, row);
    PatternRow {
        segments: through - above,
        start: end_place(plan.a, plan.n, row),
        end: plan.outer - end_place(plan.b, plan.n, row),
        inner: plan.outer + points_through(above, row - 1),
    }
}

/// Returns the number of point `i` of a row.
fn point_of_row(plan: &RowPlan, row: PatternRow, i: u32) -> u32 {
    if i == 0 {
        return outline_point(plan, row.start);
    }
    if i == row.segments { outline_point(plan, row.end) } else { row.inner + i - 1 }
}

/// Returns how many of the first `t` steps along two rows together are steps of the row with `own` segments, if the other one has
/// `others`: t * own / (own + others), rounded half up. There are at most 128 segments. Exact for the same reason as
/// [`end_place`].
fn own_steps(own: u32, others: u32, t: u32) -> u32 {
    let all = (own + others).max(1);
    (((2 * t * own + all) as f32 + 0.5) / (2 * all) as f32) as u32
}

/// Returns triangle `t` of a patch, as point numbers, in the order of the outline.
pub(super) fn row_triangle(plan: &RowPlan, t: u32) -> [u32; 3] {
    // A bisection over the at most 64 strips, unrolled.
    let mut strip = 0;
    for skip in [32, 16, 8, 4, 2, 1] {
        if strip + skip < plan.n && triangles_before(plan, strip + skip) <= t {
            strip += skip;
        }
    }
    let upper = row_at(plan, strip);
    let lower = row_at(plan, strip + 1);
    let in_strip = t - triangles_before(plan, strip);
    let shares_start = u32::from(upper.start == lower.start);
    let shares_end = u32::from(upper.end == lower.end);
    let joint = shares_start + shares_end;
    let own = upper.segments - joint;
    let others = lower.segments - joint;

    // The triangle at a shared start stands on the upper row, the one at a shared end on the lower row.
    let (mut at, mut is_upper) = ([0, 1], true);
    if in_strip >= shares_start {
        let step = in_strip - shares_start;
        let along_upper = own_steps(own, others, step);
        at = [shares_start + along_upper, shares_start + step - along_upper];
        is_upper = step < own + others && own_steps(own, others, step + 1) > along_upper;
    }
    let (p, q) = (point_of_row(plan, upper, at[0]), point_of_row(plan, lower, at[1]));
    if is_upper {
        return [point_of_row(plan, upper, at[0] + 1), p, q];
    }
    [p, q, point_of_row(plan, lower, at[1] + 1)]
}

/// Returns the number of segments of a row between the apex and the base: ceil(width * row / rows).
fn row_segments(plan: &RowPlan, row: u32) -> u32 {
    (plan.width * row).div_ceil(plan.n)
}

/// Returns the row of point `i` of those inside the patch, and the point's place in it.
///
/// Rows 1 to j have at most j (width (j + 1) - 2) / (2 n) points inside, and less than j fewer. The rows that follow those which
/// have at most `i` by this count are passed together where they have the same number of segments.
fn row_of_point(plan: &RowPlan, i: u32) -> [u32; 2] {
    let (n, width) = (plan.n as f32, plan.width as f32);
    let root = ((width - 2.0) * (width - 2.0) + 8.0 * width * n * i as f32).sqrt();
    // Too few rows are no mistake, so rounding is always downwards.
    let mut row = (((root + 2.0 - width) / (2.0 * width)) - 0.015625).max(0.0) as u32;
    let mut rest = i - points_through(widths_through(plan.n, plan.width, row), row);
    let mut inner = row_segments(plan, row + 1) - 1;
    let mut alike = (inner + 1) * plan.n / plan.width - row;
    while rest >= alike * inner {
        rest -= alike * inner;
        row += alike;
        inner = row_segments(plan, row + 1) - 1;
        alike = (inner + 1) * plan.n / plan.width - row;
    }
    let passed = rest / inner;
    [row + 1 + passed, rest - passed * inner + 1]
}

/// Returns (U, V) of point `i` of those inside the patch, in 16.16 fixed point.
pub(super) fn row_point(plan: &RowPlan, i: u32) -> [u32; 2] {
    let [row, place] = row_of_point(plan, i);
    let along = row_location(domain_row(whole_word(row_segments(plan, row))), place);
    let start = row_location(domain_row(plan.edges[0]), end_place(plan.a, plan.n, row));
    let end = row_location(domain_row(plan.edges[1]), end_place(plan.b, plan.n, row));
    // The weights of the base's start and end. Neither product exceeds 32 bits, since `along` is neither 0 nor 1.
    let at_start = (start * (FIXED_ONE - along) + FIXED_HALF) >> 16;
    let at_end = (end * along + FIXED_HALF) >> 16;
    let at_apex = FIXED_ONE - at_start - at_end;
    match plan.base {
        0 => [at_apex, at_start],
        1 => [at_end, at_apex],
        _ => [at_start, at_end],
    }
}

/// Returns the word of a whole factor.
fn whole_word(segments: u32) -> u32 {
    segments << 16 | segments << 31
}

#[cfg(test)]
mod picture;
#[cfg(test)]
mod tests;
