//! Emitted vertices, and how their patch and their domain point are packed. Twin: `Vertex` and `pack_key` in
//! `shaders/types.wgsl`.

use bytemuck::{Pod, Zeroable};

use super::factors::FIXED_ONE;
use super::surface::UNIT;

/// An emitted vertex.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// The position in object units.
    pub position: [f32; 3],
    /// The packed unit normal: see [`super::unpack_normal`].
    pub normal: u32,
    /// The packed patch and domain point: see [`Self::patch`] and [`Self::domain`].
    pub key: [u32; 2],
    /// The texture coordinate.
    pub uv: [f32; 2],
}

impl Vertex {
    /// Returns the patch that emitted the vertex.
    pub fn patch(&self) -> u32 {
        self.key[1] >> 2
    }

    /// Returns the domain point: the weights of corners 0 and 1 in 16.16 fixed point, whatever the convention calls
    /// them.
    pub fn domain(&self) -> [u32; 2] {
        [self.key[0] & 0x1ffff, (self.key[0] >> 17) | ((self.key[1] & 3) << 15)]
    }

    /// Returns the domain point as numbers, which hold it exactly.
    pub fn exact_domain(&self) -> [f64; 2] {
        self.domain().map(|weight| f64::from(weight) / f64::from(FIXED_ONE))
    }

    /// Returns how much each of the patch's corners counts at the domain point. They add up to 1.
    pub fn weights(&self) -> [f32; 3] {
        let [u, v] = self.domain();
        [u, v, FIXED_ONE - u - v].map(|weight| weight as f32 * UNIT)
    }
}

/// Packs a patch (30 bits) and a domain point (17 bits for each of U and V).
pub fn pack_key(patch: u32, [u, v]: [u32; 2]) -> [u32; 2] {
    [u | (v << 17), (v >> 15) | (patch << 2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_unpack_to_what_was_packed() {
        for patch in [0, 1, (1 << 30) - 1] {
            for uv in [[0, 0], [65536, 0], [0, 65536], [32767, 32768], [21845, 21845]] {
                let vertex = Vertex { key: pack_key(patch, uv), ..Zeroable::zeroed() };
                assert_eq!((vertex.patch(), vertex.domain()), (patch, uv));
            }
        }
    }
}
