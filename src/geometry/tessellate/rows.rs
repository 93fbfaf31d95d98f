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

use super::domain_row::{segment_length, whole_location};
use super::factors::{
    FIXED_HALF, FIXED_ONE, PatchFactors, points_in_rows, row_base, row_count, row_flip, row_width, segments,
};
use super::quotients::{common_divisor, divided, inverse, quotient, reciprocal, scaled};

/// A patch's rows, prepared for [`row_triangle_places`].
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

/// A patch's rows, prepared for [`row_point`] and [`row_triangle`].
#[derive(Clone, Copy, Debug)]
pub(super) struct NumberedRows {
    rows: RowPlan,
    /// The [`common_divisor`] of the number of rows and the width.
    divisor: u32,
    /// How many points lie inside the patch.
    inside: u32,
    /// The [`inverse`] of how many points `n` pairs of rows have, and of half of how many triangles `n` pairs of strips have.
    per_point: f32,
    per_half: f32,
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

/// Prepares the rows of a patch, and their numbers.
pub(super) fn numbered_rows(factors: PatchFactors) -> NumberedRows {
    let rows = row_plan(factors);
    let (n, width) = (rows.n, rows.width);
    let divisor = common_divisor(n, width);
    NumberedRows {
        rows,
        divisor,
        inside: points_in_rows(n, width, divisor),
        // Where there is nothing to find, any number will do.
        per_point: inverse((n * (width - 1)).max(divisor + 1) - divisor),
        per_half: inverse((n * width).max(divisor + 1) - divisor),
    }
}

/// Returns point `i` of the outline, counted from the apex.
fn outline_point(plan: &RowPlan, i: u32) -> u32 {
    let point = plan.apex + i;
    if point >= plan.outer { point - plan.outer } else { point }
}

/// Returns ceil(width * row / rows): the number of segments of a row before the base.
fn widened(plan: &RowPlan, row: u32) -> u32 {
    scaled(plan.width * row + plan.n - 1, plan.per_row)
}

/// Returns the number of segments of a row.
fn row_segments(plan: &RowPlan, row: u32) -> u32 {
    if row == plan.n { plan.c } else { widened(plan, row) }
}

/// Returns where a row starts on the first edge and ends on the second: max(1, row * segments / n) of each, rounded half up.
///
/// That is the row's own number on the edge with `n` segments.
fn end_places(plan: &RowPlan, row: u32) -> [u32; 2] {
    let place = (scaled(2 * row * plan.a.min(plan.b) + plan.n, plan.per_row) >> 1).max(row.min(1));
    if plan.a < plan.b { [place, row] } else { [row, place] }
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
    let [start, end] = end_places(plan, row);
    PatternRow { segments: row_segments(plan, row), start, end }
}

/// A strip between a row and the next one.
#[derive(Clone, Copy)]
struct Strip {
    /// The number of the upper row.
    row: u32,
    upper: PatternRow,
    lower: PatternRow,
}

/// Returns the strip below a row.
fn strip_below(plan: &RowPlan, row: u32) -> Strip {
    Strip { row, upper: row_at(plan, row), lower: row_at(plan, row + 1) }
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

/// Returns how many points the first `pairs` pairs of rows have inside the patch, of which pair j is rows j and n - j.
///
/// A pair has one point less than the width; two less if both rows have a whole number of segments without rounding up.
fn pair_points(rows: &NumberedRows, pairs: u32) -> u32 {
    pairs * (rows.rows.width - 1) - scaled(pairs * rows.divisor, rows.rows.per_row)
}

/// Returns the row of point `i` of those inside the patch, and the point's place in it. Points are numbered pair by pair, the row
/// nearer to the apex first.
fn row_of_point(rows: &NumberedRows, i: u32) -> [u32; 2] {
    let pairs = divided(i * rows.rows.n, rows.per_point);
    let rest = i - pair_points(rows, pairs);
    let inner = widened(&rows.rows, pairs + 1) - 1;
    if rest < inner { [pairs + 1, rest + 1] } else { [rows.rows.n - pairs - 1, rest - inner + 1] }
}

/// Returns the number that is added to a point's place in a row with so many segments, if it's no end of the row.
fn number_before(rows: &NumberedRows, row: u32, segments: u32) -> u32 {
    let plan = &rows.rows;
    if row == plan.n {
        // The points of the base follow each other on the outline.
        return outline_point(plan, plan.a);
    }
    if 2 * row > plan.n {
        return plan.outer + pair_points(rows, plan.n - row) - segments;
    }
    plan.outer + pair_points(rows, row.max(1) - 1) - 1
}

/// Returns the strip with triangle `k` of the last ones.
///
/// Two rows that share no point lie on both sides of point k of the edge with fewer segments, and the next one.
fn unshared_strip(plan: &RowPlan, k: u32) -> u32 {
    let fewer = 2 * plan.a.min(plan.b);
    if k == 0 { 0 } else { quotient((2 * k + 1) * plan.n + fewer - 1, fewer) - 1 }
}

/// Returns the strip with triangle `t`, and the triangle's number in it.
///
/// All strips have at most one shared point. The last triangles of those without one follow at the end. What is left is numbered by
/// pairs of strips, the ones below rows n - 1 - j and j, with j from 0. If the base had as many segments as the width, each pair
/// would have twice the width; one less if row j has a whole number of segments without rounding up, and one less if row j + 1 has.
/// So the first j pairs have x triangles rounded up and x rounded down, with x = j (width - divisor / n).
fn strip_of_triangle(rows: &NumberedRows, t: u32) -> [u32; 2] {
    let plan = &rows.rows;
    let last = plan.n - 1;
    if t < widened(plan, last) + plan.c - 1 {
        return [last, t];
    }
    let paired = 2 * rows.inside + last + plan.c - 1;
    if t >= paired {
        let row = unshared_strip(plan, t - paired);
        return [row, row_segments(plan, row) + row_segments(plan, row + 1) - 1];
    }
    let i = t + plan.width - plan.c;
    let pairs = divided(((i + 1) >> 1) * plan.n - (i & 1), rows.per_half);
    let whole = scaled(pairs * rows.divisor, plan.per_row);
    let is_rounded = whole * plan.n != pairs * rows.divisor;
    let rest = i + u32::from(is_rounded) - 2 * (pairs * plan.width - whole);
    let lower = last - pairs;
    let in_lower = widened(plan, lower) + widened(plan, lower + 1) - 1;
    if rest < in_lower { [lower, rest] } else { [pairs, rest - in_lower] }
}

/// Returns the number of a corner of a triangle. `before` are the [`number_before`] of the strip's upper and lower row.
fn corner_number(plan: &RowPlan, strip: Strip, before: [u32; 2], corner: StripPoint) -> u32 {
    let (row, start) = if corner.is_lower { (strip.lower, before[1]) } else { (strip.upper, before[0]) };
    if corner.at == 0 {
        return outline_point(plan, row.start);
    }
    if corner.at == row.segments {
        return outline_point(plan, plan.outer - row.end);
    }
    start + corner.at
}

/// Returns triangle `t` of a patch, as point numbers, in the order of the outline.
pub(super) fn row_triangle(rows: &NumberedRows, t: u32) -> [u32; 3] {
    let plan = &rows.rows;
    let [row, i] = strip_of_triangle(rows, t);
    let strip = strip_below(plan, row);
    let before = [number_before(rows, row, strip.upper.segments), number_before(rows, row + 1, strip.lower.segments)];
    strip_corners(plan, strip, i).map(|corner| corner_number(plan, strip, before, corner))
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

/// Returns (U, V) of the corners of triangle `t` of a patch, counted strip by strip from the apex, in 16.16 fixed point. LOD by
/// error looks at triangles in this order. For the few rows of most patches it is faster to pass strips one by one than to prepare
/// [`NumberedRows`].
pub(super) fn row_triangle_places(plan: &RowPlan, t: u32) -> [[u32; 2]; 3] {
    let mut strip = strip_below(plan, 0);
    let mut rest = t;
    while rest >= strip_triangles(strip) && strip.row + 1 < plan.n {
        rest -= strip_triangles(strip);
        strip = Strip { row: strip.row + 1, upper: strip.lower, lower: row_at(plan, strip.row + 2) };
    }
    strip_corners(plan, strip, rest).map(|corner| corner_place(plan, strip, corner))
}

/// Returns (U, V) of point `i` of those inside the patch, in 16.16 fixed point.
pub(super) fn row_point(rows: &NumberedRows, i: u32) -> [u32; 2] {
    let [row, place] = row_of_point(rows, i);
    place_in_row(&rows.rows, row_at(&rows.rows, row), place)
}

#[cfg(test)]
mod picture_tests;
#[cfg(test)]
mod tests;
