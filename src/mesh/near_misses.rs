//! Near misses: open edges that look joined and aren't.

use glam::DVec3;
use serde::Serialize;

use super::bounds::Bounds;
use super::grid::Grid;
use super::topology::{EdgeKind, Topology};

/// How near ends must be to count as a near miss, as a part of the bounding diagonal.
const NEAR: f64 = 1e-5;

/// Edges tried against one edge at most. More than that within one tolerance is noise, and trying all would be quadratic.
const TRIES: usize = 256;

/// Two boundary edges that look welded and aren't: a crack before any tessellation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NearMiss {
    /// Indices into [`Topology::edges`], the lower one first.
    pub edges: [u32; 2],
    /// The second edge's own direction runs against the first's.
    pub reversed: bool,
    /// The larger of the two distances between ends, in object units.
    pub distance: f32,
}

/// A boundary edge on the grid of middles.
struct Open {
    edge: u32,
    ends: [DVec3; 2],
}

/// Pairs of boundary edges whose ends lie within 1e-5 of the bounding diagonal of each other's, in either direction,
/// though they aren't the same points. Edges shorter than twice that are left out. In the order of the first edge.
///
/// Near linear: middles are hashed on a grid, and an edge is compared with the first 256 edges of each grid cell around it.
pub fn near_misses(topology: &Topology) -> Vec<NearMiss> {
    let tolerance = Bounds::of(topology.points.iter().copied()).part(NEAR);
    let mut misses = Vec::new();
    let mut grid: Grid<Open> = Grid::new(tolerance);
    let long = |open: &Open| open.ends[0].distance(open.ends[1]) > 2.0 * tolerance;
    for open in boundary(topology).filter(long) {
        let middle = open.ends[0].midpoint(open.ends[1]);
        for near in grid.near(middle) {
            let found = near.iter().take(TRIES).filter_map(|earlier| compare(earlier, &open, tolerance));
            misses.extend(found);
        }
        grid.at(middle).push(open);
    }
    misses.sort_by_key(|miss| miss.edges);
    misses
}

fn boundary(topology: &Topology) -> impl Iterator<Item = Open> {
    let edges = topology.edges.iter().enumerate().filter(|(_, edge)| edge.kind == EdgeKind::Boundary);
    edges.map(|(i, edge)| {
        let ends = edge.points.map(|point| topology.points[point as usize].as_dvec3());
        Open { edge: i as u32, ends }
    })
}

fn compare(a: &Open, b: &Open, tolerance: f64) -> Option<NearMiss> {
    let apart = |x: usize, y: usize| a.ends[0].distance(b.ends[x]).max(a.ends[1].distance(b.ends[y]));
    let (along, against) = (apart(0, 1), apart(1, 0));
    let reversed = against < along;
    let distance = along.min(against);
    (distance <= tolerance).then_some(NearMiss { edges: [a.edge, b.edge], reversed, distance: distance as f32 })
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::mesh::Progress;
    use crate::mesh::shapes::Shape;

    /// A saddle cut in two along x = 0, the right half moved by `offset`.
    fn cut_saddle(offset: Vec3) -> Topology {
        let mut mesh = Shape::Saddle.build();
        let corners = mesh.corners.clone();
        for triangle in &mut mesh.triangles {
            if triangle.iter().all(|&c| corners[c as usize].position.x > -0.01) {
                for c in triangle {
                    let mut corner = corners[*c as usize];
                    corner.position += offset;
                    *c = mesh.corners.len() as u32;
                    mesh.corners.push(corner);
                }
            }
        }
        Topology::build(&mesh, &Progress::new()).unwrap()
    }

    #[test]
    fn a_hairline_cut_is_found() {
        let misses = near_misses(&cut_saddle(Vec3::X * 4e-6));
        assert_eq!(misses.len(), 6, "{misses:?}");
        assert!(misses.iter().all(|miss| miss.distance < 1e-5 && miss.edges[0] < miss.edges[1]));
    }

    #[test]
    fn a_wide_cut_and_no_cut_are_not() {
        assert_eq!(near_misses(&cut_saddle(Vec3::X * 1e-3)), []);
        assert_eq!(near_misses(&cut_saddle(Vec3::ZERO)), []);
        assert_eq!(near_misses(&Topology::default()), []);
    }
}
