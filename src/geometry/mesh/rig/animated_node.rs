//! The nodes that clips move.

use glam::{DMat4, DQuat, DVec3};

use super::clip::{Channel, Property, unit};
use crate::defaults::with_defaults;

/// A node that a clip moves. The transforms of nodes that no clip moves are part of `between`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnimatedNode {
    /// The nearest ancestor that a clip moves. Its index is lower than this node's.
    pub parent: Option<u32>,
    /// The transform from the space that `rest` places this node in to the parent's own space, or to the scene's
    /// without a parent.
    pub between: DMat4,
    /// The node's own transform while no clip moves it.
    pub rest: Placement,
    /// Whether the node, or a node below it, is a joint of a skin.
    pub is_joint: bool,
}

with_defaults! {
    /// A node's own transform, as translation, rotation and scale.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Placement {
        pub translation: DVec3 = DVec3::ZERO,
        /// Not always of unit length.
        pub rotation: DQuat = DQuat::IDENTITY,
        pub scale: DVec3 = DVec3::ONE,
    }
}

impl Placement {
    pub fn matrix(&self) -> DMat4 {
        DMat4::from_scale_rotation_translation(self.scale, unit(self.rotation), self.translation)
    }

    /// Replaces the part of the transform that the channel moves by its value at a time, in s.
    pub(super) fn animate(&mut self, channel: &Channel, time: f64) {
        let vector = match channel.property {
            Property::Translation => &mut self.translation,
            Property::Scale => &mut self.scale,
            Property::Rotation => return self.rotation = channel.keys.rotation(time),
            Property::Weights => return,
        };
        channel.keys.sample(time, |i, x| vector[i] = x);
    }
}
