//! Lights that a file has besides its mesh.

use glam::{DMat4, DVec3, Vec3};

/// The greatest number of lights of a mesh; `MOST_LIGHTS` in `shaders/punctual.wgsl`.
pub const MOST_LIGHTS: usize = 16;

/// A light of a file, as glTF's extension KHR_lights_punctual describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// What it shines from, and how far.
    pub kind: LightKind,
    /// Linear RGB: luminous intensity in cd; of a directional light, its illuminance in lx.
    pub intensity: Vec3,
    /// In object units, which count as metres.
    pub place: Vec3,
    /// The unit direction that it shines in.
    pub direction: Vec3,
}

impl Light {
    /// The same light on a node with this transform to object space; none at no finite place. A scale changes neither intensity nor
    /// range.
    pub fn at(self, global: &DMat4) -> Option<Self> {
        let direction = global.transform_vector3(DVec3::NEG_Z).try_normalize().unwrap_or(DVec3::NEG_Z).as_vec3();
        let place = global.w_axis.truncate().as_vec3();
        (place.is_finite() && direction.is_finite()).then_some(Self { place, direction, ..self })
    }
}

/// What a light shines from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Infinitely far away.
    Directional,
    /// A place, in all directions.
    Point {
        /// The distance at which it ends, in object units.
        range: Option<f32>,
    },
    /// A place, into a cone.
    Spot {
        /// The distance at which it ends, in object units.
        range: Option<f32>,
        /// The angle from its direction up to which it has its full intensity, in radians.
        inner: f32,
        /// The angle from which on there is no light, in radians.
        outer: f32,
    },
}
