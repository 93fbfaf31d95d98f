//! An emitted vertex, and how its patch and its place in the domain are packed. Twin: `Vertex` and `pack_key` in
//! `shaders/types.wgsl`.

use bytemuck::{Pod, Zeroable};

/// An emitted vertex.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// Object units.
    pub position: [f32; 3],
    /// See [`super::pack_normal`].
    pub normal: u32,
    /// Patch and domain coordinates: see [`pack_key`].
    pub key: [u32; 2],
    pub uv: [f32; 2],
}

impl Vertex {
    /// The patch that emitted it.
    pub fn patch(&self) -> u32 {
        self.key[1] >> 2
    }

    /// Its domain point: the weights of corners 0 and 1 in 16.16 fixed point, whatever the convention calls them.
    pub fn domain(&self) -> [u32; 2] {
        [self.key[0] & 0x1ffff, (self.key[0] >> 17) | ((self.key[1] & 3) << 15)]
    }
}

/// U and V need 17 bits each; the patch gets the other 30.
pub fn pack_key(patch: u32, [u, v]: [u32; 2]) -> [u32; 2] {
    [u | (v << 17), (v >> 15) | (patch << 2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_gives_back_what_was_packed() {
        for patch in [0, 1, (1 << 30) - 1] {
            for uv in [[0, 0], [65536, 0], [0, 65536], [32767, 32768], [21845, 21845]] {
                let vertex = Vertex { key: pack_key(patch, uv), ..Zeroable::zeroed() };
                assert_eq!((vertex.patch(), vertex.domain()), (patch, uv));
            }
        }
    }
}
