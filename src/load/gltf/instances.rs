//! Reads the instances of a node's mesh.
//!
//! Source: Khronos, `EXT_mesh_gpu_instancing`,
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_mesh_gpu_instancing>.

use ::gltf::Document;
use ::gltf::accessor::Accessor;
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
    let first = own.translation.or(own.rotation).or(own.scale);
    first.and_then(|first| document.accessors().nth(first)).map_or(1, |accessor| accessor.count())
}

impl<'a> Instances<'a> {
    /// # Errors
    /// [`GltfError::Accessor`] if the transforms can't be read, or aren't equally many.
    pub(super) fn read(
        document: &Document,
        accessors: &'a Accessors<'a>,
        own: &InstancingExtension,
        node: usize,
    ) -> Result<Self, GltfError> {
        let count = count(document, own);
        let role = |name: &str| format!("{name} of the instances of node {node}");
        let found = |index: Option<usize>, name: &str| -> Result<Option<Accessor<'_>>, GltfError> {
            let Some(accessor) = index.and_then(|index| document.accessors().nth(index)) else { return Ok(None) };
            accessors.check_sound(&accessor)?;
            if accessor.count() == count {
                return Ok(Some(accessor));
            }
            let reason = format!("has {} elements for {count} instances", accessor.count());
            Err(GltfError::Accessor { accessor: accessor.index(), role: role(name), reason })
        };
        let vectors = |index, name: &str| {
            found(index, name)?.map(|accessor| accessors.list::<3>(&accessor, &role(name))).transpose()
        };
        let translations = vectors(own.translation, "TRANSLATION")?;
        let rotations = found(own.rotation, "ROTATION")?;
        let rotations = rotations.map(|accessor| accessors.list::<4>(&accessor, &role("ROTATION"))).transpose()?;
        Ok(Self { count, translations, rotations, scales: vectors(own.scale, "SCALE")? })
    }

    /// Returns the transforms from each instance's own space to the node's.
    pub(super) fn transforms(&self) -> impl Iterator<Item = DMat4> {
        (0..self.count).map(|i| {
            let vector = |list: &Option<List<[f32; 3]>>, default| list.as_ref().map_or(default, |list| list.get(i));
            let placement = Placement {
                translation: Vec3::from(vector(&self.translations, [0.0; 3])).as_dvec3(),
                rotation: self
                    .rotations
                    .as_ref()
                    .map_or(Quat::IDENTITY, |list| Quat::from_array(list.get(i)))
                    .as_dquat(),
                scale: Vec3::from(vector(&self.scales, [1.0; 3])).as_dvec3(),
            };
            placement.matrix()
        })
    }
}
