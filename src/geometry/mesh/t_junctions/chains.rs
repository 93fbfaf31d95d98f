//! Finds chains of boundary edges beside another boundary edge, as where a curved surface changes its density.

use glam::DVec3;

use super::{LineSegment, TRIES, corners, open_edges};
use crate::groups::in_groups;
use crate::mesh::{Edge, Topology};

/// The greatest distance of a chain's points from the straight edge, as a part of its length.
const WIDTH: f64 = 1.0 / 8.0;

/// The least height of the triangles of the edge and of the chain, as a part of the edge's length; it is more than rounding
/// makes of a sliver. The third corners of the chain's triangles are at least as far beyond the edge, which is more than
/// rounding makes of a corner on the edge.
const HEIGHT: f64 = 1e-3;

/// The number of search steps for each boundary edge on average. A mesh's chains have no more edges than its boundary,
/// and at most 32 other edges are tried at each point. A mesh that needs more steps is a heap of edges on top of each
/// other, where trying all would take quadratic time.
const STEPS: usize = 64;

/// All boundary edges by their points, and the state of a search.
pub(super) struct ChainSearch<'a> {
    topology: &'a Topology,
    /// Where the links of each point start, and the end of the last.
    starts: Vec<u32>,
    links: Vec<Link>,
    /// For each point, the last edge whose search reached it.
    seen: Vec<u32>,
    /// The path that is being searched.
    path: Vec<Step>,
    steps_left: usize,
}

/// A boundary edge, seen from one of its points.
#[derive(Clone, Copy, Debug, Default)]
struct Link {
    /// The point at its other end.
    to: u32,
    patch: u32,
    /// The point of the third corner of its triangle.
    third: u32,
}

/// A point on the path that is being searched.
#[derive(Clone, Copy, Debug)]
struct Step {
    point: u32,
    /// The point's position along the edge, 0 to 1.
    t: f64,
    /// How many of its links have been tried.
    tried: usize,
}

impl<'a> ChainSearch<'a> {
    pub(super) fn new(topology: &'a Topology) -> Self {
        let all = open_edges(topology).flat_map(|(_, edge)| links(topology, edge));
        let (starts, links) = in_groups(topology.points.len(), all);
        // Each boundary edge has two links.
        let steps_left = STEPS * (links.len() / 2);
        Self { topology, starts, links, seen: vec![u32::MAX; topology.points.len()], path: Vec::new(), steps_left }
    }

    /// Adds the points inside the first chain that is found beside an edge, if there is one.
    pub(super) fn find(&mut self, number: u32, edge: &Edge, points: &mut Vec<u32>) {
        let Some(coarse) = CoarseEdge::new(self.topology, edge) else { return };
        if self.walk(number, &coarse) && self.is_no_leaf() {
            points.extend(self.path.iter().skip(1).map(|step| step.point));
        }
    }

    /// Searches for a chain, depth first; `path` then holds its points except the last. Whether a link may follow
    /// another depends only on the point between them, so no point is visited twice.
    fn walk(&mut self, number: u32, coarse: &CoarseEdge) -> bool {
        self.path.clear();
        self.path.push(Step { point: coarse.ends[0], t: 0.0, tried: 0 });
        while let Some(step) = self.path.last_mut() {
            let from = *step;
            let Some(&link) = links_at(&self.starts, &self.links, from.point).get(from.tried) else {
                self.path.pop();
                continue;
            };
            if self.steps_left == 0 {
                return false;
            }
            self.steps_left -= 1;
            step.tried += 1;
            let Some(t) = coarse.follows(self.topology, &from, &link) else { continue };
            if link.to == coarse.ends[1] {
                return true;
            }
            if self.seen[link.to as usize] != number {
                self.seen[link.to as usize] = number;
                self.path.push(Step { point: link.to, t, tried: 0 });
            }
        }
        false
    }

    /// Returns whether the third corner of each triangle on the path lies off the path.
    fn is_no_leaf(&self) -> bool {
        let mut points: Vec<_> = self.path.iter().map(|step| step.point).collect();
        points.sort_unstable();
        let third = |step: &Step| links_at(&self.starts, &self.links, step.point)[step.tried - 1].third;
        self.path.iter().all(|step| points.binary_search(&third(step)).is_err())
    }
}

/// Returns the links along a boundary edge, each with the point that it starts from.
fn links(topology: &Topology, edge: &Edge) -> [(u32, Link); 2] {
    let [a, b] = topology.edge_points(edge);
    let patch = topology.sides[edge.first_side as usize].patch();
    let third = third(topology, edge);
    [(a, b), (b, a)].map(|(from, to)| (from, Link { to, patch, third }))
}

/// Returns the first few links of a point.
fn links_at<'a>(starts: &[u32], links: &'a [Link], point: u32) -> &'a [Link] {
    let [start, end] = [point, point + 1].map(|point| starts[point as usize] as usize);
    &links[start..end.min(start + TRIES)]
}

/// Returns the point of a boundary edge's triangle that isn't on the edge.
fn third(topology: &Topology, edge: &Edge) -> u32 {
    let [a, b] = topology.edge_points(edge);
    corners(topology, edge).into_iter().find(|point| ![a, b].contains(point)).unwrap_or(a)
}

/// An edge that chains are searched beside.
struct CoarseEdge {
    line: LineSegment,
    length: f64,
    ends: [u32; 2],
    patch: u32,
    third: u32,
    /// The unit direction from the edge to the third corner of its triangle, at right angles to the edge.
    side: DVec3,
}

impl CoarseEdge {
    /// Returns none for an edge whose triangle is a sliver.
    fn new(topology: &Topology, edge: &Edge) -> Option<Self> {
        let (line, third) = (LineSegment::from_edge(topology, edge), third(topology, edge));
        let up = line.across(topology.points[third as usize].as_dvec3());
        let (length, height) = (line.length(), up.length());
        let patch = topology.sides[edge.first_side as usize].patch();
        let coarse = Self { line, length, ends: topology.edge_points(edge), patch, third, side: up / height };
        (height > HEIGHT * length).then_some(coarse)
    }

    /// Returns the position along the edge, 0 to 1, where a link ends, if the link can continue the chain.
    fn follows(&self, topology: &Topology, from: &Step, link: &Link) -> Option<f64> {
        if link.patch == self.patch || link.to == self.third {
            return None;
        }
        let at = |point: u32| topology.points[point as usize].as_dvec3();
        // Exactly 1 at the end; rounding could put points of the chain beyond it.
        let (t, distance) = if link.to == self.ends[1] { (1.0, 0.0) } else { self.line.project(at(link.to)) };
        let onwards = t > from.t && (t < 1.0 || link.to == self.ends[1]) && distance <= WIDTH * self.length;
        let line = LineSegment { ends: [at(from.point), at(link.to)] };
        (onwards && self.is_opposite(&line, link.third, at(link.third))).then_some(t)
    }

    /// Returns whether the triangle at a link of the chain lies on the other side of the edge than the edge's own
    /// triangle.
    fn is_opposite(&self, link: &LineSegment, third: u32, place: DVec3) -> bool {
        let depth = (self.line.ends[0] - place).dot(self.side);
        let height = -link.across(place).dot(self.side);
        !self.ends.contains(&third) && depth.min(height) > HEIGHT * self.length
    }
}

#[cfg(test)]
mod tests;
