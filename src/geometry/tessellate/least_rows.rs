//! LOD by error under rows: how many rows of which width keep a patch within a tolerance, with the fewest triangles. Twin:
//! `shaders/least_rows.wgsl`. The patches' requests are put together as in `least_factors.rs`.
//!
//! Each of the three edges may be the base. The error of a triangle of rows follows from the second derivatives along the base,
//! divided by the square of the rows' width, and across the rows, divided by the square of their number. So the number and
//! the width for which both parts are alike give the fewest triangles. They are where the search starts, at somewhat fewer;
//! what a pattern lacks is then told by its triangles' errors, as `piece_error.rs` bounds them. Once a pattern is enough, single
//! numbers are lessened. Errors don't fall steadily as numbers grow, because whether triangles lean depends on how the numbers
//! of two rows fit each other. So numbers are lessened by two as well, and the base with its rows or without them.
//!
//! Diagonals follow the direction in which the surface bends less, which second derivatives tell, too.

use glam::Vec2;

use super::factors::{MOST_ROWS, Partitioning, PatchFactors, ROW_BASE_STEP, outer_count, point_count, process};
use super::least_factors::{
    BEYOND_LAST, BOUND_SHARE, ChosenFactors, FactorSearch, SearchGoal, part_errors, without_search,
};
use super::piece_error::{SecondForms, SeenPatch, may_slide, second_forms, triangle_error};

/// What second derivatives say of rows beside a base.
#[derive(Clone, Copy, Debug)]
struct Expected {
    /// How many rows of which width may keep the tolerance. Neither is rounded.
    rows: f32,
    width: f32,
    /// A sixth of the largest second derivatives, in px: across the rows, if there is one, and along the base.
    across: f32,
    along: f32,
    /// Whether flipped diagonals follow the surface better.
    flips: bool,
}

/// Returns what second derivatives say of rows beside base `base`.
fn expected_rows(patch: &SeenPatch, base: usize, tolerance: f32) -> Expected {
    // Domain coordinates of the corners. The base leads from the corner after the apex to the one after that.
    let corners = [Vec2::X, Vec2::Y, Vec2::ZERO];
    let (start, end) = (corners[(base + 1) % 3], corners[(base + 2) % 3]);
    let forms = [0, 1, 2].map(|corner| second_forms(patch, corner, end - start, (start + end) * 0.5 - corners[base]));
    let (mut along, mut across) = (1e-12f32, 1e-12f32);
    for SecondForms { aa, bb, .. } in forms {
        along = along.max(aa.length());
        across = across.max(bb.length());
    }
    // With this many times as many segments as rows, both parts are alike.
    let ratio = (along / across).sqrt();
    let (mut error, mut agreeing, mut whole) = (0.0f32, 0.0, 0.0);
    for SecondForms { aa, ab, bb } in forms {
        let (segment, mixed) = (aa * (1.0 / (ratio * ratio)), ab * (1.0 / ratio));
        let beside = bb + segment * 0.25;
        error = error.max(triangle_error(segment.length(), (beside + mixed).length(), (beside - mixed).length()));
        // Second derivatives along the diagonals are the sum of these, plus and minus twice the mixed one.
        let sides = segment + bb;
        agreeing += sides.dot(mixed);
        whole += sides.dot(sides);
    }
    let rows = (error / tolerance).sqrt();
    // Where both diagonals are alike, rounding must not choose.
    Expected { rows, width: ratio * rows, across, along, flips: agreeing < -0.01 * whole }
}

/// Rows that are tried: their base, number and width, and the base's number of segments.
#[derive(Clone, Copy, Debug)]
struct TriedRows {
    base: usize,
    flips: bool,
    rows: f32,
    width: f32,
    segments: f32,
    /// How many segments less than rows the first and the second edge have.
    fewer: [f32; 2],
    /// 0 while they grow; then which number has just been lessened (see [`with_less`]).
    lessened: u32,
}

/// As how many triangles a segment of an edge counts where a patch requests it. It is a triangle's side in this patch and in its
/// neighbour; but the neighbour often requests it, too.
pub const REQUESTED_SEGMENT: f32 = 1.75;

/// Returns as how many triangles a segment of an edge counts.
fn segment_cost(sought: &FactorSearch) -> f32 {
    if sought.wanted == SearchGoal::Requests { REQUESTED_SEGMENT } else { 1.0 }
}

/// Returns whether the edges have their factors, so that only base and width are chosen.
fn is_given(sought: &FactorSearch) -> bool {
    sought.wanted == SearchGoal::Given
}

/// Returns the least number of rows beside a base.
fn least_rows(sought: &FactorSearch, base: usize) -> f32 {
    let beside = sought.least[(base + 1) % 3].max(sought.least[(base + 2) % 3]);
    if is_given(sought) { beside } else { beside.max(sought.inside) }
}

/// Returns the least number of a base's segments with rows of some width.
fn least_segments(sought: &FactorSearch, base: usize, width: f32) -> f32 {
    if is_given(sought) { sought.least[base] } else { sought.least[base].max(width) }
}

/// Returns an expected number rounded down, or the least one.
fn expected_at_least(number: f32, least: f32) -> f32 {
    if number > least { number.min(MOST_ROWS as f32).floor() } else { least }
}

/// Returns the rows with which the search beside a base starts.
fn first_rows(sought: &FactorSearch, base: usize, expected: &Expected, share: f32) -> TriedRows {
    let least = least_rows(sought, base);
    let rows = if is_given(sought) { least } else { expected_at_least(share * expected.rows, least) };
    let width = expected_at_least(share * expected.width, sought.inside);
    let segments = least_segments(sought, base, width);
    TriedRows { base, flips: expected.flips, rows, width, segments, fewer: [0.0; 2], lessened: 0 }
}

/// Returns the share of the expected rows with which a search starts: with the first base, and with the others. Second derivatives
/// bound the error from above, and say nothing of it where points may slide.
fn first_shares(slides: bool) -> [f32; 2] {
    if slides { [0.0; 2] } else { [0.8, 0.6] }
}

/// Returns about how many triangles rows beside a base will have.
fn expected_cost(sought: &FactorSearch, base: usize, expected: &Expected) -> f32 {
    let rows = expected.rows.max(least_rows(sought, base));
    let width = expected.width.max(sought.inside);
    let cost = rows * width + segment_cost(sought) * (rows + 0.5 * least_segments(sought, base, width));
    // NaN comes last. Where bases cost about the same, rounding must not choose: only 5 bits of the mantissa count.
    if cost < 3e38 { f32::from_bits(cost.to_bits() & 0xfffc_0000) } else { 3e38 }
}

/// Returns the factors of the edges.
fn edges_of_rows(sought: &FactorSearch, tried: &TriedRows) -> [f32; 3] {
    if is_given(sought) {
        return sought.least;
    }
    let mut edges = [tried.segments; 3];
    edges[(tried.base + 2) % 3] = tried.rows - tried.fewer[0];
    edges[(tried.base + 1) % 3] = tried.rows - tried.fewer[1];
    edges
}

/// Returns the inside factor that says which rows.
fn inside_of_rows(tried: &TriedRows) -> f32 {
    let step = tried.base as u32 + if tried.flips { 4 } else { 1 };
    (ROW_BASE_STEP * step) as f32 + tried.width
}

/// Returns the number that is tried after one that isn't enough: at least by one and by this part of it larger, but no number below
/// the largest one passes that over.
fn next_number(number: f32, part: f32, estimate: f32) -> f32 {
    let next = (number + 1.0).max((number * (1.0 + part)).floor()).max(estimate.floor());
    if number < MOST_ROWS as f32 { next.min(MOST_ROWS as f32) } else { BEYOND_LAST }
}

/// Returns rows that may be enough, after some that have this error; more than [`MOST_ROWS`], if none will be.
fn grown_rows(sought: &FactorSearch, tried: TriedRows, expected: &Expected, error: f32, tolerance: f32) -> TriedRows {
    let ratio = (error / tolerance).sqrt();
    let ratio = if ratio < 100.0 { ratio } else { 100.0 };
    let across = expected.across / (tried.rows * tried.rows);
    let along = expected.along / (tried.width * tried.width);
    // Beyond what second derivatives request, more segments rarely help.
    let part = match is_given(sought) {
        true if tried.width < 1.5 * expected.width => 0.0,
        true => 0.25,
        false => 0.125,
    };
    let more = |number: f32| next_number(number, part, 0.8 * ratio * number);
    let (mut rows, mut width) = (tried.rows, tried.width);
    if is_given(sought) {
        // There may be too few rows for any width.
        width = if 0.5 * across > tolerance { BEYOND_LAST } else { more(width) };
    } else if ratio > 1.5 {
        // The part that is much smaller isn't what is missing.
        rows = if along > 4.0 * across { rows } else { more(rows) };
        width = if across > 4.0 * along { width } else { more(width) };
    } else if across > along {
        rows = next_number(rows, part, 0.0);
    } else {
        width = next_number(width, part, 0.0);
    }
    TriedRows { rows, width, segments: least_segments(sought, tried.base, width), ..tried }
}

/// How many kinds of lessening there are.
pub const LESSENINGS: u32 = 8;

/// Returns rows with less than others: 1 row less; rows narrower by 1 segment (2) or by 2 (4), and the base with them if it has as
/// many; the same without the base (3 and 5); or 1 segment less of the base (6), of the first edge (7) or of the second one (8).
fn with_less(sought: &FactorSearch, enough: &TriedRows, kind: u32) -> TriedRows {
    let one = |of: &[u32]| if of.contains(&kind) { 1.0 } else { 0.0 };
    let width = enough.width - one(&[2, 3]) - 2.0 * one(&[4, 5]);
    let follows = [2, 4].contains(&kind) && enough.segments == enough.width;
    let [first, second] = enough.fewer;
    TriedRows {
        rows: enough.rows - one(&[1]),
        width,
        segments: if follows { least_segments(sought, enough.base, width) } else { enough.segments - one(&[6]) },
        fewer: [first + one(&[7]), second + one(&[8])],
        lessened: kind,
        ..*enough
    }
}

/// Returns whether there are such rows, and whether they differ from others that are tried.
fn is_possible(sought: &FactorSearch, enough: &TriedRows, less: &TriedRows) -> bool {
    let kind = less.lessened;
    if is_given(sought) {
        // The edges have their factors.
        return (kind == 2 || kind == 4) && less.width >= sought.inside;
    }
    // Where the base doesn't follow, kinds 3 and 5 are the same as 2 and 4.
    let follows = enough.segments == enough.width && enough.width > sought.least[less.base];
    let [first, second] = less.fewer;
    less.rows >= least_rows(sought, less.base)
        && less.width >= sought.inside
        && less.segments >= sought.least[less.base]
        && less.rows - first >= sought.least[(less.base + 2) % 3]
        && less.rows - second >= sought.least[(less.base + 1) % 3]
        && first.min(second) == 0.0
        && (follows || (kind != 3 && kind != 5))
}

/// Returns rows with less than some that are enough, by the first kind of lessening after `lessened` that there is; with a
/// `lessened` above [`LESSENINGS`], if there is none.
fn lesser_rows(sought: &FactorSearch, enough: TriedRows, lessened: u32) -> TriedRows {
    // Beside given edges there are no others after the fourth.
    let last = if is_given(sought) { 4 } else { LESSENINGS };
    for kind in lessened + 1..=last {
        let less = with_less(sought, &enough, kind);
        if is_possible(sought, &enough, &less) {
            return less;
        }
    }
    TriedRows { lessened: LESSENINGS + 1, ..enough }
}

/// Returns the kind of lessening after which the next one is looked for, once one has given rows that are enough: the same again, or
/// all of them where the numbers of two rows fit otherwise.
fn lessened_before(kind: u32) -> u32 {
    if kind == 0 || (3..6).contains(&kind) { 0 } else { kind - 1 }
}

/// Returns the number of triangles of a pattern, if a segment of an edge counts as `segment` triangles.
fn cost_of_rows(factors: PatchFactors, segment: f32) -> f32 {
    let outer = outer_count(factors);
    2.0 * (point_count(factors) - outer) as f32 + segment * outer as f32
}

/// Returns the bases from the least expected cost to the largest.
fn bases_by_cost([u, v, w]: [f32; 3]) -> [usize; 3] {
    let first = if u <= v && u <= w {
        0
    } else if v <= w {
        1
    } else {
        2
    };
    let (next, after) = ((first + 1) % 3, (first + 2) % 3);
    let costs = [u, v, w];
    if costs[next] <= costs[after] { [first, next, after] } else { [first, after, next] }
}

/// Returns the rows with which a patch is within the tolerance, and has the fewest triangles of those that are tried. If no rows
/// are enough, it returns the least factors and [`BEYOND_LAST`].
pub(super) fn fewest_rows(patch: &SeenPatch, tolerance: f32, sought: &FactorSearch) -> ChosenFactors {
    let within = BOUND_SHARE * tolerance;
    let mut best = ChosenFactors { edges: sought.least, inside: BEYOND_LAST, inner: 0.0 };
    if let Some(inside) = without_search(patch, within, Partitioning::Rows, sought) {
        return ChosenFactors { inside, ..best };
    }
    let shares = first_shares(may_slide(patch, within));
    let all = [0, 1, 2].map(|base| expected_rows(patch, base, within));
    let costs = [0, 1, 2].map(|base| expected_cost(sought, base, &all[base]));
    let order = bases_by_cost(costs);
    let mut fewest = 3.4e38;
    let mut at = 0;
    let mut tried = first_rows(sought, order[0], &all[order[0]], shares[0]);
    let mut enough = tried;
    let mut goes_on = true;
    while goes_on {
        let edges = edges_of_rows(sought, &tried);
        let factors = process(Partitioning::Rows, edges, inside_of_rows(&tried));
        let cost = cost_of_rows(factors, segment_cost(sought));
        let is_worth = tried.rows.max(tried.width) <= MOST_ROWS as f32 && cost < fewest;
        let errors = part_errors(patch, within, factors, [is_worth; 4]);
        let error = errors[0].max(errors[1]).max(errors[2]).max(errors[3]);
        let lessened = tried.lessened;
        if is_worth && error <= within {
            (fewest, enough) = (cost, tried);
            best = ChosenFactors { edges, inside: inside_of_rows(&tried), inner: 0.0 };
            tried = lesser_rows(sought, enough, lessened_before(lessened));
        } else if lessened > 0 {
            tried = lesser_rows(sought, enough, lessened);
        } else {
            tried = grown_rows(sought, tried, &all[tried.base], error, within);
        }
        if !is_worth && lessened == 0 || tried.lessened > LESSENINGS {
            at += 1;
            // The other diagonals may be the only ones that are enough.
            goes_on = at < 3 || at < 6 && best.inside == BEYOND_LAST;
            let base = order[at % 3];
            tried = first_rows(sought, base, &all[base], shares[1]);
            tried.flips = tried.flips != (at >= 3);
        }
    }
    best
}

/// Returns the number of points inside a patch.
fn points_inside(edges: [f32; 3], inside: f32) -> f32 {
    let factors = process(Partitioning::Rows, edges, inside);
    (point_count(factors) - outer_count(factors)) as f32
}

/// Returns whether a patch requests factors for its edges again: beside what other patches requested, it has many more points inside than with
/// what it has chosen.
pub(super) fn rows_request_again(chosen: &ChosenFactors, edges: [f32; 3], inside: f32) -> bool {
    inside == BEYOND_LAST || points_inside(edges, inside) > 1.1 * points_inside(chosen.edges, chosen.inside) + 2.0
}

#[cfg(test)]
mod tests;
