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
//! Where the two rows have the same number of segments, the strip consists of quads, all of which are cut along the same
//! diagonal. Whether that is the one or the other is up to the patch: its diagonals may be *flipped*. The other diagonal may
//! follow the surface much better, as on a saddle.
//!
//! So the numbers of segments of the three edges, which edge is the base, `width`, and whether diagonals are flipped say
//! everything. With all numbers equal to `n`, the patch is cut into `n * n` equal triangles.

use super::connectivity::row_widths;
use super::domain_row::{segment_length, whole_location};
use super::factors::{FIXED_HALF, FIXED_ONE, PatchFactors, row_base, row_count, row_flip, row_width, segments};
use super::row_widths::{quotient, reciprocal, scaled, widths_through};

/// A patch's rows, prepared for [`row_point`], [`row_triangle`] and [`row_triangle_places`].
#[derive(Clone, Copy, Debug)]
pub(super) struct RowPlan {
    /// The numbers of segments of the first and of the second edge.
    a: u32,
    b: u32,
    /// The number of segments of the base.
    c: u32,
    /// The lengths of one segment of the first and of the second edge.
    a_step: u32,
    b_step: u32,
    /// The number of rows, and its [`reciprocal`].
    n: u32,
    per_row: u32,
    width: u32,
    /// Which edge is the base: 0, 1 or 2 for U == 0, V == 0 or W == 0.
    base: u32,
    /// 1 if diagonals are flipped, else 0.
    flip: u32,
    /// The apex's number, and how many points are on the outline.
    apex: u32,
    outer: u32,
}

/// Returns the larger of 1 and row * segments / n, rounded half up: where a row after the first starts on an edge with so many
/// segments.
fn end_place(plan: &RowPlan, segments: u32, row: u32) -> u32 {
    (scaled(2 * row * segments + plan.n, plan.per_row) >> 1).max(1)
}

/// Returns one of three numbers, from those that follow each other in a circle.
fn in_circle(numbers: [u32; 3], i: u32) -> u32 {
    numbers[(i % 3) as usize]
}

/// Prepares the rows of a patch.
pub(super) fn row_plan(factors: PatchFactors) -> RowPlan {
    let base = row_base(factors);
    let counts = factors.outside.map(segments);
    let (a, b, n) = (in_circle(counts, base + 2), in_circle(counts, base + 1), row_count(factors));
    // Edge i runs from corner i + 1 to corner i + 2. So the outline passes the first edge, the base and the second edge.
    RowPlan {
        a,
        b,
        c: in_circle(counts, base),
        a_step: segment_length(a),
        b_step: segment_length(b),
        n,
        per_row: reciprocal(n),
        width: row_width(factors),
        base,
        flip: row_flip(factors),
        apex: in_circle([0, counts[0], counts[0] + counts[1]], base + 2),
        outer: counts[0] + counts[1] + counts[2],
    }
}

/// Returns how many points lie inside the patch in rows 1 to `row`, if these have `widths` segments together.
fn points_through(widths: u32, row: u32) -> u32 {
    widths - row
}

/// Returns the number of triangles before the strip below row `row`, which is 1 or more and less than the number of rows. `widths`
/// are its [`row_widths`].
///
/// Each strip has as many triangles as its two rows have segments, less one for each point that they share.
fn triangles_before(plan: &RowPlan, row: u32, widths: [u32; 2]) -> u32 {
    widths[0] + widths[1] + end_place(plan, plan.a, row) + end_place(plan, plan.b, row) - 2 * row
}

/// Returns between which rows the strip with triangle `t` begins: the first one or later, and before the second one.
///
/// With m for the width and s for the segments of both edges together, the strips before row j have at least
/// (m j^2 + (s - 2 n) j) / n - 2 triangles and at most (m j^2 + s j) / n + 2, because of the roundings of widths and places.
fn rows_around(plan: &RowPlan, t: u32) -> [u32; 2] {
    let [n, m] = [plan.n, plan.width].map(|number| number as f32);
    let sides = (plan.a + plan.b) as f32;
    let root = |slope: f32, height: f32| ((slope * slope + 4.0 * m * n * height.max(0.0)).sqrt() - slope) / (2.0 * m);
    // Bounds that are too far apart are no mistake, so roundings go outwards.
    let first = (root(sides, t as f32 - 2.0) - 0.015625).max(0.0);
    let end = root(sides - 2.0 * n, t as f32 + 2.0) + 1.015625;
    // The base may have so many segments that the first bound is beyond the last strip.
    [(first as u32).min(plan.n - 1), plan.n.min(end as u32 + 1)]
}

/// Returns point `i` of the outline, counted from the apex.
fn outline_point(plan: &RowPlan, i: u32) -> u32 {
    let point = plan.apex + i;
    if point >= plan.outer { point - plan.outer } else { point }
}

/// Returns the number of segments of a row between the apex and the base: ceil(width * row / rows).
fn row_segments(plan: &RowPlan, row: u32) -> u32 {
    scaled(plan.width * row + plan.n - 1, plan.per_row)
}

/// A row: its number of segments, and at which points of the first and of the second edge it starts and ends, counted from the
/// apex.
#[derive(Clone, Copy)]
struct PatternRow {
    segments: u32,
    start: u32,
    end: u32,
}

/// Returns a row of a patch.
fn row_at(plan: &RowPlan, row: u32) -> PatternRow {
    if row == 0 {
        return PatternRow { segments: 0, start: 0, end: 0 };
    }
    // The last row starts and ends at the last points of the two edges.
    let segments = if row == plan.n { plan.c } else { row_segments(plan, row) };
    PatternRow { segments, start: end_place(plan, plan.a, row), end: end_place(plan, plan.b, row) }
}

/// A strip between a row and the next one.
#[derive(Clone, Copy)]
struct Strip {
    /// The number of the upper row.
    row: u32,
    upper: PatternRow,
    lower: PatternRow,
}

/// Returns the number of triangles of a strip: one for each segment of its two rows, less one for each point that they share.
fn strip_triangles(strip: Strip) -> u32 {
    let joint = u32::from(strip.upper.start == strip.lower.start) + u32::from(strip.upper.end == strip.lower.end);
    strip.upper.segments + strip.lower.segments - joint
}

/// A corner of a triangle: whether it is on the lower row of its strip, and which point of its row it is.
#[derive(Clone, Copy)]
struct StripPoint {
    is_lower: bool,
    at: u32,
}

/// Returns the corners of triangle `i` of a strip, in the order of the outline.
fn strip_corners(plan: &RowPlan, strip: Strip, i: u32) -> [StripPoint; 3] {
    let shares_start = u32::from(strip.upper.start == strip.lower.start);
    let joint = shares_start + u32::from(strip.upper.end == strip.lower.end);
    let own = strip.upper.segments - joint;
    let others = strip.lower.segments - joint;

    // The triangle at a shared start stands on the upper row, the one at a shared end on the lower row.
    let (mut at, mut is_upper) = ([0, 1], true);
    if i >= shares_start {
        // Of the first steps along both rows, those along the upper row are step * own / (own + others), halves rounded up, or down
        // if diagonals are flipped. The next step is one of them if it makes them more.
        let (step, all) = (i - shares_start, (own + others).max(1));
        let halves = 2 * step * own + all - plan.flip;
        let along_upper = quotient(halves, 2 * all);
        at = [shares_start + along_upper, shares_start + step - along_upper];
        is_upper = step < own + others && halves + 2 * own >= 2 * all * (along_upper + 1);
    }
    let upper = StripPoint { is_lower: false, at: at[0] };
    let lower = StripPoint { is_lower: true, at: at[1] };
    if is_upper {
        return [StripPoint { at: at[0] + 1, ..upper }, upper, lower];
    }
    [upper, lower, StripPoint { at: at[1] + 1, ..lower }]
}

/// Returns the number of point `at` of row `row`. `above` is how many segments rows 1 to `row - 1` have together.
fn number_in_row(plan: &RowPlan, row: u32, own: PatternRow, above: u32, at: u32) -> u32 {
    if at == 0 {
        return outline_point(plan, own.start);
    }
    if at == own.segments {
        return outline_point(plan, plan.outer - own.end);
    }
    if row == plan.n {
        // The points of the base follow each other on the outline.
        return outline_point(plan, plan.a) + at;
    }
    plan.outer + points_through(above, row - 1) + at - 1
}

/// Returns the number of a corner of a triangle. `widths` are the [`row_widths`] of the strip's upper row.
fn corner_number(plan: &RowPlan, strip: Strip, widths: [u32; 2], corner: StripPoint) -> u32 {
    match corner.is_lower {
        true => number_in_row(plan, strip.row + 1, strip.lower, widths[1], corner.at),
        false => number_in_row(plan, strip.row, strip.upper, widths[0], corner.at),
    }
}

/// Returns triangle `t` of a patch, as point numbers, in the order of the outline.
pub(super) fn row_triangle(plan: &RowPlan, t: u32) -> [u32; 3] {
    // A bisection over the few strips that it can be. No triangle is before row 0.
    let [mut row, mut end] = rows_around(plan, t);
    let (mut before, mut widths) = (0, [0, 0]);
    if row > 0 {
        widths = row_widths(plan.n, plan.width, row);
        before = triangles_before(plan, row, widths);
    }
    while row + 1 < end {
        let middle = (row + end) / 2;
        let own = row_widths(plan.n, plan.width, middle);
        let count = triangles_before(plan, middle, own);
        if count <= t {
            (row, before, widths) = (middle, count, own);
        } else {
            end = middle;
        }
    }
    let strip = Strip { row, upper: row_at(plan, row), lower: row_at(plan, row + 1) };
    strip_corners(plan, strip, t - before).map(|corner| corner_number(plan, strip, widths, corner))
}

/// Returns (U, V) of point `at` of a row, in 16.16 fixed point.
fn place_in_row(plan: &RowPlan, row: PatternRow, at: u32) -> [u32; 2] {
    let start = whole_location(plan.a, plan.a_step, row.start);
    let end = whole_location(plan.b, plan.b_step, row.end);
    // The weights of the base's start and end. Neither product exceeds 32 bits, since `along` is neither 0 nor 1.
    let segments = row.segments.max(1);
    let along = whole_location(segments, segment_length(segments), at);
    let (mut at_start, mut at_end) = (start, 0);
    if at > 0 {
        at_start = if at == row.segments { 0 } else { (start * (FIXED_ONE - along) + FIXED_HALF) >> 16 };
        at_end = if at == row.segments { end } else { (end * along + FIXED_HALF) >> 16 };
    }
    let at_apex = FIXED_ONE - at_start - at_end;
    match plan.base {
        0 => [at_apex, at_start],
        1 => [at_end, at_apex],
        _ => [at_start, at_end],
    }
}

/// Returns (U, V) of a corner of a triangle.
fn corner_place(plan: &RowPlan, strip: Strip, corner: StripPoint) -> [u32; 2] {
    place_in_row(plan, if corner.is_lower { strip.lower } else { strip.upper }, corner.at)
}

/// Returns (U, V) of the corners of triangle `t` of a patch, in 16.16 fixed point. It passes the strips before the triangle one
/// by one: for the few rows of most patches that is faster than finding points by their numbers.
pub(super) fn row_triangle_places(plan: &RowPlan, t: u32) -> [[u32; 2]; 3] {
    let mut strip = Strip { row: 0, upper: row_at(plan, 0), lower: row_at(plan, 1) };
    let mut rest = t;
    while rest >= strip_triangles(strip) && strip.row + 1 < plan.n {
        rest -= strip_triangles(strip);
        strip = Strip { row: strip.row + 1, upper: strip.lower, lower: row_at(plan, strip.row + 2) };
    }
    strip_corners(plan, strip, rest).map(|corner| corner_place(plan, strip, corner))
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
    let mut alike = quotient((inner + 1) * plan.n, plan.width) - row;
    while rest >= alike * inner {
        rest -= alike * inner;
        row += alike;
        inner = row_segments(plan, row + 1) - 1;
        alike = quotient((inner + 1) * plan.n, plan.width) - row;
    }
    let passed = quotient(rest, inner);
    [row + 1 + passed, rest - passed * inner + 1]
}

/// Returns (U, V) of point `i` of those inside the patch, in 16.16 fixed point.
pub(super) fn row_point(plan: &RowPlan, i: u32) -> [u32; 2] {
    let [row, place] = row_of_point(plan, i);
    place_in_row(plan, row_at(plan, row), place)
}

#[cfg(test)]
mod picture;
#[cfg(test)]
mod tests;
