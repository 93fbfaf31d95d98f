use glam::{DMat4, DVec2, DVec3, DVec4, Mat4, vec3};
use proptest::prelude::*;

use super::*;

#[test]
fn control_points_are_found_by_their_indices() {
    let at = |x: f32| Vec3::splat(x);
    let corners = [at(300.0), at(30.0), at(3.0)];
    let edges = [at(210.0), at(120.0), at(21.0), at(12.0), at(102.0), at(201.0)];
    let net = ControlNet { corners, edges, center: at(111.0) };
    for [i, j, l] in (0..27).map(|n| [n / 9, n / 3 % 3, n % 3]) {
        let name = [i, j, l].map(|index: usize| [100.0, 10.0, 1.0][index]).iter().sum();
        assert_eq!(control_point(&net, i, j, l), at(name), "{i} {j} {l}");
    }
}

#[test]
fn triangle_error_is_the_maximum_over_all_weights() {
    for [a, b, c] in [
        [1.0, 1.0, 1.0],
        [1.0, 1.0, 2.0],
        [1.0, 2.0, 2.5],
        [0.0, 1.0, 1.0],
        [0.3, 0.0, 0.0],
        [1.0, 0.9, 0.1],
        [1e-6, 1.0, 1.0],
    ] {
        let sum = |u: f32, v: f32, w: f32| 3.0 * (u * v * a + v * w * b + w * u * c);
        let steps = (0..=300).flat_map(|i| (0..=300 - i).map(move |j| [i as f32 / 300.0, j as f32 / 300.0]));
        let most = steps.map(|[u, v]| sum(u, v, 1.0 - u - v)).fold(0.0, f32::max);
        let bound = triangle_error(a, b, c);
        assert!(bound >= most - 1e-6 && bound < most + 1e-4, "{a} {b} {c}: {bound}, {most}");
    }
}

/// Returns the point of a net in f64.
fn point(net: &ControlNet, [x, y, z]: [f64; 3]) -> DVec3 {
    let [a, b, c] = net.corners.map(Vec3::as_dvec3);
    let [ab, ba, bc, cb, ca, ac] = net.edges.map(Vec3::as_dvec3);
    a * (x * x * x)
        + b * (y * y * y)
        + c * (z * z * z)
        + (ab * x + ba * y) * (3.0 * x * y)
        + (bc * y + cb * z) * (3.0 * y * z)
        + (ca * z + ac * x) * (3.0 * z * x)
        + net.center.as_dvec3() * (6.0 * x * y * z)
}

/// Returns the largest distance on screen, in px, between a flat triangle and the surface, of places where one of them is
/// in view and both are beyond the near plane; sampled in f64.
fn sampled(view: &LodView, net: &ControlNet, at: [Vec2; 3]) -> f64 {
    let matrix: DMat4 = view.clip_from_object.as_dmat4();
    let corners = at.map(|at| [f64::from(at.x), f64::from(at.y), 1.0 - f64::from(at.x) - f64::from(at.y)]);
    let flat = corners.map(|corner| point(net, corner));
    let (mut worst, steps) = (0.0f64, 40);
    for (i, j) in (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| (i, j))) {
        let weights = [i, j, steps - i - j].map(|weight| f64::from(weight) / f64::from(steps));
        let place = [0, 1, 2].map(|k| (0..3).map(|c| weights[c] * corners[c][k]).sum());
        let emitted: DVec3 = (0..3).map(|c| flat[c] * weights[c]).sum();
        let [surface, emitted] = [point(net, place), emitted].map(|p| matrix * p.extend(1.0));
        let beyond = |clip: DVec4| clip.w > 0.0 && clip.z <= clip.w;
        let in_view = |clip: DVec4| clip.x.abs() <= clip.w && clip.y.abs() <= clip.w;
        if beyond(surface) && beyond(emitted) && (in_view(surface) || in_view(emitted)) {
            let px = |clip: DVec4| DVec2::new(clip.x, clip.y) / clip.w * view.half_viewport.as_dvec2();
            worst = worst.max(px(surface).distance(px(emitted)));
        }
    }
    worst
}

/// Looks along -Z from the origin, or without perspective. The near plane is at depth 0.1.
fn view(perspective: bool) -> LodView {
    let clip_from_object = if perspective {
        Mat4::from_cols_array_2d(&[
            [1.2, 0.0, 0.0, 0.0],
            [0.0, 2.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 0.1, 0.0],
        ])
    } else {
        Mat4::from_scale(vec3(0.6, 1.0, 0.01))
    };
    LodView::new(clip_from_object, Vec2::new(640.0, 360.0))
}

/// Returns how much the finest grid of a triangle leaves between its points, in px, if its errors are up to `px`: the bound from
/// second derivatives at its steps, and what depths and places change within a step.
fn left_between(patch: &SeenPatch, at: [Vec2; 3], px: f64) -> f64 {
    let piece = piece_of(patch, at);
    let depths = piece.corners.map(|corner| f64::from(corner.z));
    let deep: Vec<f64> = piece.differences.iter().map(|difference| f64::from(difference.z)).collect();
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let before = -most(&deep.iter().map(|z| -z).collect::<Vec<_>>());
    let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min) + before;
    let ratio = (most(&depths) + most(&deep)) / nearest;
    let [a, b, c] = piece.places;
    let longest = f64::from(a.distance(b).max(b.distance(c)).max(c.distance(a)));
    let middle = (a + b + c) / 3.0;
    let spread = a.distance(middle).max(b.distance(middle)).max(c.distance(middle));
    let bound = f64::from(derivative_bound(&piece, middle, spread)) / nearest;
    let share = 1.0 / f64::from(FINEST_GRID);
    let largest = most(&deep.iter().map(|z| z.abs()).collect::<Vec<_>>());
    px * (ratio - 1.0) * share + bound * share * share + longest * ratio * share * largest / nearest
}

prop_compose! {
    /// A patch whose control points lie around its corners', and a triangle in its domain.
    fn any_patch(depths: std::ops::Range<f32>)(
        corners in prop::array::uniform3([-1.0f32..1.0, -1.0f32..1.0, depths]),
        moved in prop::array::uniform7([-0.2f32..0.2, -0.2f32..0.2, -0.2f32..0.2]),
        places in prop::array::uniform3((0.0f32..1.0, 0.0f32..1.0)),
        size in 0.05f32..1.0,
    ) -> (ControlNet, [Vec2; 3]) {
        let corners = corners.map(Vec3::from);
        let [a, b, c] = corners;
        let third = |p: Vec3, q: Vec3| p.lerp(q, 1.0 / 3.0);
        let straight = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
        let edges = std::array::from_fn(|i| straight[i] + Vec3::from(moved[i]));
        let center = (a + b + c) / 3.0 + Vec3::from(moved[6]);
        let within = |(x, y): (f32, f32)| if x + y > 1.0 { Vec2::new(1.0 - x, 1.0 - y) } else { Vec2::new(x, y) };
        let first = within(places[0]);
        let at = places.map(|place| first + (within(place) - first) * size);
        (ControlNet { corners, edges, center }, at)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn errors_are_bounded_from_above_and_tightly((net, at) in any_patch(-4.0..-1.5), perspective in any::<bool>()) {
        let view = view(perspective);
        let (patch, px) = (seen_patch(&view, &net), sampled(&view, &net, at));
        // Whatever the tolerance, what counts as within it is.
        for share in [0.5, 0.9, 0.99, 1.0, 1.02, 1.5, 3.0] {
            let tolerance = (px * share) as f32;
            let error = piece_error(&patch, tolerance, at);
            prop_assert!(!is_within(error, tolerance) || px <= f64::from(error) * 1.0005 + 1e-3, "{error}, {px} px");
        }
        // Where all of the triangle is in view, a tolerance is kept that is larger by a fifth (and a tenth of a px), and by what the
        // finest grid leaves between its points if that is more.
        let corners = at.map(|at| view.clip_from_object * seen_object_point(&net, at).extend(1.0));
        if corners.iter().all(|clip| clip.x.abs() < 0.8 * clip.w && clip.y.abs() < 0.8 * clip.w) {
            let larger = px * 1.2 + 0.1;
            let left = left_between(&patch, at, larger);
            let tolerance = if left < 0.2 * (px + 0.1) { larger } else { larger + left } as f32;
            let error = piece_error(&patch, tolerance, at);
            prop_assert!(error <= tolerance, "{error}, {px} px, of which the grid leaves {left}");
        }
    }

    #[test]
    fn errors_are_bounded_beside_and_behind_the_eye((net, at) in any_patch(-1.5..1.0)) {
        let view = view(true);
        let (patch, px) = (seen_patch(&view, &net), sampled(&view, &net, at));
        for tolerance in [0.01f32, 0.5, 2.0, 10.0, 100.0, 1000.0] {
            let error = piece_error(&patch, tolerance, at);
            prop_assert!(!is_within(error, tolerance) || px <= f64::from(error) * 1.0005 + 1e-2, "{error}, {px} px");
        }
    }

    #[test]
    fn displacement_is_allowed_for((net, at) in any_patch(-4.0..-2.0), x in -1.0f32..1.0, y in -1.0f32..1.0, z in -1.0f32..1.0) {
        // The error as it would be seen if displacement moved all of the patch at once.
        let view = view(true).with_reach(0.2);
        let patch = seen_patch(&view, &net);
        let by = vec3(x, y, z).normalize_or_zero() * 0.19;
        let moved = ControlNet { corners: net.corners.map(|p| p + by), edges: net.edges.map(|p| p + by), center: net.center + by };
        let px = sampled(&view, &moved, at);
        for tolerance in [0.1f32, 1.0, 5.0, 20.0, 100.0] {
            let error = piece_error(&patch, tolerance, at);
            prop_assert!(!is_within(error, tolerance) || px <= f64::from(error) * 1.0005 + 1e-2, "{error}, {px} px");
        }
    }
}

fn seen_object_point(net: &ControlNet, at: Vec2) -> Vec3 {
    point(net, [at.x, at.y, 1.0 - at.x - at.y].map(f64::from)).as_vec3()
}

/// Returns the net of a flat patch whose centre control point is lifted by `z`.
fn raised(z: f32) -> ControlNet {
    let [a, b, c] = [vec3(0.0, 0.0, 0.5), vec3(0.6, 0.0, 0.5), vec3(0.0, 0.6, 0.5)];
    let third = |p: Vec3, q: Vec3| p.lerp(q, 1.0 / 3.0);
    let edges = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
    ControlNet { corners: [a, b, c], edges, center: (a + b + c) / 3.0 + Vec3::Z * z }
}

const WHOLE: [Vec2; 3] = [Vec2::X, Vec2::Y, Vec2::ZERO];

#[test]
fn errors_in_depth_count_with_perspective_only() {
    let orthographic = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));
    assert!(piece_error(&seen_patch(&orthographic, &raised(0.3)), 0.25, WHOLE) < 1e-4);
    let mut clip_from_object = Mat4::IDENTITY;
    clip_from_object.z_axis = glam::Vec4::new(0.0, 0.0, 0.0, 1.0);
    clip_from_object.w_axis = glam::Vec4::new(0.0, 0.0, 0.01, 0.0);
    let perspective = LodView { clip_from_object, ..orthographic };
    assert!(piece_error(&seen_patch(&perspective, &raised(0.3)), 0.25, WHOLE) > 0.25);
}

#[test]
fn the_depth_of_the_near_plane_is_that_of_the_projection() {
    use glam::camera::rh::proj::directx as proj;
    for near in [0.01f32, 0.5, 3.0] {
        let infinite = proj::perspective_infinite_reverse(0.7, 1.5, near);
        let finite = proj::perspective(0.7, 1.5, 50.0, near);
        for matrix in [infinite, finite] {
            let turned = matrix * Mat4::from_rotation_y(0.4) * Mat4::from_translation(vec3(1.0, 2.0, -3.0));
            let depth = near_depth(&LodView::new(turned, Vec2::ONE));
            assert!((depth - near).abs() <= near * 1e-3, "{depth}, not {near}");
        }
    }
    assert_eq!(near_depth(&view(false)), 0.0);
}

#[test]
fn nan_is_never_within_a_tolerance() {
    for at in 0..3 {
        let mut net = raised(0.1);
        net.corners[at] = Vec3::NAN;
        let error = piece_error(&seen_patch(&view(true), &net), 1e9, WHOLE);
        assert!(!is_within(error, 1e9), "{error}");
    }
}
