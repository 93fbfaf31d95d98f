//! LOD by error: how many segments keep the emitted triangles within a distance, in px on screen, of the surface. Twin:
//! `shaders/error.wgsl`.
//!
//! The distance between a polynomial and its linear interpolation is bounded by its second derivatives. Those of a
//! Bézier curve or triangle are bounded by the second differences of its control points (G. Wang: *The subdivision
//! method for finding the intersection between two Bézier curves or surfaces*, 1984; D. Filip, R. Magedson, R. Markot:
//! *Surface algorithms using bounds on derivatives*, 1986).
//!
//! Differences are computed in object units and then bounded on screen. In clip space the difference of two points a
//! and b on screen is (a.xy - b.xy / b.w * a.w) / a.w. So it is at most the largest |d.xy - s d.w| / w, where d = a -
//! b, w is the least depth of the control points, and s is any value between their least and greatest x / w and y / w.

use glam::{Vec2, Vec3};

use super::factors::{Partitioning, round_pow2};
use super::lod::{LodView, clip_row, max_with_one};
use super::surface::ControlNet;
use crate::mesh::MAX_LEVELS;

/// Bounds on the depth and the screen position of a set of control points, from which the size of differences on screen
/// is bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScreenBounds {
    /// The least and the greatest depth (w). Depths nearer than the near plane count as the near plane's, since nothing
    /// in front of it is visible.
    pub nearest: f32,
    pub farthest: f32,
    /// The least and the greatest x / w and y / w, from -1 to 1 over the view: of the control points if all lie beyond
    /// the near plane, otherwise at least those of the whole view.
    pub least: Vec2,
    pub greatest: Vec2,
    /// Whether a control point is nearer than the near plane.
    pub is_cut: bool,
}

/// The part of the tolerance that edges may use up. The rest is for the rows of triangles beside them, which also bend
/// in other directions.
pub(crate) const EDGE_SHARE: f32 = 0.75;

/// Returns the bounds of no points, to be widened.
fn no_bounds() -> ScreenBounds {
    ScreenBounds {
        nearest: 3.4e38,
        farthest: 0.0,
        least: Vec2::splat(3.4e38),
        greatest: Vec2::splat(-3.4e38),
        is_cut: false,
    }
}

/// Widens the bounds to include a control point `p` in object units, wherever displacement moves it.
pub(super) fn widen(view: &LodView, bounds: ScreenBounds, p: Vec3) -> ScreenBounds {
    let clip = view.clip_from_object * p.extend(1.0);
    let depth = clip.w.max(clip.z);
    let place = Vec2::new(clip.x, clip.y) / depth;
    // How far displacement may move the point in depth, past the near plane, and across the view.
    let deep = clip_row(view, 3).length() * view.reach;
    let past_near = (clip_row(view, 3) - clip_row(view, 2)).length() * view.reach;
    let across = Vec2::new(clip_row(view, 0).length(), clip_row(view, 1).length()) * view.reach;
    let beyond = clip.z + past_near <= clip.w;
    let nearest = (clip.w - deep).max(clip.z);
    let spread = (across + place.abs() * deep) / nearest;
    ScreenBounds {
        nearest: bounds.nearest.min(nearest),
        farthest: bounds.farthest.max(depth + deep),
        least: bounds.least.min(if beyond { place - spread } else { Vec2::NEG_ONE }),
        greatest: bounds.greatest.max(if beyond { place + spread } else { Vec2::ONE }),
        is_cut: bounds.is_cut || !beyond,
    }
}

/// Returns the bounds of an edge's four control points.
pub(super) fn edge_bounds(view: &LodView, [a, ab, ba, b]: [Vec3; 4]) -> ScreenBounds {
    widen(view, widen(view, widen(view, widen(view, no_bounds(), a), ab), ba), b)
}

/// Returns the bounds of a patch's ten control points.
pub(super) fn net_bounds(view: &LodView, net: &ControlNet) -> ScreenBounds {
    let mut bounds = widen(view, no_bounds(), net.center);
    for k in 0..3 {
        bounds = widen(view, bounds, net.corners[k]);
        bounds = widen(view, bounds, net.edges[2 * k]);
        bounds = widen(view, bounds, net.edges[2 * k + 1]);
    }
    bounds
}

/// Returns the bounds of points that are weighted means: `share` (0 to 1) of a point within `other`, and the rest of a
/// point within `own`. The bounds `own` must lie within `other`.
pub(super) fn mixed_bounds(own: ScreenBounds, other: ScreenBounds, share: f32) -> ScreenBounds {
    if other.is_cut {
        // The true least depth isn't known: `nearest` was clamped to the near plane, and a mean of it would be too far.
        return other;
    }
    let nearest = own.nearest + share * (other.nearest - own.nearest);
    // On screen, means are weighted by depth.
    let reach = (share * other.farthest / nearest).min(1.0);
    ScreenBounds {
        nearest,
        farthest: other.farthest,
        least: own.least + (other.least - own.least) * reach,
        greatest: own.greatest + (other.greatest - own.greatest) * reach,
        is_cut: false,
    }
}

/// Returns a bound on the length on screen, in px, of the difference vector of two points. The vector is in object
/// units.
pub(super) fn screen_length(view: &LodView, bounds: ScreenBounds, difference: Vec3) -> f32 {
    let across = Vec2::new(clip_row(view, 0).dot(difference), clip_row(view, 1).dot(difference));
    let deep = clip_row(view, 3).dot(difference);
    let a = (across - bounds.least * deep).abs();
    let b = (across - bounds.greatest * deep).abs();
    // Divide before the length is taken: squares of tiny numbers underflow.
    (a.max(b) / bounds.nearest * view.half_viewport).length()
}

/// Returns a bound on the length on screen, in px, of any vector whose length is `radius` object units.
pub(super) fn screen_radius(view: &LodView, bounds: ScreenBounds, radius: f32) -> f32 {
    let across = Vec2::new(clip_row(view, 0).length(), clip_row(view, 1).length());
    let deep = clip_row(view, 3).length();
    let most = bounds.least.abs().max(bounds.greatest.abs());
    ((across + most * deep) * (radius / bounds.nearest) * view.half_viewport).length()
}

/// Returns the least *level* of `least` or more. A level is a factor whose rows of points nest with the rows of all
/// other levels. What is beyond the last level is returned as it is, as a factor above 64, so that callers can tell.
///
/// The levels are 1, 2, 3, 4, 5, 8, 16, 32 and 64 for integer factors, the powers of two among these for pow2, and the
/// even powers of two for fractional-even. For fractional-odd they are 1, 3, 5, 9, 17 and 33.
///
/// The tessellator joins two rows with different numbers of segments in one fixed order, in which each new point halves
/// the widest gap. Other numbers of segments are uneven in that order. Triangles between such rows reach along the rows
/// by up to five segments, which costs up to 25 times the error of one segment. Between levels they reach by one
/// segment.
pub(crate) fn nesting_factor(partitioning: Partitioning, least: f32) -> f32 {
    let odd = partitioning == Partitioning::FractionalOdd;
    if least > if odd { 33.0 } else { 64.0 } {
        return least.max(64.5);
    }
    if odd {
        return if least <= 1.0 { 1.0 } else { 1.0 + round_pow2((least - 1.0).max(2.0)) };
    }
    if partitioning == Partitioning::FractionalEven {
        return round_pow2(least.max(2.0));
    }
    if partitioning == Partitioning::Integer && least <= 5.0 {
        return least.ceil();
    }
    round_pow2(least)
}

/// The numbers of segments inside whose first ring nests with an edge of 5, 8, 9, 16, 17, 32, 33 or 64 segments (one
/// row each). Bit n - 1 stands for n segments; the first word has 1 to 32. A test derives the table from the
/// tessellator.
pub(crate) const NESTING: [[u32; 2]; 8] = [
    [0xfffff797, 0xffffffff],
    [0xffffe19f, 0xffffffff],
    [0xe4078117, 0xff5c177f],
    [0xe001819f, 0xfe000007],
    [0x80010117, 0xe0000005],
    [0x8001819f, 0xe0000001],
    [0x00010117, 0x80000001],
    [0x8001819f, 0x80000001],
];

/// Returns whether the first ring of a patch with `segments` segments inside nests with an edge of the level `factor`.
///
/// Every ring nests with an edge of up to four segments. Beyond the last level the result doesn't matter, so it is
/// true.
pub(super) fn nests(factor: f32, segments: u32) -> bool {
    if factor <= 4.0 || factor > 64.0 {
        return true;
    }
    // The factor is 5, 8, 9, 16, 17, 32, 33 or 64: a power of two, or one more than a power of two.
    let power = round_pow2(factor);
    let above = if factor == power { 0 } else { 1 };
    // The exponent of that power of two: 4, 8, 16, 32 or 64.
    let exponent = ((power.to_bits() >> 23) - 127) - above;
    let words = NESTING[(2 * exponent + above - 5) as usize];
    let bit = segments - 1;
    (words[(bit >> 5) as usize] >> (bit & 31)) & 1 == 1
}

/// Returns the least factor (not rounded, 1 or more) that keeps an edge within `tolerance` px of its cubic curve:
/// sqrt(3/4 d / tolerance), where d is the larger second difference on screen in px (Wang 1984).
pub(crate) fn edge_error_factor(view: &LodView, tolerance: f32, control_points: [Vec3; 4]) -> f32 {
    let bounds = edge_bounds(view, control_points);
    let [a, ab, ba, b] = control_points;
    let near_a = screen_length(view, bounds, a - ab * 2.0 + ba);
    let near_b = screen_length(view, bounds, ab - ba * 2.0 + b);
    max_with_one((0.75 * near_a.max(near_b) / tolerance).sqrt())
}

/// The shares of the tolerance where a surface is displaced: for the surface without displacement, for the detail of
/// the heights that is lost between segments, and for the turning of the direction of displacement.
pub(crate) const SURFACE_SHARE: f32 = 0.5;
pub(crate) const DETAIL_SHARE: f32 = 0.3;
pub(crate) const TURN_SHARE: f32 = 0.2;

/// Returns the least factor (not rounded, 1 or more) that shows the heights of one image along an edge, which is
/// `texels` px of level 0 long.
///
/// Segments are as long as the px of the coarsest mip level whose loss is within its share of the tolerance. `detail`
/// has the loss of each level, which becomes object units when multiplied by `scale`. They are also short enough for
/// the turning of the direction of displacement: `turn` is the distance between the unit directions at the edge's ends.
/// This is an estimate: between two px an image may rise by more than its levels tell.
pub(super) fn displacement_factor(
    view: &LodView,
    bounds: ScreenBounds,
    tolerance: f32,
    texels: f32,
    turn: f32,
    scale: f32,
    detail: [f32; MAX_LEVELS],
) -> f32 {
    // The sagitta of an arc of radius 1 is an eighth of the squared angle, and `turn` is at least 2/3 of the angle:
    // 9/4 * 1/8 = 0.28125.
    let bend = screen_radius(view, bounds, view.reach * 0.28125 * turn * turn);
    let mut segments = texels;
    for lost in &detail[1..] {
        if screen_radius(view, bounds, scale * lost) > DETAIL_SHARE * tolerance {
            break;
        }
        segments *= 0.5;
    }
    max_with_one(segments.max((bend / (TURN_SHARE * tolerance)).sqrt()))
}

/// Returns the control point with these three indices (0 to 2), in any order: (0, 0, 1) is b210.
pub(super) fn control_point(net: &ControlNet, i: usize, j: usize, l: usize) -> Vec3 {
    if i == j && j == l {
        return net.corners[i];
    }
    if i != j && j != l && l != i {
        return net.center;
    }
    // The index that occurs twice, and the one that occurs once.
    let twice = if i == j || i == l { i } else { j };
    let once = i + j + l - 2 * twice;
    if once == (twice + 1) % 3 { net.edges[2 * twice] } else { net.edges[2 * once + 1] }
}

/// Returns a sixth of a patch's second derivatives at corner `i`, in object units: twice along the edge opposite corner
/// `k`; once along it and once inward; twice inward.
///
/// *Inward* is the vector of 2/3 of the median towards corner `k`. For each segment the tessellator places a ring that
/// far inside.
pub(super) fn second_differences(net: &ControlNet, i: usize, k: usize) -> [Vec3; 3] {
    let p = (k + 1) % 3;
    let q = (k + 2) % 3;
    let pp = control_point(net, i, p, p);
    let pq = control_point(net, i, p, q);
    let qq = control_point(net, i, q, q);
    let kp = control_point(net, i, k, p);
    let kq = control_point(net, i, k, q);
    let kk = control_point(net, i, k, k);
    let along = pp - pq * 2.0 + qq;
    let mixed = (kp - kq - (pp - qq) * 0.5) * (2.0 / 3.0);
    let inward = (kk - kp - kq + (pp + pq * 2.0 + qq) * 0.25) * (4.0 / 9.0);
    [along, mixed, inward]
}

/// Returns bounds on the three [`second_differences`] at any corner, in px on screen, then a bound on those along both
/// diagonals of a segment.
pub(super) fn screen_differences(view: &LodView, bounds: ScreenBounds, net: &ControlNet, k: usize) -> [f32; 4] {
    let mut largest = [0.0; 4];
    for i in 0..3 {
        let [along, mixed, inward] = second_differences(net, i, k);
        let rising = screen_length(view, bounds, along + mixed * 2.0 + inward);
        let falling = screen_length(view, bounds, along - mixed * 2.0 + inward);
        largest[0] = screen_length(view, bounds, along).max(largest[0]);
        largest[1] = screen_length(view, bounds, mixed).max(largest[1]);
        largest[2] = screen_length(view, bounds, inward).max(largest[2]);
        largest[3] = rising.max(falling).max(largest[3]);
    }
    largest
}

/// Returns a bound on the error, in px, of a triangle with these second differences along its sides.
///
/// The error of a quadratic function is half the sum of its second derivatives along the sides, each multiplied by the
/// weights of the side's ends. Its maximum is 3 times the squared radius of the smallest circle around a triangle whose
/// squared sides are the second differences.
pub(super) fn triangle_error(a: f32, b: f32, c: f32) -> f32 {
    let most = a.max(b).max(c);
    let least = a.min(b).min(c);
    let middle = a.min(b).max(a.max(b).min(c));
    let more = least - (most - middle);
    if more <= 0.0 {
        return 0.75 * most;
    }
    3.0 * most / (4.0 - (more / least) * (more / middle))
}

/// Returns a bound on the error, in px, of a row of triangles beside an edge: 6/8 of the second differences `on_screen`
/// (Filip et al. 1986).
///
/// The triangles reach `reach` along the edge and `height` inward, and their sides across the row lean by `slant` along
/// the edge, all in parts of the edge and of the inward vector. 1/1000 is added, since domain points are rounded to
/// 16.16.
pub(super) fn row_error(on_screen: [f32; 3], reach: f32, slant: f32, height: f32) -> f32 {
    0.751 * (on_screen[0] * reach * reach + 2.0 * on_screen[1] * slant * height + on_screen[2] * height * height)
}

/// Returns a bound on the error, in px, of all triangles inside the first ring if the patch has `segments` segments
/// inside. `on_screen` has the [`screen_differences`] of each edge.
///
/// The triangles between rings have one side along the edge, one inward and one across. The triangle in the middle has
/// three sides along edges. 1/1000 is added, since domain points are rounded to 16.16.
pub(super) fn inner_error(on_screen: [[f32; 4]; 3], segments: f32) -> f32 {
    let mut worst = triangle_error(on_screen[0][0], on_screen[1][0], on_screen[2][0]);
    for own in on_screen {
        worst = worst.max(triangle_error(own[0], own[2], own[3]));
    }
    1.001 * worst / (segments * segments)
}

/// What the error of the row of triangles along an edge depends on: the bounds of the edge itself, and the second
/// differences along it (`along`), and along it and inward (`mixed`), at its two ends and at the opposite corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeRow {
    pub bounds: ScreenBounds,
    pub along: [Vec3; 3],
    pub mixed: [Vec3; 3],
}

/// Returns these of the edge opposite corner `k`.
pub(super) fn edge_row(view: &LodView, net: &ControlNet, k: usize) -> EdgeRow {
    let p = (k + 1) % 3;
    let q = (k + 2) % 3;
    let edge = [net.corners[p], control_point(net, p, p, q), control_point(net, p, q, q), net.corners[q]];
    let own = [p, q, k].map(|corner| second_differences(net, corner, k));
    EdgeRow { bounds: edge_bounds(view, edge), along: own.map(|own| own[0]), mixed: own.map(|own| own[1]) }
}

/// Returns a bound, in px on screen, on weighted means of three differences of which the last has a weight of at most
/// `share`.
pub(super) fn edge_row_length(view: &LodView, beside: ScreenBounds, differences: [Vec3; 3], share: f32) -> f32 {
    let [at_p, at_q, at_k] = differences.map(|difference| screen_length(view, beside, difference));
    let own = at_p.max(at_q);
    own + share * (at_k - own).max(0.0)
}

/// Returns a bound on the error, in px, of the row along an edge of `factor` segments if the patch has `segments`
/// segments inside. `bounds` is the whole patch's; `on_screen` has the [`screen_differences`] for this edge.
///
/// The row is 2/3 of a segment high. In its points the weight of the opposite corner is small, so the differences there
/// are nearly the edge's own and nearly as large on screen.
pub(super) fn edge_row_error(
    view: &LodView,
    row: EdgeRow,
    bounds: ScreenBounds,
    on_screen: [f32; 4],
    factor: f32,
    segments: f32,
) -> f32 {
    let share = (2.0 / 3.0) / segments;
    let outside = 1.0 - (1.0 - share) * (1.0 - share) * (1.0 - share);
    let beside = mixed_bounds(row.bounds, bounds, outside);
    let along = edge_row_length(view, beside, row.along, share);
    let mixed = edge_row_length(view, beside, row.mixed, share);
    let size = 1.0 / segments;
    let reach = size.max(1.0 / factor);
    // An edge of one segment is a side of only one triangle, which ends in the middle of the row. Half of the other
    // triangles start at each end of the edge.
    let slant = if factor <= 1.0 { 0.5 + 0.5 * size } else { reach };
    row_error([along, mixed, on_screen[2]], reach, slant, size)
}

/// Returns the least number of segments, `least` or more, that a partitioning has without fractions: any whole number,
/// a power of two, or an odd or even number.
pub(super) fn whole_segments(partitioning: Partitioning, least: f32) -> f32 {
    match partitioning {
        Partitioning::Integer | Partitioning::Subtriangulation => least.ceil(),
        Partitioning::Pow2 => round_pow2(least),
        Partitioning::FractionalOdd => 2.0 * (0.5 * (least - 1.0)).ceil() + 1.0,
        Partitioning::FractionalEven => 2.0 * (0.5 * least).ceil(),
    }
}

/// Returns the least inside factor that keeps a patch within `tolerance` px of its surface, given the levels of the
/// edges U == 0, V == 0 and W == 0. The result is above 64 if no factor does.
///
/// Only numbers of segments are tried that the partitioning has and that nest with the edges.
pub(crate) fn inside_error_factor(
    view: &LodView,
    tolerance: f32,
    partitioning: Partitioning,
    net: &ControlNet,
    edges: [f32; 3],
) -> f32 {
    let bounds = net_bounds(view, net);
    let on_screen = [0, 1, 2].map(|k| screen_differences(view, bounds, net, k));
    let minimal = edges[0].max(edges[1]).max(edges[2]) <= 1.0;
    let single = inner_error(on_screen, 1.0);
    if minimal && single <= tolerance {
        return 1.0;
    }
    let all = [0, 1, 2].map(|k| edge_row(view, net, k));
    // Errors fall with the square of the number of segments. The tessellator treats 1 segment inside as 2.
    let least = (single / tolerance).sqrt().max(2.0);
    let last = if partitioning == Partitioning::FractionalOdd { 63.0 } else { 64.0 };
    let mut inside = whole_segments(partitioning, least);
    while inside <= last && least <= last {
        let segments = inside as u32;
        if nests(edges[0], segments) && nests(edges[1], segments) && nests(edges[2], segments) {
            let mut rows = 0.0f32;
            for (k, factor) in edges.into_iter().enumerate() {
                rows = rows.max(edge_row_error(view, all[k], bounds, on_screen[k], factor, inside));
            }
            if rows <= tolerance {
                return inside;
            }
        }
        if inside == last {
            break;
        }
        inside = whole_segments(partitioning, inside + 1.0).min(last);
    }
    least.max(64.5)
}

#[cfg(test)]
mod tests;
