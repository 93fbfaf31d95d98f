//! From triangles to patches, points, edges and sides.

use std::ops::Range;

use glam::Vec3;
use serde::Serialize;

use super::{Cancelled, Mesh, Progress, weld};

/// Who is whose neighbour. Indices are into the fields of this struct, but for corners, which are the mesh's.
#[derive(Clone, Debug, Default)]
pub struct Topology {
    /// Welded positions, in object units.
    pub points: Vec<Vec3>,
    /// The point of each corner of the mesh.
    pub corner_points: Vec<u32>,
    pub patches: Vec<Patch>,
    pub edges: Vec<Edge>,
    /// Grouped by edge.
    pub sides: Vec<Side>,
    /// Triangles left out: two corners on one point.
    pub degenerate: u32,
    /// The run of patches of each of the mesh's materials.
    pub material_patches: Vec<Range<u32>>,
}

/// A triangle that is tessellated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patch {
    pub corners: [u32; 3],
    /// Side k runs from corner k to the next.
    pub sides: [u32; 3],
    /// Index in the mesh.
    pub triangle: u32,
}

/// An unordered pair of points. Its own direction runs from `points[0]` to `points[1]`, the higher index.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    pub points: [u32; 2],
    pub sides: Range<u32>,
    pub kind: EdgeKind,
}

/// One triangle's use of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    pub patch: u32,
    /// Which side of the patch.
    pub index: u8,
    /// Whether the patch runs it against the edge's direction.
    pub reversed: bool,
    pub edge: u32,
    /// The patch's corners at the edge's ends, in the edge's direction.
    pub corners: [u32; 2],
}

/// What meets at an edge. Its numbers are the shaders'.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum EdgeKind {
    /// Two sides that share normals and uvs.
    Smooth = 0,
    /// Two sides whose normals differ at an end.
    Split = 1,
    /// Two sides that share normals, but not uvs.
    Seam = 2,
    /// One side.
    Boundary = 3,
    /// Three sides or more.
    NonManifold = 4,
}

/// How many edges there are of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct EdgeCounts {
    pub smooth: u32,
    pub split: u32,
    pub seam: u32,
    pub boundary: u32,
    pub non_manifold: u32,
}

/// A side before its edge is known.
#[derive(Clone, Copy)]
struct Loose {
    /// Points in the edge's direction: lower, higher.
    points: [u32; 2],
    patch: u32,
    index: u8,
}

impl Topology {
    /// Welds points, finds edges and their sides. Linear in triangles, however many meet at a point: sides are sorted by
    /// their higher point, then by their lower, both by counting.
    ///
    /// # Errors
    /// `progress` was cancelled.
    pub fn build(mesh: &Mesh, progress: &Progress) -> Result<Self, Cancelled> {
        let welded = weld(mesh.corners.iter().map(|corner| corner.position));
        let mut topology = Self { points: welded.points, corner_points: welded.point_of, ..Self::default() };
        progress.check()?;
        topology.take_patches(mesh);
        progress.check()?;
        let sorted = topology.sorted_sides();
        progress.check()?;
        topology.take_edges(mesh, &sorted);
        Ok(topology)
    }

    fn take_patches(&mut self, mesh: &Mesh) {
        let points = |corners: [u32; 3]| corners.map(|corner| self.corner_points[corner as usize]);
        for material in &mesh.materials {
            let first = self.patches.len() as u32;
            for triangle in material.triangles.clone() {
                let corners = mesh.triangles[triangle as usize];
                let [a, b, c] = points(corners);
                if a == b || b == c || c == a {
                    self.degenerate += 1;
                } else {
                    self.patches.push(Patch { corners, sides: [0; 3], triangle });
                }
            }
            self.material_patches.push(first..self.patches.len() as u32);
        }
    }

    /// All sides, those of one edge together, edges by lower and then higher point.
    fn sorted_sides(&self) -> Vec<Loose> {
        let loose = |(patch, index): (u32, u8)| {
            let corner = |k: u8| self.patches[patch as usize].corners[usize::from(k % 3)];
            let point = |k| self.corner_points[corner(k) as usize];
            let (a, b) = (point(index), point(index + 1));
            Loose { points: [a.min(b), a.max(b)], patch, index }
        };
        let patches = 0..self.patches.len() as u32;
        let sides: Vec<_> = patches.flat_map(|patch| [0, 1, 2].map(|index| loose((patch, index)))).collect();
        let by_higher = counting_sort(&sides, self.points.len(), |side| side.points[1]);
        counting_sort(&by_higher, self.points.len(), |side| side.points[0])
    }

    fn take_edges(&mut self, mesh: &Mesh, sorted: &[Loose]) {
        self.sides.reserve_exact(sorted.len());
        for group in sorted.chunk_by(|x, y| x.points == y.points) {
            let (edge, first) = (self.edges.len() as u32, self.sides.len() as u32);
            for loose in group {
                let patch = &mut self.patches[loose.patch as usize];
                let index = usize::from(loose.index);
                patch.sides[index] = self.sides.len() as u32;
                let mut corners = [patch.corners[index], patch.corners[(index + 1) % 3]];
                let reversed = self.corner_points[corners[0] as usize] != loose.points[0];
                if reversed {
                    corners.reverse();
                }
                self.sides.push(Side { patch: loose.patch, index: loose.index, reversed, edge, corners });
            }
            let kind = kind(mesh, &self.sides[first as usize..]);
            self.edges.push(Edge { points: group[0].points, sides: first..self.sides.len() as u32, kind });
        }
    }

    /// How many edges there are of each kind.
    pub fn edge_counts(&self) -> EdgeCounts {
        let mut counts = EdgeCounts::default();
        for edge in &self.edges {
            *match edge.kind {
                EdgeKind::Smooth => &mut counts.smooth,
                EdgeKind::Split => &mut counts.split,
                EdgeKind::Seam => &mut counts.seam,
                EdgeKind::Boundary => &mut counts.boundary,
                EdgeKind::NonManifold => &mut counts.non_manifold,
            } += 1;
        }
        counts
    }
}

fn kind(mesh: &Mesh, sides: &[Side]) -> EdgeKind {
    let ends = |side: &Side| side.corners.map(|corner| mesh.corners[corner as usize]);
    match sides {
        [_] => EdgeKind::Boundary,
        [a, b] => {
            let (a, b) = (ends(a), ends(b));
            if (0..2).any(|end| a[end].normal != b[end].normal) {
                EdgeKind::Split
            } else if (0..2).any(|end| a[end].uv != b[end].uv) {
                EdgeKind::Seam
            } else {
                EdgeKind::Smooth
            }
        }
        _ => EdgeKind::NonManifold,
    }
}

/// Sorts by a key below `keys`, in linear time; equal keys stay in order.
fn counting_sort<T: Copy>(items: &[T], keys: usize, key: impl Fn(&T) -> u32) -> Vec<T> {
    let mut places = vec![0u32; keys + 1];
    for item in items {
        places[key(item) as usize + 1] += 1;
    }
    for index in 0..keys {
        places[index + 1] += places[index];
    }
    let mut sorted = items.to_vec();
    for item in items {
        let place = &mut places[key(item) as usize];
        sorted[*place as usize] = *item;
        *place += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Corner, Shape, merge};
    use glam::{Vec2, vec3};
    use proptest::prelude::*;

    fn topology(mesh: &Mesh) -> Topology {
        Topology::build(mesh, &Progress::default()).expect("nobody cancels")
    }

    /// A mesh of these positions, all with one normal.
    fn mesh(positions: &[Vec3], triangles: &[[usize; 3]]) -> Mesh {
        let corner = |i: usize| Corner { position: positions[i], normal: Vec3::Y, uv: Vec2::ZERO };
        merge::from_triangles("test", triangles.iter().map(|t| t.map(corner)))
    }

    #[test]
    fn two_triangles_share_an_edge_whichever_way_they_run_it() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Z, vec3(1.0, 0.0, 1.0)];
        for second in [[1, 3, 2], [1, 2, 3]] {
            let topology = topology(&mesh(&positions, &[[0, 1, 2], second]));
            let counts = EdgeCounts { smooth: 1, boundary: 4, ..EdgeCounts::default() };
            assert_eq!(topology.edge_counts(), counts);
            let shared = topology.edges.iter().find(|edge| edge.sides.len() == 2).expect("one is shared");
            let sides = &topology.sides[shared.sides.start as usize..shared.sides.end as usize];
            assert_eq!(sides[0].reversed != sides[1].reversed, second == [1, 3, 2]);
            assert_eq!(sides[0].corners, sides[1].corners, "in the edge's direction");
        }
    }

    #[test]
    fn degenerate_triangles_are_left_out_and_counted() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Z, vec3(-0.0, 0.0, 0.0)];
        let topology = topology(&mesh(&positions, &[[0, 1, 2], [0, 1, 3], [1, 1, 2]]));
        assert_eq!((topology.patches.len(), topology.degenerate, topology.edges.len()), (1, 2, 3));
    }

    #[test]
    fn a_book_of_three_pages_has_a_non_manifold_spine() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, -Vec3::Z];
        let topology = topology(&mesh(&positions, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]));
        let counts = EdgeCounts { non_manifold: 1, boundary: 6, ..EdgeCounts::default() };
        assert_eq!(topology.edge_counts(), counts);
    }

    #[test]
    fn many_triangles_may_meet_at_one_point() {
        let count = 300_000;
        let rim = |i: usize| {
            let (s, c) = (i as f32 / count as f32 * std::f32::consts::TAU).sin_cos();
            vec3(c * (1.0 + i as f32), 0.0, s * (1.0 + i as f32))
        };
        let mut positions = vec![Vec3::Y];
        positions.extend((0..=count).map(rim));
        let fan: Vec<_> = (0..count).map(|i| [0, i + 2, i + 1]).collect();
        let topology = topology(&mesh(&positions, &fan));
        assert_eq!(topology.edge_counts().smooth as usize, count - 1);
    }

    #[test]
    fn shapes_have_the_topology_that_they_are_named_for() {
        for (shape, euler, boundary) in [
            (Shape::CubeSplit, 2, 0),
            (Shape::CubeSmooth, 2, 0),
            (Shape::Icosahedron, 2, 0),
            (Shape::Icosphere, 2, 0),
            (Shape::Torus, 0, 0),
            (Shape::Cylinder, 2, 0),
            (Shape::Cone, 2, 0),
        ] {
            let topology = topology(&shape.build());
            let [points, edges, patches] = [topology.points.len(), topology.edges.len(), topology.patches.len()];
            assert_eq!(points as i64 - edges as i64 + patches as i64, euler, "{shape:?}");
            assert_eq!(topology.edge_counts().boundary, boundary, "{shape:?}");
            assert_eq!(topology.edge_counts().non_manifold, 0, "{shape:?}");
        }
    }

    proptest! {
        #[test]
        fn every_side_belongs_to_the_edge_of_its_points(triangles in prop::collection::vec(prop::array::uniform3(0usize..12), 1..60)) {
            let positions: Vec<_> = (0..12).map(|i| vec3((i % 5) as f32, (i / 5) as f32, (i % 7) as f32)).collect();
            let topology = topology(&mesh(&positions, &triangles));
            prop_assert_eq!(topology.sides.len(), 3 * topology.patches.len());
            prop_assert_eq!(topology.patches.len() + topology.degenerate as usize, triangles.len());
            let mut seen = std::collections::HashSet::new();
            for (index, edge) in topology.edges.iter().enumerate() {
                prop_assert!(edge.points[0] < edge.points[1] && seen.insert(edge.points));
                prop_assert!(!edge.sides.is_empty());
                for side in edge.sides.clone() {
                    let side = topology.sides[side as usize];
                    let ends = side.corners.map(|corner| topology.corner_points[corner as usize]);
                    prop_assert_eq!((ends, side.edge as usize), (edge.points, index));
                }
            }
            for (index, patch) in topology.patches.iter().enumerate() {
                for (k, &side) in patch.sides.iter().enumerate() {
                    let side = topology.sides[side as usize];
                    prop_assert_eq!((side.patch as usize, usize::from(side.index)), (index, k));
                    let start = side.corners[usize::from(side.reversed)];
                    prop_assert_eq!(start, patch.corners[k]);
                }
            }
        }
    }
}
