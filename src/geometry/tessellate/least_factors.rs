//! LOD by error: the factors with the fewest triangles whose pattern stays within a tolerance. Twin:
//! `shaders/least_factors.wgsl`.
//!
//! The triangles along an edge (its *row*) depend on that edge's factor and on the inside factor alone, and all others
//! depend on the inside factor alone. So every patch looks for the inside factor with which it and its edges together
//! have the fewest triangles, and asks each edge for a factor. An edge gets the largest factor that its patches request.
//! Then every patch takes the least inside factor that suffices beside the factors of its edges. If that is much larger than
//! what it has chosen, it requests again. If in the end one factor for all edges takes fewer triangles, all edges get that one.

use std::array::from_fn;

use glam::{Vec2, Vec3};

use super::domain::{DomainPlan, domain_plan, domain_triangle_places};
use super::factors::{
    FIXED_ONE, Partitioning, PatchFactors, ROW_BASE_STEP, inside_segments, last_factor, patch_has_rows,
    patch_is_minimal, process, round_pow2, segments, triangle_count,
};
use super::lod::LodView;
use super::piece_error::{SeenPatch, clip_point, deeper, depth_scale, may_slide, near_depth, piece_error};

/// The part of the tolerance that bounds may use up. The rest is for rounding.
pub const BOUND_SHARE: f32 = 0.999;

/// A factor that is requested if none is enough.
pub const BEYOND_LAST: f32 = 127.5;

/// Returns the least number of segments, `least` or more, that a partitioning has without fractions: any whole number,
/// a power of two, or an odd or even number.
pub(super) fn whole_segments(partitioning: Partitioning, least: f32) -> f32 {
    match partitioning {
        Partitioning::Integer | Partitioning::Subtriangulation | Partitioning::Rows => least.ceil(),
        Partitioning::Pow2 => round_pow2(least),
        Partitioning::FractionalOdd => 2.0 * (0.5 * (least - 1.0)).ceil() + 1.0,
        Partitioning::FractionalEven => 2.0 * (0.5 * least).ceil(),
    }
}

/// Returns the least factor of a partitioning, `least` or more; [`BEYOND_LAST`] if it has none.
fn factor_from(partitioning: Partitioning, least: f32) -> f32 {
    if least <= last_factor(partitioning) { whole_segments(partitioning, least) } else { BEYOND_LAST }
}

/// Returns the least factor above `factor` that may be enough if `factor` segments have this error, which falls with the
/// square of their number. Beyond the last factor it returns [`BEYOND_LAST`].
fn next_factor(partitioning: Partitioning, factor: f32, error: f32, tolerance: f32) -> f32 {
    let ratio = (error / tolerance).sqrt();
    // The estimate is lowered, so that it passes over no factor that is enough. NaN counts as infinite.
    let estimate = if ratio < 100.0 { (0.8 * ratio * factor).floor() } else { BEYOND_LAST };
    factor_from(partitioning, estimate.max(factor + 1.0))
}

/// Returns a point of a cubic curve.
fn curve_point([a, ab, ba, b]: [Vec3; 4], t: f32) -> Vec3 {
    let s = 1.0 - t;
    a * (s * s * s) + ab * (3.0 * s * s * t) + ba * (3.0 * s * t * t) + b * (t * t * t)
}

/// Returns the largest distance in px between a curve and its `factor` segments, at three points of each that are in
/// view. The control points are in clip space, as [`clip_point`] returns them.
fn sampled_edge_error(half_viewport: Vec2, near: f32, curve: [Vec3; 4], factor: f32) -> f32 {
    let mut worst = 0.0f32;
    let mut start = curve[0];
    for i in 0..factor as u32 {
        let end = curve_point(curve, (i as f32 + 1.0) / factor);
        for k in 1..4 {
            let share = 0.25 * k as f32;
            let flat = start + (end - start) * share;
            let point = curve_point(curve, (i as f32 + share) / factor);
            let nearest = flat.z.min(point.z);
            let place = point.truncate() / point.z;
            let outside = place.abs() - half_viewport;
            if nearest > 0.0 && nearest >= near && outside.x.max(outside.y) <= 0.0 {
                worst = worst.max(place.distance(flat.truncate() / flat.z));
            }
        }
        start = end;
    }
    worst
}

/// Returns the least number of segments that keeps a curve within `tolerance` px, as far as samples tell; [`BEYOND_LAST`] if none
/// does. Patches start from it when they look for factors, and take care of the bound themselves.
pub(super) fn least_edge_factor(
    view: &LodView,
    tolerance: f32,
    partitioning: Partitioning,
    control_points: [Vec3; 4],
) -> f32 {
    let deepest = control_points.into_iter().fold(0.0, |deepest, p| deeper(view, deepest, p));
    let scale = depth_scale(deepest);
    let curve = control_points.map(|p| clip_point(view, scale, p));
    let near = near_depth(view) * scale;
    let mut factor = whole_segments(partitioning, 1.0);
    while factor <= last_factor(partitioning) {
        let error = sampled_edge_error(view.half_viewport, near, curve, factor);
        if error <= tolerance {
            return factor;
        }
        factor = next_factor(partitioning, factor, error, tolerance);
    }
    BEYOND_LAST
}

/// Returns the error of triangle `t` of a pattern, in px; a large number in place of NaN.
fn triangle_error_at(patch: &SeenPatch, tolerance: f32, plan: &DomainPlan, t: u32) -> f32 {
    // As weights of corners 0 and 1.
    let weights = |[u, v]: [u32; 2]| Vec2::new(u as f32, v as f32) / FIXED_ONE as f32;
    let error = piece_error(patch, tolerance, domain_triangle_places(plan, t).map(weights));
    if error < 3.4e38 { error } else { 3.4e38 }
}

/// Returns whether one triangle is within the tolerance in place of the patch, with these least factors of its edges and of
/// its inside.
fn single_suffices(
    patch: &SeenPatch,
    tolerance: f32,
    partitioning: Partitioning,
    edges: [f32; 3],
    inside: f32,
) -> bool {
    let factors = process(partitioning, [1.0; 3], 1.0);
    let whole = edges[0].max(edges[1]).max(edges[2]).max(inside) <= 1.0;
    whole && patch_is_minimal(factors) && triangle_error_at(patch, tolerance, &domain_plan(factors), 0) <= tolerance
}

/// How many triangles are looked at together, before those with one that isn't within the tolerance end the search.
pub const TOGETHER: u32 = 8;

/// A prime beyond the number of turns in which a pattern's triangles are looked at: its multiples are spread over them.
pub const SPREAD: u32 = 2027;

/// Returns the numbers of triangles of a pattern's parts, which follow each other: the rows along its edges U == 0, V == 0 and
/// W == 0, and its inner triangles, which lie along no edge. Of rows all are counted as inner ones.
fn part_counts(factors: PatchFactors) -> [u32; 4] {
    if patch_has_rows(factors) {
        return [0, 0, 0, triangle_count(factors)];
    }
    let [u, v, w] = factors.outside.map(|word| segments(word) + inside_segments(factors.inside) - 2);
    [u, v, w, triangle_count(factors) - u - v - w]
}

/// Returns the largest error, in px, of each wanted part of a pattern, and 0 for the others. [`TOGETHER`] triangles are looked at
/// in one turn, spread over all parts. That ends early with the first turn after which no part is within the tolerance.
pub(super) fn part_errors(patch: &SeenPatch, tolerance: f32, factors: PatchFactors, wanted: [bool; 4]) -> [f32; 4] {
    let plan = domain_plan(factors);
    let all = part_counts(factors);
    let starts: [u32; 4] = from_fn(|part| all[..part].iter().sum());
    let counts: [u32; 4] = from_fn(|part| if wanted[part] { all[part] } else { 0 });
    let ends: [u32; 4] = from_fn(|part| counts[..=part].iter().sum());
    let turns = ends[3].div_ceil(TOGETHER);
    let mut worst = [0.0f32; 4];
    let (mut turn, mut goes_on) = (0, true);
    while turn < turns && goes_on {
        let before = worst;
        for i in (0..TOGETHER).map(|lane| lane * turns + turn * SPREAD % turns) {
            let part = ends[..3].iter().filter(|&&end| i >= end).count();
            if i < ends[3] && before[part] <= tolerance {
                let t = starts[part] + i - (ends[part] - counts[part]);
                worst[part] = worst[part].max(triangle_error_at(patch, tolerance, &plan, t));
            }
        }
        goes_on = (0..4).any(|part| wanted[part] && worst[part] <= tolerance);
        turn += 1;
    }
    worst
}

/// How much larger a factor of an edge is tried than the least one and the inside factor: with more, triangles are long
/// where the points of edge and ring don't match.
pub const ROW_REACH: f32 = 6.0;

/// Returns the factor of an edge that is tried after `factor`, whose row has this error beside `inside` segments;
/// [`BEYOND_LAST`] if none is enough up to the larger of `least` and `inside`, and [`ROW_REACH`]. Where points may slide, there
/// is no such end.
fn next_row_factor(
    partitioning: Partitioning,
    slides: bool,
    [least, inside]: [f32; 2],
    factor: f32,
    error: f32,
    tolerance: f32,
) -> f32 {
    let estimate = next_factor(partitioning, factor, error, tolerance);
    if slides {
        return estimate;
    }
    // Errors of rows don't fall steadily: where the points of edge and ring don't match, triangles are up to twice as
    // long. Where points may slide, that doesn't matter. More segments than the ring has make no triangle shorter.
    let last = factor_from(partitioning, least.max(inside) + ROW_REACH);
    let next = factor_from(partitioning, factor + 1.0);
    if next <= last && 0.5 * estimate <= inside.max(factor) { next } else { BEYOND_LAST }
}

/// Returns the number of triangles of a pattern, if a segment of an edge counts as `segment` triangles.
fn pattern_cost(edges: [f32; 3], inside: f32, segment: f32) -> f32 {
    let rings = inside - 2.0;
    3.0 * rings + 1.5 * rings * rings + segment * (edges[0] + edges[1] + edges[2])
}

/// The factors that a patch has chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ChosenFactors {
    /// Of the edges U == 0, V == 0 and W == 0.
    pub edges: [f32; 3],
    pub inside: f32,
    /// The least inside factor above 2 with which the inner triangles are within the tolerance; 0 if it isn't known.
    pub inner: f32,
}

impl ChosenFactors {
    /// What the patch requests for its edges. If nothing is within the tolerance, it comes as close as it can.
    pub(super) fn requests(&self, partitioning: Partitioning) -> [f32; 3] {
        let least = if self.inside == BEYOND_LAST { last_factor(partitioning) } else { 1.0 };
        self.edges.map(|edge| edge.max(least))
    }
}

/// What the factors of a patch's edges are that are looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SearchGoal {
    /// What the patch requests for its edges. Every segment of an edge is a triangle's side in this patch and in its neighbour.
    Requests,
    /// What it would have if no neighbour requested anything.
    Own,
    /// What its edges have: only the inside is looked for.
    Given,
}

/// What a patch looks for.
#[derive(Clone, Copy, Debug)]
pub(super) struct FactorSearch {
    /// The least factors that the edges U == 0, V == 0 and W == 0 may get, or those that they have.
    pub least: [f32; 3],
    /// The least inside factor; of rows the least number of rows and of segments of a row.
    pub inside: f32,
    /// As in [`ChosenFactors`].
    pub inner: f32,
    pub wanted: SearchGoal,
}

/// Returns the inside factor that a patch gets without a search, if there is one: if one triangle is within the tolerance, or if
/// more segments are sought than there are.
pub(super) fn without_search(
    patch: &SeenPatch,
    within: f32,
    partitioning: Partitioning,
    sought: &FactorSearch,
) -> Option<f32> {
    let FactorSearch { least, inside, .. } = *sought;
    if single_suffices(patch, within, partitioning, least, inside) {
        return Some(if partitioning.has_rows() { (ROW_BASE_STEP + 1) as f32 } else { 1.0 });
    }
    let most = least[0].max(least[1]).max(least[2]).max(inside);
    if most > last_factor(partitioning) { Some(BEYOND_LAST) } else { None }
}

/// A step of a search: an inside factor; whether its inner triangles are looked at, or its rows; and whether the other ones
/// are known to be within the tolerance.
#[derive(Clone, Copy)]
struct Step {
    inside: f32,
    is_inner: bool,
    is_last: bool,
}

/// Returns the first step. `least_inside` is the least inside factor, and `inner` is as in [`ChosenFactors`].
fn first_step(partitioning: Partitioning, least_inside: f32, inner: f32) -> Step {
    let inside = factor_from(partitioning, least_inside.max(2.0));
    // Two segments leave no inner triangles.
    if inside == 2.0 || inner == 0.0 {
        return Step { inside, is_inner: inside > 2.0, is_last: inside == 2.0 };
    }
    Step { inside: inner, is_inner: false, is_last: true }
}

/// Returns the step after an inside factor that isn't enough. `error` is that of its inner triangles, 0 if these are within
/// the tolerance.
fn next_step(partitioning: Partitioning, inside: f32, inner: f32, error: f32, tolerance: f32) -> Step {
    if inside == 2.0 && inner > 0.0 {
        return Step { inside: inner, is_inner: false, is_last: true };
    }
    let next = match error > tolerance {
        true => next_factor(partitioning, inside, error, tolerance),
        false => factor_from(partitioning, inside + 1.0),
    };
    // Beyond the least one, inner triangles are rarely what is missing, and there are more of them.
    Step { inside: next, is_inner: inner == 0.0, is_last: false }
}

/// Returns the factors with which a patch is within the tolerance and has the fewest triangles. If no factors are enough, it
/// returns the least ones and [`BEYOND_LAST`].
pub(super) fn fewest_triangles(
    patch: &SeenPatch,
    tolerance: f32,
    partitioning: Partitioning,
    sought: &FactorSearch,
) -> ChosenFactors {
    let within = BOUND_SHARE * tolerance;
    let FactorSearch { least, inside: least_inside, inner, wanted } = *sought;
    if let Some(inside) = without_search(patch, within, partitioning, sought) {
        return ChosenFactors { edges: least, inside, inner };
    }
    let slides = may_slide(patch, within);
    let segment = if wanted == SearchGoal::Requests { 2.0 } else { 1.0 };
    let mut best = ChosenFactors { edges: least, inside: BEYOND_LAST, inner };
    let mut fewest = 3.4e38;
    let mut step = first_step(partitioning, least_inside, inner);
    let (mut edges, mut rows) = (least, [true; 3]);
    while step.inside <= last_factor(partitioning) && pattern_cost(least, step.inside, segment) < fewest {
        let Step { inside, is_inner, is_last } = step;
        let looked_at = if is_inner { [false, false, false, true] } else { [rows[0], rows[1], rows[2], false] };
        let errors = part_errors(patch, within, process(partitioning, edges, inside), looked_at);
        let fails = errors.map(|error| error > within);
        for k in (0..3).filter(|&k| fails[k]) {
            let [factor, error] = [edges[k], errors[k]];
            edges[k] = match wanted {
                SearchGoal::Given => BEYOND_LAST,
                _ => next_row_factor(partitioning, slides, [least[k], inside], factor, error, within),
            };
        }
        let cost = pattern_cost(edges, inside, segment);
        let mut is_over = fails[3] || cost >= fewest || edges[0].max(edges[1]).max(edges[2]) == BEYOND_LAST;
        rows = [fails[0], fails[1], fails[2]];
        if !fails.contains(&true) {
            best.inner = if is_inner && best.inner == 0.0 { inside } else { best.inner };
            if is_last && !is_over {
                fewest = cost;
                best = ChosenFactors { edges, inside, ..best };
            }
            is_over = is_over || is_last;
            rows = [true; 3];
            step = Step { inside, is_inner: !is_inner, is_last: true };
        }
        if is_over {
            step = next_step(partitioning, inside, best.inner, errors[3], within);
            (edges, rows) = (least, [true; 3]);
        }
    }
    best
}

/// Returns whether a patch requests factors for its edges again: beside what other patches requested, its inside factor is much larger
/// than the one that it has chosen.
pub(super) fn requests_again(chosen: f32, inside: f32) -> bool {
    inside == BEYOND_LAST || inside > 1.1 * chosen + 1.0
}

/// Returns whether a patch is within `tolerance` px of its surface if its edges and its inside all have one factor, from 2 on.
pub(super) fn uniform_suffices(patch: &SeenPatch, tolerance: f32, partitioning: Partitioning, factor: f32) -> bool {
    let within = BOUND_SHARE * tolerance;
    let factors = process(partitioning, [factor; 3], factor);
    part_errors(patch, within, factors, [true; 4]).iter().all(|error| *error <= within)
}

#[cfg(test)]
mod tests;
