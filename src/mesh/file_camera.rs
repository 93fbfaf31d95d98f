//! Cameras that a file has besides its mesh.

use glam::Vec3;

/// A camera of a file, as glTF 2.0 describes it (specification, section 3.10), where its node is at rest.
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

/// How a camera projects what it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// With a vertical field of view in radians (`yfov`).
    Perspective(f32),
    /// With half the height that it shows, in object units (`ymag`).
    Orthographic(f32),
}
