//! How a patch's surface curves, without displacement: twin of `shaders/curvature.wgsl`. Draws compute this at pixels, and the CPU
//! where somebody points.

use glam::{Vec3, vec2};

use super::Surface;
use super::factors::FIXED_ONE;
use super::surface::{ControlNet, UNIT, patch_tangents};
use crate::choice::choices;

choices! {
    /// Which of a surface's curvatures.
    #[derive(Default)]
    pub enum CurvatureKind {
        #[default]
        Mean => "mean", "Mean",
            "Half the sum of the largest and the least curvature. It is above 0 where the surface bulges towards the side that it \
             faces, below 0 where it is hollow, and 0 where it is flat or a saddle that bends as much both ways.";
        Gaussian => "gaussian", "Gaussian",
            "The product of the largest and the least curvature, in 1 / object unit squared. It is above 0 on bulges and hollows, \
             below 0 on saddles, and 0 where the surface bends one way only, so that it could be unrolled.";
        Largest => "largest", "Largest",
            "The larger principal curvature: that along the direction in which the surface bulges most.";
        Least => "least", "Least",
            "The smaller principal curvature: that along the direction in which the surface bulges least, or is most hollow.";
    }
}

/// Returns a curvature of a patch at weights `u` and `v` (16.16 fixed point; w = 1 - u - v): of or from its principal curvatures.
pub fn patch_curvature(kind: CurvatureKind, surface: Surface, net: &ControlNet, u: u32, v: u32) -> f32 {
    let second = patch_second_derivatives(surface, net, u, v);
    let [largest, least] = principal_curvatures(patch_tangents(surface, net, u, v), second);
    match kind {
        CurvatureKind::Mean => 0.5 * (largest + least),
        CurvatureKind::Gaussian => largest * least,
        CurvatureKind::Largest => largest,
        CurvatureKind::Least => least,
    }
}

/// Returns the second derivatives of a patch's position at weights `u` and `v` (16.16 fixed point; w = 1 - u - v), in
/// object units: twice by u, by u and v, and twice by v. They are linear Bézier triangles of second differences of
/// control points, times 6 (Farin, Triangular Bernstein-Bézier patches, 1986, section 1.4).
fn patch_second_derivatives(surface: Surface, net: &ControlNet, u: u32, v: u32) -> [Vec3; 3] {
    if surface.is_flat() {
        return [Vec3::ZERO; 3];
    }
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    let [b300, b030, b003] = net.corners;
    let [b210, b120, b021, b012, b102, b201] = net.edges;
    let b111 = net.center;
    let by_uu =
        ((b300 - b201) - (b201 - b102)) * x + ((b210 - b111) - (b111 - b012)) * y + ((b201 - b102) - (b102 - b003)) * z;
    let by_uv =
        ((b210 - b201) - (b111 - b102)) * x + ((b120 - b111) - (b021 - b012)) * y + ((b111 - b102) - (b012 - b003)) * z;
    let by_vv =
        ((b120 - b111) - (b111 - b102)) * x + ((b030 - b021) - (b021 - b012)) * y + ((b021 - b012) - (b012 - b003)) * z;
    [by_uu * 6.0, by_uv * 6.0, by_vv * 6.0]
}

/// Returns the principal curvatures of a surface with these first and second derivatives, the larger one first, in
/// 1 / object unit. Both are above 0 where the surface bulges towards the side that it faces, and 0 where it has no tangent
/// plane.
///
/// Their mean is (E N - 2 F M + G L) / (2 (E G - F²)) in the coefficients of both fundamental forms (do Carmo, Differential
/// geometry of curves and surfaces, 1976, section 3-3). How far they are from it follows from the curvature L / E along the
/// first tangent, and from the twist there: their squares add up as on Mohr's circle.
fn principal_curvatures(tangents: [Vec3; 2], second: [Vec3; 3]) -> [f32; 2] {
    // At this size products of derivatives neither underflow nor overflow.
    let size = tangents[0].abs().max_element().max(tangents[1].abs().max_element());
    if size == 0.0 {
        return [0.0; 2];
    }
    let scale = 1.0 / size;
    let along_u = tangents[0] * scale;
    let along_v = tangents[1] * scale;
    let across = along_u.cross(along_v);
    // E G - F², by Lagrange's identity.
    let area_squared = across.dot(across);
    if area_squared <= FLAT_ANGLE * FLAT_ANGLE {
        return [0.0; 2];
    }
    let area = area_squared.sqrt();
    let normal = across * (1.0 / area);
    let by_uu = normal.dot(second[0] * scale);
    let by_uv = normal.dot(second[1] * scale);
    let by_vv = normal.dot(second[2] * scale);
    let (uu, uv) = (along_u.dot(along_u), along_u.dot(along_v));
    let mean = (uu * by_vv - 2.0 * uv * by_uv + along_v.dot(along_v) * by_uu) / (2.0 * area_squared);
    let own = by_uu / uu;
    let aside = vec2(own - mean, (by_uv - uv * own) / area).length();
    // The normal of a sphere points away from where its derivatives do.
    [(aside - mean) * scale, -(aside + mean) * scale]
}

/// Tangents that span less area, with the longer coordinate at 1, are parallel.
pub const FLAT_ANGLE: f32 = 1e-6;

#[cfg(test)]
mod tests {
    use glam::{DVec3, vec3};
    use proptest::prelude::*;

    use super::*;
    use crate::tessellate::surface::patch_position;
    use crate::tessellate::{center_control_point, side_control_points};

    /// Returns the mean curvature of a patch.
    fn curvature(net: &ControlNet, u: u32, v: u32) -> f32 {
        patch_curvature(CurvatureKind::Mean, Surface::Pn, net, u, v)
    }

    /// Returns places all over a patch.
    fn places() -> impl Iterator<Item = [u32; 2]> {
        (0..=8).flat_map(|i| (0..=8 - i).map(move |j| [i * FIXED_ONE / 8, j * FIXED_ONE / 8]))
    }

    /// Returns the net of the surface z = (a x² + b y²) / 2 over a triangle. A control point is the surface's polar form (its
    /// blossom) at three corners (Ramshaw 1987): products of coordinates become means over pairs of corners.
    fn quadric(a: f32, b: f32) -> ControlNet {
        let corners = [[-0.7, -0.4], [0.9, -0.3], [0.1, 0.8]];
        let point = |[i, j, k]: [usize; 3]| {
            let [p, q, r]: [[f32; 2]; 3] = [corners[i], corners[j], corners[k]];
            let product = |c: usize| (p[c] * q[c] + q[c] * r[c] + r[c] * p[c]) / 3.0;
            let mean = |c: usize| (p[c] + q[c] + r[c]) / 3.0;
            vec3(mean(0), mean(1), 0.5 * (a * product(0) + b * product(1)))
        };
        ControlNet {
            corners: [[0; 3], [1; 3], [2; 3]].map(point),
            edges: [[0, 0, 1], [0, 1, 1], [1, 1, 2], [1, 2, 2], [2, 2, 0], [2, 0, 0]].map(point),
            center: point([0, 1, 2]),
        }
    }

    #[test]
    fn quadrics_have_the_curvature_of_their_closed_form() {
        // A bowl, a roof, a channel, a saddle, a skew saddle and a plane.
        for (a, b) in [(1.5, 1.5), (-2.0, -1.0), (0.0, 1.0), (1.0, -1.0), (2.0, -0.5), (0.0, 0.0)] {
            let net = quadric(a, b);
            for [u, v] in places() {
                let at = patch_position(Surface::Pn, &net, u, v);
                // do Carmo 1976, section 3-3, example 5: a graph, whose normal is up.
                let (slope_x, slope_y) = (a * at.x, b * at.y);
                let steep = 1.0 + slope_x * slope_x + slope_y * slope_y;
                let graph = ((1.0 + slope_y * slope_y) * a + (1.0 + slope_x * slope_x) * b) / (2.0 * steep.powf(1.5));
                let found = curvature(&net, u, v);
                assert!((found + graph).abs() < 2e-5, "{a} {b} at {at}: {found}, not {}", -graph);
            }
        }
    }

    #[test]
    fn principal_curvatures_of_quadrics_are_those_of_their_closed_form() {
        // A bowl, a paraboloid of revolution, a cylinder, a saddle, a skew saddle and a plane.
        for (a, b) in [(1.5, 0.5), (-2.0, -2.0), (0.0, 1.0), (1.0, -1.0), (2.0, -0.5), (0.0, 0.0)] {
            let net = quadric(a, b);
            for [u, v] in places() {
                let at = patch_position(Surface::Pn, &net, u, v);
                // do Carmo 1976, section 3-3, example 5. The graph's normal is up, so that a bowl is hollow.
                let (slope_x, slope_y) = (a * at.x, b * at.y);
                let steep = 1.0 + slope_x * slope_x + slope_y * slope_y;
                let gaussian = a * b / (steep * steep);
                let mean = -((1.0 + slope_y * slope_y) * a + (1.0 + slope_x * slope_x) * b) / (2.0 * steep.powf(1.5));
                let apart = (mean * mean - gaussian).max(0.0).sqrt();
                let found = CurvatureKind::ALL.map(|kind| patch_curvature(kind, Surface::Pn, &net, u, v));
                let expected = [mean, gaussian, mean + apart, mean - apart];
                // Where both are equal, a root of what rounding leaves of 0 is expected.
                let tolerances = [2e-5, 2e-4, 2e-3, 2e-3];
                let is_near = (0..4).all(|k| (found[k] - expected[k]).abs() < tolerances[k]);
                assert!(is_near, "{a} {b} at {at}: {found:?}, not {expected:?}");
                assert!(found[2] >= found[3], "{found:?}");
            }
        }
    }

    #[test]
    fn curvature_is_in_one_per_unit_at_any_size_and_changes_its_sign_with_the_side() {
        let net = quadric(1.0, 0.5);
        let own = curvature(&net, 20000, 30000);
        for scale in [1e-15_f32, 1e-3, 64.0, 1e15] {
            let scaled = ControlNet {
                corners: net.corners.map(|p| p * scale),
                edges: net.edges.map(|p| p * scale),
                center: net.center * scale,
            };
            let found = curvature(&scaled, 20000, 30000);
            assert!((found * scale - own).abs() < 1e-5, "{scale}: {found}");
        }
        let ([a, b, c], [ab, ba, bc, cb, ca, ac]) = (net.corners, net.edges);
        let turned = ControlNet { corners: [b, a, c], edges: [ba, ab, ac, ca, cb, bc], center: net.center };
        assert!((curvature(&turned, 30000, 20000) + own).abs() < 1e-5);
    }

    #[test]
    fn patches_without_a_tangent_plane_have_none() {
        let line = |t: f32| vec3(t, 2.0 * t, -t);
        let on_a_line = ControlNet {
            corners: [0.0, 3.0, 1.0].map(line),
            edges: [1.0, 2.0, 2.5, 1.5, 0.5, 0.2].map(line),
            center: line(1.1),
        };
        let point = ControlNet { corners: [Vec3::ONE; 3], edges: [Vec3::ONE; 6], center: Vec3::ONE };
        for net in [on_a_line, point] {
            assert!(places().all(|[u, v]| curvature(&net, u, v) == 0.0));
        }
        assert_eq!(patch_second_derivatives(Surface::Flat, &quadric(1.0, 1.0), 9, 9), [Vec3::ZERO; 3]);
    }

    /// Returns the PN patch of three points of a surface with these normals.
    fn pn(corners: [Vec3; 3], normals: [Vec3; 3]) -> ControlNet {
        let side = |k: usize| {
            let (a, b) = (k, (k + 1) % 3);
            side_control_points(Surface::Pn, 0.0, corners[a], corners[b], normals[a], normals[b])
        };
        let edges = [side(0), side(1), side(2)].as_flattened().try_into().expect("six");
        ControlNet { corners, edges, center: center_control_point(corners, edges) }
    }

    /// Returns how far the curvature of a patch is from that of the surface that its corners lie on, at most.
    fn worst(net: &ControlNet, expected: f32) -> f32 {
        places().map(|[u, v]| (curvature(net, u, v) - expected).abs() / expected).fold(0.0, f32::max)
    }

    #[test]
    fn patches_on_spheres_and_cylinders_have_their_curvature() {
        const RADIUS: f32 = 2.5;
        let patch = |size: f32, on_surface: fn(f32, f32) -> [Vec3; 2]| {
            let corners = [[-0.5, -0.4], [0.6, -0.3], [0.0, 0.6]].map(|[x, y]| on_surface(size * x, size * y));
            pn(corners.map(|[place, _]| place * RADIUS), corners.map(|[_, normal]| normal))
        };
        let sphere = |x: f32, y: f32| [vec3(x.sin() * y.cos(), y.sin(), x.cos() * y.cos()); 2];
        let cylinder = |x: f32, y: f32| [vec3(x.sin(), y, x.cos()), vec3(x.sin(), 0.0, x.cos())];
        for (on_surface, expected) in [(sphere as fn(f32, f32) -> [Vec3; 2], 1.0 / RADIUS), (cylinder, 0.5 / RADIUS)] {
            let [large, half, quarter] = [0.8, 0.4, 0.2].map(|size| worst(&patch(size, on_surface), expected));
            // The error falls with the square of the patch's size.
            assert!(large < 0.7 && quarter < 0.04, "{large} {half} {quarter}");
            assert!(half * 3.5 < large && quarter * 3.5 < half, "{large} {half} {quarter}");
        }
    }

    proptest! {
        #[test]
        fn second_derivatives_are_those_of_tangents(u in 600u32..30000, v in 600u32..30000) {
            let corners = [vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.5), vec3(0.5, 1.5, 0.0)];
            let normals = [vec3(-0.3, -0.3, 1.0), vec3(0.4, 0.0, 1.0), vec3(0.0, 0.5, 1.0)].map(Vec3::normalize);
            let net = pn(corners, normals);
            // Tangents are quadratic, so that their central differences are exact but for rounding.
            let tangents = |u: u32, v: u32| patch_tangents(Surface::Pn, &net, u, v).map(|tangent| tangent.as_dvec3());
            let step = 2.0 * 512.0 / 65536.0;
            let by = |a: [DVec3; 2], b: [DVec3; 2]| [(b[0] - a[0]) / step, (b[1] - a[1]) / step];
            let [uu, uv] = by(tangents(u - 512, v), tangents(u + 512, v));
            let [vu, vv] = by(tangents(u, v - 512), tangents(u, v + 512));
            let own = patch_second_derivatives(Surface::Pn, &net, u, v);
            for (own, expected) in [(own[0], uu), (own[1], uv), (own[1], vu), (own[2], vv)] {
                prop_assert!(own.as_dvec3().distance(expected) < 1e-3, "{} {}", own, expected);
            }
        }
    }
}
