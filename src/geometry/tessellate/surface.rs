//! Control nets, and the evaluation of the surfaces that they define. Twin: `shaders/surface.wgsl`.
//!
//! Weights follow the PN-AEN white paper (McDonald and Kilgard 2010): u belongs to corner 0, v to corner 1, w to corner
//! 2. Domain coordinates are 16.16 fixed point with `FIXED_ONE` = 65536. So `FIXED_ONE - t` is exact, and so is its
//! conversion to f32.

use glam::{Vec2, Vec3};

use super::Surface;
use super::factors::FIXED_ONE;

/// The smallest step of 16.16 fixed point as a float. It is a power of two, so products with it are exact.
pub const UNIT: f32 = 1.0 / FIXED_ONE as f32;

/// Returns the point at `t` (16.16 fixed point) on the edge from `a` to `b` with control points `ab` (near a) and `ba`
/// (near b), in object units. The arguments must be in the edge's own direction: then all sides do the same arithmetic
/// on the same bits, and get the same point.
pub fn edge_position(surface: Surface, a: Vec3, ab: Vec3, ba: Vec3, b: Vec3, t: u32) -> Vec3 {
    let y = t as f32 * UNIT;
    let x = (FIXED_ONE - t) as f32 * UNIT;
    if surface.is_flat() {
        return a * x + b * y;
    }
    a * (x * x * x) + ab * (3.0 * x * x * y) + ba * (3.0 * x * y * y) + b * (y * y * y)
}

/// The ten control points of a patch, in object units: the corners b300, b030 and b003; for each side k the one near
/// its start and the one near its end (b210 b120, b021 b012, b102 b201); and b111 in the centre.
#[derive(Clone, Copy, Debug)]
pub struct ControlNet {
    pub corners: [Vec3; 3],
    pub edges: [Vec3; 6],
    pub center: Vec3,
}

/// Returns the point of a patch at weights `u` and `v` (16.16 fixed point; w is the rest of 1), in object units
/// (Vlachos et al. 2001, equation 1).
pub fn patch_position(surface: Surface, net: &ControlNet, u: u32, v: u32) -> Vec3 {
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    let [b300, b030, b003] = net.corners;
    if surface.is_flat() {
        return b300 * x + b030 * y + b003 * z;
    }
    let [b210, b120, b021, b012, b102, b201] = net.edges;
    b300 * (x * x * x)
        + b030 * (y * y * y)
        + b003 * (z * z * z)
        + b210 * (3.0 * x * x * y)
        + b120 * (3.0 * x * y * y)
        + b021 * (3.0 * y * y * z)
        + b012 * (3.0 * y * z * z)
        + b102 * (3.0 * z * z * x)
        + b201 * (3.0 * z * x * x)
        + net.center * (6.0 * x * y * z)
}

/// Returns the derivatives of a patch's position by u and by v (w = 1 - u - v) at weights `u` and `v`: its tangents, in
/// object units.
pub fn patch_tangents(surface: Surface, net: &ControlNet, u: u32, v: u32) -> [Vec3; 2] {
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    let [b300, b030, b003] = net.corners;
    if surface.is_flat() {
        return [b300 - b003, b030 - b003];
    }
    let [b210, b120, b021, b012, b102, b201] = net.edges;
    let b111 = net.center;
    // The derivatives are quadratic Bézier triangles of differences of control points, times 3.
    let (xx, xy, yy) = (3.0 * x * x, 6.0 * x * y, 3.0 * y * y);
    let (yz, zz, zx) = (6.0 * y * z, 3.0 * z * z, 6.0 * z * x);
    let along_u = (b300 - b201) * xx
        + (b210 - b111) * xy
        + (b120 - b021) * yy
        + (b111 - b012) * yz
        + (b102 - b003) * zz
        + (b201 - b102) * zx;
    let along_v = (b210 - b201) * xx
        + (b120 - b111) * xy
        + (b030 - b021) * yy
        + (b021 - b012) * yz
        + (b012 - b003) * zz
        + (b111 - b102) * zx;
    [along_u, along_v]
}

/// Returns the linearly interpolated texture coordinate at weights `u` and `v` of a patch.
pub fn linear_uv(uvs: [Vec2; 3], u: u32, v: u32) -> Vec2 {
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    uvs[0] * x + uvs[1] * y + uvs[2] * z
}

/// Returns the linearly interpolated texture coordinate at `t` (16.16 fixed point) on an edge whose ends have `a` and
/// `b`.
pub fn edge_uv(a: Vec2, b: Vec2, t: u32) -> Vec2 {
    a * ((FIXED_ONE - t) as f32 * UNIT) + b * (t as f32 * UNIT)
}

/// Returns where the domain point (u, v, w) lies on the patch's outline: the side, and the weight of the side's end.
/// `None` inside the patch.
pub fn outline_place(u: u32, v: u32) -> Option<(usize, u32)> {
    let w = FIXED_ONE - u - v;
    if w == 0 {
        Some((0, v))
    } else if u == 0 {
        Some((1, w))
    } else if v == 0 {
        Some((2, u))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use glam::vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::tessellate::{center_control_point, edge_control_point};

    /// Returns the net of a patch whose normals lean outwards.
    fn net() -> ControlNet {
        let corners = [vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.5), vec3(0.5, 1.5, 0.0)];
        let normals = [vec3(-0.3, -0.3, 1.0), vec3(0.4, 0.0, 1.0), vec3(0.0, 0.5, 1.0)].map(Vec3::normalize);
        let side = |k: usize| {
            let (a, b) = (k, (k + 1) % 3);
            let near = edge_control_point(corners[a], corners[b], normals[a]);
            [near, edge_control_point(corners[b], corners[a], normals[b])]
        };
        let edges = [side(0), side(1), side(2)].as_flattened().try_into().expect("six");
        ControlNet { corners, edges, center: center_control_point(corners, edges) }
    }

    proptest! {
        #[test]
        fn the_patch_and_its_edges_agree_on_the_outline(t in 0u32..=FIXED_ONE) {
            let net = net();
            let [a, b, c] = net.corners;
            let [b210, b120, b021, b012, b102, b201] = net.edges;
            for surface in [Surface::Flat, Surface::Pn, Surface::PnAen] {
                let outline = [(a, b210, b120, b), (b, b021, b012, c), (c, b102, b201, a)];
                let inside = [(FIXED_ONE - t, t), (0, FIXED_ONE - t), (t, 0)];
                for ((p, pq, qp, q), (u, v)) in outline.into_iter().zip(inside) {
                    let on_edge = edge_position(surface, p, pq, qp, q, t);
                    prop_assert!(on_edge.distance(patch_position(surface, &net, u, v)) < 1e-6);
                }
            }
        }

        #[test]
        fn tangents_are_the_derivatives_of_positions(u in 600u32..30000, v in 600u32..30000) {
            let net = net();
            for surface in [Surface::Flat, Surface::Pn] {
                let at = |u: u32, v: u32| patch_position(surface, &net, u, v).as_dvec3();
                // The error of central differences of a cubic is a sixth of the third derivative times the square of 512 / 65536.
                let step = 2.0 * 512.0 / 65536.0;
                let expected = [at(u + 512, v) - at(u - 512, v), at(u, v + 512) - at(u, v - 512)].map(|d| d / step);
                for (own, expected) in patch_tangents(surface, &net, u, v).into_iter().zip(expected) {
                    prop_assert!(own.as_dvec3().distance(expected) < 1e-3, "{:?}: {} {}", surface, own, expected);
                }
            }
        }
    }
}
