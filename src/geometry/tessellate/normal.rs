//! Shading normals of emitted vertices. Weights are 16.16 fixed point. Twin: `shaders/normal.wgsl`.

use glam::Vec3;

use super::Surface;
use super::factors::FIXED_ONE;
use super::surface::{ControlNet, UNIT, patch_tangents};
use crate::choice::choices;

choices! {
    /// Which normals emitted vertices get.
    #[derive(Hash)]
    #[repr(u32)]
    pub enum Normals {
        Linear => "linear", "Linear normals", "The corners' normals, linearly interpolated, as in Phong shading.";
        Quadratic => "quadratic", "Quadratic normals",
            "The corners' normals, quadratically interpolated (Vlachos et al. 2001, section 3.3): they follow edges that \
             bend one way and back.";
        Surface => "surface", "Surface normals",
            "The exact normals of the curved surface. They change abruptly where the surface has a crease, which is \
             along most edges between patches.";
    }
}

/// Weighted sums of unit normals that are shorter than this are rounding errors: the normals cancel.
pub const CANCELLED: f32 = 1e-6;

/// Returns a weighted sum of normals at unit length, or `nearest` (the normal with the greatest weight) if they cancel.
pub(super) fn unit_or(sum: Vec3, nearest: Vec3) -> Vec3 {
    let length_squared = sum.dot(sum);
    if length_squared > CANCELLED * CANCELLED { sum * (1.0 / length_squared.sqrt()) } else { nearest }
}

/// Returns the linearly interpolated unit normal at weights `u` and `v` of a patch, or the normal of the nearest corner
/// if the normals cancel.
pub fn linear_normal(normals: [Vec3; 3], u: u32, v: u32) -> Vec3 {
    let w = FIXED_ONE - u - v;
    let [a, b, c] = normals;
    let nearest = if u >= v && u >= w {
        a
    } else if v >= w {
        b
    } else {
        c
    };
    unit_or(a * (u as f32 * UNIT) + b * (v as f32 * UNIT) + c * (w as f32 * UNIT), nearest)
}

/// Returns the linearly interpolated unit normal at `t` on an edge whose ends have normals `a` and `b`. The arguments
/// must be in the edge's own direction, as for [`super::edge_position`].
pub fn edge_normal(a: Vec3, b: Vec3, t: u32) -> Vec3 {
    let nearest = if 2 * t <= FIXED_ONE { a } else { b };
    unit_or(a * ((FIXED_ONE - t) as f32 * UNIT) + b * (t as f32 * UNIT), nearest)
}

/// Returns the control normal in the middle of an edge (h110 of Vlachos et al. 2001, section 3.3): the sum of the
/// normals at the ends, mirrored in the plane perpendicular to the edge, at unit length. It is `at_a` if the sum
/// cancels.
pub(crate) fn middle_normal(a: Vec3, b: Vec3, at_a: Vec3, at_b: Vec3) -> Vec3 {
    let along = b - a;
    // Scale the edge, so that its square neither underflows nor overflows: only its direction matters.
    let size = along.abs().max_element();
    let sum = at_a + at_b;
    if size == 0.0 {
        return unit_or(sum, at_a);
    }
    let direction = along * (1.0 / size);
    unit_or(sum - direction * (2.0 * direction.dot(sum) / direction.dot(direction)), at_a)
}

/// Returns the quadratically interpolated unit normal at weights `u` and `v` of a patch with these corners (Vlachos et
/// al. 2001, section 3.3), or the linearly interpolated one if the sum cancels.
///
/// The control normals in the middle of the edges are multiplied by u v, v w and w u, without the factor 2 of a Bézier
/// triangle, as in the paper.
pub(crate) fn quadratic_normal(corners: [Vec3; 3], normals: [Vec3; 3], u: u32, v: u32) -> Vec3 {
    let (x, y, z) = (u as f32 * UNIT, v as f32 * UNIT, (FIXED_ONE - u - v) as f32 * UNIT);
    let [a, b, c] = corners;
    let [at_a, at_b, at_c] = normals;
    let sum = at_a * (x * x)
        + at_b * (y * y)
        + at_c * (z * z)
        + middle_normal(a, b, at_a, at_b) * (x * y)
        + middle_normal(b, c, at_b, at_c) * (y * z)
        + middle_normal(c, a, at_c, at_a) * (z * x);
    unit_or(sum, linear_normal(normals, u, v))
}

/// Returns the quadratically interpolated unit normal at `t` on the edge from `a` to `b`. The arguments must be in the
/// edge's own direction, as for [`super::edge_position`].
pub(crate) fn quadratic_edge_normal(a: Vec3, b: Vec3, at_a: Vec3, at_b: Vec3, t: u32) -> Vec3 {
    let (x, y) = ((FIXED_ONE - t) as f32 * UNIT, t as f32 * UNIT);
    let sum = at_a * (x * x) + middle_normal(a, b, at_a, at_b) * (x * y) + at_b * (y * y);
    unit_or(sum, edge_normal(at_a, at_b, t))
}

/// Returns the unit normal of a surface with these tangents along u and v, or `otherwise` if they are parallel or one
/// is zero.
pub(super) fn facing_or(tangents: [Vec3; 2], otherwise: Vec3) -> Vec3 {
    let [along_u, along_v] = tangents;
    let size_u = along_u.abs().max_element();
    let size_v = along_v.abs().max_element();
    if size_u == 0.0 || size_v == 0.0 {
        return otherwise;
    }
    unit_or((along_u * (1.0 / size_u)).cross(along_v * (1.0 / size_v)), otherwise)
}

/// Returns the unit normal of the surface itself at weights `u` and `v`, or `otherwise` where it has none.
pub(crate) fn surface_normal(surface: Surface, net: &ControlNet, u: u32, v: u32, otherwise: Vec3) -> Vec3 {
    facing_or(patch_tangents(surface, net, u, v), otherwise)
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, vec3};
    use proptest::prelude::*;

    use super::*;
    use crate::tessellate::{center_control_point, side_control_points};

    const CORNERS: [Vec3; 3] = [vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.5), vec3(0.5, 1.5, 0.0)];

    fn normals() -> [Vec3; 3] {
        [vec3(-0.3, -0.3, 1.0), vec3(0.4, 0.0, 1.0), vec3(0.0, 0.5, 1.0)].map(Vec3::normalize)
    }

    fn net() -> ControlNet {
        let side = |k: usize| {
            let (a, b) = (k, (k + 1) % 3);
            side_control_points(Surface::Pn, 0.0, CORNERS[a], CORNERS[b], normals()[a], normals()[b])
        };
        let edges = [side(0), side(1), side(2)].as_flattened().try_into().expect("six");
        ControlNet { corners: CORNERS, edges, center: center_control_point(CORNERS, edges) }
    }

    #[test]
    fn quadratic_normals_are_those_of_the_paper() {
        // Vlachos et al. 2001, section 3.3, in f64: v12 = 2 (P2 - P1) . (N1 + N2) / (P2 - P1) . (P2 - P1),
        // h110 = N1 + N2 - v12 (P2 - P1), n110 = h110 / |h110|, and so on; n = sum of n_ijk u^i v^j w^k.
        let (p, n) = (CORNERS.map(Vec3::as_dvec3), normals().map(Vec3::as_dvec3));
        let middle = |i: usize, j: usize| {
            let (d, sum): (DVec3, DVec3) = (p[j] - p[i], n[i] + n[j]);
            (sum - d * (2.0 * d.dot(sum) / d.dot(d))).normalize()
        };
        for (u, v) in [(20000_u32, 30000_u32), (5000, 1000), (21845, 21845)] {
            let [x, y, z] = [u, v, FIXED_ONE - u - v].map(|x| f64::from(x) / 65536.0);
            let corners = n[0] * (x * x) + n[1] * (y * y) + n[2] * (z * z);
            let expected = corners + middle(0, 1) * (x * y) + middle(1, 2) * (y * z) + middle(2, 0) * (z * x);
            let own = quadratic_normal(CORNERS, normals(), u, v).as_dvec3();
            assert!(own.distance(expected.normalize()) < 1e-6, "{own}");
        }
    }

    #[test]
    fn quadratic_normals_follow_an_edge_with_an_inflection() {
        // Both normals lean the same way along a level edge, so the curve has an inflection, and in its middle the normal
        // leans the other way. Quadratic normals follow only partly, as the paper's formula lacks the factor 2. Linear ones
        // don't follow at all.
        let leaning = vec3(-0.6, 0.0, 0.8);
        let own = quadratic_edge_normal(Vec3::ZERO, Vec3::X, leaning, leaning, FIXED_ONE / 2);
        assert!(own.distance(vec3(-0.15, 0.0, 0.6).normalize()) < 1e-6, "{own}");
        assert_eq!(edge_normal(leaning, leaning, FIXED_ONE / 2), leaning);
        let mirrored = middle_normal(Vec3::ZERO, Vec3::X, leaning, leaning);
        assert!(mirrored.distance(vec3(0.6, 0.0, 0.8)) < 1e-6);
    }

    #[test]
    fn normals_do_not_depend_on_the_length_of_the_edge() {
        let [a, b, _] = CORNERS;
        let [at_a, at_b, _] = normals();
        let expected = middle_normal(a, b, at_a, at_b);
        for size in [1e-30_f32, 1e-7, 1e7, 1e30] {
            assert!(middle_normal(a * size, b * size, at_a, at_b).distance(expected) < 1e-6, "{size}");
            let tangents = [(b - a) * size, Vec3::Y * size];
            assert!(facing_or(tangents, Vec3::X).distance((b - a).cross(Vec3::Y).normalize()) < 1e-6, "{size}");
        }
        assert_eq!(facing_or([Vec3::X, Vec3::X * 2.0], Vec3::Y), Vec3::Y, "parallel tangents");
        assert_eq!(facing_or([Vec3::ZERO, Vec3::X], Vec3::Y), Vec3::Y, "no tangent");
    }

    #[test]
    fn at_a_corner_every_kind_of_normal_is_the_corners() {
        for (k, (u, v)) in [(FIXED_ONE, 0), (0, FIXED_ONE), (0, 0)].into_iter().enumerate() {
            let own = normals()[k];
            assert!(linear_normal(normals(), u, v).distance(own) < 1e-6);
            assert!(quadratic_normal(CORNERS, normals(), u, v).distance(own) < 1e-6);
            // A PN triangle's tangents lie in the corner's tangent plane.
            assert!(surface_normal(Surface::Pn, &net(), u, v, Vec3::ZERO).distance(own) < 1e-5);
        }
        let flat = surface_normal(Surface::Flat, &net(), 20000, 20000, Vec3::ZERO);
        assert!(flat.distance((CORNERS[1] - CORNERS[0]).cross(CORNERS[2] - CORNERS[0]).normalize()) < 1e-6);
    }

    proptest! {
        #[test]
        fn normals_of_the_patch_and_of_its_edges_agree_on_the_outline(t in 0u32..=FIXED_ONE) {
            let n = normals();
            let inside = [(FIXED_ONE - t, t), (0, FIXED_ONE - t), (t, 0)];
            for (k, (u, v)) in inside.into_iter().enumerate() {
                let (a, b) = (k, (k + 1) % 3);
                let on_edge = quadratic_edge_normal(CORNERS[a], CORNERS[b], n[a], n[b], t);
                prop_assert!(on_edge.distance(quadratic_normal(CORNERS, n, u, v)) < 1e-6);
                prop_assert!(edge_normal(n[a], n[b], t).distance(linear_normal(n, u, v)) < 1e-6);
            }
        }
    }
}
