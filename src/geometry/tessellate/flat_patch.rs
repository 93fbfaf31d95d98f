//! Flat patches: those whose surface lies in a plane, though its parametrisation may not be linear. Twin:
//! `shaders/flat_patch.wgsl`.
//!
//! Control points may lie along an edge or within the triangle's plane elsewhere than a linear patch has them, as normals
//! that lean along an edge put them; or edges bend within the plane, as those of a cylinder's cap do. If nothing on the patch
//! depends on where its points slide, it's the distance to the surface that counts, not to the same place of the domain.
//!
//! Why triangles that all turn the same way stay close to the surface: seen from the plane's normal, their outline is made
//! of straight segments of edges, each within a distance d of the piece of the edge that it stands for. A point that is
//! farther than d from the edges is thus surrounded by the outline of the triangles as often as by that of the surface. If a
//! triangle covers the point, it is surrounded at least once, since no triangle turns back; so the surface covers it, too.
//! A triangle that does turn back is allowed where it is close to the surface at the same places of the domain.
//!
//! Patches without an area have no plane. Where all of their control points are close to their longest side, so is
//! everything else, and the longest edge passes all of it.

use glam::{Vec2, Vec3};

use super::lod::{LodView, clip_row};
use super::piece_error::near_depth;
use super::surface::ControlNet;

/// The least cosine of the angle between two corners' unit normals (1 degree) at which sliding changes no shading.
pub const AGREEING: f32 = 0.99985;

/// Returns whether a patch looks the same wherever its points slide, as far as its corners' unit normals go.
pub(super) fn normals_agree([a, b, c]: [Vec3; 3]) -> bool {
    a.dot(b).min(b.dot(c)).min(c.dot(a)) >= AGREEING
}

/// Returns the larger of `most` and the length of a difference in object units on screen, in px times depth, by an eye that
/// sees it within `spread` px of the middle of the view.
fn longer_on_screen(view: &LodView, most: f32, spread: f32, difference: Vec3) -> f32 {
    let across = Vec2::new(clip_row(view, 0).dot(difference), clip_row(view, 1).dot(difference)) * view.half_viewport;
    most.max(across.length() + spread * clip_row(view, 3).dot(difference).abs())
}

/// Returns the least depth at which a flat triangle is seen, and its largest distance from the middle of the view, in px.
fn seen_within(view: &LodView, corners: [Vec3; 3]) -> [f32; 2] {
    let near = near_depth(view);
    let (mut nearest, mut spread) = (3.4e38f32, 0.0f32);
    for corner in corners {
        let clip = view.clip_from_object * corner.extend(1.0);
        let place = Vec2::new(clip.x, clip.y) * view.half_viewport / clip.w;
        nearest = nearest.min(clip.w);
        spread = spread.max(place.length());
    }
    if nearest > near && nearest > 0.0 {
        return [nearest, spread];
    }
    // What is seen of it is anywhere in the view, and no nearer than the near plane.
    [near, view.half_viewport.length()]
}

/// No point of a patch is farther off than this share of what its control points are, if its corners aren't off; twice
/// that, for two points on different sides.
pub const TWO_POINTS: f32 = 16.0 / 9.0;

/// Returns a bound on the distance in px, across the plane of a patch's triangle, between points of the patch that have the
/// same place in that plane. Large if the patch has no area.
pub(super) fn plane_error(view: &LodView, net: &ControlNet) -> f32 {
    let [a, b, c] = net.corners;
    let area = (b - a).cross(c - a);
    let size = area.length();
    if !(size > 1e-30 && size < 1e30) {
        return 3.4e38;
    }
    let normal = area * (1.0 / size);
    let [nearest, spread] = seen_within(view, net.corners);
    let mut most = longer_on_screen(view, 0.0, spread, normal * normal.dot(net.center - a));
    for i in 0..6 {
        most = longer_on_screen(view, most, spread, normal * normal.dot(net.edges[i] - a));
    }
    TWO_POINTS * most / nearest
}

/// Returns a point's difference from a line; a large one, if the point isn't beside the part between `start` and
/// `start + along`.
fn beside_line(start: Vec3, along: Vec3, p: Vec3) -> Vec3 {
    let share = (p - start).dot(along) / along.dot(along);
    // Rounding doesn't count.
    let is_beside = (share - 0.5).abs() <= 0.50001;
    if is_beside { p - start - along * share } else { Vec3::splat(1e18) }
}

/// Returns a bound on the distance in px between points of a patch, and of triangles in place of it, that are at the same place
/// along its longest side. Large if the patch isn't beside that side.
pub(super) fn line_error(view: &LodView, net: &ControlNet) -> f32 {
    let [a, b, c] = net.corners;
    let (mut start, mut along) = (a, b - a);
    if (c - b).length() > along.length() {
        (start, along) = (b, c - b);
    }
    if (a - c).length() > along.length() {
        (start, along) = (c, a - c);
    }
    let [nearest, spread] = seen_within(view, net.corners);
    let mut most = longer_on_screen(view, 0.0, spread, beside_line(start, along, net.center));
    for i in 0..3 {
        most = longer_on_screen(view, most, spread, beside_line(start, along, net.corners[i]));
    }
    for i in 0..6 {
        most = longer_on_screen(view, most, spread, beside_line(start, along, net.edges[i]));
    }
    2.0 * most / nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tessellate::factors::{Partitioning, process};
    use crate::tessellate::least_factors::{ChosenFactors, FactorSearch, SearchGoal, fewest_triangles};
    use crate::tessellate::piece_error::{SeenPatch, piece_error, seen_patch};
    use crate::tessellate::{FIXED_ONE, domain_plan, domain_point, domain_triangle, triangle_count};
    use glam::{Mat4, vec3};
    use proptest::prelude::*;

    const VIEW: LodView = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));
    const CORNERS: [Vec3; 3] = [vec3(0.0, 0.0, 0.5), vec3(0.6, 0.0, 0.5), vec3(0.0, 0.6, 0.5)];
    const WHOLE: [Vec2; 3] = [Vec2::X, Vec2::Y, Vec2::ZERO];

    fn linear() -> ControlNet {
        let [a, b, c] = CORNERS;
        let third = |p: Vec3, q: Vec3| p.lerp(q, 1.0 / 3.0);
        let edges = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
        ControlNet { corners: CORNERS, edges, center: (a + b + c) / 3.0 }
    }

    fn seen(view: &LodView, net: &ControlNet) -> SeenPatch {
        let mut seen = seen_patch(view, net);
        seen.off_plane = plane_error(view, net);
        seen.off_line = line_error(view, net);
        seen
    }

    /// The error of one triangle in place of the patch.
    fn whole_error(net: &ControlNet) -> f32 {
        piece_error(&seen(&VIEW, net), 1000.0, WHOLE)
    }

    #[test]
    fn points_may_slide_along_edges_and_within_the_plane() {
        assert!(whole_error(&linear()) < 1e-4);
        let mut slid = linear();
        slid.edges[0] += Vec3::X * 0.15;
        slid.edges[2] += vec3(-0.1, 0.1, 0.0);
        slid.center += vec3(0.1, -0.1, 0.0);
        assert!(whole_error(&slid) < 1e-4);
        assert!(piece_error(&seen_patch(&VIEW, &slid), 1000.0, WHOLE) > 1.0, "they may not slide");
    }

    #[test]
    fn what_leaves_the_edge_or_the_plane_counts() {
        // An edge that leaves its straight line within the plane, by 0.05 or 5 px.
        let mut bent = linear();
        bent.edges[1] += Vec3::Y * 0.05;
        assert!((whole_error(&bent) - 0.75 * 5.0).abs() < 1e-3);
        // A control point that isn't beside its edge any more.
        let mut outside = linear();
        outside.edges[0] -= Vec3::X * 0.3;
        assert!(whole_error(&outside) > 10.0);
        // A centre above the plane is seen from the side.
        let mut raised = linear();
        raised.center += Vec3::Z * 0.1;
        let turned = LodView::new(Mat4::from_rotation_x(1.2), Vec2::splat(100.0));
        let expected = TWO_POINTS * 100.0 * 0.1 * 1.2f32.sin();
        assert!((plane_error(&turned, &raised) - expected).abs() < 1e-2);
    }

    #[test]
    fn patches_without_an_area_are_not_flat() {
        let mut line = linear();
        line.corners[2] = line.corners[1];
        assert!(plane_error(&VIEW, &line) > 1e30);
        line.corners[2] = Vec3::NAN;
        assert!(plane_error(&VIEW, &line) > 1e30 && line_error(&VIEW, &line) > 1e15);
    }

    #[test]
    fn points_slide_along_a_patch_that_is_a_line() {
        // Its control points are anywhere on the line, and not beyond its ends.
        let at = |x: f32| Vec3::X * x;
        let mut net = ControlNet {
            corners: [at(0.1), at(0.7), at(0.3)],
            edges: [at(0.1), at(0.1), at(0.7), at(0.7), at(0.5), at(0.2)],
            center: at(0.6),
        };
        let error = |net: &ControlNet, at| piece_error(&seen(&VIEW, net), 0.25, at);
        assert!(error(&net, WHOLE) < 1e-3 && error(&net, [Vec2::X, Vec2::Y * 0.5, Vec2::ZERO]) < 1e-3);
        net.center.y = 0.01;
        assert!((line_error(&VIEW, &net) - 2.0).abs() < 1e-3, "{}", line_error(&VIEW, &net));
        net.center = at(0.8);
        assert!(error(&net, WHOLE) > 1.0, "beyond its end");
    }

    #[test]
    fn normals_within_a_degree_agree() {
        let leaning = |degrees: f32| vec3(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
        assert!(normals_agree([Vec3::Z, leaning(0.9), Vec3::Z]));
        assert!(!normals_agree([Vec3::Z, leaning(1.1), Vec3::Z]));
        assert!(!normals_agree([leaning(-0.6), Vec3::Z, leaning(0.6)]));
    }

    fn cubic(a: Vec3, ab: Vec3, ba: Vec3, b: Vec3, t: f32) -> Vec2 {
        let s = 1.0 - t;
        let p = a * (s * s * s) + ab * (3.0 * s * s * t) + ba * (3.0 * s * t * t) + b * (t * t * t);
        p.truncate() * 100.0
    }

    /// Returns the outline of a flat patch on screen.
    fn outline(net: &ControlNet) -> Vec<Vec2> {
        let side = |k: usize| {
            let (a, b) = (net.corners[k], net.corners[(k + 1) % 3]);
            (0..400).map(move |i| cubic(a, net.edges[2 * k], net.edges[2 * k + 1], b, i as f32 / 400.0))
        };
        (0..3).flat_map(side).collect()
    }

    /// Returns how far a point is outside an outline; 0 within.
    fn outside(outline: &[Vec2], p: Vec2) -> f32 {
        let (mut winding, mut nearest) = (0.0, f32::MAX);
        for (i, &a) in outline.iter().enumerate() {
            let b = outline[(i + 1) % outline.len()];
            winding += (a - p).angle_to(b - p);
            let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            nearest = nearest.min(p.distance(a.lerp(b, share)));
        }
        if winding.abs() > 3.0 { 0.0 } else { nearest }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]
        #[test]
        fn triangles_of_bent_patches_stay_within_the_tolerance(
            moves in prop::array::uniform14(-0.08f32..0.08),
            tolerance in 0.3f32..2.0,
        ) {
            let mut net = linear();
            for i in 0..6 {
                net.edges[i] += vec3(moves[2 * i], moves[2 * i + 1], 0.0);
            }
            net.center += vec3(moves[12], moves[13], 0.0);
            let patch = seen(&VIEW, &net);
            let found = |patch: &SeenPatch, least, wanted| {
                let sought = FactorSearch { least, inside: 1.0, inner: 0.0, wanted };
                fewest_triangles(patch, tolerance, Partitioning::Integer, &sought)
            };
            let ChosenFactors { edges, .. } = found(&patch, [1.0; 3], SearchGoal::Requests);
            let inside = found(&patch, edges, SearchGoal::Given).inside;
            prop_assert!(inside <= 64.0);
            let same_place = found(&seen_patch(&VIEW, &net), [1.0; 3], SearchGoal::Requests).edges;
            prop_assert!(edges.iter().sum::<f32>() <= same_place.iter().sum::<f32>() + 2.0);
            let factors = process(Partitioning::Integer, edges, inside);
            let (plan, outline) = (domain_plan(factors), outline(&net));
            for t in 0..triangle_count(factors) {
                let corners = domain_triangle(&plan, t).map(|i| {
                    let [x, y] = domain_point(&plan, i).map(|x| x as f32 / FIXED_ONE as f32);
                    point(&net, [x, y, 1.0 - x - y])
                });
                for (i, j) in (0..=6).flat_map(|i| (0..=6 - i).map(move |j| (i, j))) {
                    let weights = [i, j, 6 - i - j].map(|x| x as f32 / 6.0);
                    let p: Vec2 = (0..3).map(|k| corners[k] * weights[k]).sum();
                    prop_assert!(outside(&outline, p) <= tolerance + 0.01, "triangle {t} of {factors:?}, {p}");
                }
            }
        }
    }

    /// Returns a point of a patch in px.
    fn point(net: &ControlNet, [x, y, z]: [f32; 3]) -> Vec2 {
        let [a, b, c] = net.corners;
        let [ab, ba, bc, cb, ca, ac] = net.edges;
        let p = a * (x * x * x)
            + b * (y * y * y)
            + c * (z * z * z)
            + (ab * x + ba * y) * (3.0 * x * y)
            + (bc * y + cb * z) * (3.0 * y * z)
            + (ca * z + ac * x) * (3.0 * z * x)
            + net.center * (6.0 * x * y * z);
        p.truncate() * 100.0
    }
}
