//! What a tessellation depends on, besides the mesh.

use super::{Clip, Convention, Displacement, Lod, LodView, Normals, Partitioning, Surface};
use crate::choice::choices;
use crate::defaults::with_defaults;
use crate::mesh::{Mesh, Sharing, StylesUsed};

choices! {
    /// Where the values come from that all sides of an edge must agree on: control points, the factor, and positions and
    /// normals along the edge.
    #[derive(Hash)]
    #[repr(u32)]
    pub enum Edges {
        PerEdge => "per-edge", "Computed once",
            "Every shared edge is computed once. The triangles on both sides get identical bits, so that nothing cracks.";
        AsPublished => "as-published", "By each patch",
            "Every patch computes its edges for itself, as the white paper's shaders do (McDonald and Kilgard 2010). \
             Rounding differs, so that edges crack in their last bits.";
    }
}

with_defaults! {
    /// How a mesh is tessellated.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Tessellation {
        /// The surface that replaces each triangle.
        pub surface: Surface = Surface::PnAen,
        /// Strength of Phong tessellation, 0 (flat) to 1.
        pub alpha: f32 = 0.75,
        /// The normals of emitted vertices.
        pub normals: Normals = Normals::Linear,
        /// Where sides get what they share from.
        pub edges: Edges = Edges::PerEdge,
        /// Tessellation factor under uniform LOD, and the largest under LOD by distance, 1 to 64.
        pub factor: f32 = 8.0,
        /// How factors become segments.
        pub partitioning: Partitioning = Lod::Uniform.usual_partitioning(),
        /// The LOD that is chosen; [`Self::used_lod`] is the one that is used.
        pub lod: Lod = Lod::Uniform,
        /// Under LOD by edge length: length of a segment on screen, in px.
        pub pixels: f32 = 8.0,
        /// Under LOD by error: largest distance on screen between the emitted triangles and the surface, in px.
        pub tolerance: f32 = 0.25,
        /// Under LOD by distance: distance to the eye up to which the factor is `factor`, in bounding radii.
        pub near: f32 = 2.0,
        /// Under LOD by distance: distance to the eye from which on the factor is 1, in bounding radii; larger than `near`.
        pub far: f32 = 10.0,
        /// Whether patches outside the view are left out.
        pub clip: Clip = Clip::Off,
        /// Whether patches that show only their backs are left out, if the mesh is closed.
        pub cull_back_faces: bool = false,
        /// The order of factors and weights.
        pub convention: Convention = Convention::D3d11,
        /// Whether height images move the surface.
        pub displacement: Displacement = Displacement::Off,
        /// Distance between a height of 0 and a height of 1, in bounding radii of the mesh at rest.
        pub height_scale: f32 = 0.05,
        /// The height that isn't moved, 0 to 1.
        pub midlevel: f32 = 0.5,
    }
}

impl Tessellation {
    /// Subtriangulation has one number of segments everywhere, so that its LOD is uniform whichever is chosen.
    pub fn used_lod(&self) -> Lod {
        if self.partitioning.has_one_factor() { Lod::Uniform } else { self.lod }
    }

    /// Whether what is drawn follows the camera: factors, or which patches are left out.
    pub fn follows_view(&self) -> bool {
        self.used_lod().follows_view() || self.clip != Clip::Off || self.cull_back_faces
    }

    /// The same whatever the view: this factor for all edges, and all patches are drawn.
    #[must_use]
    pub fn with_one_factor(self, factor: f32) -> Self {
        Self { lod: Lod::Uniform, factor, clip: Clip::Off, cull_back_faces: false, ..self }
    }

    /// LOD by error with this tolerance in px, in a partitioning that has a factor for each edge.
    #[must_use]
    pub fn by_error(self, tolerance: f32) -> Self {
        Self { lod: Lod::Error, tolerance, partitioning: self.partitioning.with_factors_of_edges(), ..self }
    }

    /// Without displacement.
    #[must_use]
    pub fn undisplaced(self) -> Self {
        Self { displacement: Displacement::Off, ..self }
    }

    /// The mesh as it is: each of its triangles becomes one triangle.
    pub fn untessellated() -> Self {
        let partitioning = Partitioning::Integer;
        Self { surface: Surface::Flat, factor: 1.0, lod: Lod::Uniform, partitioning, ..Self::default() }
    }
}

/// What a tessellation depends on, besides the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    /// Its LOD is the one that is used.
    pub tessellation: Tessellation,
    /// What LOD and clipping are computed for.
    pub view: LodView,
}

impl Inputs {
    /// A tessellation with the LOD that it uses, seen from `view`.
    pub fn new(tessellation: &Tessellation, view: LodView) -> Self {
        Self { tessellation: Tessellation { lod: tessellation.used_lod(), ..*tessellation }, view }
    }

    /// What of the styles of parts counts: nothing where the mesh is shown as it is.
    pub fn styles(&self) -> StylesUsed {
        match self.tessellation == Tessellation::untessellated() {
            true => StylesUsed::Nothing,
            false => StylesUsed::All(self.tessellation.surface),
        }
    }

    /// The surfaces of a mesh's patches.
    pub fn surfaces(&self, mesh: &Mesh) -> impl Iterator<Item = Surface> {
        let are_used = self.styles() != StylesUsed::Nothing;
        let own = mesh.styles().filter(move |_| are_used).filter_map(|style| style.surface);
        std::iter::once(self.tessellation.surface).chain(own)
    }

    /// The surface as which all patches of a mesh are evaluated: flat only if all of them are. The control points of flat ones among
    /// others lie in their planes.
    pub fn evaluated_surface(&self, mesh: &Mesh) -> Surface {
        self.surfaces(mesh).find(|own| !own.is_flat()).unwrap_or(self.tessellation.surface)
    }
}

/// Which sides of an edge share its curve where a function of the user's own gives control points: none.
pub fn user_sharing(edges: Edges) -> Sharing {
    match edges {
        Edges::PerEdge => Sharing::EachSide,
        Edges::AsPublished => Sharing::NoneAveraged,
    }
}

/// Which sides of an edge share its curve under a surface.
pub fn sharing(surface: Surface, edges: Edges) -> Sharing {
    let alone = surface.tears() || surface.is_flat();
    match edges {
        Edges::PerEdge if surface.tears() => Sharing::EqualNormals,
        Edges::PerEdge => Sharing::AllSides,
        Edges::AsPublished if alone => Sharing::None,
        Edges::AsPublished => Sharing::NoneAveraged,
    }
}
