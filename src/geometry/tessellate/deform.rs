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

/// Turns a vector by the least rotation that takes one unit vector to another (Möller and Hughes 1999, "Efficiently building a matrix
/// to rotate one vector to another"). Returns the vector itself if the two are opposite.
pub(super) fn turn_along(vector: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let (axis, cosine) = (from.cross(to), from.dot(to));
    if 1.0 + cosine < 1e-6 {
        return vector;
    }
    let across = axis.cross(vector);
    vector + across + axis.cross(across) * (1.0 / (1.0 + cosine))
}

/// Returns the rows of the linear part, scaled so that no product of two entries overflows or underflows.
fn scaled_rows(matrix: &JointMatrix) -> [Vec3; 3] {
    let rows = matrix.rows().map(|row| Vec3::from_slice(&row));
    let scale = 1.0 / rows.map(largest_component).into_iter().fold(1e-30, f32::max);
    rows.map(|row| row * scale)
}

/// Returns `vector` at unit length, or `otherwise` if it is zero. No square overflows or underflows.
pub(super) fn scaled_unit_or(vector: Vec3, otherwise: Vec3) -> Vec3 {
    unit_or(vector * (1.0 / largest_component(vector).max(1e-30)), otherwise)
}

/// Returns the largest absolute value of the components.
fn largest_component(vector: Vec3) -> f32 {
    vector.abs().max_element()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_vector_turns_along_with_another(own in [-1f32..1.0, -1f32..1.0, -1f32..1.0], a in [-1f32..1.0, -1f32..1.0, -1f32..1.0],
            b in [-1f32..1.0, -1f32..1.0, -1f32..1.0]) {
            let [own, a, b] = [own, a, b].map(Vec3::from);
            let (Some(a), Some(b)) = (a.try_normalize(), b.try_normalize()) else { return Ok(()) };
            if a.dot(b) < -0.99 {
                return Ok(());
            }
            prop_assert!(turn_along(a, a, b).distance(b) < 1e-4);
            let turned = turn_along(own, a, b);
            prop_assert!((turned.length() - own.length()).abs() < 1e-4);
            prop_assert!((turned.dot(b) - own.dot(a)).abs() < 1e-4);
            // What both are perpendicular to is the axis.
            prop_assert!((turned.dot(a.cross(b)) - own.dot(a.cross(b))).abs() < 1e-4);
        }
    }

    #[test]
    fn nothing_turns_without_a_rotation() {
        assert_eq!(turn_along(Vec3::X, Vec3::Z, Vec3::Z), Vec3::X);
        assert_eq!(turn_along(Vec3::X, Vec3::Z, Vec3::NEG_Z), Vec3::X);
        assert_eq!(turn_along(Vec3::X, Vec3::ZERO, Vec3::ZERO), Vec3::X);
    }
}
