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

/// Returns the number of a node's instances: that of the first attribute, or 1 without any.
pub(super) fn count(document: &Document, own: &InstancingExtension) -> usize {
    own.first().and_then(|first| document.accessors().nth(first)).map_or(1, |accessor| accessor.count())
}

/// Returns the transforms from each instance's own space to the node's. They stay in their buffers until they are asked for.
///
/// # Errors
/// [`GltfError::Accessor`] if the transforms can't be read, or aren't equally many.
pub(super) fn transforms<'a>(
    document: &Document,
    accessors: &'a Accessors,
    own: &InstancingExtension,
    node: usize,
) -> Result<impl Iterator<Item = DMat4> + use<'a>, GltfError> {
    let count = count(document, own);
    let role = |name: &str| format!("{name} of the instances of node {node}");
    let find = |index: Option<usize>| document.accessors().nth(index?);
    let translations = list::<3>(find(own.translation), role("TRANSLATION"), count, accessors)?;
    let rotations = list::<4>(find(own.rotation), role("ROTATION"), count, accessors)?;
    let scales = list::<3>(find(own.scale), role("SCALE"), count, accessors)?;
    Ok((0..count).map(move |i| {
        let vector = |list: &Option<List<[f32; 3]>>, default| list.as_ref().map_or(default, |list| list.get(i));
        let rotation = rotations.as_ref().map_or(Quat::IDENTITY, |list| Quat::from_array(list.get(i)));
        let placement = Placement {
            translation: Vec3::from(vector(&translations, [0.0; 3])).as_dvec3(),
            rotation: rotation.as_dquat(),
            scale: Vec3::from(vector(&scales, [1.0; 3])).as_dvec3(),
        };
        placement.matrix()
    }))
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
