//! Control nets and the surfaces they make. Twin: `shaders/surface.wgsl`.
//!
//! Weights follow the PN-AEN white paper (McDonald and Kilgard 2010): u belongs to corner 0, v to corner 1, w to corner 2.
//! Domain coordinates are 16.16 fixed point, `FIXED_ONE` = 65536, so `FIXED_ONE - t` is exact and so is its f32 value.

use clap::ValueEnum;
use glam::{Vec2, Vec3, vec2, vec3};

use super::factors::FIXED_ONE;

/// One unit of fixed point as a float: exact, a power of two.
const UNIT: f32 = 1.0 / FIXED_ONE as f32;

/// Which surface a patch becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
#[repr(u32)]
pub enum Surface {
    /// Flat dicing: more triangles, same shape.
    Flat = 0,
    /// PN triangles (Vlachos et al. 2001): cubic patches from positions and normals; cracks where normals are split.
    Pn = 1,
    /// PN-AEN (McDonald and Kilgard 2010): PN with each edge's control points averaged over its sides; no cracks.
    PnAen = 2,
}

/// The control point one third along from `a` to `b`, in the tangent plane at `a` (Vlachos et al. 2001, section 3.1:
/// b210 = (2 P1 + P2 - w12 N1) / 3). `normal` is the unit normal at `a`.
pub fn edge_control_point(a: Vec3, b: Vec3, normal: Vec3) -> Vec3 {
    (a * 2.0 + b - normal * (b - a).dot(normal)) * (1.0 / 3.0)
}

/// The control point one third along a straight edge.
pub fn straight_control_point(a: Vec3, b: Vec3) -> Vec3 {
    (a * 2.0 + b) * (1.0 / 3.0)
}

/// b111 of the net with these corners and six edge control points: E + (E - V) / 2 (Vlachos et al. 2001, section 3.1).
pub fn center_control_point(corners: [Vec3; 3], edges: [Vec3; 6]) -> Vec3 {
    let e = (edges[0] + edges[1] + edges[2] + edges[3] + edges[4] + edges[5]) * (1.0 / 6.0);
    let v = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    e + (e - v) * 0.5
}

/// The point at `t` (16.16) on the edge from `a` to `b` with control points `ab` (near a) and `ba` (near b). Called in
/// the edge's own direction only: the two sides then run one computation on the same bits.
pub fn edge_position(surface: Surface, a: Vec3, ab: Vec3, ba: Vec3, b: Vec3, t: u32) -> Vec3 {
    let y = t as f32 * UNIT;
    let x = (FIXED_ONE - t) as f32 * UNIT;
    if surface == Surface::Flat {
        return a * x + b * y;
    }
    a * (x * x * x) + ab * (3.0 * x * x * y) + ba * (3.0 * x * y * y) + b * (y * y * y)
}

/// A patch's ten control points: corners b300 b030 b003; on side k, near its start and near its end
/// (b210 b120, b021 b012, b102 b201); b111. Positions in object units.
#[derive(Clone, Copy, Debug)]
pub struct ControlNet {
    pub corners: [Vec3; 3],
    pub edges: [Vec3; 6],
    pub center: Vec3,
}

/// The point inside a patch at weights `u`, `v` (16.16; w is the rest) (Vlachos et al. 2001, equation 1).
pub fn patch_position(surface: Surface, net: &ControlNet, u: u32, v: u32) -> Vec3 {
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    let [b300, b030, b003] = net.corners;
    if surface == Surface::Flat {
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

/// Shorter sums of weighted unit normals than this are what rounding leaves of normals that cancel.
const CANCELLED: f32 = 1e-6;

/// A weighted sum of normals at unit length, or `nearest` (the normal with the greatest weight) where they cancel.
pub fn unit_or(sum: Vec3, nearest: Vec3) -> Vec3 {
    let length_squared = sum.dot(sum);
    if length_squared > CANCELLED * CANCELLED { sum * (1.0 / length_squared.sqrt()) } else { nearest }
}

/// The shading normal at weights `u`, `v`: the corners' normals, linearly interpolated, unit length. Where they cancel
/// it is the nearest corner's.
pub fn linear_normal(normals: [Vec3; 3], u: u32, v: u32) -> Vec3 {
    let w = FIXED_ONE - u - v;
    let [a, b, c] = normals;
    let nearest = if u >= v && u >= w {
        a
    } else if v >= w {
        b
    } else {
        c
    };
    unit_or(a * (u as f32 * UNIT) + b * (v as f32 * UNIT) + c * (w as f32 * UNIT), nearest)
}

/// The shading normal at `t` (16.16) on the edge whose ends have normals `a` and `b`. Called in the edge's own
/// direction only, as [`edge_position`] is.
pub fn edge_normal(a: Vec3, b: Vec3, t: u32) -> Vec3 {
    let nearest = if 2 * t <= FIXED_ONE { a } else { b };
    unit_or(a * ((FIXED_ONE - t) as f32 * UNIT) + b * (t as f32 * UNIT), nearest)
}

/// A unit normal in 32 bits: octahedral, two signed normalised 16-bit numbers (Cigolle et al. 2014, section 3). Off by
/// less than 0.004 degrees.
pub fn pack_normal(normal: Vec3) -> u32 {
    let flat = normal / (normal.x.abs() + normal.y.abs() + normal.z.abs());
    let folded = (Vec2::ONE - vec2(flat.y.abs(), flat.x.abs())) * vec2(toward(flat.x), toward(flat.y));
    let [x, y] = if flat.z < 0.0 { folded } else { flat.truncate() }.to_array();
    let bits = |x: f32| u32::from((0.5 + 32767.0 * x.clamp(-1.0, 1.0)).floor() as i16 as u16);
    bits(x) | bits(y) << 16
}

/// The normal that was packed.
pub fn unpack_normal(bits: u32) -> Vec3 {
    let number = |bits: u32| (f32::from(bits as u16 as i16) / 32767.0).max(-1.0);
    let at = vec2(number(bits), number(bits >> 16));
    let z = 1.0 - at.x.abs() - at.y.abs();
    let back = (-z).max(0.0);
    vec3(at.x - toward(at.x) * back, at.y - toward(at.y) * back, z).normalize()
}

/// 1 for 0 and above, else -1.
fn toward(x: f32) -> f32 {
    if x >= 0.0 { 1.0 } else { -1.0 }
}

/// The texture coordinate at weights `u`, `v`, linearly interpolated.
pub fn linear_uv(uvs: [Vec2; 3], u: u32, v: u32) -> Vec2 {
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    uvs[0] * x + uvs[1] * y + uvs[2] * z
}

/// The texture coordinate at `t` (16.16) on the edge whose ends have `a` and `b`.
pub fn edge_uv(a: Vec2, b: Vec2, t: u32) -> Vec2 {
    a * ((FIXED_ONE - t) as f32 * UNIT) + b * (t as f32 * UNIT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A patch with normals that lean outwards.
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

    #[test]
    fn control_points_are_those_of_the_paper() {
        // Vlachos et al. 2001, section 3.1, by hand in f64: w12 = (P2 - P1) . N1, b210 = (2 P1 + P2 - w12 N1) / 3.
        let (a, b, n) = (vec3(1.0, 2.0, 3.0), vec3(4.0, 0.0, 5.0), vec3(0.6, 0.0, 0.8));
        let w = 3.0 * 0.6 + 2.0 * 0.8;
        let expected = [(2.0 + 4.0 - w * 0.6) / 3.0, 4.0 / 3.0, (6.0 + 5.0 - w * 0.8) / 3.0];
        assert!(edge_control_point(a, b, n).distance(Vec3::from(expected)) < 1e-6);
        // A control point lies in the tangent plane at its corner.
        assert!((edge_control_point(a, b, n) - a).dot(n).abs() < 1e-6);
    }

    #[test]
    fn a_patch_reproduces_a_quadratic_paraboloid() {
        // With E and V as the paper has them, b111 keeps quadratics: hold the patch of a paraboloid's own net against it.
        let height = |p: Vec2| p.x * p.x + 0.5 * p.y * p.y - p.x * p.y;
        let polar = |p: Vec2, q: Vec2| p.x * q.x + 0.5 * p.y * q.y - 0.5 * (p.x * q.y + p.y * q.x);
        let flat = [vec2(0.0, 0.0), vec2(1.0, 0.2), vec2(0.3, 0.9)];
        let point = |i: usize, j: usize, k: usize| {
            // The blossom of a quadratic, raised to a cubic: the mean over the pairs of its three arguments.
            let [a, b, c] = [flat[i], flat[j], flat[k]];
            ((a + b + c) / 3.0).extend((polar(a, b) + polar(b, c) + polar(c, a)) / 3.0)
        };
        let corners = [point(0, 0, 0), point(1, 1, 1), point(2, 2, 2)];
        let edges = [point(0, 0, 1), point(0, 1, 1), point(1, 1, 2), point(1, 2, 2), point(2, 2, 0), point(2, 0, 0)];
        let center = center_control_point(corners, edges);
        assert!(center.distance(point(0, 1, 2)) < 1e-6, "quadratic precision");
        let net = ControlNet { corners, edges, center };
        for (u, v) in [(20000, 30000), (5000, 1000), (21845, 21845)] {
            let at = patch_position(Surface::Pn, &net, u, v);
            assert!((at.z - height(at.truncate())).abs() < 1e-6, "{at}");
        }
    }

    proptest! {
        #[test]
        fn the_inside_meets_the_rim(t in 0u32..=FIXED_ONE) {
            let net = net();
            let [a, b, c] = net.corners;
            let [b210, b120, b021, b012, b102, b201] = net.edges;
            for surface in [Surface::Flat, Surface::Pn, Surface::PnAen] {
                let rim = [(a, b210, b120, b), (b, b021, b012, c), (c, b102, b201, a)];
                let inside = [(FIXED_ONE - t, t), (0, FIXED_ONE - t), (t, 0)];
                for ((p, pq, qp, q), (u, v)) in rim.into_iter().zip(inside) {
                    let on_rim = edge_position(surface, p, pq, qp, q, t);
                    prop_assert!(on_rim.distance(patch_position(surface, &net, u, v)) < 1e-6);
                }
            }
        }

        #[test]
        fn a_packed_normal_is_nearly_itself(x in -1f32..1.0, y in -1f32..1.0, z in -1f32..1.0) {
            let Some(normal) = vec3(x, y, z).try_normalize() else { return Ok(()) };
            let sine = normal.cross(unpack_normal(pack_normal(normal))).length();
            prop_assert!(sine.asin().to_degrees() < 0.004, "{}", sine);
        }
    }

    #[test]
    fn axes_are_packed_exactly() {
        for axis in Vec3::AXES {
            assert_eq!(unpack_normal(pack_normal(axis)), axis);
            assert_eq!(unpack_normal(pack_normal(-axis)), -axis);
        }
    }
}
