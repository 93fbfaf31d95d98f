use glam::{Mat4, vec3};
use proptest::prelude::*;

use super::*;
use crate::tessellate::largest_patch;

fn requested_factors(
    patch: &SeenPatch,
    tolerance: f32,
    partitioning: Partitioning,
    least: [f32; 3],
    inside: f32,
    inner: f32,
) -> ChosenFactors {
    fewest_triangles(
        patch,
        tolerance,
        partitioning,
        &FactorSearch { least, inside, inner, wanted: SearchGoal::Requests },
    )
}

fn minimum_factors(
    patch: &SeenPatch,
    tolerance: f32,
    partitioning: Partitioning,
    least: [f32; 3],
    inside: f32,
) -> ChosenFactors {
    fewest_triangles(
        patch,
        tolerance,
        partitioning,
        &FactorSearch { least, inside, inner: 0.0, wanted: SearchGoal::Own },
    )
}

fn least_inside_factor(
    patch: &SeenPatch,
    tolerance: f32,
    partitioning: Partitioning,
    edges: [f32; 3],
    (inside, inner): (f32, f32),
) -> f32 {
    let sought = FactorSearch { least: edges, inside, inner, wanted: SearchGoal::Given };
    fewest_triangles(patch, tolerance, partitioning, &sought).inside
}
use crate::tessellate::ControlNet;
use crate::tessellate::piece_error::seen_patch;

const VIEW: LodView = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));

#[test]
fn factors_are_the_least_of_each_partitioning() {
    let of =
        |partitioning, least: &[f32]| least.iter().map(|&least| factor_from(partitioning, least)).collect::<Vec<_>>();
    let least = [1.0, 1.1, 2.5, 3.0, 3.1, 8.0, 62.5, 63.5, 64.5];
    assert_eq!(of(Partitioning::Integer, &least), [1.0, 2.0, 3.0, 3.0, 4.0, 8.0, 63.0, 64.0, BEYOND_LAST]);
    assert_eq!(of(Partitioning::Pow2, &least), [1.0, 2.0, 4.0, 4.0, 4.0, 8.0, 64.0, 64.0, BEYOND_LAST]);
    assert_eq!(of(Partitioning::FractionalEven, &least), [2.0, 2.0, 4.0, 4.0, 4.0, 8.0, 64.0, 64.0, BEYOND_LAST]);
    assert_eq!(of(Partitioning::FractionalOdd, &least), [1.0, 3.0, 3.0, 3.0, 5.0, 9.0, 63.0, BEYOND_LAST, BEYOND_LAST]);
}

#[test]
fn the_next_factor_passes_over_none_that_is_enough() {
    for first in 1..=20u8 {
        for enough in first + 1..=64 {
            // The error falls with the square of the number of segments, and `enough` segments keep a tolerance of 1.
            let error = (f32::from(enough) / f32::from(first)).powi(2);
            let next = next_factor(Partitioning::Integer, first.into(), error, 1.0);
            assert!(next > first.into() && next <= enough.into(), "{first}, {enough}: {next}");
        }
    }
    assert_eq!(next_factor(Partitioning::Integer, 3.0, f32::NAN, 1.0), BEYOND_LAST);
    assert_eq!(next_factor(Partitioning::Integer, 64.0, 0.0, 1.0), BEYOND_LAST);
    assert_eq!(next_factor(Partitioning::Pow2, 64.0, 0.0, 1.0), BEYOND_LAST);
}

#[test]
fn the_factor_of_a_parabola_is_that_of_the_closed_form() {
    // Both second differences are d, so the error of n segments is 3/4 d / n^2.
    let d = 0.2;
    let net = [vec3(-0.9, 0.0, 0.5), vec3(-0.3, d, 0.5), vec3(0.3, d, 0.5), vec3(0.9, 0.0, 0.5)];
    let height = 0.75 * d * 100.0;
    for n in 1..20u8 {
        let factor = least_edge_factor(&VIEW, 1.001 * height / f32::from(n).powi(2), Partitioning::Integer, net);
        assert_eq!(factor, f32::from(n));
    }
    assert_eq!(least_edge_factor(&VIEW, height / 65f32.powi(2), Partitioning::Integer, net), BEYOND_LAST);
}

/// Returns the net of a patch with these corners and control points lifted by these heights.
fn lifted(corners: [Vec3; 3], heights: [f32; 7]) -> ControlNet {
    let [a, b, c] = corners;
    let third = |p: Vec3, q: Vec3| p.lerp(q, 1.0 / 3.0);
    let straight = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
    let up = vec3(0.3, 0.9, 0.0);
    let edges = std::array::from_fn(|i| straight[i] + up * heights[i]);
    ControlNet { corners, edges, center: (a + b + c) / 3.0 + up * heights[6] }
}

const CORNERS: [Vec3; 3] = [vec3(-0.5, -0.5, 0.5), vec3(0.6, -0.3, 0.5), vec3(0.0, 0.7, 0.5)];

#[test]
fn flat_patches_ask_for_the_least_factors() {
    let patch = seen_patch(&VIEW, &lifted(CORNERS, [0.0; 7]));
    for partitioning in Partitioning::DIRECT3D {
        let least = [factor_from(partitioning, 1.0); 3];
        let ChosenFactors { edges, inside: chosen, .. } =
            requested_factors(&patch, 0.01, partitioning, least, 1.0, 0.0);
        assert_eq!(edges, least, "{partitioning:?}");
        let inside = least_inside_factor(&patch, 0.01, partitioning, least, (1.0, 0.0));
        let expected = if partitioning == Partitioning::FractionalEven { 2.0 } else { 1.0 };
        assert_eq!([inside, chosen], [expected; 2], "{partitioning:?}");
    }
}

#[test]
fn heights_inside_and_factors_of_edges_are_kept() {
    let patch = seen_patch(&VIEW, &lifted(CORNERS, [0.0; 7]));
    let edges = [3.0, 1.0, 7.0];
    let requested = requested_factors(&patch, 0.01, Partitioning::Integer, edges, 5.0, 0.0);
    assert_eq!(requested, ChosenFactors { edges, inside: 5.0, inner: 5.0 });
    assert_eq!(least_inside_factor(&patch, 0.01, Partitioning::Integer, edges, (5.0, 0.0)), 5.0);
}

#[test]
fn an_inside_factor_above_64_says_that_none_is_enough() {
    let patch = seen_patch(&VIEW, &lifted(CORNERS, [0.1; 7]));
    for partitioning in Partitioning::DIRECT3D {
        let least = [factor_from(partitioning, 1.0); 3];
        let none = ChosenFactors { edges: least, inside: BEYOND_LAST, inner: 0.0 };
        let inside = |edges, tolerance| least_inside_factor(&patch, tolerance, partitioning, edges, (1.0, 0.0));
        assert_eq!(requested_factors(&patch, 1e-6, partitioning, least, 1.0, 0.0), none, "{partitioning:?}");
        assert_eq!(minimum_factors(&patch, 1e-6, partitioning, least, 1.0), none, "{partitioning:?}");
        assert_eq!(inside(least, 1e-6), BEYOND_LAST, "{partitioning:?}");
        assert_eq!(inside([BEYOND_LAST; 3], 1.0), BEYOND_LAST);
    }
}

#[test]
fn what_is_not_a_number_ends_the_search() {
    let patch = seen_patch(&VIEW, &lifted([Vec3::NAN, Vec3::X, Vec3::Y], [0.1; 7]));
    for partitioning in Partitioning::DIRECT3D {
        let least = [factor_from(partitioning, 1.0); 3];
        assert_eq!(requested_factors(&patch, 0.5, partitioning, least, 1.0, 0.0).edges, least);
        assert_eq!(least_inside_factor(&patch, 0.5, partitioning, least, (1.0, 0.0)), BEYOND_LAST);
    }
}

/// Returns the fewest triangles of a patch, where each segment of its edges counts as `segment` triangles, by trying all
/// factors up to 14, of which those of edges are no more than [`ROW_REACH`] beyond the one inside.
fn fewest(patch: &SeenPatch, tolerance: f32, partitioning: Partitioning, segment: f32) -> Option<f32> {
    let within = BOUND_SHARE * tolerance;
    let least = factor_from(partitioning, 1.0);
    if single_suffices(patch, within, partitioning, [least; 3], 1.0) {
        return Some(3.0 * segment);
    }
    let factors = || (1..=14u8).map(f32::from).filter(|&factor| factor_from(partitioning, factor) == factor);
    let of = |inside: f32| {
        let error = part_errors(patch, within, process(partitioning, [2.0; 3], inside), from_fn(|part| part == 3))[3];
        let edge = |k: usize| {
            factors().filter(|&factor| factor <= factor_from(partitioning, inside + ROW_REACH)).find(|&factor| {
                let mut edges = [2.0; 3];
                edges[k] = factor;
                let wanted = from_fn(|part| part == k);
                part_errors(patch, within, process(partitioning, edges, inside), wanted)[k] <= within
            })
        };
        let rings = inside - 2.0;
        let cost = 3.0 * rings + 1.5 * rings * rings;
        (error <= within).then_some(())?;
        Some(cost + segment * (edge(0)? + edge(1)? + edge(2)?))
    };
    factors().filter(|&inside| inside >= 2.0).filter_map(of).reduce(f32::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn patches_ask_for_the_fewest_triangles(
        heights in prop::array::uniform7(-0.15f32..0.15),
        tolerance in 0.7f32..3.0,
        index in 0usize..4,
    ) {
        let partitioning = Partitioning::DIRECT3D[index];
        let patch = seen_patch(&VIEW, &lifted(CORNERS, heights));
        let least = [factor_from(partitioning, 1.0); 3];
        let count = |[u, v, w]: [f32; 3], inside: f32, segment: f32| {
            let rings = (inside - 2.0).max(0.0);
            3.0 * rings + 1.5 * rings * rings + segment * (u + v + w)
        };
        if let Some(fewest) = fewest(&patch, tolerance, partitioning, 2.0) {
            let requested = requested_factors(&patch, tolerance, partitioning, least, 1.0, 0.0);
            let inside = |inner| least_inside_factor(&patch, tolerance, partitioning, requested.edges, (1.0, inner));
            prop_assert!(requested.inside <= 64.0 && inside(0.0) == requested.inside, "{requested:?} {}", inside(0.0));
            prop_assert_eq!(count(requested.edges, requested.inside, 2.0), fewest, "{:?}", requested);
            // What is known of the inner triangles changes no factor.
            prop_assert_eq!(inside(requested.inner), requested.inside, "{:?}", requested);
            let again = requested_factors(&patch, tolerance, partitioning, least, 1.0, requested.inner);
            prop_assert_eq!((again.edges, again.inside), (requested.edges, requested.inside));
        }
        if let Some(fewest) = fewest(&patch, tolerance, partitioning, 1.0) {
            let own = minimum_factors(&patch, tolerance, partitioning, least, 1.0);
            prop_assert!(own.inside <= 64.0);
            prop_assert_eq!(count(own.edges, own.inside, 1.0), fewest, "{:?}", own);
        }
    }
}

#[test]
fn patches_ask_again_if_their_inside_is_much_larger_than_they_chose() {
    assert!(!requests_again(1.0, 2.0) && requests_again(1.0, 3.0));
    assert!(!requests_again(18.0, 20.0) && requests_again(18.0, 21.0));
    assert!(requests_again(64.0, BEYOND_LAST));
}

#[test]
fn all_triangles_of_the_largest_pattern_are_looked_at() {
    let most = triangle_count(largest_patch()).div_ceil(TOGETHER);
    for turns in [1, 2, 512, most - 1, most] {
        let order: std::collections::HashSet<u32> = (0..turns).map(|turn| turn * SPREAD % turns).collect();
        assert_eq!(order.len(), turns as usize, "{turns} turns");
    }
    assert!((2..SPREAD).all(|divisor| !SPREAD.is_multiple_of(divisor)) && most < SPREAD);
}
