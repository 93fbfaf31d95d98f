use std::collections::HashMap;

use proptest::prelude::*;

use super::*;
use crate::tessellate::domain_row::segment_length;
use crate::tessellate::factors::{
    FACTOR_VALUE, Partitioning, outer_count, patch_is_culled, point_count, process, triangle_count,
};
use crate::tessellate::last_factor;

fn closed_form(f: PatchFactors) -> serial_tests::Patch {
    let plan = domain_plan(f);
    serial_tests::Patch {
        points: (0..point_count(f)).map(|i| domain_point(&plan, i)).collect(),
        triangles: (0..triangle_count(f)).map(|t| domain_triangle(&plan, t)).collect(),
    }
}

fn uniform(p: Partitioning, factor: f32) -> PatchFactors {
    process(p, [factor; 3], factor)
}

fn row_of(p: Partitioning, factor: f32) -> Vec<u32> {
    let word = uniform(p, factor).outside[0];
    let row = domain_row(word);
    (0..=segments(word)).map(|i| row_location(row, i)).collect()
}

/// Returns factors with every parity, with the smallest and largest values, and near where rounding and clamping begin.
fn mixed_factors(partitionings: &[Partitioning]) -> Vec<PatchFactors> {
    let values = [0.0, 1.0, 1.000_007_6, 1.000_015_3, 1.5, 2.0, 2.3, 3.0, 4.7, 6.0, 17.2, 31.9, 33.0, 63.0, 64.0];
    let mut sets = Vec::new();
    for &p in partitionings {
        for a in values {
            for b in [1.0, 2.0, 5.3, 64.0] {
                for inside in values {
                    sets.push(process(p, [a, b, 3.4], inside));
                }
            }
        }
    }
    sets
}

#[test]
fn row_locations_are_those_of_the_specification() {
    use Partitioning::{FractionalEven as Even, FractionalOdd as Odd};
    let rows: [(Partitioning, f32, &[u32]); 7] = [
        (Odd, 1.5, &[0, 5461, 60075, 65536]),
        (Odd, 2.0, &[0, 10923, 54613, 65536]),
        (Odd, 3.5, &[0, 19661, 22937, 42599, 45875, 65536]),
        (Odd, 7.5, &[0, 8842, 17684, 26526, 28347, 37189, 39010, 47852, 56694, 65536]),
        (Even, 2.5, &[0, 28672, 32768, 36864, 65536]),
        (Even, 4.5, &[0, 15019, 17750, 32768, 47786, 50517, 65536]),
        (Even, 6.5, &[0, 10240, 20481, 30721, 32768, 34815, 45055, 55296, 65536]),
    ];
    for (p, factor, points) in rows {
        assert_eq!(row_of(p, factor), points, "{p:?} {factor}");
    }
}

#[test]
fn rows_are_symmetric_and_sorted() {
    for p in Partitioning::DIRECT3D {
        for step in 0..=64 * 16 {
            let row = row_of(p, step as f32 / 16.0 + 1e-6);
            assert!(row.is_sorted(), "{p:?} {step}: {row:?}");
            assert!(row.iter().zip(row.iter().rev()).all(|(a, b)| a + b == FIXED_ONE), "{p:?} {step}: {row:?}");
        }
    }
}

#[test]
fn whole_rings_are_counted_exactly() {
    for m in 0..=64u32 {
        for area in 0..=m * m / 4 {
            let expected = (0..=m / 2).rev().find(|s| s * (m - s) <= area);
            assert_eq!(Some(rings_before(m, area)), expected, "m {m} area {area}");
        }
    }
}

#[test]
fn a_minimal_patch_is_its_corners() {
    let minimal =
        serial_tests::Patch { points: vec![[0, FIXED_ONE], [0, 0], [FIXED_ONE, 0]], triangles: vec![[0, 1, 2]] };
    for p in [Partitioning::Integer, Partitioning::Pow2, Partitioning::FractionalOdd] {
        assert_eq!(closed_form(uniform(p, 1.0)), minimal);
    }
}

#[test]
fn a_culled_patch_is_empty() {
    assert_eq!(closed_form(uniform(Partitioning::Integer, 0.0)), serial_tests::Patch::default());
}

#[test]
fn one_split_edge_gives_a_fan_around_the_centre() {
    let patch = closed_form(process(Partitioning::Integer, [2.0, 1.0, 1.0], 1.0));
    let points = [[0, FIXED_ONE], [0, FIXED_HALF], [0, 0], [FIXED_ONE, 0], [0x5555, 0x5555]];
    assert_eq!(patch.points, points);
    assert_eq!(patch.triangles, [[0, 1, 4], [1, 2, 4], [4, 2, 3], [4, 3, 0]]);
}

#[test]
fn every_whole_factor_agrees_with_the_serial_tessellator() {
    for p in Partitioning::DIRECT3D {
        for factor in 1..=64 {
            let f = uniform(p, factor as f32);
            assert_eq!(closed_form(f), serial_tests::patch(f), "{p:?} {factor}");
        }
    }
}

#[test]
fn every_pair_of_edge_and_inside_factor_agrees_with_the_serial_tessellator() {
    for inside in 1..=64 {
        for edge in 1..=62 {
            let edges = [edge, edge + 1, edge + 2].map(|e| e as f32);
            let f = process(Partitioning::Integer, edges, inside as f32);
            assert_eq!(closed_form(f).triangles, serial_tests::patch(f).triangles, "{edges:?} {inside}");
        }
    }
}

#[test]
fn mixed_factors_agree_with_the_serial_tessellator() {
    for f in mixed_factors(&Partitioning::DIRECT3D) {
        assert_eq!(closed_form(f), serial_tests::patch(f), "{f:x?}");
    }
}

/// Twice a triangle's area in the (U, V) plane.
pub(in crate::tessellate) fn doubled_area(points: &[[u32; 2]], t: [u32; 3]) -> i64 {
    let [a, b, c] = t.map(|i| points[i as usize].map(i64::from));
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[test]
fn triangles_cover_the_domain_once() {
    for f in mixed_factors(&Partitioning::ALL).into_iter().filter(|f| !patch_is_culled(*f)) {
        let patch = closed_form(f);
        let areas = patch.triangles.iter().map(|t| doubled_area(&patch.points, *t));
        assert_eq!(areas.sum::<i64>(), i64::from(FIXED_ONE) * i64::from(FIXED_ONE), "{f:x?}");
    }
}

#[test]
fn no_triangle_of_whole_factors_is_flipped() {
    for f in mixed_factors(&Partitioning::ALL)
        .into_iter()
        .filter(|f| f.outside[0] & 0xffff == 0 && f.outside[2] & 0xffff == 0)
    {
        let patch = closed_form(f);
        for t in &patch.triangles {
            assert!(doubled_area(&patch.points, *t) >= 0, "{f:x?}: {t:?}");
        }
    }
}

/// Each edge inside belongs to two triangles, which run along it in opposite directions. The other edges are the outline.
#[test]
fn triangles_form_a_disc() {
    for f in mixed_factors(&Partitioning::ALL).into_iter().step_by(7).filter(|f| !patch_is_culled(*f)) {
        let triangles = closed_form(f).triangles;
        let mut sides = HashMap::new();
        for t in &triangles {
            for k in 0..3 {
                *sides.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
            }
        }
        assert!(sides.values().all(|n| *n == 1), "{f:x?}");
        let mut outline: Vec<_> = sides.keys().filter(|(a, b)| !sides.contains_key(&(*b, *a))).copied().collect();
        outline.sort_unstable();
        let outer = outer_count(f);
        assert!(outline.iter().copied().eq((0..outer).map(|i| (i, (i + 1) % outer))), "{f:x?}");
        // Euler: points - edges + triangles = 1.
        let edges = (sides.len() as u32 + outer) / 2;
        assert_eq!(point_count(f) + triangles.len() as u32, edges + 1, "{f:x?}");
    }
}

#[test]
fn a_segments_length_is_rounded_half_up() {
    for segments in 1..=128 {
        assert_eq!(segment_length(segments), (2 * FIXED_ONE + segments) / (2 * segments), "{segments}");
        // The largest relative error that WGSL allows a GPU.
        for off in [1.0 - 3e-7, 1.0 + 3e-7] {
            let quotient = ((2 * FIXED_ONE + segments) as f32 + 0.5) / (2 * segments) as f32 * off;
            assert_eq!(quotient as u32, segment_length(segments), "{segments}");
        }
    }
}

#[test]
fn an_edge_depends_on_its_own_factor_only() {
    for p in Partitioning::DIRECT3D {
        let edge = |others: f32, inside: f32| {
            let f = process(p, [others, 7.3, others], inside);
            let start = segments(f.outside[0]);
            let plan = domain_plan(f);
            (start..start + segments(f.outside[1])).map(|i| domain_point(&plan, i)).collect::<Vec<_>>()
        };
        assert_eq!(edge(2.2, 1.0), edge(50.0, 33.3));
    }
}

pub(in crate::tessellate) fn any_factor() -> impl Strategy<Value = f32> {
    let just_above_one = (0u32..0x200).prop_map(|k| f32::from_bits(0x3f80_0000 + k));
    let near_whole =
        (1u32..=64, -3i32..=3).prop_map(|(n, k)| f32::from_bits((n as f32).to_bits().wrapping_add_signed(k)));
    prop_oneof![
        8 => 0.5f32..66.0,
        2 => 1.0f32..4.0,
        2 => near_whole,
        2 => just_above_one,
        1 => prop::sample::select(vec![f32::INFINITY, 0.0, -0.0, -2.0, f32::NAN, 1e-42, f32::MAX, f32::NEG_INFINITY]),
    ]
}

proptest! {
    #[test]
    fn any_patch_agrees_with_the_serial_tessellator(
        p in prop::sample::select(Partitioning::DIRECT3D.to_vec()),
        edges in prop::array::uniform3(any_factor()),
        inside in any_factor(),
    ) {
        let f = process(p, edges, inside);
        prop_assert_eq!(closed_form(f), serial_tests::patch(f));
    }

    #[test]
    fn points_stay_in_the_domain(
        p in prop::sample::select(Partitioning::ALL.to_vec()),
        edges in prop::array::uniform3(any_factor()),
        inside in any_factor(),
    ) {
        let f = process(p, edges, inside);
        for [u, v] in closed_form(f).points {
            prop_assert!(u + v <= FIXED_ONE);
        }
    }

    #[test]
    fn words_hold_a_factor_in_range_or_zero(p in prop::sample::select(Partitioning::ALL.to_vec()), x in any_factor()) {
        let f = process(p, [x; 3], x);
        for word in f.outside.into_iter().chain([f.inside]) {
            prop_assert!(word == 0 || (FIXED_ONE..=(last_factor(p) as u32) << 16).contains(&(word & FACTOR_VALUE)));
        }
    }
}
