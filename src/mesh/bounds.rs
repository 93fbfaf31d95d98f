//! Where a mesh lies.

use glam::Vec3;

use super::Mesh;

/// An axis-aligned box, in object units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    pub min: Vec3,
    pub max: Vec3,
}

impl Bounds {
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Length from corner to corner.
    pub fn diagonal(&self) -> f32 {
        (self.max - self.min).length()
    }

    /// Radius of the sphere around the box.
    pub fn radius(&self) -> f32 {
        0.5 * self.diagonal()
    }
}

impl Mesh {
    /// The box around all corners; at the origin if there are none.
    pub fn bounds(&self) -> Bounds {
        let mut positions = self.corners.iter().map(|corner| corner.position);
        let Some(first) = positions.next() else { return Bounds::default() };
        positions.fold(Bounds { min: first, max: first }, |b, p| Bounds { min: b.min.min(p), max: b.max.max(p) })
    }
}
