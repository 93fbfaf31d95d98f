//! T-junctions: points that lie inside an open edge of another triangle.

use glam::DVec3;
use serde::Serialize;

use super::bounds::Bounds;
use super::grid::Grid;
use super::progress::{Cancelled, Progress};
use super::topology::{Edge, EdgeKind, Topology};
use super::tree::Tree;

/// How near a point must be to an edge, as a part of the bounding diagonal.
const NEAR: f64 = 1e-5;

/// Points tried in one cell of two tolerances. More than that on one spot is noise, and trying all of them against the
/// edges that end there would be quadratic.
const TRIES: usize = 32;

/// T-junctions listed at most. A mesh with more is no mesh but edges on top of each other, whose number is quadratic.
const MOST: usize = 1 << 20;

/// A boundary point inside a boundary edge. No tessellation closes it: the edge curves and is divided on its own, and
/// doesn't know of the point. Only a mesh in which the triangle is divided there does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TJunction {
    /// Index into [`Topology::edges`].
    pub edge: u32,
    /// Index into [`Topology::points`].
    pub point: u32,
    /// Where along the edge, 0 to 1 in its own direction.
    pub t: f32,
    /// Between the point and the straight edge, in object units.
    pub distance: f32,
}

/// Boundary points that lie within 1e-5 of the bounding diagonal of a boundary edge, but not within that of its ends,
/// and aren't corners of the edge's triangle. In the order of the edges, then along each.
///
/// Takes about n log n steps in boundary edges: an edge looks only at the points along it. Of the points in one cell
/// of two tolerances the first 32 are tried, and the first 2^20 T-junctions are listed.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub fn t_junctions(topology: &Topology, progress: &Progress) -> Result<Vec<TJunction>, Cancelled> {
    let tolerance = Bounds::of(topology.points.iter().copied()).part(NEAR);
    let tree = Tree::new(boundary_points(topology, tolerance));
    progress.check()?;
    let mut all = Vec::new();
    let mut found = Vec::new();
    let open = topology.edges.iter().enumerate().filter(|(_, edge)| edge.kind == EdgeKind::Boundary);
    for (step, (i, edge)) in open.enumerate() {
        if step % 4096 == 0 {
            progress.check()?;
        }
        let ends = edge.points.map(|point| topology.points[point as usize].as_dvec3());
        tree.near_segment(ends, tolerance, |place, point| {
            if let Some((t, distance)) = inside(ends, place, tolerance).filter(|_| !uses(topology, edge, point)) {
                found.push((t, TJunction { edge: i as u32, point, t: t as f32, distance: distance as f32 }));
            }
        });
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.point.cmp(&b.1.point)));
        all.extend(found.drain(..).map(|(_, junction)| junction));
        if all.len() >= MOST {
            all.truncate(MOST);
            break;
        }
    }
    Ok(all)
}

/// The ends of all boundary edges, each once, but only so many on one spot.
fn boundary_points(topology: &Topology, tolerance: f64) -> Vec<(DVec3, u32)> {
    let mut open = vec![false; topology.points.len()];
    for edge in topology.edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary) {
        edge.points.iter().for_each(|&point| open[point as usize] = true);
    }
    let mut spots: Grid<()> = Grid::new(tolerance);
    let places = topology.points.iter().map(|point| point.as_dvec3()).zip(0..);
    places
        .filter(|&(place, point)| {
            let tried = open[point as usize].then(|| spots.at(place)).filter(|spot| spot.len() < TRIES);
            tried.map(|spot| spot.push(())).is_some()
        })
        .collect()
}

/// Where along a segment a place lies and how far from it, if that is inside.
fn inside([a, b]: [DVec3; 2], place: DVec3, tolerance: f64) -> Option<(f64, f64)> {
    let way = b - a;
    let t = (place - a).dot(way) / way.length_squared();
    let distance = place.distance(a + t * way);
    let apart = place.distance(a).min(place.distance(b)) > tolerance;
    (t > 0.0 && t < 1.0 && apart && distance <= tolerance).then_some((t, distance))
}

/// Whether the point is a corner of the boundary edge's one triangle.
fn uses(topology: &Topology, edge: &Edge, point: u32) -> bool {
    let side = topology.sides[edge.sides.start as usize];
    let corners = topology.patches[side.patch as usize].corners;
    corners.into_iter().any(|corner| topology.corner_points[corner as usize] == point)
}

#[cfg(test)]
mod tests;
