//! Triangles that cross each other.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::farthest::Soup;
use super::triangle_tree::TriangleTree;
use crate::casts::to_u32;
use crate::progress::{Cancelled, Progress};

/// The number of triangles that a thread takes at once.
const BLOCK: usize = 512;

/// The rounding of a determinant of differences of f32 numbers, as a part of the product of their lengths: some units in the last
/// place of f64. One that is nearer to 0 has no certain sign.
const ROUNDING: f64 = 1e-14;

/// Two triangles that cross, and a point of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The lower index first.
    pub triangles: [u32; 2],
    pub at: DVec3,
}

/// Returns the pairs of triangles that cross for certain: an edge of one goes through the inside of the other. Triangles that
/// share a position, lie in one plane, or only touch aren't among them. Positions must be finite.
///
/// # Errors
/// `progress` was cancelled.
pub fn crossings(soup: Soup, progress: &Progress) -> Result<Vec<Crossing>, Cancelled> {
    let corners = |triangle: u32| soup.triangles[triangle as usize].map(|corner| soup.positions[corner as usize]);
    let Some(tree) = TriangleTree::new((0..to_u32(soup.triangles.len())).map(corners)) else { return Ok(Vec::new()) };
    let found = soup.triangles.par_chunks(BLOCK).enumerate().map(|(block, triangles)| {
        progress.check()?;
        let mut found = Vec::new();
        for triangle in to_u32(block * BLOCK)..to_u32(block * BLOCK + triangles.len()) {
            let own = corners(triangle);
            tree.overlapping(own, |other| {
                if triangle < other
                    && let Some(at) = cross(own, corners(other))
                {
                    found.push(Crossing { triangles: [triangle, other], at });
                }
            });
        }
        // The tree's order depends on nothing but the triangles, but is no order for readers.
        found.sort_unstable_by_key(|crossing| crossing.triangles);
        Ok(found)
    });
    Ok(found.collect::<Result<Vec<_>, _>>()?.concat())
}

/// Returns where an edge of one triangle goes through the inside of the other, if one does for certain.
pub fn cross(a: [Vec3; 3], b: [Vec3; 3]) -> Option<DVec3> {
    if a.iter().any(|corner| b.contains(corner)) {
        return None;
    }
    let [a, b] = [a, b].map(|triangle| triangle.map(Vec3::as_dvec3));
    let through =
        |edges: [DVec3; 3], triangle| (0..3).find_map(|i| goes_through([edges[i], edges[(i + 1) % 3]], triangle));
    through(a, b).or_else(|| through(b, a))
}

/// Returns where a segment goes through the inside of a triangle, if it does for certain: its ends lie on both sides of the
/// triangle's plane, and it passes all edges on the same side.
fn goes_through([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let [above, below] = [volume(a, b, c, p), volume(a, b, c, q)];
    if above * below >= 0.0 {
        return None;
    }
    let passed = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    let is_inside = passed.iter().all(|side| *side > 0.0) || passed.iter().all(|side| *side < 0.0);
    is_inside.then(|| p.lerp(q, above / (above - below)))
}

/// Six times the volume of a tetrahedron, with its sign; 0 if rounding hides that.
fn volume(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [x, y, z] = [a - d, b - d, c - d];
    let volume = x.dot(y.cross(z));
    let least = ROUNDING * x.length() * y.length() * z.length();
    if volume.abs() > least { volume } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;

    const FLAT: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Z];

    fn found(triangles: &[[Vec3; 3]]) -> Vec<[u32; 2]> {
        let indices: Vec<[u32; 3]> = (0..to_u32(triangles.len())).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let soup = Soup { positions: triangles.as_flattened(), triangles: &indices };
        let found = crossings(soup, &Progress::new()).unwrap();
        for Crossing { triangles: pair, at } in &found {
            for triangle in pair.map(|triangle| triangles[triangle as usize].map(Vec3::as_dvec3)) {
                assert!(super::super::closest_on_triangle(triangle, *at).1.distance(*at) < 1e-12, "{pair:?}: {at}");
            }
        }
        found.iter().map(|crossing| crossing.triangles).collect()
    }

    #[test]
    fn what_goes_through_crosses_and_what_touches_does_not() {
        let needle = [vec3(0.2, -1.0, 0.2), vec3(0.2, 1.0, 0.2), vec3(5.0, 5.0, 5.0)];
        assert_eq!(found(&[FLAT, needle]), [[0, 1]]);
        let apart = needle.map(|corner| corner + vec3(0.9, 0.0, 0.9));
        let above = FLAT.map(|corner| corner + Vec3::Y * 1e-6);
        let on_it = [vec3(0.2, 0.0, 0.2), vec3(0.2, 1.0, 0.2), vec3(0.3, 1.0, 0.2)];
        let in_its_plane = FLAT.map(|corner| corner + vec3(0.1, 0.0, 0.1));
        for other in [apart, above, on_it, in_its_plane, FLAT] {
            assert!(found(&[FLAT, other]).is_empty(), "{other:?}");
        }
        // A fin that shares an edge, and one that shares a corner and goes through all the same, are neighbours.
        assert!(found(&[FLAT, [Vec3::ZERO, Vec3::X, vec3(0.3, -1.0, 0.3)]]).is_empty());
        assert!(found(&[FLAT, [Vec3::ZERO, vec3(0.6, 0.5, 0.6), vec3(0.6, -0.5, 0.6)]]).is_empty());
    }

    #[test]
    fn pairs_are_those_of_a_search_through_all() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut corner = |spread: f32| vec3(random.f32(), random.f32(), random.f32()) * spread;
        let triangles: Vec<[Vec3; 3]> = (0..700).map(|_| [corner(1.0); 3].map(|at| at + corner(0.3))).collect();
        let mut all = Vec::new();
        for i in 0..triangles.len() {
            for j in i + 1..triangles.len() {
                if cross(triangles[i], triangles[j]).is_some() {
                    all.push([i as u32, j as u32]);
                }
            }
        }
        assert!(all.len() > 500, "{}", all.len());
        assert_eq!(found(&triangles), all);
    }

    #[test]
    fn closed_surfaces_do_not_cross_themselves() {
        for shape in [crate::mesh::Shape::Torus, crate::mesh::Shape::Icosphere, crate::mesh::Shape::CubeSplit] {
            let mesh = shape.build_at(2);
            let positions: Vec<Vec3> = mesh.corners.iter().map(|corner| corner.position).collect();
            let soup = Soup { positions: &positions, triangles: &mesh.triangles };
            assert!(crossings(soup, &Progress::new()).unwrap().is_empty(), "{shape}");
        }
    }
}
