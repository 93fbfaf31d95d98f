//! Lines that mark what is found on a mesh.

use glam::Vec3;

use super::LineSegment;
use super::layout::T_JUNCTION_COLOR;
use crate::mesh::{TJunction, Topology};

/// The open edges that T-junctions lie on, and a dot on each point.
pub fn t_junction_lines(topology: &Topology, junctions: &[TJunction]) -> Vec<LineSegment> {
    let at = |point: u32| topology.points[point as usize];
    let dot = |place: Vec3| LineSegment { half_width: 4.0, ..LineSegment::new(place, place, T_JUNCTION_COLOR) };
    let marks = junctions.iter().flat_map(|junction| {
        let [a, b] = topology.edges[junction.edge as usize].points.map(at);
        [LineSegment::new(a, b, T_JUNCTION_COLOR), dot(at(junction.point))]
    });
    marks.collect()
}
