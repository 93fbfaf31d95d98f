//! What a written vertex has beside position, normal and texture coordinates: only what the mesh's materials need.

use glam::Vec4;

use geometry::mesh::Mesh;

/// The optional attributes of a mesh's vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Attributes {
    /// The sets of texture coordinates that maps use beside those of the base colour.
    pub sets: [bool; 2],
    pub colors: bool,
    pub tangents: bool,
}

impl Attributes {
    /// What the vertices of a mesh need.
    pub(super) fn new(mesh: &Mesh) -> Self {
        let Some(details) = &mesh.details else { return Self::default() };
        let looks = || mesh.materials.iter().map(|material| &material.look);
        let sets = [0, 1].map(|set| looks().any(|look| look.uv_sets()[set]));
        let needs_tangents = looks().any(|look| look.tangent_uv().is_some());
        Self {
            sets,
            colors: details.iter().any(|detail| detail.color != Vec4::ONE),
            tangents: needs_tangents && details.iter().any(|detail| detail.tangent != glam::Vec3::ZERO),
        }
    }

    /// Returns how much memory a vertex takes in a .glb file: floats for position, normal and texture coordinates, and for these.
    pub(super) fn bytes(self) -> u64 {
        let sets = self.sets.iter().filter(|is_used| **is_used).count() as u64;
        32 + 8 * sets + 16 * (u64::from(self.colors) + u64::from(self.tangents))
    }
}
