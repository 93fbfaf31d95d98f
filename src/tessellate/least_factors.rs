//! LOD by error: the factors with the fewest triangles whose pattern stays within a tolerance. Twin:
//! `shaders/least_factors.wgsl`.
//!
//! The triangles along an edge (its *row*) depend on that edge's factor and on the inside factor alone, and all others
//! on the inside factor alone. So every patch looks for the inside factor with which it and its edges together have the
//! fewest triangles, and asks each edge for a factor. An edge gets the largest factor that its patches ask for. Then
//! every patch takes the least inside factor that suffices with the factors of its edges.

use glam::Vec2;

use super::error::whole_segments;
use super::factors::{
    FIXED_ONE, Partitioning, PatchFactors, inside_segments, patch_is_minimal, process, segments, triangle_count,
};
use super::lod::LodView;
use super::piece_error::{SeenPatch, piece_error};
use super::{domain_plan, domain_point, domain_triangle};
use glam::Vec3;

/// The part of the tolerance that bounds may use up. The rest is for rounding, that of domain points to 16.16 too.
pub(crate) const BOUND_SHARE: f32 = 0.999;

/// Returns the largest factor of a partitioning.
pub(crate) fn last_factor(partitioning: Partitioning) -> f32 {
    if partitioning == Partitioning::FractionalOdd { 63.0 } else { 64.0 }
}

/// Returns the least factor above `factor` that may suffice, if the error with `factor` segments is `error`, which falls
/// with the square of their number.
fn next_factor(partitioning: Partitioning, factor: f32, error: f32, tolerance: f32) -> f32 {
    let ratio = (error / tolerance).sqrt();
    // NaN counts as infinite.
    let guess = if ratio < 64.0 { 0.8 * ratio * factor } else { 65.0 };
    whole_segments(partitioning, guess.floor().max(factor + 1.0))
}

/// Returns the least number of segments that keeps a curve within `tolerance` px, as far as three points a segment tell.
/// The result is above 64 if no number does. It's where the search of patches starts, and needs to be no bound.
pub(crate) fn least_edge_factor(
    view: &LodView,
    tolerance: f32,
    partitioning: Partitioning,
    control_points: [Vec3; 4],
) -> f32 {
    let net = control_points.map(|p| super::piece_error::clip_point(view, p));
    let [a, ab, ba, b] = net;
    let mut factor = whole_segments(partitioning, 1.0);
    let at = |t: f32| {
        let s = 1.0 - t;
        a * (s * s * s) + ab * (3.0 * s * s * t) + ba * (3.0 * s * t * t) + b * (t * t * t)
    };
    let near = super::piece_error::near_depth(view);
    loop {
        let mut worst = 0.0f32;
        let mut start = a;
        for i in 0..factor as u32 {
            let from = i as f32 / factor;
            let end = at((i + 1) as f32 / factor);
            for k in 1..4 {
                let share = 0.25 * k as f32;
                let surface = at(from + share / factor);
                let flat = start + (end - start) * share;
                if surface.z > near && flat.z > near && surface.z > 0.0 && flat.z > 0.0 {
                    let own = (surface.truncate() / surface.z).distance(flat.truncate() / flat.z);
                    let seen = (surface.truncate() / surface.z).abs().cmple(view.half_viewport).all();
                    if seen && own > worst {
                        worst = own;
                    }
                }
            }
            start = end;
        }
        if worst <= tolerance || factor >= last_factor(partitioning) {
            return factor;
        }
        factor = next_factor(partitioning, factor, worst, tolerance).min(last_factor(partitioning));
    }
}

/// Returns the largest error, in px, of the triangles `first` to `end` of a pattern. It ends early once an error isn't
/// within the tolerance.
fn triangles_error(patch: &SeenPatch, factors: PatchFactors, first: u32, end: u32, tolerance: f32) -> f32 {
    let plan = domain_plan(factors);
    let mut worst = 0.0f32;
    for t in first..end {
        let at = domain_triangle(&plan, t).map(|i| {
            let [u, v] = domain_point(&plan, i);
            Vec2::new(u as f32, v as f32) / FIXED_ONE as f32
        });
        let error = piece_error(patch, at, tolerance);
        if !(error <= worst) {
            worst = error;
        }
        if !(worst <= tolerance) {
            break;
        }
    }
    worst
}

/// Returns the error of the row along the edge `k` (U == 0, V == 0 or W == 0).
fn row_error(patch: &SeenPatch, factors: PatchFactors, k: usize, tolerance: f32) -> f32 {
    let inner = inside_segments(factors.inside) - 2;
    let mut first = k as u32 * inner;
    for i in 0..k {
        first += segments(factors.outside[i]);
    }
    triangles_error(patch, factors, first, first + segments(factors.outside[k]) + inner, tolerance)
}

/// Returns the error of the triangles that belong to no edge's row.
fn inner_error(patch: &SeenPatch, factors: PatchFactors, tolerance: f32) -> f32 {
    let rows = super::outer_count(factors) + 3 * (inside_segments(factors.inside) - 2);
    triangles_error(patch, factors, rows, triangle_count(factors), tolerance)
}

/// Returns the least inside factor, at least `least`, with which the triangles that belong to no row are within the
/// tolerance. The result is above 64 if none is.
fn least_inner_factor(patch: &SeenPatch, tolerance: f32, partitioning: Partitioning, least: f32) -> f32 {
    let mut inside = whole_segments(partitioning, least.max(2.0));
    loop {
        if inside > last_factor(partitioning) {
            return 64.5;
        }
        let error = inner_error(patch, process(partitioning, [2.0; 3], inside), tolerance);
        if error <= tolerance {
            return inside;
        }
        inside = next_factor(partitioning, inside, error, tolerance);
    }
}

/// Returns whether one triangle is within the tolerance.
fn single_suffices(patch: &SeenPatch, tolerance: f32, partitioning: Partitioning, least: f32) -> bool {
    let factors = process(partitioning, [1.0; 3], 1.0);
    least <= 1.0 && patch_is_minimal(factors) && triangles_error(patch, factors, 0, 1, tolerance) <= tolerance
}

/// Returns the least factor of edge `k`, at least `least`, whose row is within the tolerance beside `inside` segments.
/// The result is above 64 if none up to `most` is.
fn least_row_factor(
    patch: &SeenPatch,
    tolerance: f32,
    partitioning: Partitioning,
    k: usize,
    least: f32,
    inside: f32,
) -> f32 {
    let mut factor = least;
    let most = (least.max(inside) + 2.0).min(last_factor(partitioning));
    loop {
        if !(factor <= most) {
            return 64.5;
        }
        let mut edges = [2.0; 3];
        edges[k] = factor;
        let error = row_error(patch, process(partitioning, edges, inside), k, tolerance);
        if error <= tolerance {
            return factor;
        }
        factor = next_factor(partitioning, factor, error, tolerance);
    }
}

/// Returns the factors of the edges U == 0, V == 0 and W == 0 that a patch asks for. `least` are the least that its
/// edges may get, and `least_inside` is the least inside factor.
pub(crate) fn asked_factors(
    patch: &SeenPatch,
    tolerance: f32,
    partitioning: Partitioning,
    least: [f32; 3],
    least_inside: f32,
) -> [f32; 3] {
    let tolerance = BOUND_SHARE * tolerance;
    let most = least[0].max(least[1]).max(least[2]);
    if most <= 1.0 && single_suffices(patch, tolerance, partitioning, least_inside) {
        return least;
    }
    let mut best = least;
    let mut fewest = 3.4e38;
    let mut inside = least_inner_factor(patch, tolerance, partitioning, least_inside);
    while inside <= last_factor(partitioning) {
        // A segment of an edge costs a triangle on each of its two sides.
        let rings = inside - 2.0;
        let own = 3.0 * rings + 1.5 * rings * rings;
        if own + 2.0 * (least[0] + least[1] + least[2]) >= fewest {
            break;
        }
        let mut asked = least;
        let mut cost = own;
        for k in 0..3 {
            asked[k] = least_row_factor(patch, tolerance, partitioning, k, least[k], inside);
            cost += if asked[k] > 64.0 { 3.4e38 } else { 2.0 * asked[k] };
            if cost >= fewest {
                break;
            }
        }
        if cost < fewest {
            fewest = cost;
            best = asked;
        }
        inside = least_inner_factor(patch, tolerance, partitioning, inside + 1.0);
    }
    best
}

/// Returns the least inside factor, at least `least`, that keeps a patch within `tolerance` px of its surface, given the
/// factors of the edges U == 0, V == 0 and W == 0. The result is above 64 if no factor does.
pub(crate) fn least_inside_factor(
    patch: &SeenPatch,
    tolerance: f32,
    partitioning: Partitioning,
    edges: [f32; 3],
    least: f32,
) -> f32 {
    let tolerance = BOUND_SHARE * tolerance;
    let most = edges[0].max(edges[1]).max(edges[2]);
    if most <= 1.0 && single_suffices(patch, tolerance, partitioning, least) {
        return 1.0;
    }
    let mut inside = least_inner_factor(patch, tolerance, partitioning, least);
    while inside <= last_factor(partitioning) {
        let factors = process(partitioning, edges, inside);
        let mut worst = 0.0f32;
        for k in 0..3 {
            let error = row_error(patch, factors, k, tolerance);
            if !(error <= worst) {
                worst = error;
            }
            if !(worst <= tolerance) {
                break;
            }
        }
        if worst <= tolerance {
            return inside;
        }
        inside = least_inner_factor(patch, tolerance, partitioning, inside + 1.0);
    }
    64.5
}
