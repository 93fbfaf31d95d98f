use std::collections::{BTreeSet, HashMap};

use super::*;
use crate::tessellate::factors::{
    FACTOR_VALUE, Partitioning, PatchFactors, SUBTRIANGULATED, outer_count, patch_is_culled, patch_is_minimal,
    patch_is_subtriangulated, point_count, process, segments, triangle_count,
};
use crate::tessellate::{domain_plan, domain_point, domain_triangle};

/// Returns a patch's points and triangles.
fn pattern(factors: PatchFactors) -> (Vec<[u32; 2]>, Vec<[u32; 3]>) {
    let plan = domain_plan(factors);
    let points = (0..point_count(factors)).map(|i| domain_point(&plan, i)).collect();
    (points, (0..triangle_count(factors)).map(|t| domain_triangle(&plan, t)).collect())
}

fn uniform(factor: f32) -> PatchFactors {
    process(Partitioning::Subtriangulation, [factor; 3], factor)
}

/// Returns the points and triangles of every number of segments.
fn all() -> impl Iterator<Item = (u32, Vec<[u32; 2]>, Vec<[u32; 3]>)> {
    (1..=64).map(|n| {
        let (points, triangles) = pattern(uniform(n as f32));
        (n, points, triangles)
    })
}

/// Converts points from pairs of `i` and `j` (parts of `n`) to 16.16 fixed point.
fn by_hand(n: u32, points: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let exact = |k: u32| (f64::from(k) / f64::from(n) * 65536.0).round() as u32;
    points.iter().map(|point| point.map(exact)).collect()
}

#[test]
fn the_first_levels_of_detail_are_those_of_the_figure() {
    let corners = [[0, 1], [0, 0], [1, 0]];
    assert_eq!(pattern(uniform(1.0)), (by_hand(1, &corners), vec![[0, 1, 2]]));

    let points = [[0, 2], [0, 1], [0, 0], [1, 0], [2, 0], [1, 1]];
    let triangles = vec![[0, 1, 5], [2, 3, 1], [4, 5, 3], [1, 3, 5]];
    assert_eq!(pattern(uniform(2.0)), (by_hand(2, &points), triangles));

    let points = [[0, 3], [0, 2], [0, 1], [0, 0], [1, 0], [2, 0], [3, 0], [2, 1], [1, 2], [1, 1]];
    let sides =
        [[[0, 1, 8], [8, 1, 9], [1, 2, 9]], [[3, 4, 2], [2, 4, 9], [4, 5, 9]], [[6, 7, 5], [5, 7, 9], [7, 8, 9]]];
    assert_eq!(pattern(uniform(3.0)), (by_hand(3, &points), sides.concat()));

    let outline = [[0, 4], [0, 3], [0, 2], [0, 1], [0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [3, 1], [2, 2], [1, 3]];
    let points = [&outline[..], &[[1, 2], [1, 1], [2, 1]]].concat();
    let sides = [
        [[0, 1, 11], [11, 1, 12], [1, 2, 12], [12, 2, 13], [2, 3, 13]],
        [[4, 5, 3], [3, 5, 13], [5, 6, 13], [13, 6, 14], [6, 7, 14]],
        [[8, 9, 7], [7, 9, 14], [9, 10, 14], [14, 10, 12], [10, 11, 12]],
    ];
    let triangles = [&sides.concat()[..], &[[12, 13, 14]]].concat();
    assert_eq!(pattern(uniform(4.0)), (by_hand(4, &points), triangles));
}

#[test]
fn factors_are_rounded_up_to_whole_segments() {
    for (factor, n) in [(0.2, 1), (1.0, 1), (1.000_000_1, 2), (2.0, 2), (4.6, 5), (63.01, 64), (64.0, 64), (1e9, 64)] {
        let factors = uniform(factor);
        assert_eq!((segments(factors.inside), outer_count(factors)), (n, 3 * n), "{factor}");
        assert_eq!(triangle_count(factors), n * n, "{factor}");
    }
}

#[test]
fn the_largest_edge_factor_is_used_for_everything() {
    let of = |edges, inside| process(Partitioning::Subtriangulation, edges, inside);
    for inside in [f32::NAN, -3.0, 0.0, 1.0, 17.0, f32::INFINITY] {
        assert_eq!(of([2.5, 1.0, 6.1], inside), uniform(7.0), "{inside}");
        assert_eq!(of([1.0, f32::INFINITY, 2.0], inside), uniform(64.0), "{inside}");
        for bad in [0.0, -0.0, -2.0, f32::NAN, -f32::NAN, f32::NEG_INFINITY] {
            let culled = of([3.0, bad, 80.0], inside);
            assert_eq!(culled, PatchFactors::default());
            assert!(patch_is_culled(culled) && !patch_is_subtriangulated(culled));
        }
    }
}

#[test]
fn only_the_inside_word_marks_a_subtriangulated_patch() {
    for n in 1..=64 {
        let (own, integer) = (uniform(n as f32), process(Partitioning::Integer, [n as f32; 3], n as f32));
        assert_eq!((own.outside, own.inside & FACTOR_VALUE), (integer.outside, n << 16));
        assert!(own.inside & SUBTRIANGULATED != 0 && patch_is_subtriangulated(own));
        assert_eq!(patch_is_minimal(own), n == 1);
        for partitioning in Partitioning::DIRECT3D {
            assert!(!patch_is_subtriangulated(process(partitioning, [n as f32; 3], n as f32)), "{partitioning:?} {n}");
        }
    }
}

#[test]
fn whole_rings_are_counted_exactly() {
    let most = |fits: &dyn Fn(u32) -> bool| (0..=22).rev().find(|&ring| fits(ring));
    for n in 1..=64u32 {
        for i in 0..(n + 1) * (n + 2) / 2 {
            let before = |ring: u32| (0..ring).map(|r| if n > 3 * r { 3 * (n - 3 * r) } else { 1 }).sum::<u32>();
            let expected = most(&|ring| 3 * ring <= n && before(ring) <= i);
            assert_eq!(Some(subtriangulation_rings(2 * n + 3, 2 * i)), expected, "point {i} of {n}");
        }
        for t in 0..n * n {
            let expected = most(&|ring| 3 * ring <= n && n * n - (n - 3 * ring) * (n - 3 * ring) <= t);
            assert_eq!(Some(subtriangulation_rings(2 * n, t)), expected, "triangle {t} of {n}");
        }
    }
}

/// Returns `i` and `j` of a point, which must be `(i, j, n - i - j) / n` rounded to 16.16 fixed point.
fn lattice(n: u32, [u, v]: [u32; 2]) -> [i64; 2] {
    let [u, v, w, n] = [u, v, 65536 - u - v, n].map(i64::from);
    let [i, j, k] = [u, v, w].map(|x| (2 * x * n + 65536) / (2 * 65536));
    assert_eq!(i + j + k, n, "{u} {v} of {n}");
    // U and V are off by at most half a unit. W gets the errors of both: a whole unit, but on edges half a unit.
    let off = |x: i64, i: i64| 2 * (x * n - i * 65536).abs();
    assert!(off(u, i) <= n && off(v, j) <= n && off(w, k) <= 2 * n, "{u} {v} of {n}");
    assert!(i * j * k != 0 || off(w, k) <= n, "{u} {v} of {n}");
    [i, j]
}

#[test]
fn every_point_of_the_lattice_occurs_once() {
    for (n, points, _) in all() {
        assert_eq!(points.len() as u32, (n + 1) * (n + 2) / 2);
        let found: BTreeSet<_> = points.iter().map(|&point| lattice(n, point)).collect();
        let n = i64::from(n);
        assert!(found.into_iter().eq((0..=n).flat_map(|i| (0..=n - i).map(move |j| [i, j]))), "{n}");
    }
}

#[test]
fn edges_are_symmetric_and_in_the_order_of_the_tessellators_outline() {
    for (n, points, _) in all() {
        let along = |side: u32, p: u32| points[((side * n + p) % (3 * n)) as usize];
        let row: Vec<_> = (0..=n).map(|p| along(1, p)[0]).collect();
        assert!(row.iter().zip(row.iter().rev()).all(|(a, b)| a + b == 65536), "{n}: {row:?}");
        assert!((row[0], row[n as usize]) == (0, 65536) && row.is_sorted_by(|a, b| a < b), "{n}: {row:?}");
        for p in 0..=n {
            let x = row[p as usize];
            assert_eq!([along(0, p), along(1, p), along(2, p)], [[0, 65536 - x], [x, 0], [65536 - x, x]], "{n}");
        }
    }
}

/// Twice the area of a triangle of points; positive if it is wound as the patch is.
fn doubled_area(points: &[[i64; 2]], triangle: [u32; 3]) -> i64 {
    let [a, b, c] = triangle.map(|i| points[i as usize]);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[test]
fn triangles_are_equal_and_cover_the_domain_once() {
    for (n, points, triangles) in all() {
        assert_eq!(triangles.len() as u32, n * n);
        let whole: Vec<_> = points.iter().map(|&point| lattice(n, point)).collect();
        assert!(
            triangles.iter().all(|&t| doubled_area(&whole, t) == 1),
            "{n}: every triangle is one of the lattice's smallest and wound like the patch"
        );
        let fixed: Vec<_> = points.iter().map(|point| point.map(i64::from)).collect();
        let areas = triangles.iter().map(|&t| doubled_area(&fixed, t));
        assert!(areas.clone().all(|area| area > 0) && areas.sum::<i64>() == 1 << 32, "{n}");
    }
}

#[test]
fn inner_edges_have_two_triangles_and_the_outline_one() {
    for (n, points, triangles) in all() {
        let mut sides = HashMap::new();
        for t in &triangles {
            for k in 0..3 {
                *sides.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
            }
        }
        assert!(sides.values().all(|&count| count == 1), "{n}");
        let outline: BTreeSet<_> = sides.keys().copied().filter(|(a, b)| !sides.contains_key(&(*b, *a))).collect();
        assert!(outline.into_iter().eq((0..3 * n).map(|i| (i, (i + 1) % (3 * n)))), "{n}");
        let used: BTreeSet<_> = triangles.iter().flatten().copied().collect();
        assert!(used.into_iter().eq(0..points.len() as u32), "{n}: each vertex is used");
    }
}
