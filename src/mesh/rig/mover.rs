//! Nodes that clips move.

use glam::{DMat4, DQuat, DVec3};

use super::clip::{Channel, Property, unit};

/// A node that a clip moves. Nodes that none does are folded into `between`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// The nearest node above it that a clip moves, an index that is lower than its own.
    pub parent: Option<u32>,
    /// From where this node is placed to the parent's own space; to the scene's without one.
    pub between: DMat4,
    pub rest: Placement,
    /// Whether it moves a joint of a skin, itself or one below it.
    pub is_joint: bool,
}

/// A node's own transform, in parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    pub translation: DVec3,
    /// Of any length.
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl Default for Placement {
    fn default() -> Self {
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
    }
}

impl Placement {
    pub fn matrix(&self) -> DMat4 {
        DMat4::from_scale_rotation_translation(self.scale, unit(self.rotation), self.translation)
    }

    /// Replaces the part that the channel is for.
    pub(super) fn animate(&mut self, channel: &Channel, time: f64) {
        match channel.property {
            Property::Translation => {
                let value = &mut self.translation;
                channel.keys.sample(time, |i, x| value[i] = x);
            }
            Property::Scale => {
                let value = &mut self.scale;
                channel.keys.sample(time, |i, x| value[i] = x);
            }
            Property::Rotation => self.rotation = channel.keys.rotation(time),
            Property::Weights => {}
        }
    }
}
