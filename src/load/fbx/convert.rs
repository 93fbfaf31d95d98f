//! ufbx's vectors and matrices as those of glam.

use glam::{DMat4, DQuat, DVec2, DVec3, DVec4};

use geometry::mesh::rig::Placement;

pub(super) fn vec2(v: &ufbx::Vec2) -> DVec2 {
    DVec2::new(v.x, v.y)
}

pub(super) fn vec3(v: &ufbx::Vec3) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

pub(super) fn vec4(v: &ufbx::Vec4) -> DVec4 {
    DVec4::new(v.x, v.y, v.z, v.w)
}

pub(super) fn quaternion(q: &ufbx::Quat) -> DQuat {
    DQuat::from_xyzw(q.x, q.y, q.z, q.w)
}

/// Returns what a list has for a corner of a mesh; none if an index leads nowhere.
pub(super) fn at_corner<'a, T>(values: &'a [T], indices: &[u32], corner: usize) -> Option<&'a T> {
    indices.get(corner).and_then(|&index| values.get(index as usize))
}

/// The matrix's fourth row is (0, 0, 0, 1).
pub(super) fn matrix(m: &ufbx::Matrix) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(m.m00, m.m10, m.m20, 0.0),
        DVec4::new(m.m01, m.m11, m.m21, 0.0),
        DVec4::new(m.m02, m.m12, m.m22, 0.0),
        DVec4::new(m.m03, m.m13, m.m23, 1.0),
    )
}

pub(super) fn placement(transform: &ufbx::Transform) -> Placement {
    Placement {
        translation: vec3(&transform.translation),
        rotation: quaternion(&transform.rotation),
        scale: vec3(&transform.scale),
    }
}
