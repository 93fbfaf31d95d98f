//! Structs that passes read and write. `shaders/types.wgsl` has the same, field by field; a test compares sizes and offsets.
//! Padding is spelled out, so that every byte that is written is known.

use bytemuck::{Pod, Zeroable};

pub use geometry::mesh::rig::{Binding, Delta, JointMatrix};
pub use geometry::mesh::{CornerDetail, Curve, PatchRelief};
pub use geometry::tessellate::{PatchFactors, Vertex};

/// The view that factors are computed for.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LodView {
    pub clip_from_object: [[f32; 4]; 4],
    pub half_viewport: [f32; 2],
    /// How far what is emitted may be from the surface, in object units: it is displaced.
    pub reach: f32,
    pub _pad: f32,
    pub eye: [f32; 3],
    pub radius: f32,
}

/// A value of [`Params::lod`] that no [`geometry::tessellate::Lod`] has: the factors of every patch were given.
pub const LOD_GIVEN: u32 = u32::MAX;

/// Settings and view of one tessellation.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Params {
    pub view: LodView,
    pub factor: f32,
    pub pixels_per_segment: f32,
    pub surface: u32,
    pub partitioning: u32,
    pub lod: u32,
    pub clip: u32,
    pub point_count: u32,
    pub patch_count: u32,
    pub factor_count: u32,
    pub curve_count: u32,
    pub edges: u32,
    /// Px.
    pub tolerance: f32,
    /// Bounding radii.
    pub near: f32,
    pub far: f32,
    /// 1 if patches that face away from the eye are left out.
    pub culls_back: u32,
    pub convention: u32,
    /// How strong Phong tessellation is, 0 to 1.
    pub alpha: f32,
    pub normals: u32,
    pub displacement: u32,
    /// In object units: how far white is above black in images that don't say it.
    pub height_scale: f32,
    pub midlevel: f32,
    /// The surface of parts which have none of their own.
    pub chosen_surface: u32,
    pub _pad: [u32; 2],
}

/// The run of patches that one scan covers, and how much fits the arena.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Slab {
    pub first_patch: u32,
    pub patch_count: u32,
    pub vertex_capacity: u32,
    pub triangle_capacity: u32,
    pub chunk_vertices: u32,
    pub chunk_triangles: u32,
    pub chunk_capacity: u32,
    pub material_count: u32,
}

/// An input triangle. Side k runs from corner k to corner k + 1.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Patch {
    pub points: [u32; 3],
    pub corners: [u32; 3],
    /// For side k: twice the index of its curve, plus 1 if the side runs against its edge's direction.
    pub curves: [u32; 3],
    /// For side k: 8 times the index of its factor, plus the kind of its edge.
    pub factors: [u32; 3],
}

/// A corner's shading attributes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Corner {
    pub normal: [f32; 3],
    pub _pad: f32,
    pub uv: [f32; 2],
    pub _pad2: [f32; 2],
}

/// The two inner control points of a curve: the one near its start, and the one near its end.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct CurveNet {
    pub ab: [f32; 3],
    pub _pad: f32,
    pub ba: [f32; 3],
    pub _pad2: f32,
}

/// What patches share where they meet, so that displacement doesn't tear them apart. One buffer holds, one after another:
/// - for each point, the direction in which it moves, the level at which its height is looked up, and its dominant corner;
/// - for each factor's edge, the level and the dominant side;
/// - for each corner, two elements whose directions are the gradients of its two texture coordinates;
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Share {
    pub direction: [f32; 3],
    pub level: f32,
    /// 4 times a patch, plus which of its corners or sides.
    pub dominant: u32,
    pub _pad: [u32; 3],
}

/// One of the height images: width and height of its level 0 in px, its number of mip levels, and where its heights start among
/// those of all images.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct HeightMap {
    pub size: [u32; 2],
    pub levels: u32,
    pub start: u32,
    /// What is beyond it, a [`Wrap`](geometry::mesh::Wrap): along u in the lowest two bits, along v in the next.
    pub wrap: u32,
    /// 1 if it has a scale and a midlevel of its own, 0 if those of [`Params`] hold.
    pub has_amount: u32,
    pub scale: f32,
    pub midlevel: f32,
}

/// Patches that go through the arena together. `first_vertex` and `first_triangle` count from the slab's start.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Chunk {
    pub first_patch: u32,
    pub patch_end: u32,
    pub first_vertex: u32,
    pub first_triangle: u32,
    pub vertex_count: u32,
    pub triangle_count: u32,
}

/// Indirect arguments of the two dispatches that emit a chunk, and of the one that displaces it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct EmitArgs {
    pub vertices: [u32; 3],
    pub triangles: [u32; 3],
    pub displaced: [u32; 3],
}

/// Indirect arguments of the draw of one material's triangles of a chunk: for an indexed draw, and for one without an index buffer
/// whose shader fetches (pulls) each corner's vertex itself.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct DrawArgs {
    pub index_count: u32,
    pub instance_count: u32,
    pub first_index: u32,
    pub base_vertex: i32,
    pub first_instance: u32,
    pub pull_vertex_count: u32,
    pub pull_instance_count: u32,
    pub pull_first_vertex: u32,
    pub pull_first_instance: u32,
}
