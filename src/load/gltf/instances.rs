//! Reads the instances of a node's mesh.
//!
//! Source: Khronos, `EXT_mesh_gpu_instancing`,
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_mesh_gpu_instancing>.

use ::gltf::{Accessor, Document};
use glam::{DMat4, Quat, Vec3};

use super::accessor::List;
use super::extensions::InstancingExtension;
use super::{Accessors, GltfError};
use geometry::mesh::rig::Placement;

/// The transforms of a node's instances. They stay in their buffers until they are read.
pub(super) struct Instances<'a> {
    count: usize,
    translations: Option<List<'a, [f32; 3]>>,
    rotations: Option<List<'a, [f32; 4]>>,
    scales: Option<List<'a, [f32; 3]>>,
}

/// Returns the number of a node's instances: that of the first attribute, or 1 without any.
pub(super) fn count(document: &Document, own: &InstancingExtension) -> usize {
    own.first().and_then(|first| document.accessors().nth(first)).map_or(1, |accessor| accessor.count())
}

impl<'a> Instances<'a> {
    /// # Errors
    /// [`GltfError::Accessor`] if the transforms can't be read, or aren't equally many.
    pub(super) fn read(
        document: &'a Document,
        accessors: &'a Accessors<'a>,
        own: &InstancingExtension,
        node: usize,
    ) -> Result<Self, GltfError> {
        let count = count(document, own);
        let role = |name: &str| format!("{name} of the instances of node {node}");
        let find = |index: Option<usize>| document.accessors().nth(index?);
        Ok(Self {
            count,
            translations: list(find(own.translation), role("TRANSLATION"), count, accessors)?,
            rotations: list(find(own.rotation), role("ROTATION"), count, accessors)?,
            scales: list(find(own.scale), role("SCALE"), count, accessors)?,
        })
    }

    /// Returns the transforms from each instance's own space to the node's.
    pub(super) fn transforms(&self) -> impl Iterator<Item = DMat4> {
        (0..self.count).map(|i| {
            let vector = |list: &Option<List<[f32; 3]>>, default| list.as_ref().map_or(default, |list| list.get(i));
            let rotation = self.rotations.as_ref();
            let placement = Placement {
                translation: Vec3::from(vector(&self.translations, [0.0; 3])).as_dvec3(),
                rotation: rotation.map_or(Quat::IDENTITY, |list| Quat::from_array(list.get(i))).as_dquat(),
                scale: Vec3::from(vector(&self.scales, [1.0; 3])).as_dvec3(),
            };
            placement.matrix()
        })
    }
}

fn list<'a, const N: usize>(
    accessor: Option<Accessor>,
    role: String,
    count: usize,
    accessors: &'a Accessors,
) -> Result<Option<List<'a, [f32; N]>>, GltfError> {
    let Some(accessor) = accessor else { return Ok(None) };
    accessors.check_count(&accessor, &role, count, "instances")?;
    accessors.list(&accessor, &role).map(Some)
}
