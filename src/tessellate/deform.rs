//! A corner's position and normal through the mean of its joints' matrices. Twin: `shaders/deform.wgsl`.

use glam::{Vec3, vec3};

use super::normal::unit_or;
use crate::mesh::rig::JointMatrix;

/// The mean of four matrices by weight.
pub fn blend(a: &JointMatrix, b: &JointMatrix, c: &JointMatrix, d: &JointMatrix, weights: [f32; 4]) -> JointMatrix {
    let mean = |row: fn(&JointMatrix) -> [f32; 4]| {
        let [a, b, c, d] = [a, b, c, d].map(|matrix| glam::Vec4::from(row(matrix)));
        (a * weights[0] + b * weights[1] + c * weights[2] + d * weights[3]).to_array()
    };
    JointMatrix { x: mean(|matrix| matrix.x), y: mean(|matrix| matrix.y), z: mean(|matrix| matrix.z) }
}

pub fn deform_position(matrix: &JointMatrix, position: Vec3) -> Vec3 {
    let [x, y, z] = matrix.rows().map(|row| Vec3::from_slice(&row).dot(position) + row[3]);
    vec3(x, y, z)
}

/// Through the cofactors, which are the inverse transpose times the determinant, and exist where the inverse doesn't. As
/// it was where that leaves no direction.
pub fn deform_normal(matrix: &JointMatrix, normal: Vec3) -> Vec3 {
    let rows = matrix.rows().map(|row| Vec3::from_slice(&row));
    // Scaled, so that no product of two entries leaves f32.
    let scale = 1.0 / rows.map(largest).into_iter().fold(1e-30, f32::max);
    let [x, y, z] = rows.map(|row| row * scale);
    let turned = vec3(y.cross(z).dot(normal), z.cross(x).dot(normal), x.cross(y).dot(normal));
    unit_of(if x.dot(y.cross(z)) < 0.0 { -turned } else { turned }, normal)
}

/// At unit length; `otherwise` where there is no direction.
fn unit_of(vector: Vec3, otherwise: Vec3) -> Vec3 {
    unit_or(vector * (1.0 / largest(vector).max(1e-30)), otherwise)
}

fn largest(vector: Vec3) -> f32 {
    vector.abs().max_element()
}
