//! What host and shaders share. Twin: `shaders/types.wgsl` and `shaders/draw_types.wgsl`, field by field; a test
//! compares sizes and offsets. Padding is spelled out, so that every byte written is known.

use bytemuck::{Pod, Zeroable};

pub use crate::mesh::rig::{Binding, Delta, JointMatrix};
pub use crate::tessellate::{PatchFactors, Vertex};

/// View that factors are computed for; `LodView` in WGSL.
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

/// In place of [`crate::tessellate::Lod`] in [`Params::lod`]: factors are given patch by patch, and LOD has no say.
pub const LOD_GIVEN: u32 = 5;

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
    /// 1 where patches that face away are left out.
    pub culls_back: u32,
    pub convention: u32,
    /// How strong Phong tessellation is, 0 to 1.
    pub alpha: f32,
    pub normals: u32,
    pub displacement: u32,
    /// Object units.
    pub height_scale: f32,
    pub midlevel: f32,
    /// 1 where some edge's sides have different height images, and factors are by error: patches have factors of their own.
    pub mixed: u32,
    pub _pad: [u32; 2],
}

/// The run of patches that one scan covers, and what the arena holds.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Slab {
    pub first_patch: u32,
    pub patch_count: u32,
    pub vertex_capacity: u32,
    pub triangle_capacity: u32,
    pub chunk_capacity: u32,
    pub material_count: u32,
    pub _pad: [u32; 2],
}

/// An input triangle. Side k runs from corner k to corner k + 1.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Patch {
    pub points: [u32; 3],
    pub corners: [u32; 3],
    /// Curve of side k, times 2, plus 1 where the side runs against its edge's direction.
    pub curves: [u32; 3],
    /// Factor of side k, times 8, plus the kind of its edge.
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

/// What a set of an edge's sides share.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Curve {
    pub points: [u32; 2],
    pub first_side: u32,
    pub side_count: u32,
}

/// Control points of a curve: near its start and near its end.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct CurveNet {
    pub ab: [f32; 3],
    pub _pad: f32,
    pub ba: [f32; 3],
    pub _pad2: f32,
}

/// What displacement shares. Of a point: the direction in which it moves, and the level of the height image; its dominant
/// corner, as a patch times 4, plus which of its corners. Of a factor's edge, behind the points: the level, its dominant
/// side likewise, and one of its sides' images. Of a corner, behind the factors: how its texture coordinates change, one
/// after the other, as directions. Behind the corners: further images of edges' sides.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Share {
    pub direction: [f32; 3],
    pub level: f32,
    pub dominant: u32,
    /// How long the edge is at most in a height image, in px of level 0; that image, 1 for the first, 0 for none; and where
    /// the next of its sides' images stands here, 0 for nowhere.
    pub texels: f32,
    pub map: u32,
    pub next: u32,
}

/// One of the height images: width and height of level 0 in px, and where it starts among all heights.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct HeightMap {
    pub size: [u32; 2],
    pub levels: u32,
    pub start: u32,
    /// 1 where it starts again where it ends.
    pub repeats: u32,
    pub _pad: [u32; 3],
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

/// Indirect arguments of a chunk's two emit dispatches.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct EmitArgs {
    pub vertices: [u32; 3],
    pub triangles: [u32; 3],
    pub displaced: [u32; 3],
}

/// Indirect arguments of one material's draw within a chunk: indexed, and by pulling vertices.
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
