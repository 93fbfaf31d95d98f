//! Geometry: triangles with corners ([`Mesh`]), then welded points, edges and their sides ([`Topology`]).

pub mod adjacency;
pub mod bounds;
pub mod build_limits;
pub mod chunked_vec;
pub mod curves;
mod dominance;
pub mod generate_normals;
mod grid;
pub mod heights;
pub mod interner;
pub mod joins;
pub mod mesh_builder;
pub mod normal_faults;
pub mod normals;
pub mod polygon;
pub mod repairs;
pub mod rig;
pub mod rim;
pub mod shapes;
pub mod t_junctions;
pub mod topology;
mod tree;
mod union_find;
pub mod weld;

use std::ops::Range;
use std::sync::Arc;

use glam::{Vec2, Vec3};

pub use bounds::Bounds;
pub use build_limits::{BuildError, MAX_TRIANGLES, MemoryAccount, MemoryRefused, Unlimited};
pub use curves::{Curve, Curves, Sharing};
pub use dominance::Dominance;
pub use heights::{HeightMap, Heights, MAX_LEVELS, MAX_MAPS};
pub use joins::{Joins, joins};
pub use normal_faults::NormalFaults;
pub use repairs::Repairs;
pub use rig::{Moment, Pose, Rig};
pub use rim::{Rim, with_rim};
pub use shapes::{Shape, ShapeError};
pub use t_junctions::{TJunction, t_junctions};
pub use topology::{Edge, EdgeCounts, EdgeKind, Patch, Side, Topology};

/// A triangle's vertex: a position in object units, a unit normal and a texture coordinate (uv, in texture widths and
/// heights, v downwards as in glTF).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    pub position: Vec3,
    pub normal: Vec3,
    pub uv: Vec2,
}

/// Triangles ready for topology: every corner once, triangles grouped by material.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The file's or shape's name, for people.
    pub name: String,
    /// Distinct corners: no two have the same bits in all three attributes (-0 counts as 0), unless they move differently.
    pub corners: Vec<Corner>,
    /// Indices into `corners`, counter-clockwise seen from outside.
    pub triangles: Arc<Vec<[u32; 3]>>,
    /// Each owns one contiguous range of `triangles`; the ranges follow one another and cover all of them.
    pub materials: Vec<Material>,
    /// What it can be displaced by.
    pub heights: Option<Arc<Heights>>,
    /// How many corners had to be repaired.
    pub repairs: Repairs,
    /// How it moves, if it does.
    pub rig: Option<Arc<rig::Rig>>,
}

/// What a patch looks like.
#[derive(Clone, Debug)]
pub struct Material {
    pub name: String,
    /// Linear RGBA, 0 to 1.
    pub base_color: [f32; 4],
    /// Index into no list: the pixels themselves, shared between materials that use one image.
    pub texture: Option<Arc<Texture>>,
    /// Whether its triangles are meant to be seen from behind too.
    pub double_sided: bool,
    /// The triangles of the mesh that wear it.
    pub triangles: Range<u32>,
}

/// An 8-bit sRGB image with straight alpha, rows from the top.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Width and height in px.
    pub size: [u32; 2],
    /// 4 bytes a px.
    pub rgba: Vec<u8>,
}
