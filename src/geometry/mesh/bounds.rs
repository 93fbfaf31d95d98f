//! The size and position of a mesh.

use std::ops::Range;

use glam::{DVec3, Vec3, Vec3A};

use super::Mesh;
use super::weld::plus_zero3;
use crate::casts::to_f32;
use crate::cores::in_ranges;

/// The least number of corners that are worth a thread.
const LEAST: usize = 1 << 16;

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
    pub fn new(positions: impl Iterator<Item = Vec3> + Clone) -> Self {
        Self::around(box_of(positions.clone()), |center| farthest_square(positions, center))
    }

    /// Returns the bounds with this box. `square` returns the greatest squared distance of a corner from its centre.
    fn around([min, max]: [Vec3; 2], square: impl FnOnce(DVec3) -> f64) -> Self {
        if !min.is_finite() {
            return Self::default();
        }
        // Which zero is the least depends on the order of the positions.
        let bounds = Self { min: plus_zero3(min), max: plus_zero3(max), radius: 0.0 };
        Self { radius: to_f32(square(bounds.center().as_dvec3()).sqrt()), ..bounds }
    }

    /// Returns the centre of the box.
    pub fn center(&self) -> Vec3 {
        // Each term is halved first: the sum of two large coordinates could overflow.
        self.min * 0.5 + self.max * 0.5
    }

    /// Returns the length of the box's diagonal.
    pub fn diagonal(&self) -> f32 {
        to_f32(self.min.as_dvec3().distance(self.max.as_dvec3()))
    }

    /// Returns bounds that hold everything in these after it has moved by up to `by` object units.
    pub fn grown(&self, by: f32) -> Self {
        Self { min: self.min - by, max: self.max + by, radius: self.radius + by }
    }

    /// Returns whether all coordinates are finite.
    pub fn is_finite(&self) -> bool {
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
        let positions = |range: Range<usize>| self.corners[range].iter().map(|corner| corner.position);
        let boxes = in_ranges(self.corners.len(), LEAST, |range| box_of(positions(range)));
        Bounds::around(box_of(boxes.into_iter().flatten()), |center| {
            let squares = in_ranges(self.corners.len(), LEAST, |range| farthest_square(positions(range), center));
            squares.into_iter().fold(0.0, f64::max)
        })
    }
}

/// Returns the least and the greatest coordinates of some positions; infinite ones if there are none.
fn box_of(positions: impl Iterator<Item = Vec3>) -> [Vec3; 2] {
    // In registers of four lanes, which takes less than half of the time.
    let infinite = [Vec3A::INFINITY, Vec3A::NEG_INFINITY];
    positions.map(Vec3A::from).fold(infinite, |[min, max], p| [min.min(p), max.max(p)]).map(Vec3::from)
}

/// Returns the greatest squared distance of some positions from a centre, in f64, since the squares of very small or large lengths
/// leave f32; 0 if there are none.
fn farthest_square(positions: impl Iterator<Item = Vec3>, center: DVec3) -> f64 {
    // `f64::max` would look for NaN each time.
    let greater = |a: f64, b: f64| if b > a { b } else { a };
    positions.map(|position| position.as_dvec3().distance_squared(center)).fold(0.0, greater)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::cores::on_threads;
    use crate::mesh::Corner;

    #[test]
    fn an_octahedron_fills_less_than_its_box() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let bounds = Bounds::new(axes.iter().flat_map(|&a| [a + Vec3::ONE, Vec3::ONE - a]));
        assert_eq!(bounds.center(), Vec3::ONE);
        assert_eq!(bounds.radius(), 1.0);
        assert_eq!(bounds.diagonal(), 12_f32.sqrt());
    }

    #[test]
    fn tiny_and_huge_meshes_have_a_size() {
        for scale in [1e-25, 1e20] {
            let bounds = Bounds::new([Vec3::ZERO, Vec3::X * scale].into_iter());
            assert!((bounds.diagonal() / scale - 1.0).abs() < 1e-6 && (bounds.radius() / scale - 0.5).abs() < 1e-6);
        }
    }

    #[test]
    fn a_part_of_the_largest_diagonal_is_finite() {
        let part = Bounds::new([Vec3::MAX, Vec3::MIN].into_iter()).part(1e-5);
        assert!((part / (2e-5 * 3_f64.sqrt() * f64::from(f32::MAX)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_number_of_cores_makes_no_difference() {
        let zeros = [-0.0, 0.0, 0.0, -0.0, 0.0, 0.0, -0.0];
        for offset in 0..zeros.len() {
            let corner = |i: usize| Corner {
                position: Vec3::new((i * i % 1009) as f32, zeros[(i + offset) % zeros.len()], -(i as f32)),
                normal: Vec3::Z,
                uv: Vec2::ZERO,
            };
            let mesh = Mesh { corners: (0..4 * LEAST).map(corner).collect(), ..Mesh::default() };
            let bits = |bounds: Bounds| [bounds.min, bounds.max].map(|v| v.to_array().map(f32::to_bits));
            let alone = Bounds::new(mesh.corners.iter().map(|corner| corner.position));
            for cores in [1, 2, 3] {
                let bounds = on_threads(cores, || mesh.bounds()).expect("threads");
                assert!(bounds == alone && bits(bounds) == bits(alone), "{bounds:?} on {cores} cores, {alone:?}");
            }
        }
    }

    #[test]
    fn bounds_grow_on_every_side() {
        let bounds = Bounds::new([Vec3::ZERO, Vec3::X * 2.0].into_iter()).grown(0.5);
        assert_eq!((bounds.min, bounds.max), (Vec3::splat(-0.5), Vec3::new(2.5, 0.5, 0.5)));
        assert_eq!(bounds.radius(), 1.5);
    }

    #[test]
    fn nothing_has_no_size() {
        assert_eq!(Mesh::default().bounds(), Bounds::default());
    }
}
