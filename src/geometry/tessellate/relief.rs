//! How far flat triangles are from displaced surfaces because of the heights, for LOD by error. Twin: `shaders/relief.wgsl`.
//!
//! A point moves by n h, along the unit direction n by the height h. Under LOD by error heights are read from level 0 at the corners of
//! triangles. Where x is a place on a triangle, i its corners and w their weights there,
//!
//! n(x) h(x) - sum w n(i) h(i) = n(x) (h(x) - sum w h(i)) + sum w (n(x) - n(i)) h(i).
//!
//! The first part is along directions over the patch, and [`PatchRelief`] bounds it. The second is at most the directions' distance from
//! linear ones times the reach of displacement, and their differences times those of the heights.

use glam::{Vec2, Vec3};

use crate::mesh::{PatchRelief, RELIEF_STEPS};

/// The heights over a patch, as it is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeenRelief {
    pub relief: PatchRelief,
    /// How far the corners move from black to white, in clip space: x and y in px times depth, and the depth; along the way between them it may be more by
    /// `1 / shortest`.
    pub directions: [Vec3; 3],
    /// The largest distance between two of the unit directions of the corners, and a bound on the length of weighted means of these.
    pub turning: f32,
    pub shortest: f32,
    /// The distance from black to white as a part of the reach of displacement.
    pub part: f32,
}

impl SeenRelief {
    /// Over a patch that isn't displaced.
    pub(super) const NONE: Self =
        Self { relief: PatchRelief::NONE, directions: [Vec3::ZERO; 3], turning: 0.0, shortest: 1.0, part: 0.0 };
}

/// Returns the largest distance between two of three unit directions, and the least length of their weighted means: 0 or less, if there
/// may be any.
///
/// The squared length of a weighted mean is 1 less the products of two weights each times the squared distances, which are at most a
/// third in all.
pub(super) fn turning_of([a, b, c]: [Vec3; 3]) -> [f32; 2] {
    let turning = a.distance(b).max(b.distance(c)).max(c.distance(a));
    [turning, (1.0 - turning * turning / 3.0).max(0.0).sqrt()]
}

/// What rounding and packing may add to a direction, as a part of its length.
pub const DIRECTION_ROUNDING: f32 = 1.0002;

/// Returns a bound on how far heights let the triangle between three places of the domain be from the displaced surface, in px: seen
/// within `spread` px of `middle`, from `depth`. Large if none holds. Displacement moves a point by `anywhere` px times depth at most.
pub(super) fn heights_error(
    seen: &SeenRelief,
    anywhere: f32,
    at: [Vec2; 3],
    middle: Vec2,
    spread: f32,
    depth: f32,
) -> f32 {
    let SeenRelief { relief, directions, turning, shortest, part } = seen;
    if relief.longest < 0.0 {
        return 0.0;
    }
    let (mut square, mut share) = (0.0f32, 0.0f32);
    for k in 0..3 {
        let side = at[(k + 1) % 3] - at[k];
        let [aa, ab, bb] = relief.form;
        square = square.max(side.x * side.x * aa + 2.0 * side.x * side.y * ab + side.y * side.y * bb);
        share = share.max(side.x.abs().max(side.y.abs()).max((side.x + side.y).abs()));
    }
    let mut loss = relief.losses[0];
    let mut longest = relief.longest;
    for step in 1..RELIEF_STEPS {
        longest *= 0.5;
        if square <= longest * longest {
            loss = relief.losses[step];
        }
    }
    let lost = (loss[0] + loss[1] * square).min(relief.range);
    let rise = relief.range.min(relief.slope * square.sqrt());
    // How far a direction moves a point from black to white, as it is seen.
    let mut along = 0.0f32;
    for direction in directions {
        along = along.max((direction.truncate() - middle * direction.z).length() + spread * direction.z.abs());
    }
    // The second derivative of unit directions is at most 2 / sqrt(3) times the squared first one of the means, by their squared length.
    let turned = share * turning * DIRECTION_ROUNDING / shortest;
    let turns = 0.19245 * turned * turned + turned * part * rise;
    let error = DIRECTION_ROUNDING * (along * lost / shortest + anywhere * turns) / depth;
    // NaN counts as infinite.
    if error < 3.4e38 { error } else { 3.4e38 }
}

/// Returns the longest side, in px of level 0, of triangles over which heights are at most `lost` from linear ones.
fn longest_within(relief: &PatchRelief, lost: f32) -> f32 {
    if relief.range <= lost {
        return 3.4e38;
    }
    let (mut found, mut longest) = (0.0f32, relief.longest);
    for [constant, square] in relief.losses {
        let side = if constant <= lost { ((lost - constant) / square.max(1e-30)).sqrt() } else { 0.0 };
        found = found.max(side.min(longest));
        longest *= 0.5;
    }
    found
}

/// The part of the segments that heights need by their bounds that is requested before triangles are looked at.
pub const NEEDED_SHARE: f32 = 0.98;

/// Returns into how many segments sides 0, 1 and 2 must be cut at least so that heights are within a tolerance, and the inside; of rows as
/// many as the shortest side. Not rounded, and 1 or more. A search starts with these.
///
/// The corners are in clip space, as [`SeenRelief`] is; displacement moves them by `deep` at most, and `near` is the near plane.
pub(super) fn least_for_heights(
    seen: &SeenRelief,
    corners: [Vec3; 3],
    [deep, near]: [f32; 2],
    tolerance: f32,
    has_rows: bool,
) -> [f32; 4] {
    let SeenRelief { relief, directions, .. } = seen;
    // How far heights may be from linear ones at each corner.
    let mut lost = [3.4e38f32; 3];
    for i in 0..3 {
        let corner = corners[i];
        let along = (directions[i].truncate() - corner.truncate() / corner.z * directions[i].z).length();
        if corner.z > near && corner.z > 0.0 && along > 0.0 {
            lost[i] = tolerance * (corner.z + deep) / along;
        }
    }
    let [aa, ab, bb] = relief.form;
    let squares = [aa - 2.0 * ab + bb, bb, aa];
    let mut least = [1.0f32; 4];
    if relief.longest < 0.0 {
        return least;
    }
    for k in 0..3 {
        let within = longest_within(relief, lost[k].min(lost[(k + 1) % 3]));
        least[k] = (NEEDED_SHARE * squares[k].max(0.0).sqrt() / within.max(1e-30)).max(1.0);
    }
    let within = longest_within(relief, lost[0].max(lost[1]).max(lost[2]));
    let [p, q, r] = squares;
    let square = if has_rows { p.min(q).min(r) } else { p.max(q).max(r) };
    least[3] = (NEEDED_SHARE * square.max(0.0).sqrt() / within.max(1e-30)).max(1.0);
    least
}

#[cfg(test)]
mod tests;
