//! The size and position of a mesh.

use glam::Vec3;

use super::Mesh;

/// An axis-aligned bounding box, in object units, and the radius of a sphere around its centre that contains all
/// corners.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// The least coordinates, in object units.
    pub min: Vec3,
    /// The greatest coordinates, in object units.
    pub max: Vec3,
    radius: f32,
}

impl Bounds {
    /// Returns the bounds of some positions, or all zeros if there are none.
    pub fn of(positions: impl Iterator<Item = Vec3> + Clone) -> Self {
        let around = |(min, max): (Vec3, Vec3), p: Vec3| (min.min(p), max.max(p));
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (min, max) = positions.clone().fold(start, around);
        if !min.is_finite() {
            return Self::default();
        }
        let center = min * 0.5 + max * 0.5;
        // In f64, since the squares of very small or large lengths leave f32.
        let square = positions.map(|p| p.as_dvec3().distance_squared(center.as_dvec3())).fold(0.0, f64::max);
        Self { min, max, radius: square.sqrt() as f32 }
    }

    /// Returns the centre of the box.
    pub fn center(&self) -> Vec3 {
        // Each term is halved first: the sum of two large coordinates could overflow.
        self.min * 0.5 + self.max * 0.5
    }

    /// Returns the length of the box's diagonal.
    pub fn diagonal(&self) -> f32 {
        self.min.as_dvec3().distance(self.max.as_dvec3()) as f32
    }

    /// Returns bounds that hold everything in these after it has moved by up to `by` object units.
    pub fn grown(&self, by: f32) -> Self {
        Self { min: self.min - by, max: self.max + by, radius: self.radius + by }
    }

    /// Returns whether all coordinates are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Returns a length relative to the diagonal, in object units. The result is an f64, since the diagonal itself may
    /// leave f32.
    pub(super) fn part(&self, relative: f64) -> f64 {
        relative * self.min.as_dvec3().distance(self.max.as_dvec3())
    }

    /// Returns the greatest distance of a corner from [`center`](Self::center): at most half of the diagonal, often
    /// less.
    pub fn radius(&self) -> f32 {
        self.radius
    }
}

impl Mesh {
    /// Returns the bounds of all corners, or all zeros for an empty mesh.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.corners.iter().map(|corner| corner.position))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_octahedron_fills_less_than_its_box() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let bounds = Bounds::of(axes.iter().flat_map(|&a| [a + Vec3::ONE, Vec3::ONE - a]));
        assert_eq!(bounds.center(), Vec3::ONE);
        assert_eq!(bounds.radius(), 1.0);
        assert_eq!(bounds.diagonal(), 12_f32.sqrt());
    }

    #[test]
    fn tiny_and_huge_meshes_have_a_size() {
        for scale in [1e-25, 1e20] {
            let bounds = Bounds::of([Vec3::ZERO, Vec3::X * scale].into_iter());
            assert!((bounds.diagonal() / scale - 1.0).abs() < 1e-6 && (bounds.radius() / scale - 0.5).abs() < 1e-6);
        }
    }

    #[test]
    fn a_part_of_the_largest_diagonal_is_finite() {
        let part = Bounds::of([Vec3::MAX, Vec3::MIN].into_iter()).part(1e-5);
        assert!((part / (2e-5 * 3_f64.sqrt() * f64::from(f32::MAX)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_has_no_size() {
        assert_eq!(Mesh::default().bounds(), Bounds::default());
    }
}
