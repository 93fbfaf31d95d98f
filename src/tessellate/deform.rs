//! Linear blend skinning: a corner's position, normal and tangent are transformed by the weighted mean of its joints' matrices.
//! Twin: `shaders/deform.wgsl`.

use glam::{Vec3, Vec4, vec3};

use super::normal::unit_or;
use crate::mesh::rig::JointMatrix;

/// Returns the weighted sum of four matrices. The weights add up to 1.
pub(super) fn blend(
    a: &JointMatrix,
    b: &JointMatrix,
    c: &JointMatrix,
    d: &JointMatrix,
    weights: [f32; 4],
) -> JointMatrix {
    let mean = |row: fn(&JointMatrix) -> [f32; 4]| {
        let [a, b, c, d] = [a, b, c, d].map(|matrix| glam::Vec4::from(row(matrix)));
        (a * weights[0] + b * weights[1] + c * weights[2] + d * weights[3]).to_array()
    };
    JointMatrix { x: mean(|matrix| matrix.x), y: mean(|matrix| matrix.y), z: mean(|matrix| matrix.z) }
}

/// Transforms a position.
pub(super) fn deform_position(matrix: &JointMatrix, position: Vec3) -> Vec3 {
    let [x, y, z] = matrix.rows().map(|row| Vec3::from_slice(&row).dot(position) + row[3]);
    vec3(x, y, z)
}

/// Transforms a unit normal by the cofactor matrix. If the result has no direction, returns `normal` itself.
///
/// The cofactor matrix is the inverse transpose times the determinant. Unlike the inverse it always exists.
pub(super) fn deform_normal(matrix: &JointMatrix, normal: Vec3) -> Vec3 {
    let [x, y, z] = scaled_rows(matrix);
    let turned = vec3(y.cross(z).dot(normal), z.cross(x).dot(normal), x.cross(y).dot(normal));
    scaled_unit_or(if x.dot(y.cross(z)) < 0.0 { -turned } else { turned }, normal)
}

/// Transforms a unit tangent, whose last component is the sign of the bitangent: a matrix that mirrors turns that around. If
/// the result has no direction, returns the tangent itself.
pub(super) fn deform_tangent(matrix: &JointMatrix, tangent: Vec4) -> Vec4 {
    let [x, y, z] = scaled_rows(matrix);
    let own = tangent.truncate();
    let turned = vec3(x.dot(own), y.dot(own), z.dot(own));
    let sign = if x.dot(y.cross(z)) < 0.0 { -tangent.w } else { tangent.w };
    scaled_unit_or(turned, own).extend(sign)
}

/// Returns the rows of the linear part, scaled so that no product of two entries overflows or underflows.
fn scaled_rows(matrix: &JointMatrix) -> [Vec3; 3] {
    let rows = matrix.rows().map(|row| Vec3::from_slice(&row));
    let scale = 1.0 / rows.map(largest_component).into_iter().fold(1e-30, f32::max);
    rows.map(|row| row * scale)
}

/// Returns `vector` at unit length, or `otherwise` if it is zero. No square overflows or underflows.
fn scaled_unit_or(vector: Vec3, otherwise: Vec3) -> Vec3 {
    unit_or(vector * (1.0 / largest_component(vector).max(1e-30)), otherwise)
}

/// Returns the largest absolute value of the components.
fn largest_component(vector: Vec3) -> f32 {
    vector.abs().max_element()
}
