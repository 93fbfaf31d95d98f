//! What a weld tolerance would do, before one chooses it.

use std::collections::HashMap;
use std::fmt;

use foldhash::fast::RandomState;
use serde::Serialize;

use super::Mesh;
use super::topology::{EdgeKind, Topology, is_degenerate, weld_corners};
use crate::progress::{Cancelled, Progress};

/// What welding within a tolerance changes, compared with the exact weld.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Joins {
    /// Relative to the bounding diagonal.
    pub tolerance: f32,
    /// Boundary edges of the exact topology that are joined to another: their side ends up on an edge with two sides
    /// or more. Edges of triangles that collapse are not among them.
    pub edges: u32,
    /// Triangles that are patches of the exact topology and degenerate within the tolerance.
    pub collapsed: u32,
}

impl fmt::Display for Joins {
    /// In words, without the tolerance.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self.edges, self.collapsed) {
            (0, 0) => write!(f, "joins nothing"),
            (edges, 0) => write!(f, "joins {edges} edges"),
            (edges, collapsed) => write!(f, "joins {edges} edges, collapses {collapsed} triangles"),
        }
    }
}

/// The tolerances that are tried, relative to the bounding diagonal: from what the last bits of f32 leave open to what
/// visibly changes a mesh.
pub const TOLERANCES: [f32; 6] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// What each of [`TOLERANCES`] would join and collapse, in their order. `exact` is the mesh's topology without a tolerance, where
/// there is one already. Of the welded meshes no edges are made
/// but those that were open; `progress` goes from 0 to 1 meanwhile.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub fn joins(mesh: &Mesh, exact: Option<&Topology>, progress: &Progress) -> Result<Vec<Joins>, Cancelled> {
    progress.set(0.0);
    progress.check()?;
    let exact = match exact {
        Some(exact) => Exact::of(exact),
        // Gone before anything is welded.
        None => Exact::of(&Topology::build(mesh, progress)?),
    };
    let mut joins = Vec::with_capacity(TOLERANCES.len());
    for tolerance in TOLERANCES {
        let part = (joins.len() + 1) as f32 / (TOLERANCES.len() + 1) as f32;
        progress.set(part);
        progress.check()?;
        let (_, corner_points) = weld_corners(mesh, tolerance);
        progress.check()?;
        let [edges, collapsed] = exact.welded(mesh, &corner_points);
        joins.push(Joins { tolerance, edges, collapsed });
    }
    progress.set(1.0);
    Ok(joins)
}

/// What is asked of the exact topology.
struct Exact {
    /// Boundary edges: a triangle, and which of its sides.
    open: Vec<(u32, u8)>,
    degenerate: u32,
}

impl Exact {
    fn of(topology: &Topology) -> Self {
        let open = topology.edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary);
        let open = open.map(|edge| {
            let side = topology.sides[edge.first_side as usize];
            (topology.patches[side.patch() as usize].triangle, side.index() as u8)
        });
        Self { open: open.collect(), degenerate: topology.degenerate }
    }

    /// How many boundary edges share theirs where corners lie on these points, and how many triangles collapse.
    fn welded(&self, mesh: &Mesh, corner_points: &[u32]) -> [u32; 2] {
        let points = |triangle: &[u32; 3]| triangle.map(|corner| corner_points[corner as usize]);
        // By its points, the lower first: how many sides an edge has that some boundary edge becomes.
        let key = |points: [u32; 3], side: usize| {
            let [a, b] = [points[side], points[(side + 1) % 3]];
            [a.min(b), a.max(b)]
        };
        let own = |&(triangle, side): &(u32, u8)| {
            let points = points(&mesh.triangles[triangle as usize]);
            (!is_degenerate(points)).then(|| key(points, side.into()))
        };
        let mut sides: HashMap<[u32; 2], u32, RandomState> =
            self.open.iter().filter_map(own).map(|key| (key, 0)).collect();
        let mut degenerate = 0;
        for points in mesh.triangles.iter().map(points) {
            if is_degenerate(points) {
                degenerate += 1;
                continue;
            }
            for side in 0..3 {
                if let Some(count) = sides.get_mut(&key(points, side)) {
                    *count += 1;
                }
            }
        }
        let shared = self.open.iter().filter_map(own).filter(|key| sides[key] > 1);
        [shared.count() as u32, degenerate - self.degenerate]
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::mesh::Corner;
    use crate::mesh::shapes::Shape;

    /// Triangles with corners of their own.
    fn soup(triangles: &[[[f32; 2]; 3]]) -> Mesh {
        let corner = |&[x, y]: &[f32; 2]| Corner { position: Vec3::new(x, y, 0.0), normal: Vec3::Z, uv: Vec2::ZERO };
        let corners = triangles.as_flattened().iter().map(corner).collect();
        let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>().into();
        Mesh { corners, triangles, ..Mesh::default() }
    }

    fn counts(mesh: &Mesh) -> Vec<[u32; 2]> {
        let joins = joins(mesh, None, &Progress::new()).unwrap();
        assert!(joins.iter().map(|join| join.tolerance).eq(TOLERANCES));
        let exact = Topology::build(mesh, &Progress::new()).unwrap();
        assert_eq!(joins, super::joins(mesh, Some(&exact), &Progress::new()).unwrap());
        joins.iter().map(|join| [join.edges, join.collapsed]).collect()
    }

    #[test]
    fn a_gap_joins_from_the_first_tolerance_that_spans_it() {
        // A square of diagonal 1.41 in two halves, 1e-4 apart.
        let gap = 1e-4;
        let mesh = soup(&[[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[0.0, gap], [1.0, 1.0 + gap], [0.0, 1.0]]]);
        assert_eq!(counts(&mesh), [[0, 0], [0, 0], [0, 0], [2, 0], [2, 0], [2, 0]]);
    }

    #[test]
    fn what_collapses_is_not_joined() {
        // A sliver 1e-3 wide and 1e-4 too high between two halves: it joins both, then vanishes, and they meet.
        let (w, gap) = (1e-3, 1e-4);
        let mesh = soup(&[
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            [[1.0, gap], [1.0 + w, gap], [0.0, 1.0 + gap]],
            [[1.0 + w, 0.0], [1.0, 1.0], [0.0, 1.0]],
        ]);
        assert_eq!(counts(&mesh), [[0, 0], [0, 0], [0, 0], [4, 0], [2, 1], [2, 1]]);
    }

    #[test]
    fn duplicates_and_closed_edges_are_joined_already() {
        let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(counts(&soup(&[triangle, triangle])), [[0, 0]; 6]);
        assert_eq!(counts(&Shape::Torus.build()), [[0, 0]; 6]);
        assert_eq!(counts(&Shape::Moebius.build()), [[0, 0]; 6], "its boundary is nowhere near itself");
        assert_eq!(counts(&Mesh::default()), [[0, 0]; 6]);
    }

    #[test]
    fn triangles_on_one_point_were_degenerate_before() {
        let point = [[0.5, 0.5]; 3];
        assert_eq!(counts(&soup(&[point, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], point])), [[0, 0]; 6]);
    }

    #[test]
    fn they_are_told_in_words() {
        let words = |edges, collapsed| Joins { tolerance: 1e-5, edges, collapsed }.to_string();
        assert_eq!(words(0, 0), "joins nothing");
        assert_eq!(words(12, 0), "joins 12 edges");
        assert_eq!(words(0, 3), "joins 0 edges, collapses 3 triangles");
    }

    #[test]
    fn a_cancel_is_heard() {
        let progress = Progress::new();
        progress.cancel();
        assert_eq!(joins(&Shape::Torus.build(), None, &progress), Err(Cancelled));
    }
}
