//! The error of one flat triangle of a patch's pattern (a *piece*): how far on screen, in px, its points are from the
//! points of the surface at the same places of the domain. Twin: `shaders/piece_error.wgsl`.
//!
//! The piece of the surface behind a flat triangle is a cubic Bézier triangle itself. Its difference from the flat
//! triangle is one too, with zeros at its corners and seven other control points, which follow from the second
//! derivatives at the corners (G. Farin: *Triangular Bernstein-Bézier patches*, 1986, sections 1 to 3). A projection
//! divides it by the depth: where L is the flat triangle's point on screen and d the difference in clip space, the
//! distance on screen is |d.xy - L d.w| divided by the depth of the surface.
//!
//! That distance is computed on a grid of the piece. Between the points of the grid a cubic function is at most so far
//! from its linear interpolation as its second derivatives allow (D. Filip, R. Magedson, R. Markot: *Surface algorithms
//! using bounds on derivatives*, 1986), divided by the square of the grid's number of steps. So what is on the grid
//! is a lower bound, and with that margin an upper bound. Grids get finer until one of the two decides.
//!
//! On patches that are nearly flat, and where nothing depends on where their points slide, the distance to the nearest point
//! of the surface is enough: see `flat_patch.rs`.

use glam::{Vec2, Vec3, Vec4};

use super::factors::Partitioning;
use super::lod::{LodView, clip_row};
use super::relief::{SeenRelief, heights_error, least_for_heights, turning_of};
use super::surface::ControlNet;
use crate::mesh::PatchRelief;

/// The steps of the finest grid. The margin is then at most 1/64 of the bound without a grid.
pub const FINEST_GRID: u32 = 8;

/// The steps of the grid of a triangle that is only partly in view.
pub const PARTIAL_STEPS: u32 = 8;

/// A patch in clip space: x and y in px times depth, and the depth (w). All are divided by the largest depth of its control
/// points, which changes nothing on screen, so that squares don't leave the range of f32.
#[derive(Clone, Copy, Debug)]
pub struct SeenPatch {
    /// The ten control points: corners, edges, centre.
    points: [Vec3; 10],
    /// A sixth of the second derivatives at each corner: twice along a, along a and b, twice along b. Direction a leads
    /// from corner 2 to corner 0, b from corner 2 to corner 1.
    second: [[Vec3; 3]; 3],
    /// Half the viewport's width and height, in px.
    half_viewport: Vec2,
    /// The depth of the near plane; 0 in an orthographic view.
    near: f32,
    /// How far displacement may move a point: in depth, and across the view in px times depth.
    deep: f32,
    across: Vec2,
    /// Which way its triangle turns: see [`turn_of`].
    turn: f32,
    /// Where points may slide along the surface, how far in px it may be off the plane of its triangle, and off its longest
    /// side; else large numbers.
    pub off_plane: f32,
    pub off_line: f32,
    /// By what points, depths and second derivatives were multiplied.
    pub(super) scale: f32,
    pub(super) relief: SeenRelief,
}

/// Returns whether an error is within a tolerance. NaN never is.
fn is_within(error: f32, tolerance: f32) -> bool {
    error <= tolerance
}

/// Returns the control point with these three indices (0 to 2), in any order: (0, 0, 1) is b210.
fn control_point(net: &ControlNet, i: usize, j: usize, l: usize) -> Vec3 {
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

/// Returns a difference vector in object units as one in clip space.
fn clip_difference(view: &LodView, difference: Vec3) -> Vec3 {
    let across = Vec2::new(clip_row(view, 0).dot(difference), clip_row(view, 1).dot(difference)) * view.half_viewport;
    across.extend(clip_row(view, 3).dot(difference))
}

/// Returns a point in object units in clip space, all of it multiplied by `scale`.
pub(super) fn clip_point(view: &LodView, scale: f32, p: Vec3) -> Vec3 {
    let clip = view.clip_from_object * p.extend(1.0) * scale;
    (Vec2::new(clip.x, clip.y) * view.half_viewport).extend(clip.w)
}

/// Returns the absolute depth (w) of a point in object units, or `deepest` if that is larger.
pub(super) fn deeper(view: &LodView, deepest: f32, p: Vec3) -> f32 {
    let clip = view.clip_from_object * p.extend(1.0);
    deepest.max(clip.w.abs())
}

/// Returns the scale by which the largest depth becomes 1.
pub(super) fn depth_scale(deepest: f32) -> f32 {
    if deepest > 1e-38 { 1.0 / deepest } else { 1.0 }
}

/// Returns the depth (w) of the near plane, where z = w; 0 in an orthographic view. Along the view, z is a linear
/// function of w.
pub(super) fn near_depth(view: &LodView) -> f32 {
    let (z, w) = (clip_row(view, 2), clip_row(view, 3));
    let square = w.dot(w);
    if square <= 0.0 {
        return 0.0;
    }
    let slope = z.dot(w) / square;
    (view.clip_from_object.w_axis.z - slope * view.clip_from_object.w_axis.w) / (1.0 - slope)
}

/// Returns a sixth of a patch's second derivatives at corner `i`, multiplied by `scale`: see [`SeenPatch`].
fn second_derivatives(view: &LodView, scale: f32, net: &ControlNet, i: usize) -> [Vec3; 3] {
    let at_c = control_point(net, i, 2, 2);
    let ac = control_point(net, i, 0, 2);
    let bc = control_point(net, i, 1, 2);
    let aa = control_point(net, i, 0, 0) - ac * 2.0 + at_c;
    let ab = control_point(net, i, 0, 1) - ac - bc + at_c;
    let bb = control_point(net, i, 1, 1) - bc * 2.0 + at_c;
    [clip_difference(view, aa * scale), clip_difference(view, ab * scale), clip_difference(view, bb * scale)]
}

/// A sixth of a patch's second derivatives at a place, along two directions a and b of the domain: on screen, in px.
#[derive(Clone, Copy, Debug)]
pub(super) struct SecondForms {
    pub aa: Vec2,
    pub ab: Vec2,
    pub bb: Vec2,
}

/// Returns a difference on screen, in px, as an eye sees it that looks at a point in clip space.
fn seen_at(at: Vec3, difference: Vec3) -> Vec2 {
    (difference.truncate() - (at.truncate() / at.z) * difference.z) / at.z
}

/// Returns the second derivatives at a corner, as an eye sees them that looks at it; zeros if it isn't before the near plane.
pub(super) fn second_forms(patch: &SeenPatch, corner: usize, a: Vec2, b: Vec2) -> SecondForms {
    let at = patch.points[corner];
    if !(at.z > patch.near && at.z > 0.0) {
        return SecondForms { aa: Vec2::ZERO, ab: Vec2::ZERO, bb: Vec2::ZERO };
    }
    let [xx, xy, yy] = patch.second[corner];
    SecondForms {
        aa: seen_at(at, xx * (a.x * a.x) + xy * (2.0 * a.x * a.y) + yy * (a.y * a.y)),
        ab: seen_at(at, xx * (a.x * b.x) + xy * (a.x * b.y + a.y * b.x) + yy * (a.y * b.y)),
        bb: seen_at(at, xx * (b.x * b.x) + xy * (2.0 * b.x * b.y) + yy * (b.y * b.y)),
    }
}

/// Returns what [`least_for_heights`] does for a patch.
pub(super) fn heights_need(patch: &SeenPatch, tolerance: f32, partitioning: Partitioning) -> [f32; 4] {
    let [a, b, c, ..] = patch.points;
    least_for_heights(&patch.relief, [a, b, c], [patch.deep, patch.near], tolerance, partitioning.has_rows())
}

/// Returns a number whose sign tells which way a triangle of a plane turns on screen, wherever the eye is. The points are in
/// clip space.
fn turn_of(a: Vec3, b: Vec3, c: Vec3) -> f32 {
    a.dot((b - a).cross(c - a))
}

/// Returns a patch as it is seen, whose points may not slide.
pub(crate) fn seen_patch(view: &LodView, net: &ControlNet) -> SeenPatch {
    let mut deepest = deeper(view, 0.0, net.center);
    for corner in net.corners {
        deepest = deeper(view, deepest, corner);
    }
    for point in net.edges {
        deepest = deeper(view, deepest, point);
    }
    let scale = depth_scale(deepest);
    let mut points = [Vec3::ZERO; 10];
    for (point, corner) in points.iter_mut().zip(net.corners) {
        *point = clip_point(view, scale, corner);
    }
    for (point, on_edge) in points[3..].iter_mut().zip(net.edges) {
        *point = clip_point(view, scale, on_edge);
    }
    points[9] = clip_point(view, scale, net.center);
    let second = [0, 1, 2].map(|i| second_derivatives(view, scale, net, i));
    let across = Vec2::new(clip_row(view, 0).length(), clip_row(view, 1).length()) * view.half_viewport;
    SeenPatch {
        points,
        second,
        half_viewport: view.half_viewport,
        near: near_depth(view) * scale,
        deep: clip_row(view, 3).length() * view.reach * scale,
        across: across * (view.reach * scale),
        turn: turn_of(points[0], points[1], points[2]),
        off_plane: 3.4e38,
        off_line: 3.4e38,
        scale,
        relief: SeenRelief::NONE,
    }
}

/// Returns what is seen of the heights over a patch: its corners move along unit directions by `height_scale` object units from black
/// to white.
pub(super) fn seen_relief(
    view: &LodView,
    scale: f32,
    directions: [Vec3; 3],
    height_scale: f32,
    relief: PatchRelief,
) -> SeenRelief {
    let [turning, shortest] = turning_of(directions);
    let unit = height_scale.abs() * scale;
    let part = if view.reach > 0.0 { height_scale.abs() / view.reach } else { 0.0 };
    let directions = directions.map(|direction| clip_difference(view, direction * unit));
    SeenRelief { relief, directions, turning, shortest, part }
}

/// Returns the point of the surface at a place of the domain.
fn seen_point(patch: &SeenPatch, place: Vec2) -> Vec3 {
    let (x, y) = (place.x, place.y);
    let z = 1.0 - x - y;
    patch.points[0] * (x * x * x)
        + patch.points[1] * (y * y * y)
        + patch.points[2] * (z * z * z)
        + patch.points[3] * (3.0 * x * x * y)
        + patch.points[4] * (3.0 * x * y * y)
        + patch.points[5] * (3.0 * y * y * z)
        + patch.points[6] * (3.0 * y * z * z)
        + patch.points[7] * (3.0 * z * z * x)
        + patch.points[8] * (3.0 * z * x * x)
        + patch.points[9] * (6.0 * x * y * z)
}

/// Returns a sixth of the second derivatives at a place of the domain along three directions.
fn along_sides(patch: &SeenPatch, place: Vec2, sides: [Vec2; 3]) -> [Vec3; 3] {
    let z = 1.0 - place.x - place.y;
    let [p, q, r] = patch.second;
    let aa = p[0] * place.x + q[0] * place.y + r[0] * z;
    let ab = p[1] * place.x + q[1] * place.y + r[1] * z;
    let bb = p[2] * place.x + q[2] * place.y + r[2] * z;
    sides.map(|side| aa * (side.x * side.x) + ab * (2.0 * side.x * side.y) + bb * (side.y * side.y))
}

/// A flat triangle, and its difference from the surface behind it.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Its corners in clip space, and their places on screen in px from the middle of the view.
    corners: [Vec3; 3],
    places: [Vec2; 3],
    /// The control points of the difference, surface minus triangle: for each side k the one near corner k and the one
    /// near corner k + 1, and the one in the centre.
    differences: [Vec3; 7],
    /// A sixth of the second derivatives at each corner, along each side.
    second: [[Vec3; 3]; 3],
}

/// Returns the flat triangle with its corners at three places of the domain.
fn piece_of(patch: &SeenPatch, at: [Vec2; 3]) -> Piece {
    let sides = [at[1] - at[0], at[2] - at[1], at[0] - at[2]];
    let second = [along_sides(patch, at[0], sides), along_sides(patch, at[1], sides), along_sides(patch, at[2], sides)];
    let mut differences = [Vec3::ZERO; 7];
    let mut sum = Vec3::ZERO;
    for k in 0..3 {
        let (here, there) = (second[k][k], second[(k + 1) % 3][k]);
        differences[2 * k] = (here * 2.0 + there) * (-1.0 / 3.0);
        differences[2 * k + 1] = (here + there * 2.0) * (-1.0 / 3.0);
        sum += second[k][0] + second[k][1] + second[k][2];
    }
    differences[6] = sum * (-1.0 / 6.0);
    let corners = [seen_point(patch, at[0]), seen_point(patch, at[1]), seen_point(patch, at[2])];
    Piece { corners, places: corners.map(|corner| corner.truncate() / corner.z), differences, second }
}

/// Returns how far in px times depth the corners of a piece lie at least beyond the view's right, top, left and bottom side,
/// less how far the surface and displacement come back. Where a point of the flat triangle is beyond a side by this, neither
/// that point nor the one of the surface is in view.
fn beyond_sides(patch: &SeenPatch, piece: &Piece) -> [Vec4; 3] {
    let half = patch.half_viewport;
    let (mut right, mut left) = (Vec2::ZERO, Vec2::ZERO);
    for difference in piece.differences {
        let (across, deep) = (difference.truncate(), half * difference.z);
        right = right.min(across - deep);
        left = left.min(-across - deep);
    }
    let moved = patch.across + half * patch.deep;
    let (right, left) = (right - moved, left - moved);
    piece.corners.map(|corner| {
        let (across, deep) = (corner.truncate(), half * corner.z);
        let (right, left) = (across - deep + right, -across - deep + left);
        Vec4::new(right.x, right.y, left.x, left.y)
    })
}

/// Returns whether all corners are beyond the same side.
fn is_beside_view(beyond: [Vec4; 3]) -> bool {
    let [a, b, c] = beyond;
    let is_beyond = |k: usize| a[k] > 0.0 && b[k] > 0.0 && c[k] > 0.0;
    is_beyond(0) || is_beyond(1) || is_beyond(2) || is_beyond(3)
}

/// Returns a bound on the depth of the points of a flat triangle that may be in view: none has less. It may be negative.
/// `depths` are those of its corners.
fn seen_depth(depths: [f32; 3], beyond: [Vec4; 3]) -> f32 {
    let mut seen = -3.4e38f32;
    for side in [0, 1, 2, 3].map(|k| beyond.map(|corner| corner[k])) {
        // The least depth of what is on the inner side: at a corner, or where a side of the triangle crosses.
        let mut least = 3.4e38f32;
        for i in 0..3 {
            let j = (i + 1) % 3;
            let (p, q) = (side[i], side[j]);
            let (here, there) = (depths[i], depths[j]);
            if p <= 0.0 {
                least = least.min(here);
            }
            if (p <= 0.0) != (q <= 0.0) {
                least = least.min(here + (there - here) * (p / (p - q)));
            }
        }
        // Nothing is found among NaN.
        seen = seen.max(if least < 3e38 { least } else { -3.4e38 });
    }
    seen
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

/// Returns a bound on the error of a flat triangle, in px, from its second derivatives alone: as seen from a depth of 1,
/// by an eye that sees it within `spread` px of `middle`.
fn derivative_bound(piece: &Piece, middle: Vec2, spread: f32) -> f32 {
    let mut most = [0.0f32; 3];
    for at_corner in piece.second {
        for (most, second) in most.iter_mut().zip(at_corner) {
            let seen = (second.truncate() - middle * second.z).length() + spread * second.z.abs();
            // NaN counts as infinite.
            *most = most.max(if seen < 3.4e38 { seen } else { 3.4e38 });
        }
    }
    triangle_error(most[0], most[1], most[2])
}

/// Returns whether points of a patch may slide along the surface within a tolerance.
pub(super) fn may_slide(patch: &SeenPatch, tolerance: f32) -> bool {
    patch.off_plane.min(patch.off_line) <= tolerance
}

/// Returns whether the side between two places of the domain is part of an edge of the patch.
fn is_on_edge(p: Vec2, q: Vec2) -> bool {
    p.x.max(q.x) == 0.0 || p.y.max(q.y) == 0.0 || (p.x + p.y).min(q.x + q.y) == 1.0
}

/// Returns the length of a difference that sliding along a side doesn't take back; all of it, if its control point isn't
/// beside the side. In px times depth, by an eye that sees it within `spread` px of `middle`. `along` leads from the side's
/// start to its end.
fn beside_edge(middle: Vec2, spread: f32, along: Vec3, difference: Vec3) -> f32 {
    let on_screen = along.truncate() - middle * along.z;
    let share = (difference.truncate() - middle * difference.z).dot(on_screen) / on_screen.dot(on_screen);
    let rest = if share.abs() <= 1.0 / 3.0 { difference - along * share } else { difference };
    (rest.truncate() - middle * rest.z).length() + spread * rest.z.abs()
}

/// Returns a bound on the distance in px between a flat triangle and the nearest points of the surface, where points may
/// slide and as far as no other triangle's sides come into it; large if that bound doesn't hold. All that counts of it is
/// seen within `spread` px of `middle` and no nearer than `nearest`.
fn sliding_error(patch: &SeenPatch, piece: &Piece, at: [Vec2; 3], middle: Vec2, spread: f32, nearest: f32) -> f32 {
    let [a, b, c] = piece.corners;
    let turned = turn_of(a, b, c) * (at[1] - at[0]).perp_dot(at[2] - at[0]) * patch.turn;
    if !is_within(0.0, turned) {
        return 3.4e38;
    }
    let alongs = [b - a, c - b, a - c];
    let mut most = 0.0f32;
    for k in 0..3 {
        if is_on_edge(at[k], at[(k + 1) % 3]) {
            most = most.max(beside_edge(middle, spread, alongs[k], piece.differences[2 * k]));
            most = most.max(beside_edge(middle, spread, alongs[k], piece.differences[2 * k + 1]));
        }
    }
    patch.off_plane + 0.75 * most / nearest
}

/// Returns the difference at the weights `x`, `y` and `z` of a piece's corners.
fn piece_difference(piece: &Piece, x: f32, y: f32, z: f32) -> Vec3 {
    let d = &piece.differences;
    (d[0] * x + d[1] * y) * (3.0 * x * y)
        + (d[2] * y + d[3] * z) * (3.0 * y * z)
        + (d[4] * z + d[5] * x) * (3.0 * z * x)
        + d[6] * (6.0 * x * y * z)
}

/// Returns the largest error on a grid of `steps` steps, in px, and the largest difference in depth. `coarser` are those on
/// the grid of half as many steps, if there is one. It ends early once an error isn't within the tolerance.
fn grid_error(patch: &SeenPatch, piece: &Piece, moved: f32, tolerance: f32, steps: u32, coarser: [f32; 2]) -> [f32; 2] {
    let [mut error, mut deep] = coarser;
    for i in 0..=steps {
        // Every second point of every second line is on the coarser grid.
        let is_coarser = steps > 2 && i % 2 == 0;
        let (first, stride) = if is_coarser { (1, 2) } else { (0, 1) };
        for j in (first..=steps - i).step_by(stride) {
            let [x, y, z] = [i, j, steps - i - j].map(|weight| weight as f32 / steps as f32);
            let [p, q, r] = [x * piece.corners[0].z, y * piece.corners[1].z, z * piece.corners[2].z];
            let depth = p + q + r;
            let place = (piece.places[0] * p + piece.places[1] * q + piece.places[2] * r) / depth;
            let difference = piece_difference(piece, x, y, z);
            let seen = (difference.truncate() - place * difference.z).length() + moved * difference.z.abs();
            let own = seen / (depth + difference.z - patch.deep);
            deep = deep.max(difference.z.abs());
            if !is_within(own, tolerance) {
                return [own, deep];
            }
            error = error.max(own);
        }
    }
    [error, deep]
}

/// Returns the error of a flat triangle at the same places of the domain: an upper bound if it is at most `tolerance`. `piece`
/// is in front of the near plane, `bound` is its [`derivative_bound`], and displacement moves it by up to `moved` px.
fn same_place_error(
    patch: &SeenPatch,
    piece: &Piece,
    tolerance: f32,
    bound: f32,
    moved: f32,
    [nearest, farthest]: [f32; 2],
) -> f32 {
    let bound = bound / nearest;
    let [a, b, c] = piece.places;
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let ratio = farthest / nearest;
    let mut steps = 1;
    let mut upper = bound;
    let [mut error, mut deep] = [0.0; 2];
    while !is_within(upper, tolerance) && steps < FINEST_GRID {
        steps *= 2;
        [error, deep] = grid_error(patch, piece, moved, tolerance, steps, [error, deep]);
        if !is_within(error, tolerance) {
            return error;
        }
        // Between points of the grid: depth and place change, and the difference isn't linear.
        let share = 1.0 / steps as f32;
        let between = bound * share * share + longest * ratio * share * deep / nearest;
        upper = error * (1.0 + (ratio - 1.0) * share) + between;
        // What is on a finer grid is no less.
        let finest = 1.0 / FINEST_GRID as f32;
        let least = error * (1.0 + (ratio - 1.0) * finest) + bound * finest * finest;
        if !is_within(least, tolerance) {
            return least;
        }
    }
    upper
}

/// Returns a bound on the error of a flat triangle, only part of which is in view, in px. It is cut into smaller ones, each of
/// which counts with what may be in view of it: within `spread` px of `middle`, and beyond the near plane. The depths of the
/// surface are between `before` and `behind` more than those of the triangle, and `bound` is [`derivative_bound`]. It ends early
/// once an error isn't within the tolerance.
fn partial_error(
    patch: &SeenPatch,
    piece: &Piece,
    beyond: [Vec4; 3],
    [before, behind]: [f32; 2],
    (middle, spread, bound): (Vec2, f32, f32),
    tolerance: f32,
) -> f32 {
    // Between the corners of the smaller triangles.
    let between = bound / (PARTIAL_STEPS * PARTIAL_STEPS) as f32;
    let mut error = 0.0f32;
    for i in 0..PARTIAL_STEPS {
        for j in 0..2 * (PARTIAL_STEPS - i) - 1 {
            // Those that point up and those that point down, in turn.
            let (across, down) = (j / 2, j % 2);
            let at = [[i + down, across], [i + 1 - down, across + down], [i + down, across + 1]];
            let (mut depths, mut outside) = ([0.0; 3], [Vec4::ZERO; 3]);
            let mut most = 0.0f32;
            for k in 0..3 {
                let [x, y] = at[k].map(|weight| weight as f32 / PARTIAL_STEPS as f32);
                let z = 1.0 - x - y;
                depths[k] = piece.corners[0].z * x + piece.corners[1].z * y + piece.corners[2].z * z;
                outside[k] = beyond[0] * x + beyond[1] * y + beyond[2] * z;
                let difference = piece_difference(piece, x, y, z);
                most = most.max((difference.truncate() - middle * difference.z).length() + spread * difference.z.abs());
            }
            let depth = patch.near.max(seen_depth(depths, outside) + before - patch.deep);
            let farthest = depths[0].max(depths[1]).max(depths[2]) + behind + patch.deep;
            let own = (most + between) / depth;
            let is_hidden = is_beside_view(outside) || farthest < patch.near;
            if !is_hidden {
                if !is_within(own, tolerance) {
                    return own;
                }
                error = error.max(own);
            }
        }
    }
    error
}

/// Returns the error of the flat triangle with its corners at three places of the domain (weights of corners 0 and 1).
/// If it is at most `tolerance`, it is an upper bound. If it is larger or NaN, the piece may be that far off.
pub fn piece_error(patch: &SeenPatch, tolerance: f32, at: [Vec2; 3]) -> f32 {
    let piece = piece_of(patch, at);
    let (mut behind, mut before) = (0.0f32, 0.0f32);
    for difference in piece.differences {
        behind = behind.max(difference.z);
        before = before.min(difference.z);
    }
    let depths = piece.corners.map(|corner| corner.z);
    let [p, q, r] = depths;
    let farthest = p.max(q).max(r) + behind + patch.deep;
    let nearest = p.min(q).min(r) + before - patch.deep;
    if farthest < patch.near {
        return 0.0;
    }
    let beyond = beyond_sides(patch, &piece);
    if is_beside_view(beyond) {
        return 0.0;
    }
    let [a, b, c] = piece.places;
    // What is seen of it is anywhere in the view, and no nearer than the near plane.
    let (mut middle, mut spread, mut moved) = (Vec2::ZERO, patch.half_viewport.length(), 0.0);
    let mut depth = patch.near.max(seen_depth(depths, beyond) + before - patch.deep);
    // NaN is no depth in front of the eye.
    let is_before_eye = nearest > 0.0 && nearest >= patch.near;
    if is_before_eye {
        middle = (a + b + c) / 3.0;
        // How far displacement moves it on screen.
        let most = a.abs().max(b.abs()).max(c.abs());
        moved = ((patch.across + most * patch.deep) / nearest).length();
        spread = a.distance(middle).max(b.distance(middle)).max(c.distance(middle)) + moved;
        depth = nearest;
    }
    let anywhere = (patch.across + (middle.length() + spread) * patch.deep).length();
    let lost = heights_error(&patch.relief, anywhere, at, middle, spread, depth);
    if !is_within(lost, tolerance) {
        return lost;
    }
    // What is left of it is for the surface without displacement.
    let tolerance = tolerance - lost;
    let mut error = 3.4e38;
    if may_slide(patch, tolerance) {
        error = patch.off_line.min(sliding_error(patch, &piece, at, middle, spread, depth));
    }
    if is_within(error, tolerance) {
        return lost + error;
    }
    let bound = derivative_bound(&piece, middle, spread);
    error = error.min(match is_before_eye {
        true => same_place_error(patch, &piece, tolerance, bound, moved, [nearest, farthest]),
        false => bound / depth,
    });
    let is_partial = !is_before_eye || beyond.into_iter().any(|corner| corner.max_element() > 0.0);
    if is_partial && !is_within(error, tolerance) {
        error = error.min(partial_error(patch, &piece, beyond, [before, behind], (middle, spread, bound), tolerance));
    }
    lost + error
}

#[cfg(test)]
mod tests;
