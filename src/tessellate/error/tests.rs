use super::*;
use crate::tessellate::{domain_plan, domain_point, domain_triangle, process, triangle_count};
use glam::{Mat4, Vec4, vec3};

const VIEW: LodView = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));

/// Returns the net of a flat patch whose centre control point is lifted by `z`.
fn raised(corners: [Vec3; 3], z: f32) -> ControlNet {
    let third = |a: Vec3, b: Vec3| a.lerp(b, 1.0 / 3.0);
    let [a, b, c] = corners;
    let edges = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
    ControlNet { corners, edges, center: (a + b + c) / 3.0 + Vec3::Z * z }
}

const CORNERS: [Vec3; 3] = [vec3(0.0, 0.0, 0.5), vec3(0.6, 0.0, 0.5), vec3(0.0, 0.6, 0.5)];

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
fn the_factor_of_a_parabola_is_that_of_the_closed_form() {
    // Both second differences are d, so the error of n segments is 3/4 d / n^2.
    let d = 0.2;
    let net = [vec3(-0.9, 0.0, 0.5), vec3(-0.3, d, 0.5), vec3(0.3, d, 0.5), vec3(0.9, 0.0, 0.5)];
    let height = 0.75 * d * 100.0;
    for n in 1..20u8 {
        let factor = edge_error_factor(&VIEW, height / f32::from(n).powi(2), net);
        assert!((factor - f32::from(n)).abs() < 1e-3, "{n}: {factor}");
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

#[test]
fn flat_edges_and_patches_get_a_factor_of_1() {
    let net = raised(CORNERS, 0.0);
    for partitioning in [Partitioning::Integer, Partitioning::Pow2, Partitioning::FractionalOdd] {
        assert_eq!(inside_error_factor(&VIEW, 0.25, partitioning, &net, [1.0; 3]), 1.0);
    }
    assert_eq!(edge_error_factor(&VIEW, 0.25, [Vec3::X, Vec3::X * 2.0, Vec3::X * 3.0, Vec3::X * 4.0]), 1.0);
}

#[test]
fn the_factor_is_above_64_if_no_number_of_segments_suffices() {
    let net = raised(CORNERS, 0.0);
    let twisted = ControlNet { center: net.center + Vec3::X * 0.2, ..net };
    for partitioning in Partitioning::DIRECT3D {
        let inside = |tolerance| inside_error_factor(&VIEW, tolerance, partitioning, &twisted, [1.0; 3]);
        assert!(inside(1e-4) > 64.0 && inside(1e-9) > 64.0, "{partitioning:?}");
        let enough = inside(5.0);
        assert!(enough > 1.0 && enough <= 64.0, "{partitioning:?}: {enough}");
    }
}

#[test]
fn errors_in_depth_count_with_perspective_only() {
    let net = raised(CORNERS, 0.3);
    assert_eq!(inside_error_factor(&VIEW, 0.25, Partitioning::Integer, &net, [1.0; 3]), 1.0);
    let mut clip_from_object = Mat4::IDENTITY;
    clip_from_object.z_axis = Vec4::new(0.0, 0.0, 0.0, 1.0);
    clip_from_object.w_axis = Vec4::new(0.0, 0.0, 0.01, 0.0);
    let perspective = LodView { clip_from_object, ..VIEW };
    assert!(inside_error_factor(&perspective, 0.25, Partitioning::Integer, &net, [1.0; 3]) > 4.0);
}

#[test]
fn mixed_bounds_hold_for_means_with_a_point_behind_the_eye() {
    let mut clip_from_object = Mat4::IDENTITY;
    clip_from_object.z_axis = Vec4::new(0.0, 0.0, 0.0, 1.0);
    clip_from_object.w_axis = Vec4::new(0.0, 0.0, 0.01, 0.0);
    let view = LodView { clip_from_object, ..VIEW };
    let (beside, behind) = (vec3(0.5, 0.0, 10.0), vec3(0.5, 0.0, -50.0));
    let own = edge_bounds(&view, [beside; 4]);
    let other = widen(&view, own, behind);
    let between = beside.lerp(behind, 0.1);
    assert!(mixed_bounds(own, other, 0.1).nearest <= between.z, "{between}");
}

#[test]
fn levels_are_the_least_nesting_factors_of_each_partitioning() {
    let of = |partitioning, least: &[f32]| least.iter().map(|&x| nesting_factor(partitioning, x)).collect::<Vec<_>>();
    let least = [1.0, 1.1, 2.5, 3.0, 3.1, 4.5, 8.0, 9.5, 33.0];
    assert_eq!(of(Partitioning::Integer, &least), [1.0, 2.0, 3.0, 3.0, 4.0, 5.0, 8.0, 16.0, 64.0]);
    assert_eq!(of(Partitioning::Pow2, &least), [1.0, 2.0, 4.0, 4.0, 4.0, 8.0, 8.0, 16.0, 64.0]);
    assert_eq!(of(Partitioning::FractionalEven, &least), [2.0, 2.0, 4.0, 4.0, 4.0, 8.0, 8.0, 16.0, 64.0]);
    assert_eq!(of(Partitioning::FractionalOdd, &least), [1.0, 3.0, 3.0, 3.0, 5.0, 5.0, 9.0, 17.0, 33.0]);
    for partitioning in Partitioning::DIRECT3D {
        assert!(
            nesting_factor(partitioning, 64.1) > 64.0 && nesting_factor(partitioning, 1e9) > 64.0,
            "{partitioning:?}: beyond the last level"
        );
    }
}

/// Returns how far the triangles of the row beside the edge U == 0 reach along it, in the longer one of the segments of
/// the edge and of the first ring.
fn reach(partitioning: Partitioning, factor: f32, inside: f32) -> f64 {
    let factors = process(partitioning, [factor, inside, inside], inside);
    let plan = domain_plan(factors);
    let mut longest = 0.0f64;
    for triangle in 0..triangle_count(factors) {
        let corners = domain_triangle(&plan, triangle).map(|i| domain_point(&plan, i).map(|x| f64::from(x) / 65536.0));
        let beside = |[u, v]: [f64; 2]| u <= v + 1e-4 && u <= 1.0 - u - v + 1e-4;
        if corners.into_iter().all(beside) && corners.iter().any(|[u, _]| *u == 0.0) {
            let along = corners.map(|[u, v]| v + u / 2.0);
            let ends = along.into_iter().fold((1.0f64, 0.0f64), |(a, b), x| (a.min(x), b.max(x)));
            longest = longest.max(ends.1 - ends.0);
        }
    }
    longest * f64::from(factor.min(inside))
}

/// Returns how far the sides across the row beside the edge U == 0 lean along the edge, as a part of the edge.
fn slant(factor: f32, inside: f32) -> f64 {
    let factors = process(Partitioning::Integer, [factor, inside, inside], inside);
    let plan = domain_plan(factors);
    let mut longest = 0.0f64;
    for triangle in 0..triangle_count(factors) {
        let corners = domain_triangle(&plan, triangle).map(|i| domain_point(&plan, i).map(|x| f64::from(x) / 65536.0));
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let ([a, v], [b, w]) = (corners[a], corners[b]);
            // Leave out the rows of the other two edges, which start at this edge's ends.
            let beside = v.min(1.0 - a - v) >= a - 1e-4 && w.min(1.0 - b - w) >= b - 1e-4;
            if beside && (a == 0.0) != (b == 0.0) {
                longest = longest.max((v + a / 2.0 - w - b / 2.0).abs());
            }
        }
    }
    longest
}

#[test]
fn half_of_the_triangles_beside_an_edge_of_one_segment_start_at_each_end() {
    for inside in 2..=64u8 {
        let (slant, most) = (slant(1.0, inside.into()), 0.5 + 0.5 / f64::from(inside));
        assert!(slant <= most * 1.0005 && slant >= 0.4995, "{inside}: {slant}");
    }
    assert!(slant(2.0, 64.0) > 0.48, "with two segments, all triangles of a row may start at one end");
}

#[test]
fn triangles_between_rows_of_levels_are_short_and_others_are_long() {
    // All levels nest with each other, so for any levels of the edges there is a number of segments that nests with all.
    for partitioning in Partitioning::DIRECT3D {
        let mut levels: Vec<f32> = (1..=33).map(|least| nesting_factor(partitioning, least as f32)).collect();
        levels.dedup();
        for (&factor, &inside) in levels.iter().flat_map(|a| levels.iter().map(move |b| (a, b))) {
            let reach = reach(partitioning, factor, inside);
            assert!(reach < 1.0011 || inside < 5.0, "{partitioning:?}: {factor} beside {inside} reaches {reach}");
        }
    }
    let masks = [5, 8, 9, 16, 17, 32, 33, 64].map(|factor| {
        let bit = |n: u32| u64::from(reach(Partitioning::Integer, factor as f32, n as f32) < 1.0011) << (n - 1);
        (1..=64).map(bit).sum::<u64>()
    });
    assert_eq!(NESTING.map(|[low, high]| u64::from(low) | u64::from(high) << 32), masks, "{masks:#x?}");
    for (k, factor) in [5.0, 8.0, 9.0, 16.0, 17.0, 32.0, 33.0, 64.0].into_iter().enumerate() {
        for n in 1..=64 {
            assert_eq!(nests(factor, n), masks[k] >> (n - 1) & 1 == 1, "{factor} beside {n}");
        }
    }
    assert!(
        reach(Partitioning::Integer, 64.0, 48.0) > 4.9,
        "other factors still cost what levels were introduced to save"
    );
}

#[test]
fn bounds_are_widened_by_what_displacement_may_move() {
    let spread = |view: &LodView, p: Vec3| {
        let bounds = widen(view, no_bounds(), p);
        [bounds.least.x, bounds.least.y, bounds.greatest.x, bounds.greatest.y, bounds.nearest, bounds.farthest]
    };
    let near = |own: [f32; 6], expected: [f32; 6]| {
        assert!(own.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{own:?}, not {expected:?}");
    };
    let flat = LodView { reach: 0.1, ..VIEW };
    near(spread(&flat, vec3(0.3, -0.2, 0.5)), [0.2, -0.3, 0.4, -0.1, 1.0, 1.0]);
    // With perspective, a point at a depth of 2 may come as near as 1.6: it moves by 0.4 across, and by as much of its
    // place as it comes nearer.
    let mut clip_from_object = Mat4::IDENTITY;
    clip_from_object.z_axis = Vec4::new(0.0, 0.0, 0.0, 1.0);
    clip_from_object.w_axis = Vec4::new(0.0, 0.0, 0.01, 0.0);
    let perspective = LodView { clip_from_object, reach: 0.4, ..VIEW };
    let (across, up) = ((0.4 + 0.5 * 0.4) / 1.6, 0.4 / 1.6);
    near(spread(&perspective, vec3(1.0, 0.0, 2.0)), [0.5 - across, -up, 0.5 + across, up, 1.6, 2.4]);
}

#[test]
fn differences_on_screen_are_those_of_one_moved_control_point() {
    // The control point beside an end of the edge opposite corner 0 is moved across the view by 30 px. At that end it is
    // part of the difference along and inward, and at corner 0 of the one along; both make up one diagonal.
    for moved in [1, 4] {
        let mut net = raised(CORNERS, 0.0);
        net.edges[moved] += Vec3::X * 0.3;
        let own = screen_differences(&VIEW, net_bounds(&VIEW, &net), &net, 0);
        let expected = [30.0, 30.0 * 2.0 / 3.0, 30.0 * 4.0 / 9.0, 30.0 * 16.0 / 9.0];
        assert!(own.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{moved}: {own:?}, not {expected:?}");
    }
}

#[test]
fn errors_inside_fall_with_the_square_of_the_number_of_segments() {
    // The triangle in the middle is equilateral in its second differences, so that its error is that of its sides.
    for (segments, expected) in [(1.0, 1.001), (4.0, 1.001 / 16.0), (5.0, 1.001 / 25.0)] {
        let own = inner_error([[1.0, 0.0, 0.0, 0.0]; 3], segments);
        assert!((own - expected).abs() < 1e-6, "{segments}: {own}");
    }
}

#[test]
fn a_row_of_two_segments_is_seen_from_as_near_as_its_inner_points_may_be() {
    let at =
        |nearest: f32| ScreenBounds { nearest, farthest: 1.0, least: Vec2::ZERO, greatest: Vec2::ZERO, is_cut: false };
    let row = EdgeRow { bounds: at(1.0), along: [Vec3::X * 0.35; 3], mixed: [Vec3::ZERO; 3] };
    // The weight of the opposite corner is up to 1/3 in the row, so 1 - (2/3)^3 = 19/27 of a way from 1 to 1/2: the
    // nearest depth is 35/54, and 35 px become 54. Half a segment costs a quarter of them.
    let own = edge_row_error(&VIEW, row, at(0.5), [0.0; 4], 2.0, 2.0);
    assert!((own - 0.751 * 54.0 / 4.0).abs() < 1e-4, "{own}");
}

#[test]
fn bounds_of_a_net_hold_all_ten_control_points() {
    let net = raised(CORNERS, 0.0);
    for (k, mut moved) in [net; 10].into_iter().enumerate() {
        *match k {
            0..3 => &mut moved.corners[k],
            3..9 => &mut moved.edges[k - 3],
            _ => &mut moved.center,
        } = vec3(-3.0, 5.0, 0.5);
        let bounds = net_bounds(&VIEW, &moved);
        assert_eq!((bounds.least.x, bounds.greatest.y), (-3.0, 5.0), "control point {k}");
    }
}

#[test]
fn mixed_bounds_are_weighted_by_depth() {
    let bounds = |nearest: f32, farthest: f32, reach: f32| ScreenBounds {
        nearest,
        farthest,
        least: Vec2::splat(-reach),
        greatest: Vec2::splat(reach),
        is_cut: false,
    };
    // The nearest mean is a quarter of 1 and three quarters of 7/3, which is 2. There, a quarter of a point at a depth of
    // 4 counts as a half.
    let own = mixed_bounds(bounds(7.0 / 3.0, 3.0, 0.25), bounds(1.0, 4.0, 0.75), 0.25);
    assert!((own.nearest - 2.0).abs() < 1e-6 && own.farthest == 4.0 && !own.is_cut, "{own:?}");
    assert!(own.least.distance(Vec2::splat(-0.5)) < 1e-6 && own.greatest.distance(Vec2::splat(0.5)) < 1e-6, "{own:?}");
}

#[test]
fn heights_need_segments_for_their_detail_and_for_their_turning() {
    let view = LodView { reach: 0.5, ..VIEW };
    let bounds = ScreenBounds { nearest: 1.0, farthest: 1.0, least: Vec2::ZERO, greatest: Vec2::ZERO, is_cut: false };
    let mut detail = [0.5; MAX_LEVELS];
    (detail[0], detail[1], detail[2]) = (0.0, 0.001, 0.01);
    // A length of 1 is 100 px across and 100 px up. Of a tolerance of 10 px, 3 px are for the detail, which is 2 px at
    // level 2 with the scale 1.4, and 4 px with 2.8.
    let factor = |turn, scale| displacement_factor(&view, bounds, 10.0, 64.0, turn, scale, detail);
    assert_eq!([factor(0.0, 1.4), factor(0.0, 2.8)], [64.0 / 4.0, 64.0 / 2.0]);
    assert_eq!(factor(0.0, 1400.0), 64.0, "each level loses too much");
    // 2 px of it are for the turning.
    let bend = 0.5 * 0.28125 * 20.0_f32.powi(2) * 100.0 * 2.0_f32.sqrt();
    let turning = factor(20.0, 1.4);
    assert!((turning - (bend / 2.0).sqrt()).abs() < 1e-3, "{turning}");
}
