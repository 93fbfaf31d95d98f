//! The joints of skins, to be shown.

use glam::Vec3;

/// A joint of a skin that moves something of the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bone {
    /// In object units.
    pub place: Vec3,
    /// The nearest joint above it, as an index into the list of bones, where it comes first.
    pub parent: Option<u32>,
}
