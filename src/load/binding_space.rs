//! Transforms vertices into the space that the matrices of their joints start from.

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4, Vec3, Vec4};

use geometry::mesh::CornerDetail;
use geometry::mesh::normals::GivenNormal;
use geometry::mesh::rig::{Binding, Delta, Pose};

/// The transform from a mesh's own space to that of the animated node that it is attached to.
pub(super) struct BindingSpace {
    matrix: DMat4,
    linear: DMat3,
    /// The matrix for normals; no entry is larger than 1.
    cofactors: DMat3,
}

impl BindingSpace {
    pub(super) fn new(matrix: DMat4) -> Self {
        let linear = DMat3::from_mat4(matrix);
        let cofactors = cofactors(&linear);
        let largest = cofactors.to_cols_array().iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let scale = if largest > 0.0 && largest.is_finite() { 1.0 / largest } else { 1.0 };
        Self { matrix, linear, cofactors: cofactors * scale }
    }

    /// Transforms a vertex, and its displacements by morph targets. The normal is scaled to unit length if it has a
    /// direction, and its displacements by the same factor.
    pub(super) fn take(&self, position: Vec3, normal: Vec3, deltas: &mut [Delta]) -> ([f32; 3], [f32; 3]) {
        let is_there = self.matrix == DMat4::IDENTITY;
        let turned = if is_there { normal.as_dvec3() } else { self.cofactors * normal.as_dvec3() };
        let length = turned.length();
        let has_direction = length > 0.0 && length.is_finite();
        let is_unit = is_there && (length - 1.0).abs() < 1e-6;
        let scale = if has_direction && !is_unit { 1.0 / length } else { 1.0 };
        for delta in deltas {
            let [position, normal] = [delta.position, delta.normal].map(|v| Vec3::from(v).as_dvec3());
            delta.position = finite(self.linear * position);
            delta.normal = finite(if is_there { normal } else { self.cofactors * normal } * scale);
        }
        let position = if is_there { position } else { self.matrix.transform_point3(position.as_dvec3()).as_vec3() };
        (position.to_array(), finite(turned * scale))
    }

    /// Transforms a tangent, and its displacements by morph targets. The tangent is scaled to unit length, and its displacements
    /// by the same factor. Returns none if the result has no direction.
    pub(super) fn take_tangent(&self, tangent: Vec3, displacements: &mut [[f32; 3]]) -> Option<[f32; 3]> {
        let turned = self.linear * tangent.as_dvec3();
        let scale = 1.0 / turned.length();
        if !scale.is_finite() {
            return None;
        }
        for displacement in displacements {
            *displacement = finite(self.linear * Vec3::from(*displacement).as_dvec3() * scale);
        }
        Some(finite(turned * scale))
    }
}

/// Returns the inverse transpose of a linear map, times its determinant without a sign: that exists even where the inverse doesn't.
fn cofactors(linear: &DMat3) -> DMat3 {
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}

/// Transforms a normal by the inverse transpose of a linear map, and normalises it; returns none if the result has no
/// direction.
pub(super) fn turned(normal: Vec3, linear: &DMat3) -> Option<Vec3> {
    let normal = GivenNormal::new(normal).unit()?;
    if *linear == DMat3::IDENTITY {
        return Some(normal);
    }
    (cofactors(linear) * normal.as_dvec3()).try_normalize().map(DVec3::as_vec3)
}

/// Returns zero for a vector that doesn't fit f32.
fn finite(vector: DVec3) -> [f32; 3] {
    let vector = vector.as_vec3();
    if vector.is_finite() { vector.to_array() } else { [0.0; 3] }
}

/// Returns the tangent of a binding, and the sign of its bitangent, that become those of `detail` in a pose. Where the blended
/// matrix has no inverse, the tangent is that of the pose. `deltas` are those of the rig.
pub(super) fn unturned(binding: &Binding, deltas: &[Delta], pose: &Pose, detail: &CornerDetail) -> [f32; 4] {
    let [x, y, z] = blended(binding, pose).map(DVec4::truncate);
    let linear = DMat3::from_cols(x, y, z).transpose();
    let determinant = linear.determinant();
    let own = (linear.inverse() * detail.tangent.as_dvec3()).try_normalize().map(DVec3::as_vec3);
    let tangent = own.filter(|_| determinant != 0.0).unwrap_or(detail.tangent);
    let tangent = unmorphed(tangent, binding, deltas, pose);
    let sign = if determinant < 0.0 { -detail.bitangent_sign } else { detail.bitangent_sign };
    tangent.extend(sign).to_array()
}

/// Returns the tangent that morph targets turn to `tangent` in a pose, along with the normal of the binding.
fn unmorphed(tangent: Vec3, binding: &Binding, deltas: &[Delta], pose: &Pose) -> Vec3 {
    let own = Vec3::from(binding.normal).as_dvec3();
    let mut morphed = own;
    for delta in &deltas[binding.first_delta as usize..][..binding.delta_count as usize] {
        morphed += Vec3::from(delta.normal).as_dvec3() * f64::from(pose.weights[delta.weight as usize]);
    }
    let (Some(own), Some(morphed)) = (own.try_normalize(), morphed.try_normalize()) else { return tangent };
    if morphed == own {
        return tangent;
    }
    (DQuat::from_rotation_arc(morphed, own) * tangent.as_dvec3()).as_vec3()
}

/// Returns the position of a binding in a pose. `deltas` are those of the rig.
pub(super) fn posed(binding: &Binding, deltas: &[Delta], pose: &Pose) -> Vec3 {
    let mut position = Vec3::from(binding.position).as_dvec3();
    for delta in &deltas[binding.first_delta as usize..][..binding.delta_count as usize] {
        position += Vec3::from(delta.position).as_dvec3() * f64::from(pose.weights[delta.weight as usize]);
    }
    let rows = blended(binding, pose);
    DVec3::from_array(rows.map(|row| row.dot(position.extend(1.0)))).as_vec3()
}

/// Returns the rows of a binding's blended matrix in a pose.
fn blended(binding: &Binding, pose: &Pose) -> [DVec4; 3] {
    let mut rows = [DVec4::ZERO; 3];
    for (&joint, &weight) in binding.joints.iter().zip(&binding.weights) {
        for (sum, row) in rows.iter_mut().zip(pose.palette[joint as usize].rows()) {
            *sum += Vec4::from(row).as_dvec4() * f64::from(weight);
        }
    }
    rows
}

/// Returns the normal of a binding that becomes `normal` in a pose: the transpose of its blended matrix times `normal`.
pub(super) fn untwisted(binding: &Binding, pose: &Pose, normal: Vec3) -> Vec3 {
    let rows = blended(binding, pose).into_iter().zip(normal.to_array());
    let sum: DVec3 = rows.map(|(row, x)| row.truncate() * f64::from(x)).sum();
    sum.try_normalize().map_or(normal, DVec3::as_vec3)
}
