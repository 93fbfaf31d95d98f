use std::collections::HashSet;

use proptest::prelude::*;

use super::*;
use crate::tessellate::factors::{
    MOST_ROWS, Partitioning, ROW_BASE_STEP, base_by_edges, patch_has_rows, point_count, process, triangle_count,
};
use crate::tessellate::{domain_plan, domain_point, domain_triangle};

/// Returns what becomes of whole factors of the edges, a base and a width. Bases 3 to 5 are 0 to 2 with flipped diagonals.
fn rows([u, v, w]: [u32; 3], base: u32, width: u32) -> PatchFactors {
    process(Partitioning::Rows, [u as f32, v as f32, w as f32], (ROW_BASE_STEP * (base + 1) + width) as f32)
}

/// Numbers of segments: all small ones, and some up to the largest.
fn numbers() -> impl Iterator<Item = u32> + Clone {
    (1..=64).chain([65, 66, 81, 96, 97, 113, 126, MOST_ROWS])
}

/// Returns a patch's points and triangles.
fn pattern(factors: PatchFactors) -> (Vec<[u32; 2]>, Vec<[u32; 3]>) {
    let plan = domain_plan(factors);
    let points = (0..point_count(factors)).map(|i| domain_point(&plan, i)).collect();
    (points, (0..triangle_count(factors)).map(|t| domain_triangle(&plan, t)).collect())
}

/// Returns twice the area of a triangle in units of 1 / 65536 squared, positive if it winds as the outline does.
fn area(points: &[[u32; 2]], triangle: [u32; 3]) -> i64 {
    let [[ax, ay], [bx, by], [cx, cy]] = triangle.map(|i| points[i as usize].map(i64::from));
    (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
}

/// Returns what is wrong with a pattern that should cover the domain once, if anything is.
fn fault(factors: PatchFactors) -> Option<String> {
    let (points, triangles) = pattern(factors);
    let outline = factors.outside.iter().map(|&word| segments(word)).sum::<u32>();
    if points.iter().collect::<HashSet<_>>().len() != points.len() {
        return Some("two points at one place".into());
    }
    let mut sides = HashSet::new();
    for &triangle in &triangles {
        if triangle.iter().any(|&i| i as usize >= points.len()) {
            return Some(format!("{triangle:?} has a point too many"));
        }
        if area(&points, triangle) <= 0 {
            return Some(format!("{triangle:?} has the area {}", area(&points, triangle)));
        }
        let [a, b, c] = triangle;
        if [[a, b], [b, c], [c, a]].into_iter().any(|side| !sides.insert(side)) {
            return Some(format!("{triangle:?} has a side that another triangle has, too"));
        }
    }
    // With areas that are all positive and add up to the domain's, nothing overlaps.
    let whole: i64 = triangles.iter().map(|&triangle| area(&points, triangle)).sum();
    if whole != i64::from(FIXED_ONE).pow(2) {
        return Some(format!("the areas add up to {whole}"));
    }
    let is_outline = |[a, b]: [u32; 2]| a < outline && b == (a + 1) % outline;
    let lonely = sides.iter().find(|&&[a, b]| sides.contains(&[b, a]) == is_outline([a, b]));
    lonely.map(|side| format!("{side:?} is a side of one triangle"))
}

#[test]
fn few_segments_are_cut_as_by_hand() {
    let corners = [[0, 0x10000], [0, 0], [0x10000, 0]];
    for base in 0..3 {
        assert_eq!(
            pattern(rows([1; 3], base, 1)),
            (corners.to_vec(), vec![[[2, 0, 1], [0, 1, 2], [1, 2, 0]][base as usize]])
        );
    }
    // A fan from the corner U == 1 to three segments of the edge U == 0.
    let (points, triangles) = pattern(rows([3, 1, 1], 0, 7));
    assert_eq!(points, [[0, 0x10000], [0, 0xaaab], [0, 0x5555], [0, 0], [0x10000, 0]]);
    assert_eq!(triangles, [[4, 0, 1], [4, 1, 2], [4, 2, 3]]);
    // A strip of two rows beside the edge W == 0.
    let (points, triangles) = pattern(rows([2, 2, 1], 2, 1));
    assert_eq!(points, [[0, 0x10000], [0, 0x8000], [0, 0], [0x8000, 0], [0x10000, 0]]);
    assert_eq!(triangles, [[1, 3, 4], [2, 3, 1], [1, 4, 0]]);
    // One edge isn't cut: its base's end is where all rows end.
    let (_, triangles) = pattern(rows([1, 1, 3], 0, 1));
    assert_eq!(triangles, [[4, 0, 1], [3, 4, 1], [2, 3, 1]]);
    // Two rows with a point inside.
    let (points, triangles) = pattern(rows([2, 2, 2], 0, 3));
    assert_eq!(points[6..], [[0x8000, 0x4000]]);
    assert_eq!(triangles, [[6, 5, 0], [6, 0, 1], [3, 6, 1], [4, 5, 6], [4, 6, 3], [3, 1, 2]]);
}

#[test]
fn equal_numbers_give_equal_triangles() {
    for n in 1..=MOST_ROWS {
        let (points, triangles) = pattern(rows([n; 3], 1, n));
        assert_eq!(triangles.len() as u32, n * n);
        let each = f64::from(FIXED_ONE).powi(2) / f64::from(n * n);
        for triangle in triangles {
            let off = area(&points, triangle) as f64 - each;
            // The lengths of segments are rounded, too, which adds up to n / 4 units in the middle of an edge.
            let rounded = 2.0 + 0.25 * f64::from(n);
            assert!(off.abs() <= 3.0 * rounded * f64::from(FIXED_ONE) / f64::from(n), "{n}: {off} of {each}");
        }
    }
}

#[test]
fn all_small_numbers_cover_the_domain_once() {
    let numbers = [1, 2, 3, 4, 5, 7];
    for (u, v) in numbers.into_iter().flat_map(|u| numbers.map(|v| (u, v))) {
        for (w, base) in numbers.into_iter().flat_map(|w| [0, 1, 2, 3, 4, 5].map(|base| (w, base))) {
            for width in 1..=9 {
                let found = fault(rows([u, v, w], base, width));
                assert_eq!(found, None, "{u}, {v}, {w}, base {base}, width {width}");
            }
        }
    }
}

#[test]
fn very_unequal_numbers_cover_the_domain_once() {
    for (u, v) in [1, 2, 63, 64, 127].into_iter().flat_map(|u| [1, 2, 63, 64, 127].map(|v| (u, v))) {
        for (w, width) in [1, 64, 127].into_iter().flat_map(|w| [1, 2, 33, 64, 127].map(|width| (w, width))) {
            for base in 0..6 {
                let found = fault(rows([u, v, w], base, width));
                assert_eq!(found, None, "{u}, {v}, {w}, base {base}, width {width}");
            }
        }
    }
}

#[test]
fn the_manuals_table_is_right() {
    let counts = |[a, b, c]: [u32; 3], width| {
        let factors = rows([c, b, a], 0, width);
        [point_count(factors) - a - b - c, triangle_count(factors)]
    };
    assert_eq!([counts([1; 3], 1), counts([1, 1, 5], 1), counts([1, 1, 5], 9)], [[0, 1], [0, 5], [0, 5]]);
    assert_eq!([counts([5, 5, 1], 1), counts([2; 3], 2), counts([2, 2, 6], 6)], [[0, 9], [0, 4], [2, 12]]);
    assert_eq!(counts([6, 3, 4], 4), [7, 25]);
    for n in 1..=MOST_ROWS {
        assert_eq!(counts([n; 3], n), [(n - 1) * n.saturating_sub(2) / 2, n * n]);
    }
}

#[test]
fn every_point_inside_has_one_number() {
    for (n, width) in numbers().flat_map(|n| numbers().map(move |width| (n, width))) {
        let numbered = numbered_rows(rows([1, n, n], 0, width));
        let segments = |row: u32| (width * row).div_ceil(n);
        assert_eq!(numbered.inside, (1..n).map(|row| segments(row) - 1).sum::<u32>(), "{n} rows, to {width}");
        for i in 0..numbered.inside {
            let [row, place] = row_of_point(&numbered, i);
            assert!((1..n).contains(&row) && (1..segments(row)).contains(&place), "point {i} of {n} rows, to {width}");
            let number = number_before(&numbered, row, segments(row)) + place;
            assert_eq!(number, numbered.rows.outer + i, "point {i} of {n} rows, to {width}");
        }
    }
}

#[test]
fn every_triangle_has_one_number() {
    for (n, width) in numbers().flat_map(|n| numbers().map(move |width| (n, width))) {
        let others = [5, 11].map(|k| (1 + (k * n + 3 * width) % n, 1 + (k * n + width) % MOST_ROWS));
        for (fewer, c) in [(n, width), (1, 1), others[0], others[1]] {
            let edges = if (n + width) % 2 == 0 { [c, n, fewer] } else { [c, fewer, n] };
            let factors = rows(edges, 0, width);
            let numbered = numbered_rows(factors);
            let strips: Vec<_> = (0..n).map(|row| strip_triangles(strip_below(&numbered.rows, row))).collect();
            assert_eq!(strips.iter().sum::<u32>(), triangle_count(factors), "{edges:?}, width {width}");
            let mut found: Vec<_> = strips.iter().map(|&count| vec![false; count as usize]).collect();
            for t in 0..triangle_count(factors) {
                let [row, i] = strip_of_triangle(&numbered, t);
                let place = found.get_mut(row as usize).and_then(|strip| strip.get_mut(i as usize));
                assert!(place.is_some_and(|place| !std::mem::replace(place, true)), "{t} of {edges:?}, width {width}");
            }
        }
    }
}

#[test]
fn flipped_diagonals_are_those_of_the_mirrored_pattern() {
    // Two rows of one segment beside the edge W == 0 have one diagonal.
    let (_, upright) = pattern(rows([2, 2, 1], 2, 1));
    let (_, flipped) = pattern(rows([2, 2, 1], 5, 1));
    assert_eq!(upright, [[1, 3, 4], [2, 3, 1], [1, 4, 0]]);
    assert_eq!(flipped, [[3, 4, 0], [2, 3, 1], [1, 3, 0]]);
    // Exchanging U and V mirrors a pattern beside the edge W == 0, and turns its triangles.
    let places = |factors, mirrored: bool| {
        let (points, triangles) = pattern(factors);
        let place = |i: u32| points[i as usize];
        let corners = |triangle: [u32; 3]| {
            let mut own = triangle.map(place);
            if mirrored {
                own = own.map(|[u, v]| [v, u]);
            }
            own.sort_unstable();
            own
        };
        let mut all: Vec<_> = triangles.into_iter().map(corners).collect();
        all.sort_unstable();
        all
    };
    for numbers in [[6, 6, 3], [7, 4, 9], [1, 5, 2], [12, 12, 12], [8, 16, 5]] {
        for width in [1, 3, 4, 8, 17] {
            let [u, v, w] = numbers;
            assert_eq!(
                places(rows([u, v, w], 2, width), true),
                places(rows([v, u, w], 5, width), false),
                "{numbers:?}, width {width}"
            );
        }
    }
}

#[test]
fn turning_the_base_turns_the_pattern() {
    let (numbers, width) = ([7, 4, 9], 5);
    let at = |base: u32| {
        let factors = rows([0, 1, 2].map(|i| numbers[(i + 3 - base as usize) % 3]), base, width);
        let (points, triangles) = pattern(factors);
        let weights = |[u, v]: [u32; 2]| [u, v, FIXED_ONE - u - v];
        triangles
            .into_iter()
            .map(|triangle| {
                triangle.map(|i| {
                    let own = weights(points[i as usize]);
                    [0, 1, 2].map(|k| own[(k + base as usize) % 3])
                })
            })
            .collect::<Vec<_>>()
    };
    let upright = at(0);
    for base in [1, 2] {
        for (one, other) in upright.iter().zip(at(base)) {
            for (p, q) in one.iter().zip(other) {
                // The edge W == 0 rounds the other way than U == 0.
                assert!(p.iter().zip(q).all(|(&p, q)| p.abs_diff(q) <= 1), "{one:?} {other:?}");
            }
        }
    }
}

#[test]
fn the_base_without_a_choice_lies_beside_similar_edges() {
    let base = |numbers| base_by_edges(rows(numbers, 0, 1).outside);
    assert_eq!([[5, 5, 5], [9, 8, 8], [8, 1, 7], [7, 8, 1], [1, 9, 9]].map(base), [0, 0, 1, 2, 0]);
    assert_eq!([[16, 12, 8], [8, 12, 16], [2, 4, 2]].map(base), [2, 0, 1]);
}

#[test]
fn inside_factors_say_base_and_width() {
    let of = |inside: f32| {
        let factors = process(Partitioning::Rows, [3.0, 8.0, 8.0], inside);
        assert!(patch_has_rows(factors), "{inside}");
        (row_base(factors), row_width(factors))
    };
    for nothing in [0.0, -3.0, f32::NAN, f32::NEG_INFINITY, 1e-40, 1.0] {
        assert_eq!(of(nothing), (0, 1), "{nothing}");
    }
    assert_eq!([3.2, 127.0, 127.5, 1e9, f32::INFINITY].map(of), [(0, 4), (0, 127), (0, 127), (0, 127), (0, 127)]);
    let step = |times: u32, width: f32| (times * ROW_BASE_STEP) as f32 + width;
    let first = [0.0, 1.0, 3.5, 127.5, 255.0].map(|width| of(step(1, width)));
    assert_eq!(first, [(0, 1), (0, 1), (0, 4), (0, 127), (0, 127)]);
    let others = [(2, 1.0), (2, 64.0), (3, 1.0), (3, 7.0)].map(|(times, width)| of(step(times, width)));
    assert_eq!(others, [(1, 1), (1, 64), (2, 1), (2, 7)]);
    // From 4 times the step on, diagonals are flipped.
    let flips = |inside: f32| row_flip(process(Partitioning::Rows, [3.0, 8.0, 8.0], inside));
    let flipped = [1024.0, 1023.5, 1029.0, 1281.0, 1543.0, 1791.0].map(of);
    assert_eq!(flipped, [(0, 1), (0, 1), (0, 5), (1, 1), (2, 7), (2, 127)]);
    let few = [3.0, 258.0, 1023.0, 1024.0, 1029.0, 1791.0, 1792.0, f32::NAN].map(flips);
    assert_eq!(few, [0, 0, 0, 1, 1, 1, 0, 0]);
    assert_eq!([1792.0, 1791.5, 1800.0].map(of), [(0, 127), (0, 127), (0, 127)]);
    assert!(!patch_has_rows(process(Partitioning::Rows, [3.0, 0.0, 8.0], 259.0)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn rows_cover_the_domain_once(edges in prop::array::uniform3(1u32..=MOST_ROWS), base in 0u32..6, width in 1u32..=MOST_ROWS) {
        prop_assert_eq!(fault(rows(edges, base, width)), None);
    }

    #[test]
    fn triangles_lie_where_their_points_do(edges in prop::array::uniform3(1u32..=MOST_ROWS), base in 0u32..6, width in 1u32..=MOST_ROWS) {
        let factors = rows(edges, base, width);
        let (points, triangles) = pattern(factors);
        let plan = row_plan(factors);
        let mut strip_by_strip: Vec<_> = (0..triangles.len() as u32).map(|t| row_triangle_places(&plan, t)).collect();
        let mut by_number: Vec<_> = triangles.iter().map(|triangle| triangle.map(|i| points[i as usize])).collect();
        strip_by_strip.sort_unstable();
        by_number.sort_unstable();
        prop_assert_eq!(strip_by_strip, by_number);
    }

    #[test]
    fn any_factors_give_a_pattern_or_none(bits in prop::array::uniform4(any::<u32>()), inside in 0.0f32..1000.0) {
        let [u, v, w, any_inside] = bits.map(f32::from_bits);
        for (edges, inside) in [([u, v, w], any_inside), ([u.abs(), v.abs(), w.abs()], inside), ([3.0, 5.0, 4.0], any_inside)] {
            let factors = process(Partitioning::Rows, edges, inside);
            if patch_has_rows(factors) {
                prop_assert_eq!(fault(factors), None);
            }
        }
    }
}
