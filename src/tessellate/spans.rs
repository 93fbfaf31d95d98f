//! How long edges are in the height images of their sides, which may have different ones.

use super::displace::texel_length;
use crate::mesh::{Dominance, Heights, Mesh, Topology};

/// Whose heights an edge is asked by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Maps {
    /// Those of all its sides.
    All,
    /// One map's: 1 for the first, 0 for none at all.
    Only(u32),
}

/// How long an edge is at most in one of its sides' maps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Span {
    /// 1 for the first, 0 for none.
    pub map: u32,
    /// Px of level 0.
    pub texels: f32,
    /// The span in another of its sides' maps; 0 if there is none.
    pub next: u32,
}

/// A patch's map: 1 for the first, 0 for none.
pub fn map_number(heights: &Heights, topology: &Topology, patch: u32) -> u32 {
    heights.of_material.get(topology.material_of(patch)).copied().flatten().map_or(0, |map| map + 1)
}

/// One for each factor, then the further ones of edges whose sides have different maps.
pub fn spans(heights: &Heights, mesh: &Mesh, topology: &Topology, dominance: &Dominance) -> Vec<Span> {
    let mut spans = vec![Span::default(); dominance.sides.len()];
    for (index, patch) in (0..).zip(&topology.patches) {
        let number = map_number(heights, topology, index);
        let Some(map) = number.checked_sub(1).and_then(|map| heights.maps.get(map as usize)) else { continue };
        let uvs = topology.corners(patch).map(|corner| mesh.corners[corner as usize].uv);
        for (side, factor) in dominance.patch_factors[index as usize].into_iter().enumerate() {
            let own = own_span(&mut spans, factor as usize, number);
            own.texels = own.texels.max(texel_length(map, uvs[side], uvs[(side + 1) % 3]));
        }
    }
    spans
}

/// The span of an edge in a map, added if it isn't there.
fn own_span(spans: &mut Vec<Span>, factor: usize, map: u32) -> &mut Span {
    let mut at = factor;
    while ![0, map].contains(&spans[at].map) {
        if spans[at].next == 0 {
            spans[at].next = spans.len() as u32;
            spans.push(Span::default());
        }
        at = spans[at].next as usize;
    }
    spans[at].map = map;
    &mut spans[at]
}

/// Whether a patch has a side that other maps speak for too.
pub fn is_mixed(spans: &[Span], heights: &Heights, topology: &Topology, dominance: &Dominance) -> bool {
    let differs = |span: &Span, own: u32| span.next > 0 || span.map != own;
    (0..).zip(&dominance.patch_factors).any(|(patch, factors)| {
        let own = map_number(heights, topology, patch);
        factors.iter().any(|&factor| differs(&spans[factor as usize], own))
    })
}
