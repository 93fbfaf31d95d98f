//! Makes normals where a file has none but says where its surface is smooth: at edges, or on polygons.

use std::collections::HashMap;

use foldhash::fast::FixedState;
use glam::{DVec3, Vec3};
use ufbx::Mesh;

use super::convert::vec3;
use crate::memory_budget::Budget;
use crate::read_error::ReadError;
use geometry::casts::to_u32;
use geometry::mesh::union_find::UnionFind;

/// Memory for each corner, in bytes: its side in the table, whose room is up to twice as large, its set, and two normals.
const PER_CORNER: u64 = 96;

/// An edge, as its vertices in ascending order.
type Vertices = [u32; 2];

/// A polygon's side: its corners at the edge's first and second vertex, and the polygon.
type Side = ([u32; 2], usize);

/// Returns a normal for each corner of a mesh: of all polygons around its vertex that are joined by smooth edges the sum of
/// normals, each as long as the polygon is large. Returns none if the file says nothing about smoothness.
///
/// # Errors
/// [`ReadError::TooLarge`].
pub(super) fn normals(mesh: &Mesh, budget: &Budget) -> Result<Option<Vec<Vec3>>, ReadError> {
    if mesh.edge_smoothing.is_empty() && mesh.face_smoothing.is_empty() {
        return Ok(None);
    }
    budget.borrow(PER_CORNER * mesh.num_indices as u64)?;
    // The edges that the file calls smooth.
    let smooth = mesh.edges.iter().zip(mesh.edge_smoothing.iter()).filter(|(_, is_smooth)| **is_smooth);
    let smooth = smooth.filter_map(|(edge, _)| Some((sorted(mesh, [edge.a, edge.b])?.0, ())));
    let smooth: HashMap<Vertices, (), FixedState> = smooth.collect();
    let sets = UnionFind::new(mesh.num_indices);
    let mut sides: HashMap<Vertices, Side, FixedState> = HashMap::default();
    for (i, face) in mesh.faces.iter().enumerate() {
        let (first, count) = (face.index_begin, face.num_indices);
        for k in 0..count {
            let corners = [first + k, first + (k + 1) % count];
            let Some((edge, corners)) = sorted(mesh, corners) else { continue };
            let Some((others, other)) = sides.insert(edge, (corners, i)) else { continue };
            // Two polygons that are smooth meet in a smooth edge.
            let by_faces = [i, other].iter().all(|&face| mesh.face_smoothing.get(face) == Some(&true));
            if by_faces || smooth.contains_key(&edge) {
                corners.into_iter().zip(others).for_each(|(a, b)| sets.join(a, b));
            }
        }
    }
    Ok(Some(summed(mesh, &sets)))
}

/// Returns the edge between two corners, and the corners in the order of its vertices.
fn sorted(mesh: &Mesh, [a, b]: [u32; 2]) -> Option<(Vertices, [u32; 2])> {
    let vertex = |corner: u32| mesh.vertex_indices.get(corner as usize).copied();
    let (from, to) = (vertex(a)?, vertex(b)?);
    Some(if from < to { ([from, to], [a, b]) } else { ([to, from], [b, a]) })
}

/// Returns for each corner the sum over its set.
fn summed(mesh: &Mesh, sets: &UnionFind) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; mesh.num_indices];
    let corners = |face: &ufbx::Face| (face.index_begin..).take(face.num_indices as usize);
    for face in &mesh.faces {
        let normal = area_vector(mesh, corners(face));
        for corner in corners(face) {
            sums[sets.of(corner) as usize] += normal;
        }
    }
    (0..to_u32(mesh.num_indices)).map(|corner| sums[sets.of(corner) as usize].normalize_or_zero().as_vec3()).collect()
}

/// Returns a polygon's normal, twice as long as its area is large (Newell's method: Sutherland, Sproull and Schumacker 1974).
fn area_vector(mesh: &Mesh, corners: impl Iterator<Item = u32> + Clone) -> DVec3 {
    let at = |corner: u32| {
        let vertex = mesh.vertex_indices.get(corner as usize)?;
        mesh.vertices.get(*vertex as usize).map(vec3)
    };
    let Some(origin) = corners.clone().next().and_then(at) else { return DVec3::ZERO };
    let around = corners.filter_map(at).map(|position| position - origin);
    let next = around.clone().skip(1);
    around.zip(next).map(|(a, b)| a.cross(b)).sum()
}
