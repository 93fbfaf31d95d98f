//! Cameras that a file has besides its mesh.

use glam::{DMat4, DVec3, Vec3};

/// A camera of a file, as glTF 2.0 describes it (specification, section 3.10), where its node is.
#[derive(Clone, Debug, PartialEq)]
pub struct FileCamera {
    /// The name of its node, or else its own.
    pub name: String,
    /// In object units.
    pub eye: Vec3,
    /// Unit vectors to the right, up, and back towards the eye, which are perpendicular to each other.
    pub axes: [Vec3; 3],
    /// How it projects.
    pub projection: Projection,
}

impl FileCamera {
    /// The place and the axes of a camera on a node with this transform to object space, or none without a finite place and
    /// direction. Scales and mirrors have no part in them.
    pub fn view_axes(global: &DMat4) -> Option<(Vec3, [Vec3; 3])> {
        let back = global.transform_vector3(DVec3::Z).try_normalize()?;
        let right = global.transform_vector3(DVec3::Y).cross(back).try_normalize()?;
        let eye = global.w_axis.truncate().as_vec3();
        eye.is_finite().then(|| (eye, [right, back.cross(right), back].map(|axis| axis.as_vec3())))
    }
}

/// How a camera projects what it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// With a vertical field of view in radians (`yfov`).
    Perspective(f32),
    /// With half the height that it shows, in object units (`ymag`).
    Orthographic(f32),
}
