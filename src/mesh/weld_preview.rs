//! What welding within various tolerances would change, for choosing one.

use std::collections::HashMap;
use std::fmt;

use foldhash::fast::RandomState;
use serde::Serialize;

use super::Mesh;
use super::topology::{EdgeKind, Topology, is_degenerate, weld_corners};
use crate::progress::{Cancelled, Progress};

/// What welding within a tolerance changes, compared with the exact weld.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WeldPreview {
    /// The tolerance, relative to the bounding diagonal.
    pub tolerance: f32,
    /// Boundary edges of the exact topology that the weld connects to another: afterwards their side belongs to an edge
    /// with two sides or more. Edges of triangles that collapse don't count.
    pub edges: u32,
    /// Triangles that are patches of the exact topology and degenerate after the weld.
    pub collapsed: u32,
}

impl fmt::Display for WeldPreview {
    /// Writes the changes as text, without the tolerance.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self.edges, self.collapsed) {
            (0, 0) => write!(f, "joins nothing"),
            (edges, 0) => write!(f, "joins {edges} edges"),
            (edges, collapsed) => write!(f, "joins {edges} edges, collapses {collapsed} triangles"),
        }
    }
}

/// The tolerances to try, relative to the bounding diagonal: from the rounding of f32 to distances that visibly change
/// a mesh.
pub(crate) const TOLERANCES: [f32; 6] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// Returns how many edges a weld within each of [`TOLERANCES`] would join, and how many triangles it would collapse, in
/// their order. `exact` is the mesh's topology without a tolerance, if the caller has it. To save time and memory, no
/// topology is built for the welded meshes: only the edges that were open are looked up in them. `progress` goes from 0
/// to 1.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub fn weld_previews(
    mesh: &Mesh,
    exact: Option<&Topology>,
    progress: &Progress,
) -> Result<Vec<WeldPreview>, Cancelled> {
    progress.set(0.0);
    progress.check()?;
    let exact = match exact {
        Some(exact) => Exact::of(exact),
        // This topology is freed before anything is welded.
        None => Exact::of(&Topology::build(mesh, progress)?),
    };
    let mut previews = Vec::with_capacity(TOLERANCES.len());
    for tolerance in TOLERANCES {
        let part = (previews.len() + 1) as f32 / (TOLERANCES.len() + 1) as f32;
        progress.set(part);
        progress.check()?;
        let (_, corner_points) = weld_corners(mesh, tolerance);
        progress.check()?;
        let [edges, collapsed] = exact.welded(mesh, &corner_points);
        previews.push(WeldPreview { tolerance, edges, collapsed });
    }
    progress.set(1.0);
    Ok(previews)
}

/// The facts about the exact topology that the welded meshes are compared with.
struct Exact {
    /// Boundary edges: the triangle, and which of its sides.
    open: Vec<(u32, u8)>,
    /// The number of degenerate triangles.
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

    /// Returns how many boundary edges are joined, and how many triangles collapse, if corners lie on these points.
    fn welded(&self, mesh: &Mesh, corner_points: &[u32]) -> [u32; 2] {
        let points = |triangle: &[u32; 3]| triangle.map(|corner| corner_points[corner as usize]);
        // For each edge that a boundary edge becomes, given by its points (the lower first), the number of its sides.
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

    /// Triangles that share no corners.
    fn soup(triangles: &[[[f32; 2]; 3]]) -> Mesh {
        let corner = |&[x, y]: &[f32; 2]| Corner { position: Vec3::new(x, y, 0.0), normal: Vec3::Z, uv: Vec2::ZERO };
        let corners = triangles.as_flattened().iter().map(corner).collect();
        let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>().into();
        Mesh { corners, triangles, ..Mesh::default() }
    }

    fn counts(mesh: &Mesh) -> Vec<[u32; 2]> {
        let joins = weld_previews(mesh, None, &Progress::new()).unwrap();
        assert!(joins.iter().map(|join| join.tolerance).eq(TOLERANCES));
        let exact = Topology::build(mesh, &Progress::new()).unwrap();
        assert_eq!(joins, super::weld_previews(mesh, Some(&exact), &Progress::new()).unwrap());
        joins.iter().map(|join| [join.edges, join.collapsed]).collect()
    }

    #[test]
    fn a_gap_joins_from_the_first_tolerance_that_spans_it() {
        // The two halves of a square with a diagonal of 1.41, 1e-4 apart.
        let gap = 1e-4;
        let mesh = soup(&[[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[0.0, gap], [1.0, 1.0 + gap], [0.0, 1.0]]]);
        assert_eq!(counts(&mesh), [[0, 0], [0, 0], [0, 0], [2, 0], [2, 0], [2, 0]]);
    }

    #[test]
    fn what_collapses_is_not_joined() {
        // A sliver, 1e-3 wide and 1e-4 too high, between two halves. First a weld joins it to both; with a larger
        // tolerance it collapses and the halves meet.
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
    fn previews_are_written_as_text() {
        let words = |edges, collapsed| WeldPreview { tolerance: 1e-5, edges, collapsed }.to_string();
        assert_eq!(words(0, 0), "joins nothing");
        assert_eq!(words(12, 0), "joins 12 edges");
        assert_eq!(words(0, 3), "joins 0 edges, collapses 3 triangles");
    }

    #[test]
    fn cancelling_stops_the_work() {
        let progress = Progress::new();
        progress.cancel();
        assert_eq!(weld_previews(&Shape::Torus.build(), None, &progress), Err(Cancelled));
    }
}
