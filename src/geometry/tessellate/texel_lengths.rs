//! The lengths of edges in px of the height images on their sides. The sides of an edge may have different images.

use super::displace::texel_length;
use crate::mesh::{Dominance, Heights, Mesh, Topology};

/// The height maps that an edge's factor depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Maps {
    /// The maps of all its sides.
    All,
    /// One map: 1 for the first, 0 for none.
    Only(u32),
}

/// The greatest length that an edge has in one of its sides' maps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TexelLength {
    /// The map: 1 for the first, 0 for none.
    pub map: u32,
    /// The length in px of level 0.
    pub texels: f32,
    /// The index of the same edge's length in another map, or 0 if there is none.
    pub next: u32,
}

/// Returns the number of a patch's height map: 1 for the first, 0 for none.
pub fn map_number(heights: &Heights, topology: &Topology, patch: u32) -> u32 {
    heights.of_material.get(topology.material_of(patch)).copied().flatten().map_or(0, |map| map + 1)
}

/// Returns one length for each edge factor, followed by the further lengths of edges whose sides have different maps.
pub fn texel_lengths(heights: &Heights, mesh: &Mesh, topology: &Topology, dominance: &Dominance) -> Vec<TexelLength> {
    let mut texel_lengths = vec![TexelLength::default(); dominance.sides.len()];
    for (index, patch) in (0..).zip(&topology.patches) {
        let number = map_number(heights, topology, index);
        let Some(map) = number.checked_sub(1).and_then(|map| heights.maps.get(map as usize)) else { continue };
        let uvs = topology.corners(patch).map(|corner| mesh.corners[corner as usize].uv);
        for (side, factor) in dominance.patch_factors[index as usize].into_iter().enumerate() {
            let own = own_texel_length(&mut texel_lengths, factor as usize, number);
            own.texels = own.texels.max(texel_length(map, uvs[side], uvs[(side + 1) % 3]));
        }
    }
    texel_lengths
}

/// Returns the length of an edge in a map, and adds it if it doesn't exist.
fn own_texel_length(texel_lengths: &mut Vec<TexelLength>, factor: usize, map: u32) -> &mut TexelLength {
    let mut at = factor;
    while ![0, map].contains(&texel_lengths[at].map) {
        if texel_lengths[at].next == 0 {
            texel_lengths[at].next = texel_lengths.len() as u32;
            texel_lengths.push(TexelLength::default());
        }
        at = texel_lengths[at].next as usize;
    }
    texel_lengths[at].map = map;
    &mut texel_lengths[at]
}
