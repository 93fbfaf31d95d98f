//! T-junctions: points between the ends of another triangle's open edge, where the surface on the other side of that
//! edge is divided.

mod chains;
mod points_on_edges;

use glam::DVec3;
use serde::Serialize;

use super::topology::{Edge, EdgeKind, Topology};
use crate::casts::to_f32;
use crate::progress::{Cancelled, Progress};

use chains::ChainSearch;
use points_on_edges::PointsOnEdges;

/// The greatest number of boundary edges at one point, and of boundary points in one place, that are tried. Trying all
/// would take quadratic time and tell little.
const TRIES: usize = 32;

/// The greatest number of T-junctions that are listed. A mesh with more is a heap of edges on top of each other, where
/// the number of T-junctions is quadratic.
const MOST: usize = 1 << 20;

/// A boundary point between the ends of a boundary edge. No tessellation closes the gap there: the edge curves and is
/// divided without regard to the point. The mesh must be changed so that the edge ends at the point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TJunction {
    /// Index into [`Topology::edges`].
    pub edge: u32,
    /// Index into [`Topology::points`].
    pub point: u32,
    /// The point's position along the edge, 0 to 1 in the edge's own direction.
    pub t: f32,
    /// The distance between the point and the straight edge, in object units. It is up to 1/8 of the edge's length
    /// where a chain of edges runs beside the edge.
    pub distance: f32,
}

/// Finds the T-junctions of a mesh, of two kinds. They are listed in the order of the edges, then along each edge. A
/// point that is of both kinds is listed once.
///
/// *On the straight edge*: the point is no farther from the edge than 1e-5 of the bounding diagonal, and nearly meets
/// neither end of the edge. It nearly meets an end if the distance is within 1e-5 of the diagonal. It also does if the
/// smallest of [`TOLERANCES`](super::weld_preview::TOLERANCES) within which the distance lies is less than half of the
/// length of every boundary edge at both points: then welding joins the two and collapses none of those edges.
///
/// *Beside the edge*: the point lies inside a chain of two or more other boundary edges that connects the edge's ends,
/// as where a curved surface changes its density. Along the edge, the chain's points come in order, strictly between
/// the ends; across, they lie within 1/8 of the edge's length (an arc of 56 degrees over its chord). The chain's
/// triangles lie on the other side of the edge than its own triangle: the direction from the edge to the third corner
/// of its triangle is opposed to the directions from the chain's edges to theirs. The chain's third corners lie beyond
/// the edge, and none of them is a point of the chain. A height counts only from a thousandth of the edge's length on.
/// So neither a thin ribbon nor a two-sided leaf is taken for a seam, since their third corners lie between; nor is a
/// sliver.
///
/// A corner of the edge's own triangle is never its T-junction.
///
/// Takes about n log n steps for n boundary edges, since only points near an edge are tried. Of the points in one cell
/// with a width of two tolerances, and of the boundary edges at one point, the first 32 are tried. Chains are searched
/// in 64 steps for each boundary edge on average, and the first 2^20 T-junctions are listed.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub fn t_junctions(topology: &Topology, progress: &Progress) -> Result<Vec<TJunction>, Cancelled> {
    progress.check()?;
    if open_edges(topology).next().is_none() {
        return Ok(Vec::new());
    }
    let on_edges = PointsOnEdges::new(topology);
    progress.check()?;
    let mut chains = ChainSearch::new(topology);
    let mut all = Vec::new();
    let mut points = Vec::new();
    for (step, (i, edge)) in open_edges(topology).enumerate() {
        if step % 4096 == 0 {
            progress.check()?;
        }
        on_edges.find(edge, &mut points);
        chains.find(i, edge, &mut points);
        list(topology, i, edge, &mut points, &mut all);
        if all.len() >= MOST {
            all.truncate(MOST);
            break;
        }
    }
    Ok(all)
}

/// Returns the boundary edges with their indices.
fn open_edges(topology: &Topology) -> impl Iterator<Item = (u32, &Edge)> + Clone {
    (0..).zip(&topology.edges).filter(|(_, edge)| edge.kind == EdgeKind::Boundary)
}

/// Lists an edge's T-junctions at `points`, each once and in their order along the edge; empties `points`.
fn list(topology: &Topology, edge: u32, of: &Edge, points: &mut Vec<u32>, all: &mut Vec<TJunction>) {
    if points.is_empty() {
        return;
    }
    let line = LineSegment::from_edge(topology, of);
    points.sort_unstable();
    points.dedup();
    let places = points.drain(..).map(|point| (line.project(topology.points[point as usize].as_dvec3()), point));
    let mut places: Vec<_> = places.collect();
    places.sort_by(|((a, _), _), ((b, _), _)| a.total_cmp(b));
    let junction =
        |((t, distance), point): ((f64, f64), u32)| TJunction { edge, point, t: to_f32(t), distance: to_f32(distance) };
    all.extend(places.into_iter().map(junction));
}

/// The straight line between an edge's ends, with a length above 0, in object units. In f64, since squares of very small or large lengths
/// leave f32.
#[derive(Clone, Copy, Debug)]
struct LineSegment {
    ends: [DVec3; 2],
}

impl LineSegment {
    fn from_edge(topology: &Topology, edge: &Edge) -> Self {
        Self { ends: topology.edge_points(edge).map(|point| topology.points[point as usize].as_dvec3()) }
    }

    fn way(&self) -> DVec3 {
        self.ends[1] - self.ends[0]
    }

    fn length(&self) -> f64 {
        self.way().length()
    }

    /// Returns where along the segment a position lies, 0 at its start and 1 at its end, and its distance from the
    /// line.
    fn project(&self, place: DVec3) -> (f64, f64) {
        let t = (place - self.ends[0]).dot(self.way()) / self.way().length_squared();
        (t, place.distance(self.ends[0] + t * self.way()))
    }

    /// Returns the vector from the line to a position, at right angles to the line.
    fn across(&self, place: DVec3) -> DVec3 {
        let (t, _) = self.project(place);
        place - (self.ends[0] + t * self.way())
    }
}

/// Returns the points of a boundary edge's one triangle.
fn corners(topology: &Topology, edge: &Edge) -> [u32; 3] {
    let side = topology.sides[edge.first_side as usize];
    topology.patch_points(side.patch())
}

#[cfg(test)]
mod tests;
