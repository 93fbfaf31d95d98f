//! How many segments keep what is emitted within a distance of the surface, in px on screen. Twin: `shaders/error.wgsl`.
//!
//! The distance between a polynomial and its linear interpolation is bounded by second derivatives, and those of a
//! Bézier curve or triangle by second differences of its control points (G. Wang: *The subdivision method for finding
//! the intersection between two Bézier curves or surfaces*, 1984; D. Filip, R. Magedson, R. Markot: *Surface algorithms
//! using bounds on derivatives*, 1986). Differences are taken in object units and then seen on screen: that of two
//! points a and b is (a.xy - b.xy / b.w * a.w) / a.w in clip space, so no more than the largest |d.xy - s d.w| / w, where
//! d is the difference, w the least depth of the control points, and s anywhere between their least and greatest x / w
//! and y / w.

use glam::{Vec2, Vec3};

use super::factors::{Partitioning, round_pow2};
use super::lod::{LodView, at_least_one, clip_row};
use super::surface::ControlNet;
use crate::mesh::MAX_LEVELS;

/// How large differences between control points can look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// The least and the greatest depth (w); not nearer than the near plane, in front of which nothing is seen.
    pub nearest: f32,
    pub farthest: f32,
    /// Least and greatest x / w and y / w: of control points beyond the near plane, or of all that is in view where one
    /// isn't.
    pub least: Vec2,
    pub greatest: Vec2,
    /// Whether a control point is nearer than the near plane.
    pub is_cut: bool,
}

/// The part of the tolerance that edges use up: the rest is for the rows beside them, which bend in other directions too.
pub const EDGE_SHARE: f32 = 0.75;

/// Of nothing: to be widened.
fn no_sight() -> Sight {
    Sight { nearest: 3.4e38, farthest: 0.0, least: Vec2::splat(3.4e38), greatest: Vec2::splat(-3.4e38), is_cut: false }
}

/// The same with one more control point.
pub fn widen(view: &LodView, sight: Sight, p: Vec3) -> Sight {
    let clip = view.clip_from_object * p.extend(1.0);
    let depth = clip.w.max(clip.z);
    let place = Vec2::new(clip.x, clip.y) / depth;
    // Displacement moves it towards the eye, away and across.
    let deep = clip_row(view, 3).length() * view.reach;
    let past_near = (clip_row(view, 3) - clip_row(view, 2)).length() * view.reach;
    let across = Vec2::new(clip_row(view, 0).length(), clip_row(view, 1).length()) * view.reach;
    let beyond = clip.z + past_near <= clip.w;
    let nearest = (clip.w - deep).max(clip.z);
    let spread = (across + place.abs() * deep) / nearest;
    Sight {
        nearest: sight.nearest.min(nearest),
        farthest: sight.farthest.max(depth + deep),
        least: sight.least.min(if beyond { place - spread } else { Vec2::NEG_ONE }),
        greatest: sight.greatest.max(if beyond { place + spread } else { Vec2::ONE }),
        is_cut: sight.is_cut || !beyond,
    }
}

/// Of an edge's four control points.
pub fn edge_sight(view: &LodView, [a, ab, ba, b]: [Vec3; 4]) -> Sight {
    widen(view, widen(view, widen(view, widen(view, no_sight(), a), ab), ba), b)
}

/// Of a patch's ten.
pub fn net_sight(view: &LodView, net: &ControlNet) -> Sight {
    let mut sight = widen(view, no_sight(), net.center);
    for k in 0..3 {
        sight = widen(view, sight, net.corners[k]);
        sight = widen(view, sight, net.edges[2 * k]);
        sight = widen(view, sight, net.edges[2 * k + 1]);
    }
    sight
}

/// Of points that are `share` of something seen so, and otherwise of `own`, whose sight is a part of that.
pub fn mixed_sight(own: Sight, other: Sight, share: f32) -> Sight {
    if other.is_cut {
        // Its least depth is the near plane's, and points between may be nearer than that would make them.
        return other;
    }
    let nearest = own.nearest + share * (other.nearest - own.nearest);
    // Places on screen are averages by depth.
    let reach = (share * other.farthest / nearest).min(1.0);
    Sight {
        nearest,
        farthest: other.farthest,
        least: own.least + (other.least - own.least) * reach,
        greatest: own.greatest + (other.greatest - own.greatest) * reach,
        is_cut: false,
    }
}

/// The most that a difference of two points can look, in px.
pub fn seen_length(view: &LodView, sight: Sight, difference: Vec3) -> f32 {
    let across = Vec2::new(clip_row(view, 0).dot(difference), clip_row(view, 1).dot(difference));
    let deep = clip_row(view, 3).dot(difference);
    let a = (across - sight.least * deep).abs();
    let b = (across - sight.greatest * deep).abs();
    // Divided first: squares of tiny lengths are none.
    (a.max(b) / sight.nearest * view.half_viewport).length()
}

/// The most that a vector of this length in object units can look, in px.
pub fn seen_radius(view: &LodView, sight: Sight, radius: f32) -> f32 {
    let across = Vec2::new(clip_row(view, 0).length(), clip_row(view, 1).length());
    let deep = clip_row(view, 3).length();
    let most = sight.least.abs().max(sight.greatest.abs());
    ((across + most * deep) * (radius / sight.nearest) * view.half_viewport).length()
}

/// The least level, `least` or more: a factor whose rows of points nest with those of all other levels. Levels are 1 to 5,
/// 8, 16, 32 and 64, of these the powers of two or the even ones, or the odd 1, 3, 5, 9, 17 and 33.
///
/// The tessellator joins rows of different numbers of segments as their points come up in one fixed order, in which each
/// new point halves the widest gap. Rows of other numbers are uneven in that order, and triangles between them reach along
/// the rows by up to five segments, which costs up to 25 times the error of one. Between levels it is one segment. What is
/// beyond the last level is asked for as it is, so that one can tell.
pub fn level(partitioning: Partitioning, least: f32) -> f32 {
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

/// Numbers of segments inside whose first ring nests with an edge of 5, 8, 9, 16, 17, 32, 33 or 64 segments: bit n - 1 for
/// n, 1 to 32 in the first word. A test derives them from the tessellator.
pub const NESTING: [[u32; 2]; 8] = [
    [0xfffff797, 0xffffffff],
    [0xffffe19f, 0xffffffff],
    [0xe4078117, 0xff5c177f],
    [0xe001819f, 0xfe000007],
    [0x80010117, 0xe0000005],
    [0x8001819f, 0xe0000001],
    [0x00010117, 0x80000001],
    [0x8001819f, 0x80000001],
];

/// Whether the first ring of a patch with `segments` inside nests with an edge of this level. With up to four segments
/// every ring does; what is beyond the last level is no promise anyway.
pub fn nests(factor: f32, segments: u32) -> bool {
    if factor <= 4.0 || factor > 64.0 {
        return true;
    }
    // 5, 8, 9, 16, 17, 32, 33, 64.
    let power = round_pow2(factor);
    let above = if factor == power { 0 } else { 1 };
    // Of the power of two below or at it: 4, 8, 16, 32, 64.
    let exponent = ((power.to_bits() >> 23) - 127) - above;
    let words = NESTING[(2 * exponent + above - 5) as usize];
    let bit = segments - 1;
    (words[(bit >> 5) as usize] >> (bit & 31)) & 1 == 1
}

/// The fewest segments that keep an edge within `tolerance` px of its cubic: sqrt(3/4 d / tolerance), d the larger second
/// difference (Wang 1984).
pub fn edge_error_factor(view: &LodView, tolerance: f32, control_points: [Vec3; 4]) -> f32 {
    let sight = edge_sight(view, control_points);
    let [a, ab, ba, b] = control_points;
    let near_a = seen_length(view, sight, a - ab * 2.0 + ba);
    let near_b = seen_length(view, sight, ab - ba * 2.0 + b);
    at_least_one((0.75 * near_a.max(near_b) / tolerance).sqrt())
}

/// Of the tolerance, where a surface is displaced: for the surface below, for what its heights lose between segments, and
/// for the turn of the direction in which they stand.
pub const SURFACE_SHARE: f32 = 0.5;
pub const DETAIL_SHARE: f32 = 0.3;
pub const TURN_SHARE: f32 = 0.2;

/// The fewest segments that show one image's heights over an edge, which is `texels` px long there: as fine as the image's
/// coarsest level whose loss (`detail`, times `scale` in object units) is within its share of the tolerance, and as the turn
/// of the directions at its ends (the distance between them) asks for. An estimate: between its px an image may rise by
/// more than its levels tell.
pub fn relief_factor(
    view: &LodView,
    sight: Sight,
    tolerance: f32,
    texels: f32,
    turn: f32,
    scale: f32,
    detail: [f32; MAX_LEVELS],
) -> f32 {
    // An arc's rise over its chord is an eighth of the angle's square, of which the distance is at least 2/3.
    let bend = seen_radius(view, sight, view.reach * 0.28125 * turn * turn);
    let mut segments = texels;
    for lost in &detail[1..] {
        if seen_radius(view, sight, scale * lost) > DETAIL_SHARE * tolerance {
            break;
        }
        segments *= 0.5;
    }
    at_least_one(segments.max((bend / (TURN_SHARE * tolerance)).sqrt()))
}

/// The control point with these three indices, in any order: (0, 0, 1) is b210.
pub fn control_point(net: &ControlNet, i: usize, j: usize, l: usize) -> Vec3 {
    if i == j && j == l {
        return net.corners[i];
    }
    if i != j && j != l && l != i {
        return net.center;
    }
    // The index that comes twice, and the other.
    let twice = if i == j || i == l { i } else { j };
    let once = i + j + l - 2 * twice;
    if once == (twice + 1) % 3 { net.edges[2 * twice] } else { net.edges[2 * once + 1] }
}

/// A sixth of a patch's second derivatives at corner `i`: twice along the edge opposite corner `k`; along it and inward,
/// which is 2/3 of the median towards `k`, as far in as the tessellator puts a ring for each segment; and twice inward.
pub fn second_differences(net: &ControlNet, i: usize, k: usize) -> [Vec3; 3] {
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

/// The largest of them at any corner as they are seen, in px; and the largest along the diagonals of a segment each way.
pub fn seen_differences(view: &LodView, sight: Sight, net: &ControlNet, k: usize) -> [f32; 4] {
    let mut largest = [0.0; 4];
    for i in 0..3 {
        let [along, mixed, inward] = second_differences(net, i, k);
        let rising = seen_length(view, sight, along + mixed * 2.0 + inward);
        let falling = seen_length(view, sight, along - mixed * 2.0 + inward);
        largest[0] = seen_length(view, sight, along).max(largest[0]);
        largest[1] = seen_length(view, sight, mixed).max(largest[1]);
        largest[2] = seen_length(view, sight, inward).max(largest[2]);
        largest[3] = rising.max(falling).max(largest[3]);
    }
    largest
}

/// The bound on the error of a triangle with such second differences along its sides, in px. A quadratic function's error is
/// half the sum of its second derivatives along the sides, each times the weights of its ends; at most, 3 times the squared
/// radius of the least circle around a triangle whose squared sides these are.
pub fn triangle_error(a: f32, b: f32, c: f32) -> f32 {
    let most = a.max(b).max(c);
    let least = a.min(b).min(c);
    let middle = a.min(b).max(a.max(b).min(c));
    let more = least - (most - middle);
    if more <= 0.0 {
        return 0.75 * most;
    }
    3.0 * most / (4.0 - (more / least) * (more / middle))
}

/// The bound on the error of triangles that reach so far along an edge and inward, and whose sides across the row lean so
/// far along it, in px (Filip et al. 1986): 6/8 of second differences. A thousandth more, as points of the domain are
/// rounded to 16.16.
pub fn row_error(seen: [f32; 3], reach: f32, slant: f32, height: f32) -> f32 {
    0.751 * (seen[0] * reach * reach + 2.0 * seen[1] * slant * height + seen[2] * height * height)
}

/// The bound for all rows between rings if there are `segments` inside, whose triangles have one side along the edge, one
/// inward and one across; and for the triangle in the middle, which has three sides along edges. A thousandth more, as
/// points of the domain are rounded to 16.16. Second differences as seen, for each edge.
pub fn inner_error(seen: [[f32; 4]; 3], segments: f32) -> f32 {
    let mut worst = triangle_error(seen[0][0], seen[1][0], seen[2][0]);
    for own in seen {
        worst = worst.max(triangle_error(own[0], own[2], own[3]));
    }
    1.001 * worst / (segments * segments)
}

/// What the row along an edge has of its own: how the edge is seen, and the second differences along it, and along it and
/// inward, at its ends and at the corner opposite.
#[derive(Clone, Copy, Debug)]
pub struct Rim {
    pub sight: Sight,
    pub along: [Vec3; 3],
    pub mixed: [Vec3; 3],
}

/// Of the edge opposite corner `k`.
pub fn edge_rim(view: &LodView, net: &ControlNet, k: usize) -> Rim {
    let p = (k + 1) % 3;
    let q = (k + 2) % 3;
    let edge = [net.corners[p], control_point(net, p, p, q), control_point(net, p, q, q), net.corners[q]];
    let own = [p, q, k].map(|corner| second_differences(net, corner, k));
    Rim { sight: edge_sight(view, edge), along: own.map(|own| own[0]), mixed: own.map(|own| own[1]) }
}

/// The most that differences look, of which the last has no more than this share, in px.
pub fn rim_length(view: &LodView, beside: Sight, differences: [Vec3; 3], share: f32) -> f32 {
    let [at_p, at_q, at_k] = differences.map(|difference| seen_length(view, beside, difference));
    let own = at_p.max(at_q);
    own + share * (at_k - own).max(0.0)
}

/// The bound for the row along an edge, which has `factor` segments, while there are `segments` inside. The row is 2/3 of a
/// segment high; of its points' control points the third corner's share is small, so that differences are about the edge's
/// and are seen about as it is. `sight` and `seen` are the whole patch's, the latter for this edge.
pub fn rim_error(view: &LodView, rim: Rim, sight: Sight, seen: [f32; 4], factor: f32, segments: f32) -> f32 {
    let share = (2.0 / 3.0) / segments;
    let outside = 1.0 - (1.0 - share) * (1.0 - share) * (1.0 - share);
    let beside = mixed_sight(rim.sight, sight, outside);
    let along = rim_length(view, beside, rim.along, share);
    let mixed = rim_length(view, beside, rim.mixed, share);
    let size = 1.0 / segments;
    let reach = size.max(1.0 / factor);
    // An edge of one segment is the side of one triangle, to the middle of the row, and half of the others start at either
    // end.
    let slant = if factor <= 1.0 { 0.5 + 0.5 * size } else { reach };
    row_error([along, mixed, seen[2]], reach, slant, size)
}

/// The least number of segments, `least` or more, that a partitioning has without fractions: 1, 2, 4 and so on, or even,
/// or odd ones.
pub fn whole(partitioning: Partitioning, least: f32) -> f32 {
    match partitioning {
        Partitioning::Integer | Partitioning::Subtriangulation => least.ceil(),
        Partitioning::Pow2 => round_pow2(least),
        Partitioning::FractionalOdd => 2.0 * (0.5 * (least - 1.0)).ceil() + 1.0,
        Partitioning::FractionalEven => 2.0 * (0.5 * least).ceil(),
    }
}

/// The fewest segments inside that keep a patch within `tolerance` px of its surface, given the levels of the edges
/// U == 0, V == 0 and W == 0; of numbers that the partitioning has, and that nest with the edges. More than 64 where none
/// does, so that one can tell.
pub fn inside_error_factor(
    view: &LodView,
    tolerance: f32,
    partitioning: Partitioning,
    net: &ControlNet,
    edges: [f32; 3],
) -> f32 {
    let sight = net_sight(view, net);
    let seen = [0, 1, 2].map(|k| seen_differences(view, sight, net, k));
    let minimal = edges[0].max(edges[1]).max(edges[2]) <= 1.0;
    let single = inner_error(seen, 1.0);
    if minimal && single <= tolerance {
        return 1.0;
    }
    let all = [0, 1, 2].map(|k| edge_rim(view, net, k));
    // Errors fall with the square of the number of segments. One alone would act as two.
    let least = (single / tolerance).sqrt().max(2.0);
    let last = if partitioning == Partitioning::FractionalOdd { 63.0 } else { 64.0 };
    let mut inside = whole(partitioning, least);
    while inside <= last && least <= last {
        let segments = inside as u32;
        if nests(edges[0], segments) && nests(edges[1], segments) && nests(edges[2], segments) {
            let mut rims = 0.0f32;
            for (k, factor) in edges.into_iter().enumerate() {
                rims = rims.max(rim_error(view, all[k], sight, seen[k], factor, inside));
            }
            if rims <= tolerance {
                return inside;
            }
        }
        if inside == last {
            break;
        }
        inside = whole(partitioning, inside + 1.0).min(last);
    }
    least.max(64.5)
}
#[cfg(test)]
mod tests;
