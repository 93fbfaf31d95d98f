//! LOD by error under rows: how many rows of which width keep a patch within a tolerance, with the fewest triangles. Twin:
//! `shaders/least_rows.wgsl`. The patches' requests are put together as in `least_factors.rs`.
//!
//! Each of the three edges may be the base. The error of a triangle of rows follows from the second derivatives along the base,
//! divided by the square of the rows' width, and across the rows, divided by the square of their number. So the number and
//! the width for which both parts are alike give the fewest triangles. They are where the search starts, at somewhat fewer;
//! what a pattern lacks is then told by its triangles' errors, as `piece_error.rs` bounds them.

use glam::Vec2;

use super::factors::{Partitioning, PatchFactors, ROW_BASE_STEP, outer_count, point_count, process};
use super::least_factors::{BEYOND_LAST, BOUND_SHARE, Chosen, part_errors, single_suffices};
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
    let mut error = 0.0f32;
    for SecondForms { aa, ab, bb } in forms {
        let (segment, mixed) = (aa * (1.0 / (ratio * ratio)), ab * (1.0 / ratio));
        let beside = bb + segment * 0.25;
        error = error.max(triangle_error(segment.length(), (beside + mixed).length(), (beside - mixed).length()));
    }
    let rows = (error / tolerance).sqrt();
    Expected { rows, width: ratio * rows, across, along }
}

/// Rows that are tried: their base, number and width, and the base's number of segments.
#[derive(Clone, Copy, Debug)]
struct Tried {
    base: usize,
    rows: f32,
    width: f32,
    segments: f32,
    /// How many segments less than rows the first and the second edge have.
    fewer: [f32; 2],
    /// 0 while they grow; then which number has just been made one less: of rows, of their segments, of the base's, or of the
    /// first or the second edge's.
    lessened: u32,
}

/// What a search looks for.
#[derive(Clone, Copy)]
struct Sought {
    /// The least factors of the edges U == 0, V == 0 and W == 0.
    least: [f32; 3],
    /// The least number of rows and of segments of a row.
    inside: f32,
    /// Whether the edges have these factors, so that only base and width are chosen.
    is_given: bool,
    /// As how many triangles a segment of an edge counts.
    segment: f32,
}

/// Returns the least number of rows beside a base.
fn least_rows(sought: &Sought, base: usize) -> f32 {
    let beside = sought.least[(base + 1) % 3].max(sought.least[(base + 2) % 3]);
    if sought.is_given { beside } else { beside.max(sought.inside) }
}

/// Returns the least number of a base's segments with rows of some width.
fn least_segments(sought: &Sought, base: usize, width: f32) -> f32 {
    if sought.is_given { sought.least[base] } else { sought.least[base].max(width) }
}

/// Returns an expected number rounded down, or the least one.
fn expected_at_least(number: f32, least: f32) -> f32 {
    if number > least { number.min(64.0).floor() } else { least }
}

/// Returns the rows with which the search beside a base starts.
fn first_rows(sought: &Sought, base: usize, expected: &Expected, slides: bool) -> Tried {
    // Second derivatives bound the error from above, and say nothing of it where points may slide.
    let share = if slides { 0.0 } else { 0.8 };
    let least = least_rows(sought, base);
    let rows = if sought.is_given { least } else { expected_at_least(share * expected.rows, least) };
    let width = expected_at_least(share * expected.width, sought.inside);
    Tried { base, rows, width, segments: least_segments(sought, base, width), fewer: [0.0; 2], lessened: 0 }
}

/// Returns about how many triangles rows beside a base will have.
fn expected_cost(sought: &Sought, base: usize, expected: &Expected) -> f32 {
    let rows = expected.rows.max(least_rows(sought, base));
    let width = expected.width.max(sought.inside);
    let cost = rows * width + sought.segment * (rows + 0.5 * least_segments(sought, base, width));
    // NaN comes last.
    if cost < 3e38 { cost } else { 3e38 }
}

/// Returns the factors of the edges.
fn edges_of_rows(sought: &Sought, tried: &Tried) -> [f32; 3] {
    if sought.is_given {
        return sought.least;
    }
    let mut edges = [tried.segments; 3];
    edges[(tried.base + 2) % 3] = tried.rows - tried.fewer[0];
    edges[(tried.base + 1) % 3] = tried.rows - tried.fewer[1];
    edges
}

/// Returns the inside factor that says which rows.
fn inside_of_rows(tried: &Tried) -> f32 {
    (ROW_BASE_STEP as usize * (tried.base + 1)) as f32 + tried.width
}

/// Returns rows that may be enough, after some that have this error; more than 64, if none will be.
fn grown_rows(sought: &Sought, tried: Tried, expected: &Expected, error: f32, tolerance: f32) -> Tried {
    let ratio = (error / tolerance).sqrt();
    let ratio = if ratio < 100.0 { ratio } else { 100.0 };
    let across = expected.across / (tried.rows * tried.rows);
    let along = expected.along / (tried.width * tried.width);
    let more = |number: f32| (0.8 * ratio * number).floor().max(number + 1.0);
    let (mut rows, mut width) = (tried.rows, tried.width);
    if sought.is_given {
        // There may be too few rows for any width.
        width = if 0.5 * across > tolerance { BEYOND_LAST } else { more(width) };
    } else if ratio > 1.5 {
        // The part that is much smaller isn't what is missing.
        rows = if along > 4.0 * across { rows } else { more(rows) };
        width = if across > 4.0 * along { width } else { more(width) };
    } else if across > along {
        rows += 1.0;
    } else {
        width += 1.0;
    }
    Tried { rows, width, segments: least_segments(sought, tried.base, width), ..tried }
}

/// Returns rows with fewer triangles than some that are enough, of which the first possible number after `lessened` is one less;
/// with a `lessened` above 5, if there are none.
fn lesser_rows(sought: &Sought, enough: Tried, lessened: u32) -> Tried {
    let Tried { base, rows, width, segments, fewer: [first, second], .. } = enough;
    if sought.is_given {
        return Tried { lessened: 6, ..enough };
    }
    if lessened < 1 && rows > least_rows(sought, base) {
        return Tried { rows: rows - 1.0, lessened: 1, ..enough };
    }
    if lessened < 2 && width > sought.inside {
        // The base has as many segments as rows are wide, unless its edge needs more.
        let less = if segments == width { least_segments(sought, base, width - 1.0) } else { segments };
        return Tried { width: width - 1.0, segments: less, lessened: 2, ..enough };
    }
    if lessened < 3 && segments > sought.least[base] {
        return Tried { segments: segments - 1.0, lessened: 3, ..enough };
    }
    if lessened < 4 && second == 0.0 && rows - first > sought.least[(base + 2) % 3] {
        return Tried { fewer: [first + 1.0, second], lessened: 4, ..enough };
    }
    if lessened < 5 && first == 0.0 && rows - second > sought.least[(base + 1) % 3] {
        return Tried { fewer: [first, second + 1.0], lessened: 5, ..enough };
    }
    Tried { lessened: 6, ..enough }
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
fn fewest_rows(patch: &SeenPatch, tolerance: f32, sought: &Sought) -> Chosen {
    let within = BOUND_SHARE * tolerance;
    let mut best = Chosen { edges: sought.least, inside: BEYOND_LAST, inner: 0.0 };
    let [u, v, w] = sought.least;
    if u.max(v).max(w).max(sought.inside) > 64.0 {
        return best;
    }
    if single_suffices(patch, within, Partitioning::Rows, sought.least, sought.inside) {
        return Chosen { inside: (ROW_BASE_STEP + 1) as f32, ..best };
    }
    let slides = may_slide(patch, within);
    let all = [0, 1, 2].map(|base| expected_rows(patch, base, within));
    let costs = [0, 1, 2].map(|base| expected_cost(sought, base, &all[base]));
    let order = bases_by_cost(costs);
    let mut fewest = 3.4e38;
    let mut at = 0;
    let mut tried = first_rows(sought, order[0], &all[order[0]], slides);
    let mut enough = tried;
    let mut goes_on = true;
    while goes_on {
        let edges = edges_of_rows(sought, &tried);
        let factors = process(Partitioning::Rows, edges, inside_of_rows(&tried));
        let cost = cost_of_rows(factors, sought.segment);
        let is_worth = tried.rows <= 64.0 && tried.width <= 64.0 && cost < fewest;
        let errors = part_errors(patch, within, factors, [is_worth; 4]);
        let error = errors[0].max(errors[1]).max(errors[2]).max(errors[3]);
        let lessened = tried.lessened;
        if is_worth && error <= within {
            (fewest, enough) = (cost, tried);
            best = Chosen { edges, inside: inside_of_rows(&tried), inner: 0.0 };
            tried = lesser_rows(sought, enough, lessened.saturating_sub(1));
        } else if lessened > 0 {
            tried = lesser_rows(sought, enough, lessened);
        } else {
            tried = grown_rows(sought, tried, &all[tried.base], error, within);
        }
        if !is_worth && lessened == 0 || tried.lessened > 5 {
            at += 1;
            goes_on = at < 3;
            let base = order[at.min(2)];
            tried = first_rows(sought, base, &all[base], slides);
        }
    }
    best
}

/// Returns the factors that a patch asks its edges for, and the rows that it would take beside these. `least` are the least
/// factors that the edges may get, and `inside` is the least number of rows and of segments of a row.
pub(super) fn asked_rows(patch: &SeenPatch, tolerance: f32, least: [f32; 3], inside: f32) -> Chosen {
    // Every segment of an edge is a triangle's side in this patch and in its neighbour.
    fewest_rows(patch, tolerance, &Sought { least, inside, is_given: false, segment: 2.0 })
}

/// Returns the factors with which a patch has the fewest triangles if no neighbour asks for anything.
pub(super) fn own_least_rows(patch: &SeenPatch, tolerance: f32, least: [f32; 3], inside: f32) -> Chosen {
    fewest_rows(patch, tolerance, &Sought { least, inside, is_given: false, segment: 1.0 })
}

/// Returns the inside factor of the rows with the fewest triangles that keep a patch within a tolerance beside these factors of
/// its edges; [`BEYOND_LAST`] if none do.
pub(super) fn rows_beside(patch: &SeenPatch, tolerance: f32, edges: [f32; 3], inside: f32) -> f32 {
    fewest_rows(patch, tolerance, &Sought { least: edges, inside, is_given: true, segment: 1.0 }).inside
}

/// Returns the number of points inside a patch.
fn points_inside(edges: [f32; 3], inside: f32) -> f32 {
    let factors = process(Partitioning::Rows, edges, inside);
    (point_count(factors) - outer_count(factors)) as f32
}

/// Returns whether a patch asks its edges again: beside what other patches asked for, it has many more points inside than with
/// what it has chosen.
pub(super) fn rows_ask_again(chosen: &Chosen, edges: [f32; 3], inside: f32) -> bool {
    inside == BEYOND_LAST || points_inside(edges, inside) > 1.1 * points_inside(chosen.edges, chosen.inside) + 2.0
}

#[cfg(test)]
mod tests;
