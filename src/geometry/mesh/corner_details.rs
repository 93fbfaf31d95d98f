//! What some meshes' corners have beside position, normal and texture coordinates.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

use crate::defaults::with_defaults;

with_defaults! {
    /// What a corner has beside the attributes of [`Corner`](super::Corner), as passes and draws read it too. Interpolated
    /// linearly over a patch.
    #[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
    #[repr(C)]
    pub struct CornerDetail {
        /// The texture coordinates TEXCOORD_0 and TEXCOORD_1 of the file, untransformed. Those that no map of the corner's
        /// material uses (see [`MapUv::Set`](super::MapUv::Set)) are zero.
        pub uvs: [Vec2; 2] = [Vec2::ZERO; 2],
        /// Linear RGBA that multiplies the base colour (COLOR_0); white without one.
        pub color: Vec4 = Vec4::ONE,
        /// The direction in which the normal map's u grows, of unit length, in object space; zero if it isn't known.
        pub tangent: Vec3 = Vec3::ZERO,
        /// 1, or -1 where the bitangent is `-cross(normal, tangent)`.
        pub bitangent_sign: f32 = 1.0,
    }
}

impl CornerDetail {
    /// Returns what is between a triangle's corners with these weights, which add up to 1. The bitangents of a triangle's corners
    /// have one sign, unless its normal map is mirrored between them; the first corner's is taken, as when the triangle is drawn.
    pub fn blended([a, b, c]: [&Self; 3], [u, v, w]: [f32; 3]) -> Self {
        let set = |i: usize| a.uvs[i] * u + b.uvs[i] * v + c.uvs[i] * w;
        Self {
            uvs: [set(0), set(1)],
            color: a.color * u + b.color * v + c.color * w,
            tangent: (a.tangent * u + b.tangent * v + c.tangent * w).normalize_or_zero(),
            bitangent_sign: a.bitangent_sign,
        }
    }
}

/// One [`CornerDetail`] for each of a mesh's corners.
pub type CornerDetails = Vec<CornerDetail>;
