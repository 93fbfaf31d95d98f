//! Geometry: triangles with corners ([`Mesh`]); and the points, edges and sides that they meet in ([`Topology`]).

#![cfg_attr(not(test), warn(clippy::cast_possible_truncation))]

pub mod adjacency;
mod alike_corners;
pub mod bounds;
pub mod build_limits;
mod cell_chains;
pub mod chunked_vec;
pub mod corner_details;
pub mod crease_band;
pub mod curves;
pub mod detail_table;
mod dominance;
mod file_camera;
pub(crate) mod generate_normals;
pub mod heights;
mod light;
pub mod material;
pub mod mesh_builder;
pub mod mipmap;
mod near_points;
pub mod normal_faults;
pub mod normals;
pub mod orientation;
mod part_style;
pub mod polygon;
pub mod repairs;
pub mod rig;
mod sampling;
pub mod shapes;
mod slices;
mod smooth_points;
pub mod subdivision;
pub mod t_junctions;
pub mod topology;
mod unfinished_mesh;
pub mod union_find;
pub mod weld;
pub mod weld_preview;

use std::ops::Range;
use std::sync::Arc;

use glam::{Vec2, Vec3};

pub use bounds::Bounds;
pub use corner_details::{CornerDetail, CornerDetails};
pub use file_camera::{FileCamera, Projection};
pub use heights::{HeightAmount, HeightMap, Heights};
pub use light::{Light, LightKind, MOST_LIGHTS};
pub use material::{Alpha, Look, Map, MapUv, Material, Slot, Texture};
pub use repairs::Repairs;
pub use rig::clip::Clip;
pub use rig::{Bone, Moment, Pose, Rig};
pub use sampling::{Sampling, Wrap};
pub use slices::{MeshSlices, SliceError};
pub use topology::{Edge, EdgeCounts, EdgeKind, Patch, Side, Topology};

pub use build_limits::{Borrowed, Budget, BuildError, MemoryRefused, borrowing};
pub use crease_band::{CreaseBand, with_crease_band};
pub use curves::{Curve, CurveItems, Curves, Sharing};
pub use dominance::Dominance;
pub use heights::{HEIGHTS_ACROSS, MAX_MAPS, PatchRelief, RELIEF_STEPS, Relief, patch_reliefs};
pub use normal_faults::NormalFaults;
pub use orientation::UpAxis;
pub use part_style::{CurveStyle, PartStyle, StylesUsed};
pub use shapes::Shape;
pub use t_junctions::{TJunction, t_junctions};
pub use weld_preview::{WeldPreview, weld_previews};

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
    /// Which triangles are whose part of the file, in their order. Triangles that belong to no part are in none of these.
    pub part_ranges: Vec<PartRange>,
    /// What each of the file's parts has in place of what is said for all; empty if none has anything.
    pub part_styles: Vec<PartStyle>,
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
    /// The joints of its skins.
    pub bones: Vec<Bone>,
}

/// Triangles of a part of the file, one after the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartRange {
    pub triangles: Range<u32>,
    /// An index into the file's list of parts.
    pub part: u32,
}

impl Mesh {
    /// The part of the file that a triangle belongs to: an index into the file's list of parts.
    pub fn part_of(&self, triangle: u32) -> Option<u32> {
        let after = self.part_ranges.partition_point(|range| range.triangles.start <= triangle);
        let range = &self.part_ranges[after.checked_sub(1)?];
        range.triangles.contains(&triangle).then_some(range.part)
    }

    /// The box around triangles; none if there are none.
    pub fn bounds_of(&self, triangles: impl Iterator<Item = u32> + Clone) -> Option<Bounds> {
        let corners = triangles.flat_map(|triangle| self.triangles[triangle as usize]);
        let positions = corners.map(|corner| self.corners[corner as usize].position);
        positions.clone().next().map(|_| Bounds::new(positions))
    }

    /// The size in memory, in bytes. A texture or a height image that materials share counts once.
    pub fn bytes(&self) -> u64 {
        let of_material = |material: &Material| {
            let maps = material.look.maps.clone().into_iter().flatten().map(|map| map.texture);
            material.texture.clone().into_iter().chain(maps)
        };
        let mut textures: Vec<_> = self.materials.iter().flat_map(of_material).collect();
        textures.sort_unstable_by_key(Arc::as_ptr);
        textures.dedup_by_key(|texture| Arc::as_ptr(texture));
        let textures: usize = textures.iter().map(|texture| texture.rgba.capacity()).sum();
        let materials: usize =
            self.materials.iter().map(|material| size_of::<Material>() + material.name.capacity()).sum();
        let heights = heights::bytes_of_maps(self.materials.iter().filter_map(|material| material.height.as_ref()));
        let rig = self.rig.as_ref().map_or(0, |rig| rig.bytes());
        let [corners, triangles] = [self.corners.capacity() * 32, self.triangles.capacity() * 12];
        let details = self.details.as_ref().map_or(0, |details| size_of_val(&details[..]));
        let parts = self.part_ranges.capacity() * size_of::<PartRange>() + size_of_val(&self.bones[..]);
        let names: usize = self.bones.iter().map(|bone| bone.name.len()).sum();
        (corners + triangles + parts + names + textures + materials + rig + details) as u64 + heights
    }

    /// Returns the lights of the file in a pose. One without a finite place there stays where it is at rest.
    pub fn lights_in(&self, pose: &Pose) -> Vec<Light> {
        let mut lights = self.lights.clone();
        for (light, global) in lights.iter_mut().zip(&pose.lights) {
            *light = light.at(global).unwrap_or(*light);
        }
        lights
    }

    /// Returns the cameras of the file in a pose. One without a finite place and direction there stays where it is at rest.
    pub fn cameras_in(&self, pose: &Pose) -> Vec<FileCamera> {
        let mut cameras = self.cameras.clone();
        for (camera, global) in cameras.iter_mut().zip(&pose.cameras) {
            if let Some((eye, axes)) = FileCamera::view_axes(global) {
                (camera.eye, camera.axes) = (eye, axes);
            }
        }
        cameras
    }

    /// Returns the bones where they are in a pose, or at rest, in object space.
    pub fn bones_in(&self, pose: Option<&Pose>) -> Vec<Bone> {
        let rest = self.rig.as_ref().filter(|_| pose.is_none()).map(|rig| rig.rest());
        let nodes = pose.or(rest.as_ref()).map_or(&[][..], |pose| &pose.nodes);
        let placed = |bone: &Bone| match bone.node.and_then(|node| nodes.get(node as usize)) {
            Some(global) => global.transform_point3(bone.place.as_dvec3()).as_vec3(),
            None => bone.place,
        };
        self.bones.iter().map(|bone| Bone { node: None, place: placed(bone), ..bone.clone() }).collect()
    }

    /// Returns the cameras of the file at a moment of one of its clips; without one, where they are at rest.
    pub fn cameras_at(&self, moment: Option<Moment>) -> Vec<FileCamera> {
        let pose = moment.zip(self.rig.as_ref()).map(|(moment, rig)| rig.pose(moment));
        pose.map_or_else(|| self.cameras.clone(), |pose| self.cameras_in(&pose))
    }

    /// Whether texture coordinates differ anywhere. Without any in the file, those of all corners are 0.
    pub fn has_texture_coordinates(&self) -> bool {
        self.corners.windows(2).any(|pair| pair[0].uv != pair[1].uv)
    }
}
