//! Skins: the joints' matrices at rest.

use ::gltf::Skin;
use glam::{DMat4, Mat4};

use super::{Accessors, Problem};

/// For each joint the matrix that takes a vertex from the mesh's bind pose to the scene: the joint's global transform
/// times its inverse bind matrix. The skinned node's own transform plays no part (specification, section 3.7.3).
///
/// # Errors
/// [`Problem::Accessor`] when the inverse bind matrices can't be read or are fewer than the joints.
pub fn joint_matrices(skin: &Skin, global: &[DMat4], accessors: &Accessors) -> Result<Vec<DMat4>, Problem> {
    let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
    let role = format!("inverse bind matrices of skin {}", skin.index());
    let inverse_binds = match skin.inverse_bind_matrices() {
        None => vec![DMat4::IDENTITY; joints.len()],
        Some(accessor) => {
            let matrices = accessors.numbers::<16>(&accessor, &role)?;
            if matrices.len() < joints.len() {
                let reason = format!("has {} matrices for {} joints", matrices.len(), joints.len());
                return Err(Problem::Accessor { accessor: accessor.index(), role, reason });
            }
            matrices.iter().map(|matrix| Mat4::from_cols_array(matrix).as_dmat4()).collect()
        }
    };
    let place = |&joint: &usize| global.get(joint).copied().unwrap_or(DMat4::IDENTITY);
    Ok(joints.iter().map(place).zip(inverse_binds).map(|(joint, inverse_bind)| joint * inverse_bind).collect())
}
