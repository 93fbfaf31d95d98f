//! Dominance: which side of an edge, and which corner on a point, all patches around it use where texture coordinates
//! differ (McDonald 2011, *Tessellation on Any Budget*: dominant edges and dominant vertices). Also the weights of the
//! corners on a point in the direction in which the point is displaced.

use super::{Curves, Topology};
use crate::casts::to_u32;
use crate::groups::group_starts;

/// The dominant sides and corners, and lists of each point's corners and factors.
#[derive(Clone, Debug, Default)]
pub struct Dominance {
    /// For each factor of [`Curves`], the dominant side of its edge: 4 * patch + k for the patch's side k.
    pub sides: Vec<u32>,
    /// For each point, its dominant corner: 4 * patch + k for corner k of some patch around the point.
    pub corners: Vec<u32>,
    /// The corners on point p and their weights are `parts[part_starts[p]..part_starts[p + 1]]`. A corner's weight is
    /// the sum of the angles, in radians, of its triangles there, so that it doesn't depend on how faces are
    /// triangulated. It is never 0.
    pub part_starts: Vec<u32>,
    pub parts: Vec<(u32, f32)>,
    /// The factors of the edges at point p are `factors[factor_starts[p]..factor_starts[p + 1]]`.
    pub factor_starts: Vec<u32>,
    pub factors: Vec<u32>,
    /// For each patch, the factors of its sides 0, 1 and 2.
    pub patch_factors: Vec<[u32; 3]>,
}

impl Dominance {
    /// Finds dominant sides and corners. `angles` are those of [`super::Heights`]. Takes about n log n steps.
    pub fn new(topology: &Topology, curves: &Curves, angles: &[f32]) -> Self {
        let mut dominance = Self { sides: sides(topology, curves), ..Self::default() };
        let of_sides = |patch: &super::Patch| patch.sides.map(|side| curves.factor(topology, side));
        dominance.patch_factors = topology.patches.iter().map(of_sides).collect();
        let mut corners = vec![u32::MAX; topology.points.len()];
        let mut parts: Vec<(u32, u32)> = Vec::with_capacity(3 * topology.patches.len());
        let mut factors: Vec<(u32, u32)> = Vec::with_capacity(6 * topology.patches.len());
        for (index, patch) in (0..).zip(&topology.patches) {
            for k in 0..3 {
                let corner = topology.corners(patch)[k];
                let point = topology.corner_points[corner as usize];
                let known = &mut corners[point as usize];
                *known = (*known).min(index * 4 + to_u32(k));
                parts.push((point, corner));
                let own = dominance.patch_factors[index as usize];
                factors.extend([(point, own[k]), (point, own[(k + 2) % 3])]);
            }
        }
        // Points that only degenerate triangles use have no dominant corner, and none is ever read.
        dominance.corners = corners.into_iter().map(|corner| if corner == u32::MAX { 0 } else { corner }).collect();
        parts.sort_unstable();
        parts.dedup();
        let part =
            |&(_, corner): &(u32, u32)| (corner, angles.get(corner as usize).map_or(1e-6, |angle| angle.max(1e-6)));
        dominance.parts = parts.iter().map(part).collect();
        dominance.part_starts = group_starts(topology.points.len(), parts.iter().map(|part| part.0));
        factors.sort_unstable();
        factors.dedup();
        dominance.factor_starts = group_starts(topology.points.len(), factors.iter().map(|factor| factor.0));
        dominance.factors = factors.into_iter().map(|(_, factor)| factor).collect();
        dominance
    }
}

/// Returns the dominant side for each factor: the first side of its edge.
fn sides(topology: &Topology, curves: &Curves) -> Vec<u32> {
    let mut sides = vec![0; curves.factor_count() as usize];
    for (index, side) in (0..).zip(&topology.sides) {
        let first = &topology.sides[topology.edges[side.edge as usize].first_side as usize];
        sides[curves.factor(topology, index) as usize] = first.patch() * 4 + to_u32(first.index());
    }
    sides
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{HeightMap, Heights, Shape, Sharing};
    use crate::progress::Progress;

    fn dominance(shape: Shape, sharing: Sharing) -> (Topology, Curves, Dominance) {
        let mesh = shape.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("not cancelled");
        let curves = Curves::build(&mesh, &topology, sharing);
        let heights = Heights::everywhere(&mesh, HeightMap::new([1, 1], vec![0.0]));
        let dominance = Dominance::new(&topology, &curves, &heights.angles);
        (topology, curves, dominance)
    }

    #[test]
    fn each_edge_has_a_dominant_side_and_each_point_a_dominant_corner() {
        for shape in Shape::ALL {
            for sharing in [Sharing::AllSides, Sharing::EqualNormals, Sharing::None] {
                let (topology, curves, dominance) = dominance(shape, sharing);
                for (index, side) in (0..).zip(&topology.sides) {
                    let dominant = dominance.sides[curves.factor(&topology, index) as usize];
                    let other = topology.patches[dominant as usize / 4].sides[dominant as usize % 4];
                    assert_eq!(topology.sides[other as usize].edge, side.edge, "{shape:?} {sharing:?}");
                }
                for (point, &dominant) in (0..).zip(&dominance.corners) {
                    let corner = topology.patch_corners(dominant / 4)[dominant as usize % 4];
                    assert_eq!(topology.corner_points[corner as usize], point, "{shape:?}");
                }
            }
        }
    }

    #[test]
    fn every_point_has_its_corners_angles_and_edges() {
        let (topology, curves, dominance) = dominance(Shape::CubeSplit, Sharing::AllSides);
        for (point, ends) in (0..).zip(dominance.part_starts.windows(2)) {
            let parts = &dominance.parts[ends[0] as usize..ends[1] as usize];
            assert_eq!(parts.len(), 3, "a cube's corner has three normals");
            for (corner, angle) in parts {
                assert_eq!(topology.corner_points[*corner as usize], point);
                assert!((angle - std::f32::consts::FRAC_PI_2).abs() < 1e-6, "of one triangle or two: {angle}");
            }
        }
        assert_eq!(dominance.factor_starts.len(), topology.points.len() + 1);
        for (point, ends) in (0..).zip(dominance.factor_starts.windows(2)) {
            let own = &dominance.factors[ends[0] as usize..ends[1] as usize];
            let expected = topology.edges.iter().filter(|edge| topology.edge_points(edge).contains(&point)).count();
            assert_eq!(own.len(), expected);
            assert!(own.iter().all(|&factor| topology.edge_points(&topology.edges[factor as usize]).contains(&point)));
        }
        assert_eq!(curves.factor_count() as usize, topology.edges.len());
    }
}
