//! Reads skins: joints, and their matrices at rest.

use ::gltf::Skin;
use glam::{DMat4, Mat4};

use super::{Accessors, GltfError};

/// The joints of a skin.
pub(super) struct Joints {
    /// Indices into the document's nodes.
    pub nodes: Vec<usize>,
    /// The transforms from the mesh's bind pose to each joint's own space.
    pub inverse_binds: Vec<DMat4>,
}

impl Joints {
    /// # Errors
    /// [`GltfError::Accessor`] if the inverse bind matrices can't be read, or are fewer than the joints.
    pub(super) fn read(skin: &Skin, accessors: &Accessors) -> Result<Self, GltfError> {
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
        Ok(Self { nodes, inverse_binds })
    }

    /// Returns, for each joint, the matrix that takes a vertex from the mesh's bind pose to the scene: the joint's
    /// global transform times its inverse bind matrix. The skinned node's own transform isn't used (specification,
    /// section 3.7.3).
    pub(super) fn matrices(&self, global: &[DMat4]) -> Vec<DMat4> {
        let place = |&joint: &usize| global.get(joint).copied().unwrap_or(DMat4::IDENTITY);
        self.nodes.iter().map(place).zip(&self.inverse_binds).map(|(joint, inverse)| joint * *inverse).collect()
    }
}
