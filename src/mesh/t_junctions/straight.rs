//! Points that lie on straight open edges.

use glam::DVec3;

use super::line::Line;
use super::{TRIES, corners, open_edges};
use crate::mesh::bounds::Bounds;
use crate::mesh::grid::Grid;
use crate::mesh::joins::TOLERANCES;
use crate::mesh::tree::Tree;
use crate::mesh::{Edge, Topology};

/// How near a point must be to an edge, as a part of the bounding diagonal.
const NEAR: f64 = 1e-5;

/// All boundary points, and what tells a near miss from a T-junction. Lengths in object units.
pub(super) struct Straight<'a> {
    topology: &'a Topology,
    tree: Tree,
    pub tolerance: f64,
    /// [`TOLERANCES`] as lengths.
    pub welds: [f64; TOLERANCES.len()],
    /// The length of the shortest boundary edge at each point.
    shortest: Vec<f64>,
}

impl<'a> Straight<'a> {
    pub fn new(topology: &'a Topology) -> Self {
        let bounds = Bounds::of(topology.points.iter().copied());
        let tolerance = bounds.part(NEAR);
        let shortest = shortest(topology);
        let tree = Tree::new(boundary_points(topology, &shortest, tolerance));
        Self { topology, tree, tolerance, welds: TOLERANCES.map(|weld| bounds.part(weld.into())), shortest }
    }

    /// Adds the points on an edge.
    pub fn find(&self, edge: &Edge, points: &mut Vec<u32>) {
        let line = Line::of(self.topology, edge);
        self.tree.near_segment(line.ends, self.tolerance, |place, point| {
            if self.is_inside(edge, &line, point, place) {
                points.push(point);
            }
        });
    }

    /// Whether a point lies on an edge, is no near miss of its ends and no corner of its triangle.
    pub fn is_inside(&self, edge: &Edge, line: &Line, point: u32, place: DVec3) -> bool {
        let (t, distance) = line.project(place);
        let ends = self.topology.edge_points(edge).into_iter().zip(line.ends);
        t > 0.0
            && t < 1.0
            && distance <= self.tolerance
            && !corners(self.topology, edge).contains(&point)
            && ends.into_iter().all(|(end, at)| !self.nearly_meet(point, end, place.distance(at)))
    }

    /// Whether two points so far apart are what a weld is for. It may move either end of an edge by its tolerance: an
    /// edge longer than twice that survives.
    fn nearly_meet(&self, a: u32, b: u32, distance: f64) -> bool {
        let shortest = self.shortest[a as usize].min(self.shortest[b as usize]);
        let weld = self.welds.into_iter().find(|weld| distance <= *weld);
        distance <= self.tolerance || weld.is_some_and(|weld| 2.0 * weld < shortest)
    }
}

/// The length of the shortest boundary edge at each point, infinite where there is none.
fn shortest(topology: &Topology) -> Vec<f64> {
    let mut shortest = vec![f64::INFINITY; topology.points.len()];
    for (_, edge) in open_edges(topology) {
        let length = Line::of(topology, edge).length();
        topology
            .edge_points(edge)
            .into_iter()
            .for_each(|point| shortest[point as usize] = length.min(shortest[point as usize]));
    }
    shortest
}

/// The ends of all boundary edges, each once, but only so many on one spot.
fn boundary_points(topology: &Topology, shortest: &[f64], tolerance: f64) -> Vec<(DVec3, u32)> {
    let mut spots = Grid::new(tolerance);
    let place_of = |point: u32| topology.points[point as usize].as_dvec3();
    // How many were tried on a point's spot, that point among them.
    let mut tried = vec![0_usize; topology.points.len()];
    let open = (0..topology.points.len() as u32).filter(|&point| shortest[point as usize].is_finite());
    let few = open.filter(|&point| {
        let before = spots.at(place_of(point), place_of).map_or(0, |latest| tried[latest as usize]);
        let is_one = before < TRIES;
        if is_one {
            tried[point as usize] = before + 1;
            spots.put(point, place_of);
        }
        is_one
    });
    few.map(|point| (place_of(point), point)).collect()
}
