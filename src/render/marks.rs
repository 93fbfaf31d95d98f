//! Lines that mark cracks, T-junctions, the largest deviation, and the selected patch.

use glam::Vec3;

use super::LineSegment;
use super::layout::{CRACK_COLOR, FACTOR_COLORS, OUTLINE_COLOR, T_JUNCTION_COLOR, WORST_COLOR};
use crate::measure::{CrackedEdge, Measured};
use crate::mesh::{TJunction, Topology};

/// The lines of every side of every cracked edge.
pub(crate) fn crack_lines(measured: &Measured, topology: &Topology) -> Vec<LineSegment> {
    crack_lines_in(measured, topology, |_| CRACK_COLOR)
}

/// The lines of every side of every cracked edge. `color` returns the sRGB colour of each edge.
pub(crate) fn crack_lines_in(
    measured: &Measured,
    topology: &Topology,
    color: impl Fn(&CrackedEdge) -> [u8; 3],
) -> Vec<LineSegment> {
    let mut lines = Vec::new();
    for edge in measured.cracks.cracked() {
        let color = color(edge);
        for side in measured.outlines.edge(topology, edge.edge) {
            let points: Vec<_> = side.positions().collect();
            lines.extend(points.windows(2).map(|ends| LineSegment::new(ends[0], ends[1], color)));
        }
    }
    lines
}

/// Lines along the open edges that T-junctions lie on, and a dot on each junction's point.
pub(crate) fn t_junction_lines(topology: &Topology, junctions: &[TJunction]) -> Vec<LineSegment> {
    let at = |point: u32| topology.points[point as usize];
    let dot = |place: Vec3| LineSegment { half_width: 4.0, ..LineSegment::new(place, place, T_JUNCTION_COLOR) };
    let marks = junctions.iter().flat_map(|junction| {
        let [a, b] = topology.edge_points(&topology.edges[junction.edge as usize]).map(at);
        [LineSegment::new(a, b, T_JUNCTION_COLOR), dot(at(junction.point))]
    });
    marks.collect()
}

/// The place with the largest deviation: a dot on it, and a line to the nearest point of the reference surface.
pub(crate) fn worst_lines(emitted: Vec3, truth: Vec3) -> Vec<LineSegment> {
    let line = |start, end, color, half_width| LineSegment { half_width, ..LineSegment::new(start, end, color) };
    let mark =
        |color, wider: f32| [line(emitted, truth, color, 1.25 + wider), line(emitted, emitted, color, 4.5 + wider)];
    [mark(OUTLINE_COLOR, 1.5), mark(WORST_COLOR, 0.0)].concat()
}

/// The outline of a selected patch: lines through the points of the edges that factors 0, 1 and 2 cut.
pub(crate) fn patch_lines(edges: &[Vec<Vec3>; 3]) -> Vec<LineSegment> {
    let edge = |points: &[Vec3], color, half_width| {
        let ends = points.windows(2).map(move |ends| LineSegment::new(ends[0], ends[1], color));
        ends.map(|line| LineSegment { half_width, ..line }).collect::<Vec<_>>()
    };
    let outline = edges.iter().flat_map(|points| edge(points, OUTLINE_COLOR, 4.0));
    let colored = edges.iter().zip(FACTOR_COLORS).flat_map(|(points, color)| edge(points, color, 2.75));
    outline.chain(colored).collect()
}
