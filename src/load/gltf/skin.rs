//! Reads skins: joints, and their matrices at rest.

use ::gltf::Skin;
use glam::{DMat4, Mat4};

use super::{Accessors, GltfError};
use crate::rig_builder::SkinJoints;

/// Reads the joints of a skin, which are nodes of the document.
///
/// # Errors
/// [`GltfError::Accessor`] if the inverse bind matrices can't be read, or are fewer than the joints.
pub(super) fn read(skin: &Skin, accessors: &Accessors) -> Result<SkinJoints, GltfError> {
    let nodes: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
    let role = format!("inverse bind matrices of skin {}", skin.index());
    let inverse_binds = match skin.inverse_bind_matrices() {
        None => vec![DMat4::IDENTITY; nodes.len()],
        Some(accessor) => {
            let matrices = accessors.numbers::<16>(&accessor, &role)?;
            if matrices.len() < nodes.len() {
                let reason = format!("has {} matrices for {} joints", matrices.len(), nodes.len());
                return Err(GltfError::Accessor { accessor: accessor.index(), role, reason });
            }
            matrices.iter().map(|matrix| Mat4::from_cols_array(matrix).as_dmat4()).collect()
        }
    };
    Ok(SkinJoints { nodes, inverse_binds, place: DMat4::IDENTITY })
}
