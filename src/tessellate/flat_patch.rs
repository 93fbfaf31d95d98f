//! Flat patches: those whose surface is a flat triangle, though its parametrisation may not be linear. Twin:
//! `shaders/flat_patch.wgsl`.
//!
//! Control points may lie along an edge or within the triangle's plane elsewhere than a linear patch has them, as normals
//! that lean along an edge put them. If nothing on the patch depends on where its points slide, it's the distance to the
//! surface that counts, not to the same place of the domain.
//!
//! Let all control points of an edge be within a distance d of the straight edge, and all control points of the patch
//! within d of the triangle's plane. Then every point of the triangle is within d of the surface. Points that are farther
//! than d from the edges are surrounded by the outline of the surface, so that the surface has a point above each. Where
//! the outline leaves out a point closer to an edge, it passes between that point and those, within d of the point.

use glam::{Vec2, Vec3};

use super::lod::{LodView, clip_row};
use super::piece_error::near_depth;
use super::surface::ControlNet;

/// The least cosine of the angle between two corners' unit normals (1 degree) at which sliding changes no shading.
pub(crate) const AGREEING: f32 = 0.99985;

/// Returns whether a patch looks the same wherever its points slide, as far as its corners' unit normals go.
pub(super) fn normals_agree([a, b, c]: [Vec3; 3]) -> bool {
    a.dot(b).min(b.dot(c)).min(c.dot(a)) >= AGREEING
}

/// Returns the part of a control point's difference from the straight edge that sliding along the edge doesn't take back;
/// all of it, if the control point isn't beside the edge. `along` leads from the edge's start to its end.
fn beside_edge(along: Vec3, difference: Vec3) -> Vec3 {
    let share = difference.dot(along) / along.dot(along);
    if share.abs() <= 1.0 / 3.0 { difference - along * share } else { difference }
}

/// Returns the larger of `most` and the length of a difference in object units on screen, in px times depth, by an eye that
/// sees it within `spread` px of the middle of the view.
fn longer_on_screen(view: &LodView, most: f32, spread: f32, difference: Vec3) -> f32 {
    let across = Vec2::new(clip_row(view, 0).dot(difference), clip_row(view, 1).dot(difference)) * view.half_viewport;
    most.max(across.length() + spread * clip_row(view, 3).dot(difference).abs())
}

/// Returns a bound on the distance between a patch's triangle and the nearest points of its surface, in px. Large if the
/// patch has no area.
pub(super) fn flat_error(view: &LodView, net: &ControlNet) -> f32 {
    let [a, b, c] = net.corners;
    let area = (b - a).cross(c - a);
    let size = area.length();
    if !(size > 1e-30 && size < 1e30) {
        return 3.4e38;
    }
    let normal = area * (1.0 / size);
    let near = near_depth(view);
    let (mut nearest, mut spread) = (3.4e38f32, 0.0f32);
    for corner in net.corners {
        let clip = view.clip_from_object * corner.extend(1.0);
        let place = Vec2::new(clip.x, clip.y) * view.half_viewport / clip.w;
        nearest = nearest.min(clip.w);
        spread = spread.max(place.length());
    }
    if !(nearest > near && nearest > 0.0) {
        // What is seen of it is anywhere in the view, and no nearer than the near plane.
        nearest = near;
        spread = view.half_viewport.length();
    }
    let center = net.center - (a + b + c) * (1.0 / 3.0);
    let mut most = longer_on_screen(view, 0.0, spread, normal * normal.dot(center));
    for k in 0..3 {
        let (start, end) = (net.corners[k], net.corners[(k + 1) % 3]);
        let at_start = net.edges[2 * k] - (start * 2.0 + end) * (1.0 / 3.0);
        let at_end = net.edges[2 * k + 1] - (start + end * 2.0) * (1.0 / 3.0);
        most = longer_on_screen(view, most, spread, beside_edge(end - start, at_start));
        most = longer_on_screen(view, most, spread, beside_edge(end - start, at_end));
    }
    most / nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat4, vec3};

    const VIEW: LodView = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));
    const CORNERS: [Vec3; 3] = [vec3(0.0, 0.0, 0.5), vec3(0.6, 0.0, 0.5), vec3(0.0, 0.6, 0.5)];

    fn linear() -> ControlNet {
        let [a, b, c] = CORNERS;
        let third = |p: Vec3, q: Vec3| p.lerp(q, 1.0 / 3.0);
        let edges = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
        ControlNet { corners: CORNERS, edges, center: (a + b + c) / 3.0 }
    }

    #[test]
    fn points_may_slide_along_edges_and_within_the_plane() {
        assert!(flat_error(&VIEW, &linear()) < 1e-4);
        let mut slid = linear();
        slid.edges[0] += Vec3::X * 0.15;
        slid.edges[2] += vec3(-0.1, 0.1, 0.0);
        slid.center += vec3(0.1, -0.1, 0.0);
        assert!(flat_error(&VIEW, &slid) < 1e-4);
    }

    #[test]
    fn what_leaves_the_edge_or_the_plane_counts() {
        // An edge that leaves its straight line within the plane, by 0.05 or 5 px.
        let mut bent = linear();
        bent.edges[1] += Vec3::Y * 0.05;
        assert!((flat_error(&VIEW, &bent) - 5.0).abs() < 1e-3);
        // A control point that isn't beside its edge any more.
        let mut outside = linear();
        outside.edges[0] -= Vec3::X * 0.3;
        assert!((flat_error(&VIEW, &outside) - 30.0).abs() < 1e-3);
        // A centre above the plane is seen from the side.
        let mut raised = linear();
        raised.center += Vec3::Z * 0.1;
        let turned = LodView::new(Mat4::from_rotation_x(1.2), Vec2::splat(100.0));
        let expected = 100.0 * 0.1 * 1.2f32.sin();
        assert!((flat_error(&turned, &raised) - expected).abs() < 1e-2);
    }

    #[test]
    fn patches_without_an_area_are_not_flat() {
        let mut line = linear();
        line.corners[2] = line.corners[1];
        assert!(flat_error(&VIEW, &line) > 1e30);
        line.corners[2] = Vec3::NAN;
        assert!(flat_error(&VIEW, &line) > 1e30);
    }

    #[test]
    fn normals_within_a_degree_agree() {
        let leaning = |degrees: f32| vec3(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
        assert!(normals_agree([Vec3::Z, leaning(0.9), Vec3::Z]));
        assert!(!normals_agree([Vec3::Z, leaning(1.1), Vec3::Z]));
        assert!(!normals_agree([leaning(-0.6), Vec3::Z, leaning(0.6)]));
    }
}
