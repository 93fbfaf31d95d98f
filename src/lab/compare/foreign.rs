//! A tessellated mesh that another program emitted: positions and triangles alone.

use glam::Vec3;
use half::f16;

use super::OurTessellation;
use super::our_mesh::is_thin;
use geometry::mesh::weld::weld;
use geometry::mesh::{Bounds, Mesh};

/// The triangles of another program, without regard to the order and the sharing of their vertices: vertices at equal positions
/// are one.
#[derive(Clone, Debug, Default)]
pub struct ForeignMesh {
    /// In object units, all finite and each once.
    pub positions: Vec<Vec3>,
    /// Indices into `positions`, three different ones each.
    pub triangles: Vec<[u32; 3]>,
    /// How many triangles were left out because two of their corners have the same position.
    pub degenerate: u64,
    /// How many triangles were left out because a coordinate isn't finite.
    pub not_finite: u64,
}

impl ForeignMesh {
    /// Collects triangles with these corners, which are indices into `positions`. Indices must be below their number.
    pub fn new(positions: &[Vec3], triangles: impl IntoIterator<Item = [u32; 3]>) -> Self {
        let mut made = Self::default();
        let (points, point_of) = weld(positions.len(), |vertex| positions[vertex]);
        // A vertex that no triangle uses says nothing about a tessellation.
        let mut numbers = vec![None; points.len()];
        for corners in triangles {
            let own = corners.map(|corner| point_of[corner as usize] as usize);
            if !own.iter().all(|point| points[*point].is_finite()) {
                made.not_finite += 1;
                continue;
            }
            let own = own.map(|point| {
                *numbers[point].get_or_insert_with(|| {
                    made.positions.push(points[point]);
                    made.positions.len() as u32 - 1
                })
            });
            if is_thin(own) {
                made.degenerate += 1;
            } else {
                made.triangles.push(own);
            }
        }
        made
    }

    /// Collects the triangles of a mesh that was read from a file.
    pub fn from_mesh(mesh: &Mesh) -> Self {
        let positions: Vec<Vec3> = mesh.corners.iter().map(|corner| corner.position).collect();
        Self::new(&positions, mesh.triangles.iter().copied())
    }

    pub fn bounds(&self) -> Bounds {
        Bounds::new(self.positions.iter().copied())
    }

    /// Half a unit in the last place of the largest coordinate as a number of 16 bits, as vertex buffers of engines often have them, in
    /// our object units. `None` if some coordinates have more bits, or if all of ours have as few.
    pub(super) fn resolution_of_halves(&self, ours: &OurTessellation) -> Option<f64> {
        let is_rounded = |position: &Vec3| position.to_array().into_iter().all(has_16_bits);
        let emitted = ours.emitted_positions();
        if !self.positions.iter().all(is_rounded) || emitted.iter().all(is_rounded) {
            return None;
        }
        let [own, bounds] = [Bounds::new(emitted.into_iter()), self.bounds()];
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let unit = f64::from(largest.max(f16::MIN_POSITIVE.to_f32())).log2().floor().exp2() / 1024.0;
        // Their units may be others than ours.
        let scale = f64::from(own.diagonal()) / f64::from(bounds.diagonal());
        Some(0.5 * unit * scale).filter(|resolution| resolution.is_finite())
    }

    /// Up to `most` of its vertices, spread evenly over the list.
    pub(super) fn sample(&self, most: usize) -> impl Iterator<Item = u32> + Clone + use<> {
        spread(self.positions.len(), most).map(|index| index as u32)
    }
}

/// Up to `most` of the numbers below `count`, spread evenly.
pub(super) fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> + Clone {
    let taken = count.min(most);
    (0..taken).map(move |index| index * count / taken)
}

/// Whether a number is one of 16 bits (IEEE 754-2019, binary16).
fn has_16_bits(number: f32) -> bool {
    number.is_finite() && f16::from_f32(number).to_f32() == number
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn vertices_at_one_place_are_one_and_useless_triangles_are_counted() {
        let positions =
            [Vec3::ZERO, Vec3::X, Vec3::Y, vec3(-0.0, 0.0, 0.0), vec3(f32::NAN, 0.0, 0.0), vec3(9.0, 9.0, 9.0)];
        let mesh = ForeignMesh::new(&positions, [[0, 1, 2], [3, 2, 1], [0, 3, 1], [0, 1, 4]]);
        assert_eq!(mesh.positions, positions[..3]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 1]]);
        assert_eq!((mesh.degenerate, mesh.not_finite), (1, 1));
    }

    #[test]
    fn a_sample_is_spread_over_all() {
        assert_eq!(spread(10, 5).collect::<Vec<_>>(), [0, 2, 4, 6, 8]);
        assert_eq!(spread(3, 5).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(spread(0, 5).count(), 0);
    }

    #[test]
    fn numbers_of_16_bits_are_told_from_others() {
        for number in [0.0, -0.0, 1.0, 0.333_251_95, -65504.0, 6.1035156e-5, 5.9604645e-8, 1.7881393e-7, 2049.0 - 1.0] {
            assert!(has_16_bits(number), "{number}");
        }
        for number in [0.333_333_34, 65505.0, 1e6, 5.9e-8, 9e-8, 2049.0, f32::INFINITY, f32::NAN] {
            assert!(!has_16_bits(number), "{number}");
        }
    }
}
