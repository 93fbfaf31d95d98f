//! Where a surface's control points lie, given what an edge's ends look like. Twin: `shaders/control_points.wgsl`.
//!
//! Every surface is a cubic net, so that one evaluation, one bound on its error and one clip test serve them all. Phong
//! tessellation and Nagata's patch are quadratic: they have one control point on an edge, and are raised to cubics, which
//! changes no point of them. [`center_control_point`] keeps quadratics, so their centres come out as they should.

use glam::Vec3;

use super::Surface;

/// Normals whose cross product's squared length is no more than this are parallel or opposite: the squared sine of 0.1
/// degrees, within which rounding decides where their planes cut each other.
pub(crate) const PARALLEL: f32 = 3.046e-6;

/// The control point one third along from `a` to `b`, in the tangent plane at `a` (Vlachos et al. 2001, section 3.1:
/// b210 = (2 P1 + P2 - w12 N1) / 3). `normal` is the unit normal at `a`.
pub fn edge_control_point(a: Vec3, b: Vec3, normal: Vec3) -> Vec3 {
    (a * 2.0 + b - normal * (b - a).dot(normal)) * (1.0 / 3.0)
}

/// The control point one third along a straight edge.
pub fn straight_control_point(a: Vec3, b: Vec3) -> Vec3 {
    (a * 2.0 + b) * (1.0 / 3.0)
}

/// The middle control point of an edge of Phong tessellation (Boubekeur and Alexa 2008, equations 2 to 4): `alpha` of the
/// way from the edge's middle to the mean of each end's projection into the other's tangent plane.
pub fn phong_control_point(alpha: f32, a: Vec3, b: Vec3, at_a: Vec3, at_b: Vec3) -> Vec3 {
    let along = b - a;
    let back = at_a * along.dot(at_a) - at_b * along.dot(at_b);
    (a + b - back * alpha) * 0.5
}

/// The middle control point of Nagata's edge (2005): the curve a + (d - c) t + c t t, d = b - a, with the shortest c that
/// makes it normal to both ends' normals. As the normals' half sum s and half difference h are perpendicular,
/// c = (d.h / s.s) s + (d.s / h.h) h, here with both by their lengths, whose squares are too small to divide what is vast
/// by. Between parallel or opposite normals the edge is straight. Where normals are nearly
/// parallel and both lean along the edge, c is many times as long as the edge: that is Nagata's.
pub fn nagata_control_point(a: Vec3, b: Vec3, at_a: Vec3, at_b: Vec3) -> Vec3 {
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

/// The control point of a cubic near `a` of the quadratic whose middle control point is `middle`.
pub fn raised_control_point(a: Vec3, middle: Vec3) -> Vec3 {
    (a + middle * 2.0) * (1.0 / 3.0)
}

/// What one side of an edge proposes for its control points near `a` and near `b`, from its own unit normals at the ends.
pub fn side_control_points(surface: Surface, alpha: f32, a: Vec3, b: Vec3, at_a: Vec3, at_b: Vec3) -> [Vec3; 2] {
    if surface == Surface::Flat {
        return [straight_control_point(a, b), straight_control_point(b, a)];
    }
    if surface == Surface::Phong || surface == Surface::PhongAen {
        let middle = phong_control_point(alpha, a, b, at_a, at_b);
        return [raised_control_point(a, middle), raised_control_point(b, middle)];
    }
    if surface == Surface::Nagata || surface == Surface::NagataAen {
        let middle = nagata_control_point(a, b, at_a, at_b);
        return [raised_control_point(a, middle), raised_control_point(b, middle)];
    }
    [edge_control_point(a, b, at_a), edge_control_point(b, a, at_b)]
}

/// The different normals that an edge's sides have at one of its ends, as far as two.
#[derive(Clone, Copy, Debug, Default)]
pub struct Meeting {
    pub first: Vec3,
    pub second: Vec3,
    /// How many there are; 3 for any more.
    pub count: u32,
}

/// The same with one more side's normal.
pub fn meet(meeting: Meeting, normal: Vec3) -> Meeting {
    if meeting.count == 0 {
        return Meeting { first: normal, second: normal, count: 1 };
    }
    if normal == meeting.first || normal == meeting.second {
        return meeting;
    }
    if meeting.count == 1 {
        return Meeting { second: normal, count: 2, ..meeting };
    }
    Meeting { count: 3, ..meeting }
}

/// The control point near `a` of an edge at which two surfaces meet: a third of the edge, projected on the line that their
/// tangent planes share (Vlachos et al. 2001, section 3.4). `mean` is the mean of all sides' proposals, and stays where
/// there is no such line: the normals are one or parallel, or of more than two surfaces.
pub fn crease_control_point(a: Vec3, b: Vec3, meeting: Meeting, mean: Vec3) -> Vec3 {
    let line = meeting.first.cross(meeting.second);
    let length_squared = line.dot(line);
    if meeting.count != 2 || length_squared <= PARALLEL {
        return mean;
    }
    // By the line's own length: its square is too small to divide what is vast by.
    let direction = line / length_squared.sqrt();
    a + direction * ((b - a).dot(direction) * (1.0 / 3.0))
}

/// b111 of the net with these corners and six edge control points: E + (E - V) / 2 (Vlachos et al. 2001, section 3.1).
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

    /// Two points and the unit normals there, in general position.
    const ENDS: [Vec3; 4] = [vec3(1.0, 2.0, 3.0), vec3(4.0, 0.0, 5.0), vec3(0.6, 0.0, 0.8), vec3(0.36, 0.48, 0.8)];

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
    fn phongs_edge_is_that_of_the_paper() {
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
    fn a_phong_patch_is_that_of_the_paper_inside_too() {
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

    /// The net of one patch alone.
    fn net(surface: Surface, corners: [Vec3; 3], normals: [Vec3; 3]) -> ControlNet {
        let side = |k: usize| {
            let (a, b) = (k, (k + 1) % 3);
            side_control_points(surface, 0.75, corners[a], corners[b], normals[a], normals[b])
        };
        let edges = [side(0), side(1), side(2)].as_flattened().try_into().expect("six");
        ControlNet { corners, edges, center: center_control_point(corners, edges) }
    }

    /// Nagata 2005: c is the shortest solution of n0 . c = n0 . d, n1 . c = -n1 . d, by the generalised inverse.
    fn curvature(d: DVec3, n0: DVec3, n1: DVec3) -> DVec3 {
        let cosine = n0.dot(n1);
        let (x, y) = (n0.dot(d), -n1.dot(d));
        let determinant = 1.0 - cosine * cosine;
        (n0 * (x - cosine * y) + n1 * (y - cosine * x)) / determinant
    }

    #[test]
    fn nagatas_edge_is_that_of_the_paper() {
        let [a, b, at_a, at_b] = ENDS;
        let middle = nagata_control_point(a, b, at_a, at_b).as_dvec3();
        let [a, b, at_a, at_b] = ENDS.map(Vec3::as_dvec3);
        let expected = (a + b - curvature(b - a, at_a, at_b)) / 2.0;
        assert!(middle.distance(expected) < 1e-5, "{middle} {expected}");
        // Its ends' tangents are perpendicular to the normals there.
        assert!((middle - a).dot(at_a).abs() < 1e-5 && (b - middle).dot(at_b).abs() < 1e-5);
        // The third unknown is chosen for the shortest c: nothing of it lies along both planes' line.
        let c = a + b - middle * 2.0;
        assert!(c.dot(at_a.cross(at_b)).abs() < 1e-5);
    }

    #[test]
    fn a_nagata_patch_is_that_of_the_paper_inside_too() {
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
    fn nagatas_control_point_is_where_a_circles_tangents_meet() {
        // A quarter, its normals along the radii.
        let middle = nagata_control_point(Vec3::X, Vec3::Y, Vec3::X, Vec3::Y);
        assert!(middle.distance(vec3(1.0, 1.0, 0.0)) < 1e-6);
    }

    #[test]
    fn parallel_and_opposite_normals_leave_nagatas_edge_straight() {
        let (a, b) = (Vec3::ZERO, vec3(2.0, 0.0, 1.0));
        let leaning = |degrees: f32| Vec3::Z.rotate_x(degrees.to_radians());
        for (at_a, at_b) in [(Vec3::Z, Vec3::Z), (Vec3::Z, Vec3::NEG_Z), (Vec3::Z, leaning(0.09))] {
            assert_eq!(nagata_control_point(a, b, at_a, at_b), (a + b) * 0.5);
        }
        assert_ne!(nagata_control_point(a, b, Vec3::Z, leaning(0.2)), (a + b) * 0.5);
    }

    #[test]
    fn a_crease_runs_along_both_tangent_planes() {
        let none = Meeting::default();
        let [a, b, at_a, at_b] = ENDS;
        let meeting = meet(meet(meet(none, at_a), at_a), at_b);
        assert_eq!(meeting.count, 2);
        let own = crease_control_point(a, b, meeting, Vec3::ZERO);
        assert!((own - a).dot(at_a).abs() < 1e-6 && (own - a).dot(at_b).abs() < 1e-6);
        // The projection, by hand in f64.
        let line = at_a.as_dvec3().cross(at_b.as_dvec3()).normalize();
        let expected = a.as_dvec3() + line * ((b - a).as_dvec3().dot(line) / 3.0);
        assert!(own.as_dvec3().distance(expected) < 1e-6);
        // One surface, three, and two that are nearly one: there is no such line.
        let mean = vec3(7.0, 8.0, 9.0);
        for normals in [&[at_a, at_a][..], &[at_a, at_b, Vec3::X], &[at_a, at_a + vec3(1e-5, 0.0, 0.0)], &[at_a, -at_a]]
        {
            let meeting = normals.iter().fold(none, |meeting, &normal| meet(meeting, normal));
            assert_eq!(crease_control_point(a, b, meeting, mean), mean, "{normals:?}");
        }
    }

    #[test]
    fn a_faint_crease_is_found_on_the_largest_and_smallest_edges() {
        // Just beyond parallel: the normals' cross product is short, and what divides by its square is vast.
        let (at_a, at_b) = (Vec3::Y, vec3(0.0, 0.003f32.cos(), 0.003f32.sin()));
        let meeting = meet(meet(Meeting::default(), at_a), at_b);
        for size in [1e-36f32, 1.0, 1e37] {
            let own = crease_control_point(Vec3::ZERO, vec3(size, 0.2 * size, 0.0), meeting, Vec3::NAN);
            assert!((own / size).distance(Vec3::X / 3.0) < 1e-6, "{own} of {size}");
        }
    }

    #[test]
    fn nagatas_faintest_curve_is_found_on_the_largest_and_smallest_edges() {
        // Both normals lean along the edge, and differ by little: the curve is hundreds of times as long, and no more.
        let leaning = |angle: f32| vec3(angle.sin(), 0.0, angle.cos());
        let (at_a, at_b) = (leaning(0.8), leaning(0.803));
        for size in [1e-33f32, 1.0, 1e34] {
            let own = nagata_control_point(Vec3::ZERO, vec3(0.0, 0.0, size), at_a, at_b) / size;
            // By hand in f64, of unit size.
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
        // With E and V as the paper has them, b111 keeps quadratics: hold the patch of a paraboloid's own net against it.
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
        fn proposals_move_with_the_edge(
            (ax, ay, az) in (-2f32..2.0, -2f32..2.0, -2f32..2.0),
            (bx, by, bz) in (-2f32..2.0, -2f32..2.0, -2f32..2.0),
            (nx, ny) in (-1f32..1.0, -1f32..1.0),
            (mx, my) in (-1f32..1.0, -1f32..1.0),
            angle in -3f64..3.0,
        ) {
            let (a, b) = (vec3(ax, ay, az), vec3(bx, by, bz));
            let (at_a, at_b) = (vec3(nx, ny, 1.0).normalize(), vec3(mx, my, 1.0).normalize());
            // Below, f32 has too few digits for Nagata's division.
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
