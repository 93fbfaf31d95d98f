//! Normals for corners that a file gives none.

use glam::Vec3;

use super::weld;

/// Faces whose normals are further apart than this don't smooth each other: 60 degrees.
const SMOOTH_COSINE: f32 = 0.5;

/// One normal a corner, three a triangle: the mean of the normals of all faces that meet at the corner's point and lie
/// within 60 degrees of the corner's own face, each weighted by its angle there. Unit length; corners of faces without
/// area take what their neighbours give, or +Y.
///
/// Linear in triangles, but quadratic in the triangles that meet at one point.
pub fn smooth_normals(triangles: &[[Vec3; 3]]) -> Vec<[Vec3; 3]> {
    let welded = weld(triangles.iter().flatten().copied());
    let faces: Vec<Vec3> = triangles.iter().map(face_normal).collect();
    let (starts, corners) = corners_by_point(&welded.point_of, welded.points.len());
    let normal = |corner: usize| {
        let own = faces[corner / 3];
        let point = welded.point_of[corner] as usize;
        let around = &corners[starts[point] as usize..starts[point + 1] as usize];
        let weighted = around.iter().map(|&other| {
            let (face, k) = (other as usize / 3, other as usize % 3);
            let near = own == Vec3::ZERO || faces[face].dot(own) >= SMOOTH_COSINE;
            if near { faces[face] * angle(&triangles[face], k) } else { Vec3::ZERO }
        });
        weighted.sum::<Vec3>().try_normalize().unwrap_or_else(|| own.normalize_or(Vec3::Y))
    };
    (0..triangles.len()).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(normal)).collect()
}

/// Unit normal of a counter-clockwise triangle; zero if it has no area.
pub fn face_normal(&[a, b, c]: &[Vec3; 3]) -> Vec3 {
    // Scaled first, so that tiny triangles don't underflow.
    let (x, y) = (b - a, c - a);
    let scale = x.abs().max_element().max(y.abs().max_element());
    if scale > 0.0 && scale.is_finite() { (x / scale).cross(y / scale).normalize_or_zero() } else { Vec3::ZERO }
}

/// The triangle's angle at corner k, in radians.
fn angle(triangle: &[Vec3; 3], k: usize) -> f32 {
    let at = triangle[k];
    let to = |other: usize| (triangle[other % 3] - at).normalize_or_zero();
    to(k + 1).dot(to(k + 2)).clamp(-1.0, 1.0).acos()
}

/// Corners grouped by their point: those of point p are `corners[starts[p]..starts[p + 1]]`.
fn corners_by_point(point_of: &[u32], points: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; points + 1];
    for &point in point_of {
        starts[point as usize + 1] += 1;
    }
    for point in 0..points {
        starts[point + 1] += starts[point];
    }
    let mut next = starts.clone();
    let mut corners = vec![0; point_of.len()];
    for (corner, &point) in point_of.iter().enumerate() {
        corners[next[point as usize] as usize] = corner as u32;
        next[point as usize] += 1;
    }
    (starts, corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

    fn positions(shape: Shape) -> Vec<[Vec3; 3]> {
        let mesh = shape.build();
        mesh.triangles.iter().map(|t| t.map(|corner| mesh.corners[corner as usize].position)).collect()
    }

    #[test]
    fn a_cube_keeps_its_edges() {
        let triangles = positions(Shape::CubeSmooth);
        for (triangle, normals) in triangles.iter().zip(smooth_normals(&triangles)) {
            for normal in normals {
                assert!(normal.distance(face_normal(triangle)) < 1e-6);
            }
        }
    }

    #[test]
    fn a_sphere_becomes_smooth() {
        let triangles = positions(Shape::Icosphere);
        for (triangle, normals) in triangles.iter().zip(smooth_normals(&triangles)) {
            for (position, normal) in triangle.iter().zip(normals) {
                assert!(position.normalize().dot(normal) > 0.995);
            }
        }
    }

    #[test]
    fn a_face_is_weighted_by_its_angle_not_by_how_it_is_cut() {
        // Two faces at 45 degrees along x; the second is cut into two triangles at the origin.
        let up = Vec3::new(0.0, 1.0, 1.0);
        let whole = [[Vec3::ZERO, -Vec3::Z, Vec3::X], [Vec3::ZERO, Vec3::X, up]];
        let middle = Vec3::X.lerp(up, 0.3);
        let cut = [whole[0], [Vec3::ZERO, Vec3::X, middle], [Vec3::ZERO, middle, up]];
        let (a, b) = (smooth_normals(&whole)[0][0], smooth_normals(&cut)[0][0]);
        assert!(a.distance(b) < 1e-6, "{a} {b}");
        assert!(a.distance(face_normal(&whole[0])) > 0.1, "the faces smooth each other");
    }

    #[test]
    fn faces_without_area_give_no_nan() {
        let flat =
            [[Vec3::ZERO, Vec3::X, Vec3::X * 2.0], [Vec3::ZERO; 3], [Vec3::ZERO, Vec3::Z * 1e-30, Vec3::X * 1e-30]];
        let normals = smooth_normals(&flat);
        assert!(normals.iter().flatten().all(|normal| (normal.length() - 1.0).abs() < 1e-5), "{normals:?}");
    }
}
