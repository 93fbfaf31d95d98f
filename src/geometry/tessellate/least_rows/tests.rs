use std::sync::LazyLock;

use glam::{Mat4, Vec3, vec3};
use proptest::prelude::*;

use super::*;

fn requested_rows(patch: &SeenPatch, tolerance: f32, least: [f32; 3], inside: f32) -> ChosenFactors {
    fewest_rows(patch, tolerance, &FactorSearch { least, inside, inner: 0.0, wanted: SearchGoal::Requests })
}

fn minimum_rows(patch: &SeenPatch, tolerance: f32, least: [f32; 3], inside: f32) -> ChosenFactors {
    fewest_rows(patch, tolerance, &FactorSearch { least, inside, inner: 0.0, wanted: SearchGoal::Own })
}

fn rows_beside(patch: &SeenPatch, tolerance: f32, edges: [f32; 3], inside: f32) -> f32 {
    fewest_rows(patch, tolerance, &FactorSearch { least: edges, inside, inner: 0.0, wanted: SearchGoal::Given }).inside
}
use crate::tessellate::factors::{ROW_BASE_STEP, row_count, row_width, segments, triangle_count};
use crate::tessellate::piece_error::seen_patch;
use crate::tessellate::{ControlNet, LodView};

const VIEW: LodView = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));
const CORNERS: [Vec3; 3] = [vec3(-0.5, -0.5, 0.5), vec3(0.6, -0.3, 0.5), vec3(0.0, 0.7, 0.5)];

/// Returns the net of a patch whose control points are lifted off its triangle by these heights.
fn lifted(heights: [f32; 7]) -> ControlNet {
    let [a, b, c] = CORNERS;
    let third = |p: Vec3, q: Vec3| p.lerp(q, 1.0 / 3.0);
    let straight = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
    let up = vec3(0.3, 0.9, 0.0);
    let edges = std::array::from_fn(|i| straight[i] + up * heights[i]);
    ControlNet { corners: CORNERS, edges, center: (a + b + c) / 3.0 + up * heights[6] }
}

/// Returns a patch that is bent in one direction of the domain alone: its height is `height` times the square of `along` times
/// a place (x, y, z), as a polynomial of degree three.
fn bent(along: [f32; 3], height: f32) -> SeenPatch {
    // The polar form of a square, at three corners.
    let polar =
        |i: usize, j: usize, k: usize| height * (along[i] * along[j] + along[j] * along[k] + along[k] * along[i]) / 3.0;
    let up = vec3(0.3, 0.9, 0.0);
    let mut net = lifted([0.0; 7]);
    for (corner, at) in net.corners.iter_mut().enumerate() {
        *at += up * polar(corner, corner, corner);
    }
    for (i, at) in net.edges.iter_mut().enumerate() {
        let (from, to) = (i / 2, (i / 2 + 1) % 3);
        *at += up * if i % 2 == 0 { polar(from, from, to) } else { polar(from, to, to) };
    }
    net.center += up * polar(0, 1, 2);
    seen_patch(&VIEW, &net)
}

fn within(patch: &SeenPatch, tolerance: f32, edges: [f32; 3], inside: f32) -> bool {
    let factors = process(Partitioning::Rows, edges, inside);
    part_errors(patch, BOUND_SHARE * tolerance, factors, [true; 4]).iter().all(|error| *error <= tolerance)
}

#[test]
fn a_patch_that_is_bent_in_one_direction_has_no_points_inside() {
    // Edge k is the one opposite corner k: along it the height doesn't change.
    for k in 0..3 {
        let mut along = [0.0; 3];
        along[k] = 1.0;
        let patch = bent(along, 0.2);
        let ChosenFactors { edges, inside, .. } = requested_rows(&patch, 0.1, [1.0; 3], 1.0);
        let factors = process(Partitioning::Rows, edges, inside);
        assert_eq!(point_count(factors), outer_count(factors), "{edges:?} {inside}");
        assert_eq!(edges[k], 1.0, "{edges:?}");
        // The error of a parabola with n segments is a quarter of its height, divided by the square of n.
        let n = (0.25 * 0.2 * 100.0 * vec3(0.3, 0.9, 0.0).length() / (0.1 * BOUND_SHARE)).sqrt().ceil();
        assert!(
            edges.iter().all(|&own| own <= n + 1.0) && triangle_count(factors) as f32 <= 2.0 * n + 1.0,
            "{edges:?}"
        );
    }
}

#[test]
fn a_patch_that_one_triangle_shows_is_one_triangle() {
    let patch = seen_patch(&VIEW, &lifted([0.0; 7]));
    let one = ChosenFactors { edges: [1.0; 3], inside: (ROW_BASE_STEP + 1) as f32, inner: 0.0 };
    assert_eq!(requested_rows(&patch, 0.01, [1.0; 3], 1.0), one);
    assert_eq!(minimum_rows(&patch, 0.01, [1.0; 3], 1.0), one);
    assert_eq!(rows_beside(&patch, 0.01, [1.0; 3], 1.0), one.inside);
    // Heights may need more rows than the surface does.
    let factors = |chosen: ChosenFactors| process(Partitioning::Rows, chosen.edges, chosen.inside);
    let raised = factors(requested_rows(&patch, 0.01, [1.0; 3], 5.0));
    assert_eq!((row_count(raised), row_width(raised)), (5, 5));
    let beside = process(Partitioning::Rows, [7.0, 3.0, 2.0], rows_beside(&patch, 0.01, [7.0, 3.0, 2.0], 1.0));
    assert_eq!((row_width(beside), beside.outside.map(segments)), (1, [7, 3, 2]));
}

#[test]
fn what_no_rows_suffice_for_says_so() {
    let patch = seen_patch(&VIEW, &lifted([0.1, -0.1, 0.1, 0.2, -0.1, 0.1, 0.3]));
    let none = |least| ChosenFactors { edges: least, inside: BEYOND_LAST, inner: 0.0 };
    assert_eq!(requested_rows(&patch, 1e-6, [2.0, 3.0, 1.0], 1.0), none([2.0, 3.0, 1.0]));
    assert_eq!(requested_rows(&patch, 0.5, [127.5, 1.0, 1.0], 1.0), none([127.5, 1.0, 1.0]));
    assert_eq!(rows_beside(&patch, 1e-6, [127.0; 3], 1.0), BEYOND_LAST);
    assert_eq!(requested_rows(&patch, 0.5, [1.0; 3], BEYOND_LAST).inside, BEYOND_LAST);
    let lost = seen_patch(&VIEW, &lifted([f32::NAN; 7]));
    assert_eq!(requested_rows(&lost, 0.5, [1.0; 3], 1.0), none([1.0; 3]));
}

#[test]
fn patches_that_are_near_get_more_rows_than_rings_have_segments() {
    let patch = seen_patch(&VIEW, &lifted([0.1, -0.1, 0.1, 0.2, -0.1, 0.1, 0.3]));
    let chosen = requested_rows(&patch, 4e-3, [1.0; 3], 1.0);
    let factors = process(Partitioning::Rows, chosen.edges, chosen.inside);
    assert!(row_count(factors).max(row_width(factors)) > 64, "{chosen:?}");
    assert!(within(&patch, 4e-3, chosen.edges, chosen.inside));
}

#[test]
fn patches_ask_again_if_they_have_many_more_points_inside_than_they_chose() {
    let chosen = ChosenFactors { edges: [8.0; 3], inside: (ROW_BASE_STEP + 8) as f32, inner: 0.0 };
    let again = |edges, inside| rows_request_again(&chosen, edges, inside);
    assert!(!again([8.0; 3], chosen.inside) && !again([10.0, 8.0, 8.0], chosen.inside));
    assert!(again([8.0, 12.0, 12.0], chosen.inside) && again([8.0; 3], BEYOND_LAST));
}

/// Returns the fewest triangles of all rows whose two edges beside the base have the same number of segments, where segments of
/// edges count as in [`requested_rows`].
fn fewest_of_all(patch: &SeenPatch, tolerance: f32) -> Option<f32> {
    // Those with the fewest triangles first.
    static ALL: LazyLock<Vec<(f32, [f32; 3], f32)>> = LazyLock::new(|| {
        let mut all = Vec::new();
        for (base, rows) in (0..6).flat_map(|base| (1..=24u8).map(move |rows| (base, f32::from(rows)))) {
            for (width, segments) in (1..=24u8).flat_map(|width| (1..=24u8).map(move |segments| (width, segments))) {
                let mut edges = [rows; 3];
                edges[base % 3] = segments.into();
                let inside = (ROW_BASE_STEP as usize * (base + 1)) as f32 + f32::from(width);
                all.push((cost_of_rows(process(Partitioning::Rows, edges, inside), REQUESTED_SEGMENT), edges, inside));
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    });
    ALL.iter().find(|(_, edges, inside)| within(patch, tolerance, *edges, *inside)).map(|(cost, ..)| *cost)
}

#[test]
fn diagonals_follow_the_direction_in_which_a_patch_bends_less() {
    let mut random = fastrand::Rng::with_seed(2);
    let (mut logs, mut flipped) = (Vec::new(), 0);
    for i in 0..400 {
        let patch = seen_patch(&VIEW, &lifted(std::array::from_fn(|_| 0.1 * random.f32() - 0.05)));
        let base = i % 3;
        let flips = expected_rows(&patch, base, 1.0).flips;
        // Many rows of few segments: nearly all strips consist of quads.
        let mut edges = [12.0; 3];
        edges[base] = 3.0;
        let error = |flips: bool| {
            let tried = TriedRows { base, flips, rows: 12.0, width: 3.0, segments: 3.0, fewer: [0.0; 2], lessened: 0 };
            let errors =
                part_errors(&patch, 1e9, process(Partitioning::Rows, edges, inside_of_rows(&tried)), [true; 4]);
            errors.into_iter().fold(0.0, f32::max)
        };
        logs.push((error(flips) / error(!flips)).ln());
        flipped += u32::from(flips);
    }
    let mean = (logs.iter().sum::<f32>() / logs.len() as f32).exp();
    assert!((100..300).contains(&flipped), "{flipped} of 400 are flipped");
    assert!(mean < 0.95, "{mean} times the error with the other diagonals");
}

#[test]
fn the_search_is_close_to_the_fewest_of_all() {
    let mut random = fastrand::Rng::with_seed(1);
    let mut ratios = Vec::new();
    while ratios.len() < 60 {
        let patch = seen_patch(&VIEW, &lifted(std::array::from_fn(|_| 0.1 * random.f32() - 0.05)));
        let tolerance = 0.15 + 1.85 * random.f32();
        let Some(fewest) = fewest_of_all(&patch, tolerance) else { continue };
        let requested = requested_rows(&patch, tolerance, [1.0; 3], 1.0);
        ratios.push(
            cost_of_rows(process(Partitioning::Rows, requested.edges, requested.inside), REQUESTED_SEGMENT) / fewest,
        );
    }
    // It goes up from one place, and down one number after the other, and so misses some. But it also tries edges that differ.
    let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f32>() / ratios.len() as f32).exp();
    let most = ratios.iter().copied().fold(0.0, f32::max);
    assert!(mean <= 1.08 && most <= 1.7, "{mean} times as many on average, {most} at most");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn what_patches_ask_for_keeps_the_tolerance(
        heights in prop::array::uniform7(-0.05f32..0.05),
        tolerance in 0.15f32..2.0,
        least in prop::array::uniform3(1u8..9),
    ) {
        let (patch, least) = (seen_patch(&VIEW, &lifted(heights)), least.map(f32::from));
        let requested = requested_rows(&patch, tolerance, least, 1.0);
        prop_assert!(requested.inside != BEYOND_LAST && within(&patch, tolerance, requested.edges, requested.inside), "{requested:?}");
        prop_assert!(requested.edges.iter().zip(least).all(|(&own, least)| own >= least), "{requested:?}");
        let beside = rows_beside(&patch, tolerance, least, 1.0);
        prop_assert!(beside == BEYOND_LAST || within(&patch, tolerance, least, beside), "{beside}");
        let own = minimum_rows(&patch, tolerance, [1.0; 3], 1.0);
        prop_assert!(within(&patch, tolerance, own.edges, own.inside), "{own:?}");
    }
}
