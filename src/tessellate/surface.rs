//! Control nets and the surfaces they make. Twin: `shaders/surface.wgsl`.
//!
//! Weights follow the PN-AEN white paper (McDonald and Kilgard 2010): u belongs to corner 0, v to corner 1, w to corner 2.
//! Domain coordinates are 16.16 fixed point, `FIXED_ONE` = 65536, so `FIXED_ONE - t` is exact and so is its f32 value.

use clap::ValueEnum;
use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::factors::FIXED_ONE;

/// One unit of fixed point as a float: exact, a power of two.
const UNIT: f32 = 1.0 / FIXED_ONE as f32;

/// Which surface a patch becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
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

/// The shading normal at weights `u`, `v`: the corners' normals, linearly interpolated, unit length. Normals that cancel
/// give +Z rather than NaN.
pub fn linear_normal(normals: [Vec3; 3], u: u32, v: u32) -> Vec3 {
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    (normals[0] * x + normals[1] * y + normals[2] * z).normalize_or(Vec3::Z)
}

/// The texture coordinate at weights `u`, `v`, linearly interpolated.
pub fn linear_uv(uvs: [glam::Vec2; 3], u: u32, v: u32) -> glam::Vec2 {
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    uvs[0] * x + uvs[1] * y + uvs[2] * z
}
