//! Uniform subtriangulation: a patch of `n` segments on each side becomes `n * n` equal triangles. Each point and each
//! triangle is computed from its number alone, as in `domain.rs`. Twin: `shaders/subtriangulation.wgsl`.
//!
//! The points have barycentric coordinates `(i, j, k) / n` with integers `i + j + k = n`. They form rings, numbered
//! inwards from 0 at the outline. Ring `r` has three sides of `n - 3 r` segments. The innermost ring is a point, one
//! triangle, or a triangle whose sides' middles are joined. Rings start, turn and wind as the tessellator's do, so that
//! the outline consists of the edges U == 0, V == 0 and W == 0 in this order.
//!
//! Source: Vlachos, Peters, Boyd and Mitchell, *Curved PN Triangles*, 2001, section 2 and figure 4. There the level of
//! detail is `n - 1`, the number of points added to each edge. Coordinates are 16.16 fixed point.

use super::factors::FIXED_ONE;

/// Returns the number of complete rings before a point or a triangle: the largest `r` up to `m / 6` with `3 r (m - 3 r)
/// <= area`. For a point, `m` is `2 n + 3` and `area` is twice the number of points before it. For a triangle, `m` is
/// `2 n` and `area` is the number of triangles before it. `n` is at most 64.
///
/// The exact root is an integer, or at least 1/400 below the next one. The code adds 1/1024, which is tens of times the
/// error that WGSL allows for a square root and a product, so the result is exact on every device.
fn subtriangulation_rings(m: u32, area: u32) -> u32 {
    let root = ((m * m - 4 * area) as f32).sqrt();
    ((m as f32 - root) * (1.0 / 6.0) + 0.0009765625) as u32
}

/// Returns `k / n` in 16.16 fixed point, rounded to the nearest. There are no ties for `n` up to 64, so the results for
/// `k` and `n - k` add up to 1.
fn subtriangulation_location(n: u32, k: u32) -> u32 {
    (2 * FIXED_ONE * k + n) / (2 * n)
}

/// Returns (U, V) of point `i` of a patch of `n` segments on each side; W = 1 - U - V.
pub(super) fn subtriangulation_point(n: u32, i: u32) -> [u32; 2] {
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

/// Returns the number of point `q` of the row that lies inside side `side` of a ring. The ring starts at point `start`,
/// and its sides have `length` segments.
///
/// The row's first point is the last but one of the previous side. The others are points of the next ring inside.
fn subtriangulation_row(start: u32, length: u32, side: u32, q: u32) -> u32 {
    if q == 0 {
        return start + (side * length + 3 * length - 1) % (3 * length);
    }
    // In a ring that is a single point, every point of a side is that point.
    let inner = length - 3;
    start + 3 * length + (side * inner + q - 1) % (3 * inner).max(1)
}

/// Returns the corners of triangle `t` of a patch of `n` segments on each side, as point numbers, clockwise.
pub(super) fn subtriangulation_triangle(n: u32, t: u32) -> [u32; 3] {
    let ring = subtriangulation_rings(2 * n, t);
    let length = n - 3 * ring;
    let start = (3 * ring * (2 * n + 3 - 3 * ring)) >> 1;
    if length < 3 && t + 1 == n * n {
        // The triangle in the middle of the innermost ring joins its corners, or the middles of its sides.
        return [start + length - 1, start + 2 * length - 1, start + 3 * length - 1];
    }
    // A side's triangles have an edge on the side and on the row inside by turns. The last corner belongs to the next side.
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
