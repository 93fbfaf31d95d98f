//! Chains of open edges beside another one, as where a curved surface changes its density.

use glam::DVec3;

use super::line::Line;
use super::{TRIES, corners, open_edges};
use crate::mesh::{Edge, Topology};

/// How far from the straight edge a chain's points may lie, as a part of its length.
const WIDTH: f64 = 1.0 / 8.0;

/// How high the edge's triangle and the chain's must be at least, and how far beyond the edge the third corners of the
/// latter, as a part of its length: more than what rounding makes of a sliver, or of a corner on the edge.
const HEIGHT: f64 = 1e-3;

/// Steps that are taken for each boundary edge on average. A mesh's chains have no more edges than its boundary, and
/// at most 32 others are tried at each point: more is edges on top of each other, where trying all would be quadratic.
const STEPS: usize = 64;

/// All boundary edges, by their points.
pub(super) struct Chains<'a> {
    topology: &'a Topology,
    /// For each point and one more, where its links start.
    starts: Vec<u32>,
    links: Vec<Link>,
    /// For each point, the last edge whose search came there.
    seen: Vec<u32>,
    path: Vec<Step>,
    steps_left: usize,
}

/// A boundary edge as it is seen from one of its points.
#[derive(Clone, Copy, Debug, Default)]
struct Link {
    to: u32,
    patch: u32,
    /// The third corner's point of its triangle.
    third: u32,
}

/// A point of a chain in the making.
#[derive(Clone, Copy, Debug)]
struct Step {
    point: u32,
    /// Where along the edge it lies.
    t: f64,
    /// How many of its links have been tried.
    tried: usize,
}

impl<'a> Chains<'a> {
    pub fn new(topology: &'a Topology) -> Self {
        let mut starts = vec![0; topology.points.len() + 1];
        let mut open = 0;
        for (_, edge) in open_edges(topology) {
            topology.edge_points(edge).into_iter().for_each(|point| starts[point as usize + 1] += 1);
            open += 1;
        }
        for point in 1..starts.len() {
            starts[point] += starts[point - 1];
        }
        Self {
            topology,
            links: links(topology, &starts),
            starts,
            seen: vec![u32::MAX; topology.points.len()],
            path: Vec::new(),
            steps_left: STEPS * open,
        }
    }

    /// Adds the points inside the first chain found beside an edge, if there is one.
    pub fn find(&mut self, number: u32, edge: &Edge, points: &mut Vec<u32>) {
        let Some(beside) = Beside::of(self.topology, edge) else { return };
        if self.walk(number, &beside) && self.is_no_leaf() {
            points.extend(self.path.iter().skip(1).map(|step| step.point));
        }
    }

    /// Looks for a chain: `path` then holds its points but the last. Depth first; whether a link may follow another
    /// depends on the point between them only, so no point need be visited twice.
    fn walk(&mut self, number: u32, beside: &Beside) -> bool {
        self.path.clear();
        self.path.push(Step { point: beside.ends[0], t: 0.0, tried: 0 });
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
            let Some(t) = beside.follows(self.topology, &from, &link) else { continue };
            if link.to == beside.ends[1] {
                return true;
            }
            if self.seen[link.to as usize] != number {
                self.seen[link.to as usize] = number;
                self.path.push(Step { point: link.to, t, tried: 0 });
            }
        }
        false
    }

    /// Whether no triangle of the path has its third corner on the path.
    fn is_no_leaf(&self) -> bool {
        let mut points: Vec<_> = self.path.iter().map(|step| step.point).collect();
        points.sort_unstable();
        let third = |step: &Step| links_at(&self.starts, &self.links, step.point)[step.tried - 1].third;
        self.path.iter().all(|step| points.binary_search(&third(step)).is_err())
    }
}

/// The boundary edges of every point, in their order.
fn links(topology: &Topology, starts: &[u32]) -> Vec<Link> {
    let mut links = vec![Link::default(); starts.last().map_or(0, |&end| end as usize)];
    let mut next = starts.to_vec();
    for (_, edge) in open_edges(topology) {
        let [a, b] = topology.edge_points(edge);
        let patch = topology.sides[edge.first_side as usize].patch();
        let third = third(topology, edge);
        for (from, to) in [(a, b), (b, a)] {
            links[next[from as usize] as usize] = Link { to, patch, third };
            next[from as usize] += 1;
        }
    }
    links
}

/// The first few of a point's links.
fn links_at<'a>(starts: &[u32], links: &'a [Link], point: u32) -> &'a [Link] {
    let [start, end] = [point, point + 1].map(|point| starts[point as usize] as usize);
    &links[start..end.min(start + TRIES)]
}

/// The point of the boundary edge's triangle that isn't the edge's.
fn third(topology: &Topology, edge: &Edge) -> u32 {
    let [a, b] = topology.edge_points(edge);
    corners(topology, edge).into_iter().find(|point| ![a, b].contains(point)).unwrap_or(a)
}

/// An edge, and what may run beside it.
struct Beside {
    line: Line,
    length: f64,
    ends: [u32; 2],
    patch: u32,
    third: u32,
    /// From the edge to its triangle's third corner, at right angles to it, of length 1.
    side: DVec3,
}

impl Beside {
    /// Nothing for an edge whose triangle is a sliver over it.
    fn of(topology: &Topology, edge: &Edge) -> Option<Self> {
        let (line, third) = (Line::of(topology, edge), third(topology, edge));
        let up = line.across(topology.points[third as usize].as_dvec3());
        let (length, height) = (line.length(), up.length());
        let patch = topology.sides[edge.first_side as usize].patch();
        let beside = Self { line, length, ends: topology.edge_points(edge), patch, third, side: up / height };
        (height > HEIGHT * length).then_some(beside)
    }

    /// Where along the edge a link ends, if it goes on from a step in a chain.
    fn follows(&self, topology: &Topology, from: &Step, link: &Link) -> Option<f64> {
        if link.patch == self.patch || link.to == self.third {
            return None;
        }
        let at = |point: u32| topology.points[point as usize].as_dvec3();
        // Exactly 1 at the end, where rounding would let points lie beyond it.
        let (t, distance) = if link.to == self.ends[1] { (1.0, 0.0) } else { self.line.project(at(link.to)) };
        let onwards = t > from.t && (t < 1.0 || link.to == self.ends[1]) && distance <= WIDTH * self.length;
        let line = Line { ends: [at(from.point), at(link.to)] };
        (onwards && self.is_opposite(&line, link.third, at(link.third))).then_some(t)
    }

    /// Whether a triangle over a link of the chain lies on the other side of the edge than the edge's own.
    fn is_opposite(&self, link: &Line, third: u32, place: DVec3) -> bool {
        let depth = (self.line.ends[0] - place).dot(self.side);
        let height = -link.across(place).dot(self.side);
        !self.ends.contains(&third) && depth.min(height) > HEIGHT * self.length
    }
}

#[cfg(test)]
mod tests;
