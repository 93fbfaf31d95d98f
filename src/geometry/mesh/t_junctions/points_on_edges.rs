//! Finds points that lie on straight open edges.

use std::collections::HashMap;

use foldhash::fast::RandomState;
use glam::DVec3;

use super::{LineSegment, TRIES, corners, open_edges};
use crate::casts::to_u32;
use crate::mesh::bounds::Bounds;
use crate::mesh::weld_preview::TOLERANCES;
use crate::mesh::{Edge, Topology};
use crate::near::TriangleTree;

/// The greatest distance of a point from an edge, as a part of the bounding diagonal.
const NEAR: f64 = 1e-5;

/// All boundary points, and the lengths that tell points that nearly meet from T-junctions, in object units.
pub(super) struct PointsOnEdges<'a> {
    topology: &'a Topology,
    /// The boundary points that are tried, those in one place one after the other, and a tree of them; none if there are none.
    tried: Vec<u32>,
    tree: Option<TriangleTree>,
    /// [`NEAR`] as a length.
    pub tolerance: f64,
    /// [`TOLERANCES`] as lengths.
    pub welds: [f64; TOLERANCES.len()],
    /// For each point, the length of its shortest boundary edge.
    shortest: Vec<f64>,
}

impl<'a> PointsOnEdges<'a> {
    pub(super) fn new(topology: &'a Topology) -> Self {
        let bounds = Bounds::new(topology.points.iter().copied());
        let tolerance = bounds.part(NEAR);
        let shortest = shortest(topology);
        let mut tried = boundary_points(topology, &shortest, tolerance);
        tried.sort_by_key(|point| (topology.points[*point as usize] + 0.0).to_array().map(f32::to_bits));
        let tree = TriangleTree::new(tried.iter().map(|point| [topology.points[*point as usize]; 3]));
        Self { topology, tried, tree, tolerance, welds: TOLERANCES.map(|weld| bounds.part(weld.into())), shortest }
    }

    /// Adds the points that lie on an edge.
    pub(super) fn find(&self, edge: &Edge, points: &mut Vec<u32>) {
        let line = LineSegment::from_edge(self.topology, edge);
        let Some(tree) = &self.tree else { return };
        tree.near_segment(line.ends, self.tolerance, |tried| {
            // The tree has the first of several points in one place, which the others follow.
            let tried = &self.tried[tried as usize..];
            let at = |point: &u32| self.topology.points[*point as usize];
            let here = tried.iter().take_while(|point| at(point) == at(&tried[0]));
            points.extend(here.filter(|point| self.is_inside(edge, &line, **point, at(point).as_dvec3())));
        });
    }

    /// Returns whether a point lies on an edge, nearly meets neither end, and is no corner of the edge's triangle.
    pub(super) fn is_inside(&self, edge: &Edge, line: &LineSegment, point: u32, place: DVec3) -> bool {
        let (t, distance) = line.project(place);
        let ends = self.topology.edge_points(edge).into_iter().zip(line.ends);
        t > 0.0
            && t < 1.0
            && distance <= self.tolerance
            && !corners(self.topology, edge).contains(&point)
            && ends.into_iter().all(|(end, at)| !self.nearly_meet(point, end, place.distance(at)))
    }

    /// Returns whether a weld should join two points at this distance. A weld may move either end of an edge by its
    /// tolerance, so an edge that is longer than twice the tolerance survives.
    fn nearly_meet(&self, a: u32, b: u32, distance: f64) -> bool {
        let shortest = self.shortest[a as usize].min(self.shortest[b as usize]);
        let weld = self.welds.into_iter().find(|weld| distance <= *weld);
        distance <= self.tolerance || weld.is_some_and(|weld| 2.0 * weld < shortest)
    }
}

/// Returns the length of the shortest boundary edge at each point; infinite where there is none.
fn shortest(topology: &Topology) -> Vec<f64> {
    let mut shortest = vec![f64::INFINITY; topology.points.len()];
    for (_, edge) in open_edges(topology) {
        let length = LineSegment::from_edge(topology, edge).length();
        topology
            .edge_points(edge)
            .into_iter()
            .for_each(|point| shortest[point as usize] = length.min(shortest[point as usize]));
    }
    shortest
}

/// Returns the ends of all boundary edges, each once, but only the first few in any one place: a cell of a grid.
fn boundary_points(topology: &Topology, shortest: &[f64], tolerance: f64) -> Vec<u32> {
    // How many points a cell has, by the bits of its coordinates. They never become integers, which could overflow, and adding 0 turns
    // -0 into +0.
    let mut spots: HashMap<[u64; 3], usize, RandomState> = HashMap::default();
    let cell = |place: DVec3| place.to_array().map(|x| ((x / (2.0 * tolerance)).floor() + 0.0).to_bits());
    let open = (0..to_u32(topology.points.len())).filter(|&point| shortest[point as usize].is_finite());
    let few = open.filter(|&point| {
        let count = spots.entry(cell(topology.points[point as usize].as_dvec3())).or_default();
        *count += 1;
        *count <= TRIES
    });
    few.collect()
}
