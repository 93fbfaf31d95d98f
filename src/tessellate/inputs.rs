//! What a tessellation is a function of, besides the mesh.

use clap::ValueEnum;

use super::{Clip, Convention, Displacement, Lod, LodView, Normals, Partitioning, Surface};
use crate::mesh::Sharing;

/// Who computes what the sides of an edge must agree on: control points, factor, positions and normals along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
#[repr(u32)]
pub enum Edges {
    /// The edge itself, once, in its own direction: all sides get the same bits, and nothing cracks.
    PerEdge = 0,
    /// Every patch for itself, in its own direction, as the white paper's shaders do (McDonald and Kilgard 2010): the
    /// same but for rounding, so that edges crack in their last bits. In the window, LOD by length and clipping switch to
    /// the white paper's form too.
    AsPublished = 1,
}

/// What a tessellation is a function of, besides the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    pub surface: Surface,
    /// How strong Phong tessellation is, 0 (flat) to 1.
    pub alpha: f32,
    pub normals: Normals,
    pub edges: Edges,
    pub factor: f32,
    pub partitioning: Partitioning,
    pub lod: Lod,
    /// Px a segment, for adaptive LOD.
    pub pixels: f32,
    /// Under LOD by error: the distance in px that what is emitted keeps to the surface.
    pub tolerance: f32,
    /// Under LOD by distance: up to which the factor is `factor`, and from which on it is 1, in bounding radii.
    pub near: f32,
    pub far: f32,
    pub clip: Clip,
    /// Whether patches that show their backs only are left out, where [`super::Solid`] allows it.
    pub cull_back_faces: bool,
    pub convention: Convention,
    pub displacement: Displacement,
    /// How far white is above black, in bounding radii of the mesh at rest.
    pub height_scale: f32,
    /// The height that stays where it is, 0 to 1.
    pub midlevel: f32,
    pub view: LodView,
}

/// Which sides share a curve under a surface.
pub fn sharing(surface: Surface, edges: Edges) -> Sharing {
    let alone = surface.tears() || surface == Surface::Flat;
    match edges {
        Edges::PerEdge if surface.tears() => Sharing::EqualNormals,
        Edges::PerEdge => Sharing::AllSides,
        Edges::AsPublished if alone => Sharing::None,
        Edges::AsPublished => Sharing::NoneAveraged,
    }
}
