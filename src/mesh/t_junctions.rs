//! T-junctions: points between the ends of another triangle's open edge, which divide the surface on its other side.

mod chains;
mod line;
mod straight;

use serde::Serialize;

use super::topology::{Edge, EdgeKind, Topology};
use crate::progress::{Cancelled, Progress};

use chains::Chains;
use line::Line;
use straight::Straight;

/// Boundary edges at one point, and boundary points on one spot, that are tried. More than that is noise, and trying
/// all of them would be quadratic.
const TRIES: usize = 32;

/// T-junctions listed at most. A mesh with more is no mesh but edges on top of each other, whose number is quadratic.
const MOST: usize = 1 << 20;

/// A boundary point between the ends of a boundary edge. No tessellation closes it: the edge curves and is divided on
/// its own, and doesn't know of the point. Only a mesh in which the triangle is divided there does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TJunction {
    /// Index into [`Topology::edges`].
    pub edge: u32,
    /// Index into [`Topology::points`].
    pub point: u32,
    /// Where along the edge, 0 to 1 in its own direction.
    pub t: f32,
    /// Between the point and the straight edge, in object units. Up to 1/8 of the edge's length where a chain of edges
    /// runs beside it.
    pub distance: f32,
}

/// Boundary points that are a boundary edge's T-junctions, in either of two ways. In the order of the edges, then along
/// each; a point that is one in both ways is listed once.
///
/// *On the straight edge*: the point lies within 1e-5 of the bounding diagonal of it, and is no near miss of its ends.
/// It is a near miss of an end within 1e-5 of the diagonal, or within the smallest of
/// [`TOLERANCES`](super::joins::TOLERANCES) that reaches from one to the other, if all boundary edges at both are longer
/// than twice that: welding within it joins the two and collapses none of those edges.
///
/// *Beside it*: the point is inside a chain of two or more other boundary edges from one end to the other, as where a
/// curved surface changes its density. Along the edge the chain's points come in order, strictly between the ends;
/// across, they lie within 1/8 of its length (an arc of 56 degrees over its chord). The chain's triangles lie on the
/// other side of the edge than its own: from the edge to its triangle's third corner, and from each of the chain's edges
/// to its own, directions are opposed; the chain's third corners lie beyond the edge, and are none of the chain's points.
/// Heights below a thousandth of the edge's length are none. So neither a thin ribbon nor a leaf is taken for a seam, as
/// its third corners lie between, and no sliver is.
///
/// In both, the point is no corner of the edge's own triangle.
///
/// Takes about n log n steps in boundary edges: an edge looks only at the points along it. Of the points in one cell
/// of two tolerances, and of the boundary edges at one point, the first 32 are tried, chains are sought in 64 steps for
/// each boundary edge on average, and the first 2^20 T-junctions are listed.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub fn t_junctions(topology: &Topology, progress: &Progress) -> Result<Vec<TJunction>, Cancelled> {
    let straight = Straight::new(topology);
    progress.check()?;
    let mut chains = Chains::new(topology);
    let mut all = Vec::new();
    let mut points = Vec::new();
    for (step, (i, edge)) in open_edges(topology).enumerate() {
        if step % 4096 == 0 {
            progress.check()?;
        }
        straight.find(edge, &mut points);
        chains.find(i, edge, &mut points);
        list(topology, i, edge, &mut points, &mut all);
        if all.len() >= MOST {
            all.truncate(MOST);
            break;
        }
    }
    Ok(all)
}

/// Boundary edges with their numbers.
fn open_edges(topology: &Topology) -> impl Iterator<Item = (u32, &Edge)> {
    (0..).zip(&topology.edges).filter(|(_, edge)| edge.kind == EdgeKind::Boundary)
}

/// Takes an edge's points, each once and in their order along it.
fn list(topology: &Topology, edge: u32, of: &Edge, points: &mut Vec<u32>, all: &mut Vec<TJunction>) {
    if points.is_empty() {
        return;
    }
    let line = Line::of(topology, of);
    points.sort_unstable();
    points.dedup();
    let places = points.drain(..).map(|point| (line.project(topology.points[point as usize].as_dvec3()), point));
    let mut places: Vec<_> = places.collect();
    places.sort_by(|((a, _), _), ((b, _), _)| a.total_cmp(b));
    let junction =
        |((t, distance), point): ((f64, f64), u32)| TJunction { edge, point, t: t as f32, distance: distance as f32 };
    all.extend(places.into_iter().map(junction));
}

/// The points of the corners of the boundary edge's one triangle.
fn corners(topology: &Topology, edge: &Edge) -> [u32; 3] {
    let side = topology.sides[edge.first_side as usize];
    topology.patch_points(side.patch())
}

#[cfg(test)]
mod tests;
