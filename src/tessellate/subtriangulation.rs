//! Uniform subtriangulation: a patch of `n` segments a side as `n * n` equal triangles, each point and triangle in closed
//! form from its number as in `domain.rs`. Twin: `shaders/subtriangulation.wgsl`.
//!
//! The points are `(i, j, k) / n` with whole `i + j + k = n`. As rings, numbered from 0 at the outline inwards, ring `r` has
//! three sides of `n - 3 r` segments; the last one is a point, a triangle, or a triangle whose sides' middles are joined.
//! Rings start, turn and wind as the tessellator's do, so that the outline has the edges U == 0, V == 0 and W == 0 one after
//! another.
//!
//! Source: Vlachos, Peters, Boyd and Mitchell, *Curved PN Triangles*, 2001, section 2 and figure 4, where `n - 1`, the
//! points added to each edge, is the level of detail. Coordinates are 16.16 fixed point.

use super::factors::FIXED_ONE;

/// The number of whole rings before something: the largest `r` up to `m / 6` with `3 r (m - 3 r) <= area`. For points `m`
/// is `2 n + 3` and `area` twice the points before it, for triangles `2 n` and the triangles; `n` is up to 64.
///
/// The exact root is a whole number or at least 1/400 below the next one. 1/1024 is added, tens of times the error that WGSL
/// allows a square root and a product, so that the result is exact everywhere.
fn subtriangulation_rings(m: u32, area: u32) -> u32 {
    let root = ((m * m - 4 * area) as f32).sqrt();
    ((m as f32 - root) * (1.0 / 6.0) + 0.0009765625) as u32
}

/// `k / n`, rounded to the nearest: no `n` up to 64 has ties, so that `k` and `n - k` add up to 1.
fn subtriangulation_location(n: u32, k: u32) -> u32 {
    (2 * FIXED_ONE * k + n) / (2 * n)
}

/// (U, V) of point `i` of a patch of `n` segments a side; W = 1 - U - V.
pub fn subtriangulation_point(n: u32, i: u32) -> [u32; 2] {
    let ring = subtriangulation_rings(2 * n + 3, 2 * i);
    let length = n - 3 * ring;
    let in_ring = i - ((3 * ring * (2 * n + 3 - 3 * ring)) >> 1);
    let side = u32::from(in_ring >= length) + u32::from(in_ring >= 2 * length);
    let p = in_ring - side * length;
    let (up, down) = (ring + p, ring + length - p);
    let [u, v] = match side {
        0 => [ring, down],
        1 => [up, ring],
        _ => [down, up],
    };
    [subtriangulation_location(n, u), subtriangulation_location(n, v)]
}

/// The number of point `q` of the row inside side `side` of a ring, which starts at point `start` and has sides of `length`
/// segments. The row's first point is the last but one of the side before, the next are those of the ring inside.
fn subtriangulation_row(start: u32, length: u32, side: u32, q: u32) -> u32 {
    if q == 0 {
        return start + (side * length + 3 * length - 1) % (3 * length);
    }
    // Of a ring that is a point, all sides' points are that one.
    let inner = length - 3;
    start + 3 * length + (side * inner + q - 1) % (3 * inner).max(1)
}

/// The corners of triangle `t` of a patch of `n` segments a side, as point numbers, clockwise.
pub fn subtriangulation_triangle(n: u32, t: u32) -> [u32; 3] {
    let ring = subtriangulation_rings(2 * n, t);
    let length = n - 3 * ring;
    let start = (3 * ring * (2 * n + 3 - 3 * ring)) >> 1;
    if length < 3 && t + 1 == n * n {
        // The last ring's middle: its corners, or the middles of its sides.
        return [start + length - 1, start + 2 * length - 1, start + 3 * length - 1];
    }
    // A side's triangles stand on it and hang from the row inside it by turns, and leave the last corner to the next side.
    let per_side = 2 * length - 3;
    let in_ring = t - 3 * ring * (2 * n - 3 * ring);
    let side = u32::from(in_ring >= per_side) + u32::from(in_ring >= 2 * per_side);
    let q = in_ring - side * per_side;
    let h = q >> 1;
    let inner = subtriangulation_row(start, length, side, h);
    let outer = start + side * length + h;
    if q & 1 == 0 {
        [outer, outer + 1, inner]
    } else {
        [inner, outer + 1, subtriangulation_row(start, length, side, h + 1)]
    }
}

#[cfg(test)]
mod tests;
