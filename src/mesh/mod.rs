//! Geometry: triangles with corners ([`Mesh`]); and the points, edges and sides that they meet in ([`Topology`]).

pub(crate) mod adjacency;
mod alike_corners;
mod bounding_box_tree;
pub(crate) mod bounds;
pub(crate) mod build_limits;
mod cell_chains;
mod cell_grid;
pub(crate) mod chunked_vec;
pub(crate) mod corner_details;
pub(crate) mod crease_band;
pub(crate) mod curves;
pub(crate) mod detail_table;
mod dominance;
mod file_camera;
pub(crate) mod generate_normals;
pub(crate) mod heights;
pub(crate) mod interner;
mod light;
pub(crate) mod material;
pub(crate) mod mesh_builder;
pub(crate) mod mipmap;
mod near_points;
pub(crate) mod normal_faults;
pub(crate) mod normals;
pub(crate) mod orientation;
pub(crate) mod polygon;
pub(crate) mod repairs;
pub(crate) mod rig;
pub(crate) mod shapes;
mod slices;
mod smooth_points;
mod spatial_hash;
pub(crate) mod t_junctions;
pub(crate) mod topology;
mod unfinished_mesh;
pub(crate) mod union_find;
pub(crate) mod weld;
pub(crate) mod weld_preview;

use std::sync::Arc;

use glam::{Vec2, Vec3};

pub use bounds::Bounds;
pub use corner_details::{CornerDetail, CornerDetails};
pub use file_camera::{FileCamera, Projection};
pub use heights::{HeightMap, Heights};
pub use light::{Light, LightKind, MOST_LIGHTS};
pub use material::{Alpha, Look, Map, MapUv, Material, Sampling, Slot, Texture, Wrap};
pub use repairs::Repairs;
pub use rig::clip::Clip;
pub use rig::{Moment, Pose, Rig};
pub use slices::{MeshSlices, SliceError};
pub use topology::{Edge, EdgeCounts, EdgeKind, Patch, Side, Topology};

#[cfg(test)]
pub(crate) use build_limits::Unlimited;
pub(crate) use build_limits::{Borrowed, BuildError, MemoryAccount, MemoryRefused, borrowing};
pub(crate) use crease_band::{CreaseBand, with_crease_band};
pub(crate) use curves::{Curve, Curves, Sharing};
pub(crate) use dominance::Dominance;
pub(crate) use heights::{MAX_LEVELS, MAX_MAPS};
pub(crate) use normal_faults::NormalFaults;
pub(crate) use orientation::UpAxis;
pub(crate) use shapes::Shape;
pub(crate) use t_junctions::{TJunction, t_junctions};
pub(crate) use weld_preview::{WeldPreview, weld_previews};

/// A triangle's vertex: a position in object units, a unit normal and a texture coordinate (uv, in texture widths and
/// heights, v downwards as in glTF).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// In object units.
    pub position: Vec3,
    /// Of unit length.
    pub normal: Vec3,
    /// In texture widths and heights, from the upper left corner.
    pub uv: Vec2,
}

/// Triangles ready for topology: every corner once, triangles grouped by material.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The name of the file or shape, for display.
    pub name: String,
    /// Distinct corners: no two have the same bits in all three attributes (-0 counts as 0), unless an animation moves
    /// them differently, or their details differ.
    pub corners: Vec<Corner>,
    /// Indices into `corners`, counter-clockwise seen from outside.
    pub triangles: Arc<Vec<[u32; 3]>>,
    /// The ranges of `triangles` of these materials follow one another and cover all triangles.
    pub materials: Vec<Material>,
    /// The height images that displacement can move the surface by.
    pub heights: Option<Arc<Heights>>,
    /// More about each corner, for meshes whose materials need it.
    pub details: Option<Arc<CornerDetails>>,
    /// How many corners had to be repaired.
    pub repairs: Repairs,
    /// The joints, morph targets and clips of an animated mesh.
    pub rig: Option<Arc<rig::Rig>>,
    /// The lights of the file, at most [`MOST_LIGHTS`].
    pub lights: Vec<Light>,
    /// The cameras of the file.
    pub cameras: Vec<FileCamera>,
}

impl Mesh {
    /// Returns the lights of the file in a pose. One without a finite place there stays where it is at rest.
    pub(crate) fn lights_in(&self, pose: &Pose) -> Vec<Light> {
        let mut lights = self.lights.clone();
        for (light, global) in lights.iter_mut().zip(&pose.lights) {
            *light = light.at(global).unwrap_or(*light);
        }
        lights
    }

    /// Returns the cameras of the file in a pose. One without a finite place and direction there stays where it is at rest.
    pub(crate) fn cameras_in(&self, pose: &Pose) -> Vec<FileCamera> {
        let mut cameras = self.cameras.clone();
        for (camera, global) in cameras.iter_mut().zip(&pose.cameras) {
            if let Some((eye, axes)) = FileCamera::view_axes(global) {
                (camera.eye, camera.axes) = (eye, axes);
            }
        }
        cameras
    }

    /// Returns the cameras of the file at a moment of one of its clips; without one, where they are at rest.
    pub(crate) fn cameras_at(&self, moment: Option<Moment>) -> Vec<FileCamera> {
        let pose = moment.zip(self.rig.as_ref()).map(|(moment, rig)| rig.pose(moment));
        pose.map_or_else(|| self.cameras.clone(), |pose| self.cameras_in(&pose))
    }

    /// Whether texture coordinates differ anywhere. Without any in the file, those of all corners are 0.
    pub(crate) fn has_texture_coordinates(&self) -> bool {
        self.corners.windows(2).any(|pair| pair[0].uv != pair[1].uv)
    }
}
