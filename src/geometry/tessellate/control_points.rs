//! Control points of cubic patches, computed from the positions and normals at the ends of their edges. Twin:
//! `shaders/control_points.wgsl`.
//!
//! Every surface is a cubic control net, so that one evaluation, one error bound and one clipping test serve all of
//! them. Phong tessellation and Nagata's patch are quadratic: an edge has one control point in the middle, which is
//! degree-elevated to two cubic ones without changing the curve. [`center_control_point`] reproduces quadratic patches
//! exactly, so it gives the centre of these nets too.

use glam::Vec3;

use super::{Surface, SurfaceFamily};

/// Two unit normals count as parallel or opposite if the squared length of their cross product is at most this: the
/// squared sine of 0.1 degrees. Below it, rounding would decide in which line their tangent planes intersect.
pub const PARALLEL: f32 = 3.046e-6;

/// Returns the control point near `a` of a PN triangle's edge: the point one third of the way from `a` to `b`,
/// projected into the tangent plane at `a` (Vlachos et al. 2001, section 3.1: b210 = (2 P1 + P2 - w12 N1) / 3).
/// `normal` is the unit normal at `a`.
pub(crate) fn edge_control_point(a: Vec3, b: Vec3, normal: Vec3) -> Vec3 {
    (a * 2.0 + b - normal * (b - a).dot(normal)) * (1.0 / 3.0)
}

/// Returns the control point near `a` of a straight edge: the point one third of the way from `a` to `b`.
pub fn straight_control_point(a: Vec3, b: Vec3) -> Vec3 {
    (a * 2.0 + b) * (1.0 / 3.0)
}

/// Returns the middle control point of a quadratic edge of Phong tessellation (Boubekeur and Alexa 2008, equations 2 to
/// 4). `at_a` and `at_b` are the unit normals at the ends.
///
/// Each end is projected into the tangent plane at the other end. The control point lies `alpha` (0 to 1) of the way
/// from the middle of the edge to the mean of both projections.
pub(crate) fn phong_control_point(alpha: f32, a: Vec3, b: Vec3, at_a: Vec3, at_b: Vec3) -> Vec3 {
    let along = b - a;
    let back = at_a * along.dot(at_a) - at_b * along.dot(at_b);
    (a + b - back * alpha) * 0.5
}

/// Returns the middle control point of a quadratic edge of Nagata's patch (Nagata 2005). `at_a` and `at_b` are the unit
/// normals at the ends. Where they are parallel or opposite, the edge is straight.
///
/// The edge is the curve a + (d - c) t + c t t with d = b - a, where c is the shortest vector that makes the curve
/// perpendicular to both normals. Half the sum s and half the difference h of the normals are perpendicular to each
/// other, so c = (d.h / s.s) s + (d.s / h.h) h. The code divides by the lengths of s and h twice and never by their
/// squares: a large number divided by so small a square would overflow. Where the normals are nearly parallel and both
/// lean along the edge, c is many times as long as the edge. This is a property of Nagata's method.
pub(crate) fn nagata_control_point(a: Vec3, b: Vec3, at_a: Vec3, at_b: Vec3) -> Vec3 {
    let line = at_a.cross(at_b);
    if line.dot(line) <= PARALLEL {
        return (a + b) * 0.5;
    }
    let along = b - a;
    let sum = (at_a + at_b) * 0.5;
    let difference = (at_a - at_b) * 0.5;
    let (long, short) = (sum.length(), difference.length());
    let curvature = sum / long * (along.dot(difference) / long) + difference / short * (along.dot(sum) / short);
    (a + b - curvature) * 0.5
}

/// Returns the cubic control point near `a` of a quadratic edge whose middle control point is `middle`, by degree
/// elevation.
pub(super) fn elevated_control_point(a: Vec3, middle: Vec3) -> Vec3 {
    (a + middle * 2.0) * (1.0 / 3.0)
}

/// Returns the control points near `a` and near `b` that one side of an edge proposes. `at_a` and `at_b` are the side's
/// own unit normals at the ends; `alpha` is the strength of Phong tessellation, which other surfaces ignore.
pub(crate) fn side_control_points(surface: Surface, alpha: f32, a: Vec3, b: Vec3, at_a: Vec3, at_b: Vec3) -> [Vec3; 2] {
    let elevated = |middle| [elevated_control_point(a, middle), elevated_control_point(b, middle)];
    match surface.family() {
        SurfaceFamily::Flat => [straight_control_point(a, b), straight_control_point(b, a)],
        SurfaceFamily::Pn => [edge_control_point(a, b, at_a), edge_control_point(b, a, at_b)],
        SurfaceFamily::Phong => elevated(phong_control_point(alpha, a, b, at_a, at_b)),
        SurfaceFamily::Nagata => elevated(nagata_control_point(a, b, at_a, at_b)),
    }
}

/// The distinct normals that the sides of an edge have at one of its ends. Only the first two are stored.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DistinctNormals {
    pub first: Vec3,
    pub second: Vec3,
    /// The number of distinct normals: 0, 1, 2, or 3 for three or more.
    pub count: u32,
}

/// Adds the normal of one more side.
pub(crate) fn add_normal(distinct: DistinctNormals, normal: Vec3) -> DistinctNormals {
    if distinct.count == 0 {
        return DistinctNormals { first: normal, second: normal, count: 1 };
    }
    if normal == distinct.first || normal == distinct.second {
        return distinct;
    }
    if distinct.count == 1 {
        return DistinctNormals { second: normal, count: 2, ..distinct };
    }
    DistinctNormals { count: 3, ..distinct }
}

/// Returns the control point near `a` of an edge on which two surfaces meet at a crease: the control point of a
/// straight edge, projected onto the line in which the two tangent planes at `a` intersect (Vlachos et al. 2001,
/// section 3.4). `mean` is the mean of all sides' proposals; it is returned if the planes are parallel or if there are
/// not two of them.
pub(crate) fn crease_control_point(a: Vec3, b: Vec3, distinct: DistinctNormals, mean: Vec3) -> Vec3 {
    let line = distinct.first.cross(distinct.second);
    let length_squared = line.dot(line);
    if distinct.count != 2 || length_squared <= PARALLEL {
        return mean;
    }
    // The square of a short line's length is too small to divide by: large edges would overflow.
    let direction = line / length_squared.sqrt();
    a + direction * ((b - a).dot(direction) * (1.0 / 3.0))
}

/// Returns the control point b111 of a net with these corners and six edge control points: E + (E - V) / 2, where E is
/// the mean of the edge control points and V is the mean of the corners (Vlachos et al. 2001, section 3.1).
pub fn center_control_point(corners: [Vec3; 3], edges: [Vec3; 6]) -> Vec3 {
    let e = (edges[0] + edges[1] + edges[2] + edges[3] + edges[4] + edges[5]) * (1.0 / 6.0);
    let v = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    e + (e - v) * 0.5
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3, Vec2, vec2, vec3};
    use proptest::prelude::*;

    use super::*;
    use crate::tessellate::{ControlNet, FIXED_ONE, patch_position};

    /// Two points in general position, then the unit normals at them.
    const ENDS: [Vec3; 4] = [vec3(1.0, 2.0, 3.0), vec3(4.0, 0.0, 5.0), vec3(0.6, 0.0, 0.8), vec3(0.36, 0.48, 0.8)];

    #[test]
    fn normals_that_sides_share_count_once() {
        let count = |normals: &[Vec3]| normals.iter().fold(DistinctNormals::default(), |a, &b| add_normal(a, b)).count;
        let [x, y, z] = Vec3::AXES;
        assert_eq!([count(&[]), count(&[x, x]), count(&[x, y, x, y]), count(&[x, y, y, z])], [0, 1, 2, 3]);
    }

    #[test]
    fn control_points_are_those_of_the_paper() {
        // Vlachos et al. 2001, section 3.1, by hand in f64: w12 = (P2 - P1) . N1, b210 = (2 P1 + P2 - w12 N1) / 3.
        let [a, b, n, _] = ENDS;
        let w = 3.0 * 0.6 + 2.0 * 0.8;
        let expected = [(2.0 + 4.0 - w * 0.6) / 3.0, 4.0 / 3.0, (6.0 + 5.0 - w * 0.8) / 3.0];
        assert!(edge_control_point(a, b, n).distance(Vec3::from(expected)) < 1e-6);
        // A control point lies in the tangent plane at its corner.
        assert!((edge_control_point(a, b, n) - a).dot(n).abs() < 1e-6);
    }

    #[test]
    fn phong_edges_are_those_of_the_paper() {
        // Boubekeur and Alexa 2008: p* = (1 - alpha) p + alpha (x pi_a(p) + y pi_b(p)), pi_i(q) = q - ((q - p_i) . n_i) n_i.
        let [a, b, at_a, at_b] = ENDS.map(Vec3::as_dvec3);
        for alpha in [0.0, 0.5, 0.75, 1.0] {
            let middle = phong_control_point(alpha as f32, ENDS[0], ENDS[1], ENDS[2], ENDS[3]).as_dvec3();
            for y in [0.0, 0.125, 0.5, 0.8] {
                let x = 1.0 - y;
                let p = a * x + b * y;
                let onto = |at: DVec3, n: DVec3| p - n * (p - at).dot(n);
                let expected = p * (1.0 - alpha) + (onto(a, at_a) * x + onto(b, at_b) * y) * alpha;
                let own = a * (x * x) + middle * (2.0 * x * y) + b * (y * y);
                assert!(own.distance(expected) < 1e-6, "{alpha} {y}");
            }
        }
        // By hand: the edge's middle is (2.5, 1, 4), (P2 - P1) . N is 3.4 and 1.72, so that 3/8 of
        // 3.4 N1 - 1.72 N2 = (1.4208, -0.8256, 1.344) comes off.
        let expected = vec3(2.5 - 0.5328, 1.0 + 0.3096, 4.0 - 0.504);
        assert!(phong_control_point(0.75, ENDS[0], ENDS[1], ENDS[2], ENDS[3]).distance(expected) < 1e-6);
    }

    #[test]
    fn phong_patches_are_those_of_the_paper_inside_too() {
        let corners = [vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.5), vec3(0.5, 1.5, 0.0)];
        let normals = [vec3(-0.3, -0.3, 1.0), vec3(0.4, 0.0, 1.0), vec3(0.0, 0.5, 1.0)].map(Vec3::normalize);
        let net = net(Surface::Phong, corners, normals);
        for (u, v) in [(20000, 30000), (5000, 1000), (21845, 21845)] {
            let weights = [u, v, FIXED_ONE - u - v].map(|x| f64::from(x) / 65536.0);
            let p: DVec3 = (0..3).map(|i| corners[i].as_dvec3() * weights[i]).sum();
            let onto = |i: usize| {
                let n = normals[i].as_dvec3();
                p - n * (p - corners[i].as_dvec3()).dot(n)
            };
            let expected = p * 0.25 + (0..3).map(|i| onto(i) * weights[i]).sum::<DVec3>() * 0.75;
            assert!(patch_position(Surface::Phong, &net, u, v).as_dvec3().distance(expected) < 1e-6);
        }
    }

    /// Returns the control net of a patch without neighbours.
    fn net(surface: Surface, corners: [Vec3; 3], normals: [Vec3; 3]) -> ControlNet {
        let side = |k: usize| {
            let (a, b) = (k, (k + 1) % 3);
            side_control_points(surface, 0.75, corners[a], corners[b], normals[a], normals[b])
        };
        let edges = [side(0), side(1), side(2)].as_flattened().try_into().expect("six");
        ControlNet { corners, edges, center: center_control_point(corners, edges) }
    }

    /// Returns Nagata's c (2005), the shortest solution of n0 . c = n0 . d and n1 . c = -n1 . d, by the generalised
    /// inverse.
    fn curvature(d: DVec3, n0: DVec3, n1: DVec3) -> DVec3 {
        let cosine = n0.dot(n1);
        let (x, y) = (n0.dot(d), -n1.dot(d));
        let determinant = 1.0 - cosine * cosine;
        (n0 * (x - cosine * y) + n1 * (y - cosine * x)) / determinant
    }

    #[test]
    fn nagata_edges_are_those_of_the_paper() {
        let [a, b, at_a, at_b] = ENDS;
        let middle = nagata_control_point(a, b, at_a, at_b).as_dvec3();
        let [a, b, at_a, at_b] = ENDS.map(Vec3::as_dvec3);
        let expected = (a + b - curvature(b - a, at_a, at_b)) / 2.0;
        assert!(middle.distance(expected) < 1e-5, "{middle} {expected}");
        // Its ends' tangents are perpendicular to the normals there.
        assert!((middle - a).dot(at_a).abs() < 1e-5 && (b - middle).dot(at_b).abs() < 1e-5);
        // c is the shortest solution, so it has no component along the line in which both tangent planes intersect.
        let c = a + b - middle * 2.0;
        assert!(c.dot(at_a.cross(at_b)).abs() < 1e-5);
    }

    #[test]
    fn nagata_patches_are_those_of_the_paper_inside_too() {
        let corners = [vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.5), vec3(0.5, 1.5, 0.0)];
        let normals = [vec3(-0.3, -0.3, 1.0), vec3(0.4, 0.0, 1.0), vec3(0.0, 0.5, 1.0)].map(Vec3::normalize);
        let net = net(Surface::Nagata, corners, normals);
        // Nagata 2005: x(eta, zeta) with coefficients c00 to c02 of the edges' c1 (00-10), c2 (10-11) and c3 (00-11).
        let [x00, x10, x11] = corners.map(Vec3::as_dvec3);
        let [n00, n10, n11] = normals.map(Vec3::as_dvec3);
        let (c1, c2) = (curvature(x10 - x00, n00, n10), curvature(x11 - x10, n10, n11));
        let c3 = curvature(x11 - x00, n00, n11);
        for (u, v) in [(20000_u32, 30000_u32), (5000, 1000), (21845, 21845)] {
            // u = 1 - eta, v = eta - zeta, w = zeta.
            let (eta, zeta) = (1.0 - f64::from(u) / 65536.0, f64::from(FIXED_ONE - u - v) / 65536.0);
            let linear = x00 + (x10 - x00 - c1) * eta + (x11 - x10 + c1 - c3) * zeta;
            let expected = linear + (c3 - c1 - c2) * (eta * zeta) + c1 * (eta * eta) + c2 * (zeta * zeta);
            let own = patch_position(Surface::Nagata, &net, u, v).as_dvec3();
            assert!(own.distance(expected) < 1e-5, "{own} {expected}");
        }
    }

    #[test]
    fn the_nagata_control_point_of_an_arc_is_where_its_end_tangents_meet() {
        // A quarter of a circle. Its normals lie along the radii.
        let middle = nagata_control_point(Vec3::X, Vec3::Y, Vec3::X, Vec3::Y);
        assert!(middle.distance(vec3(1.0, 1.0, 0.0)) < 1e-6);
    }

    #[test]
    fn nagata_edges_are_straight_between_parallel_or_opposite_normals() {
        let (a, b) = (Vec3::ZERO, vec3(2.0, 0.0, 1.0));
        let leaning = |degrees: f32| Vec3::Z.rotate_x(degrees.to_radians());
        for (at_a, at_b) in [(Vec3::Z, Vec3::Z), (Vec3::Z, Vec3::NEG_Z), (Vec3::Z, leaning(0.09))] {
            assert_eq!(nagata_control_point(a, b, at_a, at_b), (a + b) * 0.5);
        }
        assert_ne!(nagata_control_point(a, b, Vec3::Z, leaning(0.2)), (a + b) * 0.5);
    }

    #[test]
    fn a_crease_starts_in_both_tangent_planes() {
        let none = DistinctNormals::default();
        let [a, b, at_a, at_b] = ENDS;
        let distinct = add_normal(add_normal(add_normal(none, at_a), at_a), at_b);
        assert_eq!(distinct.count, 2);
        let own = crease_control_point(a, b, distinct, Vec3::ZERO);
        assert!((own - a).dot(at_a).abs() < 1e-6 && (own - a).dot(at_b).abs() < 1e-6);
        // The projection, by hand in f64.
        let line = at_a.as_dvec3().cross(at_b.as_dvec3()).normalize();
        let expected = a.as_dvec3() + line * ((b - a).as_dvec3().dot(line) / 3.0);
        assert!(own.as_dvec3().distance(expected) < 1e-6);
        // The planes have no common line: one normal, three, two that are nearly parallel, and two that are opposite.
        let mean = vec3(7.0, 8.0, 9.0);
        for normals in [&[at_a, at_a][..], &[at_a, at_b, Vec3::X], &[at_a, at_a + vec3(1e-5, 0.0, 0.0)], &[at_a, -at_a]]
        {
            let distinct = normals.iter().fold(none, |distinct, &normal| add_normal(distinct, normal));
            assert_eq!(crease_control_point(a, b, distinct, mean), mean, "{normals:?}");
        }
    }

    #[test]
    fn creases_of_nearly_parallel_normals_are_found_whatever_the_length_of_the_edge() {
        // The normals are just far enough apart to count as not parallel, so their cross product is short.
        let (at_a, at_b) = (Vec3::Y, vec3(0.0, 0.003f32.cos(), 0.003f32.sin()));
        let distinct = add_normal(add_normal(DistinctNormals::default(), at_a), at_b);
        for size in [1e-36f32, 1.0, 1e37] {
            let own = crease_control_point(Vec3::ZERO, vec3(size, 0.2 * size, 0.0), distinct, Vec3::NAN);
            assert!((own / size).distance(Vec3::X / 3.0) < 1e-6, "{own} of {size}");
        }
    }

    #[test]
    fn nagata_edges_of_nearly_parallel_normals_are_curved_whatever_their_length() {
        // Both normals lean along the edge and are nearly parallel, so c is hundreds of times as long as the edge.
        let leaning = |angle: f32| vec3(angle.sin(), 0.0, angle.cos());
        let (at_a, at_b) = (leaning(0.8), leaning(0.803));
        for size in [1e-33f32, 1.0, 1e34] {
            let own = nagata_control_point(Vec3::ZERO, vec3(0.0, 0.0, size), at_a, at_b) / size;
            // Computed in f64 for an edge of length 1.
            let (p, q) = (at_a.as_dvec3(), at_b.as_dvec3());
            let (sum, difference) = ((p + q) * 0.5, (p - q) * 0.5);
            let curvature =
                sum * (difference.z / sum.length_squared()) + difference * (sum.z / difference.length_squared());
            let expected = (DVec3::Z - curvature) * 0.5;
            assert!(own.as_dvec3().distance(expected) < 1e-5 * expected.length(), "{own} of {size}, not {expected}");
        }
    }

    #[test]
    fn a_patch_reproduces_a_quadratic_paraboloid() {
        // With the paper's E and V, b111 reproduces quadratics: the patch of a paraboloid's own net is the paraboloid.
        let height = |p: Vec2| p.x * p.x + 0.5 * p.y * p.y - p.x * p.y;
        let polar = |p: Vec2, q: Vec2| p.x * q.x + 0.5 * p.y * q.y - 0.5 * (p.x * q.y + p.y * q.x);
        let flat = [vec2(0.0, 0.0), vec2(1.0, 0.2), vec2(0.3, 0.9)];
        let point = |i: usize, j: usize, k: usize| {
            // The blossom of a quadratic, raised to a cubic: the mean over the pairs of its three arguments.
            let [a, b, c] = [flat[i], flat[j], flat[k]];
            ((a + b + c) / 3.0).extend((polar(a, b) + polar(b, c) + polar(c, a)) / 3.0)
        };
        let corners = [point(0, 0, 0), point(1, 1, 1), point(2, 2, 2)];
        let edges = [point(0, 0, 1), point(0, 1, 1), point(1, 1, 2), point(1, 2, 2), point(2, 2, 0), point(2, 0, 0)];
        let center = center_control_point(corners, edges);
        assert!(center.distance(point(0, 1, 2)) < 1e-6, "quadratic precision");
        let net = ControlNet { corners, edges, center };
        for (u, v) in [(20000, 30000), (5000, 1000), (21845, 21845)] {
            let at = patch_position(Surface::Pn, &net, u, v);
            assert!((at.z - height(at.truncate())).abs() < 1e-6, "{at}");
        }
    }

    proptest! {
        #[test]
        fn control_points_turn_with_the_edge_and_do_not_depend_on_its_direction(
            (ax, ay, az) in (-2f32..2.0, -2f32..2.0, -2f32..2.0),
            (bx, by, bz) in (-2f32..2.0, -2f32..2.0, -2f32..2.0),
            (nx, ny) in (-1f32..1.0, -1f32..1.0),
            (mx, my) in (-1f32..1.0, -1f32..1.0),
            angle in -3f64..3.0,
        ) {
            let (a, b) = (vec3(ax, ay, az), vec3(bx, by, bz));
            let (at_a, at_b) = (vec3(nx, ny, 1.0).normalize(), vec3(mx, my, 1.0).normalize());
            // If the normals are closer to each other, f32 has too few digits for Nagata's division.
            prop_assume!(at_a.cross(at_b).length() > 0.03);
            let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, angle).as_mat3();
            for surface in Surface::ALL {
                let here = side_control_points(surface, 0.75, a, b, at_a, at_b);
                let there = side_control_points(surface, 0.75, turn * a, turn * b, turn * at_a, turn * at_b);
                let back = side_control_points(surface, 0.75, b, a, at_b, at_a);
                for k in 0..2 {
                    let size = 1e-4 * (1.0 + here[k].length());
                    prop_assert!((turn * here[k]).distance(there[k]) < size, "{:?}", surface);
                    prop_assert!(here[k].distance(back[1 - k]) < size, "{:?}: seen from the other end", surface);
                }
            }
        }
    }
}
