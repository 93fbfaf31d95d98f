use std::collections::HashMap;

use proptest::prelude::*;

use super::*;
use crate::tessellate::domain::tests::{any_factor, doubled_area};
use crate::tessellate::factors::FIXED_HALF;
use crate::tessellate::{domain_plan, domain_point, process};

const ONE: u32 = FIXED_ONE;
const HALF: u32 = FIXED_HALF;

/// How many points and triangles there are, in closed form.
impl QuadFactors {
    /// Returns the number of points on the patch's outline.
    fn outer_count(&self) -> u32 {
        self.outside.map(segments).iter().sum()
    }

    /// Returns the number of points inside the outline.
    fn inner_count(&self) -> u32 {
        let [u, v] = self.inside.map(segments);
        if self.is_minimal() { 0 } else { (u - 1) * (v - 1) }
    }

    /// Returns the number of domain points.
    fn point_count(&self) -> u32 {
        self.outer_count() + self.inner_count()
    }

    /// Returns the number of triangles, by Euler's formula.
    fn triangle_count(&self) -> u32 {
        self.outer_count() + 2 * self.inner_count() - 2
    }
}

fn quad(p: Partitioning, edges: [f32; 4], inside: [f32; 2]) -> QuadFactors {
    QuadFactors::new(p, edges, inside).expect("a patch that is drawn")
}

/// The points of one edge, but for its last, as (U, V).
fn edge_points(quad: &QuadFactors, edge: usize) -> Vec<[u32; 2]> {
    let start: u32 = quad.outside[..edge].iter().copied().map(segments).sum();
    quad.points()[start as usize..][..segments(quad.outside[edge]) as usize].to_vec()
}

#[test]
fn a_minimal_quad_is_its_corners() {
    for p in [Partitioning::Integer, Partitioning::Pow2, Partitioning::FractionalOdd] {
        let minimal = quad(p, [1.0; 4], [1.0; 2]);
        assert_eq!(minimal.points(), [[0, 0], [ONE, 0], [ONE, ONE], [0, ONE]]);
        assert_eq!(minimal.triangles(), [[0, 1, 3], [1, 2, 3]]);
    }
    assert_eq!(
        quad(Partitioning::FractionalEven, [1.0; 4], [1.0; 2]).triangle_count(),
        8,
        "even factors are at least 2"
    );
}

#[test]
fn twos_give_a_fan_around_the_centre() {
    let twos = quad(Partitioning::Integer, [2.0; 4], [2.0; 2]);
    let outline =
        [[0, ONE], [0, HALF], [0, 0], [HALF, 0], [ONE, 0], [ONE, HALF], [ONE, ONE], [HALF, ONE], [HALF, HALF]];
    assert_eq!(twos.points(), outline);
    assert!(twos.triangles().into_iter().eq((0..8).map(|k| [k, (k + 1) % 8, 8])));
}

#[test]
fn an_inside_of_three_by_two_collapses_to_a_row_along_u() {
    let mixed = quad(Partitioning::Integer, [1.0, 2.0, 1.0, 1.0], [3.0, 2.0]);
    let points = [[0, ONE], [0, 0], [HALF, 0], [ONE, 0], [ONE, ONE], [21845, HALF], [43691, HALF]];
    assert_eq!(mixed.points(), points);
    let triangles = [[5, 0, 1], [1, 2, 5], [5, 2, 6], [2, 3, 6], [6, 3, 4], [6, 4, 5], [5, 4, 0]];
    assert_eq!(mixed.triangles(), triangles);
}

#[test]
fn an_inside_of_one_by_four_collapses_to_a_row_from_the_greatest_v() {
    let tall = quad(Partitioning::Integer, [1.0; 4], [1.0, 4.0]);
    assert_eq!(tall.points()[4..], [[HALF, 49152], [HALF, HALF], [HALF, 16384]]);
    let triangles = [[4, 0, 5], [5, 0, 1], [5, 1, 6], [6, 1, 2], [6, 2, 5], [5, 2, 3], [5, 3, 4], [4, 3, 0]];
    assert_eq!(tall.triangles(), triangles);
}

#[test]
fn an_odd_fraction_leaves_one_quad_in_the_middle() {
    let odd = quad(Partitioning::FractionalOdd, [2.5; 4], [2.5; 2]);
    let [a, b] = [16384, 49152];
    assert_eq!(edge_points(&odd, 0), [[0, ONE], [0, b], [0, a]]);
    assert_eq!(odd.points()[12..], [[a, b], [a, a], [b, a], [b, b]]);
    let triangles = odd.triangles();
    assert_eq!(triangles[..4], [[0, 1, 12], [12, 1, 13], [13, 1, 2], [2, 3, 13]]);
    assert_eq!(triangles[16..], [[12, 14, 15], [12, 13, 14]]);
}

#[test]
fn strips_turn_the_middle_diagonal_only_of_odd_columns() {
    let last = |inside: [f32; 2], count: usize| {
        let triangles = quad(Partitioning::Integer, [3.0; 4], inside).triangles();
        triangles[triangles.len() - count..].to_vec()
    };
    // The last ring has points 12 to 19: a column of three segments, then one of two, then a row of three.
    let column = [[12, 13, 19], [19, 13, 18], [13, 17, 18], [13, 14, 17], [14, 15, 17], [17, 15, 16]];
    assert_eq!(last([3.0, 5.0], 6), column);
    assert_eq!(last([3.0, 4.0], 4), [[17, 12, 13], [17, 13, 16], [16, 13, 14], [16, 14, 15]]);
    let row = [[12, 13, 14], [12, 14, 19], [19, 14, 15], [19, 15, 18], [18, 15, 16], [18, 16, 17]];
    assert_eq!(last([5.0, 3.0], 6), row);
}

#[test]
fn edges_cull_and_the_inside_does_not() {
    for p in Partitioning::ALL {
        for bad in [0.0, -0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
            for k in 0..4 {
                let mut edges = [3.0; 4];
                edges[k] = bad;
                assert_eq!(QuadFactors::new(p, edges, [3.0; 2]), None, "{bad} on edge {k}");
            }
            for inside in [[bad, 5.0], [5.0, bad]] {
                let least = inside.map(|x| if x == 5.0 { 5.0 } else { 1.0 });
                assert_eq!(QuadFactors::new(p, [5.0; 4], inside), QuadFactors::new(p, [5.0; 4], least));
            }
        }
    }
}

#[test]
fn an_odd_quad_with_any_divided_side_has_a_ring_inside() {
    let tie = f32::from_bits(BITS_ONE_AND_HALF_STEP);
    let with = |edge, u| quad(Partitioning::FractionalOdd, [1.0, edge, 1.0, 1.0], [u, 1.0]);
    for minimal in [with(1.0, 0.5), with(tie, 1.0), with(1.0, tie)] {
        assert_eq!((minimal.point_count(), minimal.triangle_count()), (4, 2));
    }
    for (divided, points) in
        [(with(tie.next_up(), 1.0), 6 + 4), (with(1.0, tie.next_up()), 4 + 4), (with(1.0, 5.0), 4 + 8)]
    {
        assert_eq!(divided.inside[1], FACTOR_ODD | (FIXED_ONE + 1));
        assert_eq!(divided.point_count(), points);
    }
}

#[test]
fn partitionings_that_direct3d_does_not_have_act_as_integer() {
    for p in [Partitioning::Subtriangulation, Partitioning::Rows] {
        let of = |p| QuadFactors::new(p, [2.5, 100.0, 1.0, 3.0], [70.0, 1.0]);
        assert_eq!(of(p), of(Partitioning::Integer));
    }
}

#[test]
fn edges_are_those_of_the_triangle_domain_and_depend_on_their_own_factor_only() {
    for p in Partitioning::DIRECT3D {
        let triangle = process(p, [7.3; 3], 4.0);
        let plan = domain_plan(triangle);
        let count = segments(triangle.outside[0]);
        let row: Vec<u32> = (0..count).map(|i| domain_point(&plan, i)[1]).collect();
        let mirrored: Vec<u32> = row.iter().map(|x| ONE - x).collect();
        for (other, inside) in [(2.2, [1.0, 9.0]), (50.0, [33.3, 2.0])] {
            let place = |edge: usize, axis: usize| {
                let mut edges = [other; 4];
                edges[edge] = 7.3;
                edge_points(&quad(p, edges, inside), edge).into_iter().map(|point| point[axis]).collect::<Vec<_>>()
            };
            let all = [place(0, 1), place(1, 0), place(2, 1), place(3, 0)];
            assert_eq!(all, [&row, &mirrored, &mirrored, &row].map(Clone::clone), "{p:?}");
        }
    }
}

/// Each edge inside belongs to two triangles, which run along it in opposite directions. The other edges are the outline.
fn assert_is_disc(quad: &QuadFactors, triangles: &[[u32; 3]]) {
    let mut sides = HashMap::new();
    for t in triangles {
        for k in 0..3 {
            *sides.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
        }
    }
    assert!(sides.values().all(|n| *n == 1), "{quad:x?}");
    let mut outline: Vec<_> = sides.keys().filter(|(a, b)| !sides.contains_key(&(*b, *a))).copied().collect();
    outline.sort_unstable();
    let outer = quad.outer_count();
    assert!(outline.iter().copied().eq((0..outer).map(|i| (i, (i + 1) % outer))), "{quad:x?}");
}

fn assert_is_whole(quad: &QuadFactors) {
    let (points, triangles) = (quad.points(), quad.triangles());
    assert_eq!((points.len(), triangles.len()), (quad.point_count() as usize, quad.triangle_count() as usize));
    let areas: Vec<_> = triangles.iter().map(|t| doubled_area(&points, *t)).collect();
    assert!(areas.iter().all(|area| *area >= 0), "{quad:x?}");
    assert_eq!(areas.iter().sum::<i64>(), 2 * i64::from(ONE) * i64::from(ONE), "{quad:x?}");
}

#[test]
fn every_pair_of_inside_factors_makes_a_disc() {
    for u in 1..=64 {
        for v in 1..=64 {
            let own = quad(Partitioning::Integer, [1.0, 2.0, 5.0, 64.0], [u as f32, v as f32]);
            assert_is_whole(&own);
            assert_is_disc(&own, &own.triangles());
        }
    }
}

proptest! {
    #[test]
    fn any_quad_is_covered_once_and_counted(
        p in prop::sample::select(Partitioning::DIRECT3D.to_vec()),
        edges in prop::array::uniform4(any_factor()),
        inside in prop::array::uniform2(any_factor()),
    ) {
        if let Some(own) = QuadFactors::new(p, edges, inside) {
            assert_is_whole(&own);
            assert_is_disc(&own, &own.triangles());
        }
    }
}
