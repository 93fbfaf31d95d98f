//! Finds out which positions are the same point.

use std::hash::BuildHasher;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use bytemuck::zeroed_vec;
use foldhash::fast::RandomState;
use glam::Vec3;
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;

use super::cell_chains::{CellChains, spread};
use crate::casts::to_u32;
use crate::cores::{fill, in_ranges};

/// The least number of positions that are worth a thread.
const LEAST: usize = 1 << 14;
/// About the number of positions in a part of them, whose table fits the cache of a core.
const PART: usize = 1 << 14;
/// With more parts, the ends of their lists wouldn't fit the cache.
const MOST_PARTS: usize = 256;

/// The most memory that an exact weld needs while it runs, in bytes for each position: 9 for its hash and index, 4 for its point, and 22
/// in tables, which take 9 bytes a place and are seven sixteenths full at least. Where many positions are equal, lists double, but
/// tables are small.
pub(super) const WELD_BYTES: u64 = 36;

/// Joins equal positions into points. Two positions are equal if all three coordinates have the same value (-0 equals
/// 0), without any tolerance. Points are in the order of their first appearance, and have +0 for every zero.
///
/// Returns the points, and for each of the `count` positions the index of its point. Takes expected linear time.
pub fn weld(count: usize, position: impl Fn(usize) -> Vec3 + Sync) -> (Vec<Vec3>, Vec<u32>) {
    weld_alike(count, |i| (position(i), 0), 0.0)
}

/// Joins positions as [`weld`] does; each has a number, which must be equal too. Returns the first position of each point in place of
/// the point.
fn weld_exactly(count: usize, place: impl Fn(usize) -> (Vec3, u32) + Sync) -> (Vec<u32>, Vec<u32>) {
    let mut point_of = first_equal(count, place);
    let points = (0..).zip(&point_of).filter(|(i, first)| i == *first).count();
    let mut firsts = Vec::with_capacity(points);
    for i in 0..count {
        let first = point_of[i] as usize;
        // The first of equal positions comes before the others, and has its point already.
        point_of[i] = if first < i {
            point_of[first]
        } else {
            firsts.push(to_u32(i));
            to_u32(firsts.len()) - 1
        };
    }
    (firsts, point_of)
}

/// Returns for each position the first one that has the same bits and the same number. Positions are divided by their hashes into parts
/// that have a table each: a table of all of them would be read all over memory.
fn first_equal(count: usize, place: impl Fn(usize) -> (Vec3, u32) + Sync) -> Vec<u32> {
    // Two words per key, which foldhash hashes several times faster than an array.
    let key = |i: usize| {
        let (position, number) = place(i);
        let [x, y, z] = position.to_array().map(|coordinate| u64::from(coordinate.to_bits()));
        (x << 32 | y, z << 32 | u64::from(number))
    };
    let hasher = RandomState::default();
    let parts = (count / PART).next_power_of_two().min(MOST_PARTS);
    // For each range of positions and each part, the hash and the index of each position, in the order of the positions.
    let ranges = in_ranges(count, LEAST, |range| {
        // Hashes are spread evenly, so that there is room enough nearly always.
        let room = range.len() / parts * 9 / 8;
        let mut of_parts: Vec<Vec<u64>> = (0..parts).map(|_| Vec::with_capacity(room)).collect();
        for i in range {
            let hash = hasher.hash_one(key(i)) >> 32;
            of_parts[((hash * parts as u64) >> 32) as usize].push(hash << 32 | i as u64);
        }
        of_parts
    });
    // Each is written by one core at most.
    let first: Vec<AtomicU32> = (0..to_u32(count)).map(AtomicU32::new).collect();
    in_ranges(parts, 1, |own| {
        let mut table = HashTable::new();
        for part in own {
            let hashed: Vec<&[u64]> = ranges.iter().map(|of_parts| &of_parts[part][..]).collect();
            find_equal(&mut table, &hashed, |a, b| key(a as usize) == key(b as usize), &first);
        }
    });
    first.into_iter().map(AtomicU32::into_inner).collect()
}

/// Writes the first of equal positions for each position of a part, each of which is given as its hash and its index. `table` has room
/// that is used again.
#[expect(clippy::cast_possible_truncation, reason = "the lower half is the number, the upper half the hash")]
fn find_equal(table: &mut HashTable<u64>, part: &[&[u64]], is_equal: impl Fn(u32, u32) -> bool, first: &[AtomicU32]) {
    let spread = |&own: &u64| spread((own >> 32) as u32);
    let positions: usize = part.iter().map(|own| own.len()).sum();
    table.clear();
    // A part with many more positions has many equal ones, which need one place together.
    table.reserve(positions.min(2 * PART), spread);
    for own in part.iter().copied().flatten() {
        let is_same = |other: &u64| *other >> 32 == own >> 32 && is_equal(*other as u32, *own as u32);
        match table.entry(spread(own), is_same, spread) {
            Entry::Occupied(there) => first[*own as u32 as usize].store(*there.get() as u32, Ordering::Relaxed),
            Entry::Vacant(free) => drop(free.insert(*own)),
        }
    }
}

/// Joins positions within a tolerance, in object units, into points. Distinct positions are taken in the order of their
/// first appearance. Each becomes part of the nearest point so far that lies within the tolerance (the earlier one of
/// two at the same distance), or else a new point. So every position lies within one tolerance of its point, however
/// long a chain of near positions is, and any two points are more than one tolerance apart.
///
/// A tolerance that isn't above 0 gives the same result as [`weld`]. Each position has a number, and positions with different numbers
/// aren't joined. Returns the points, and for each of the `count` positions the index of its point. Beside the exact weld it takes
/// expected linear time, since only a limited number of points that far apart fit into one cell of the grid.
pub fn weld_alike(count: usize, place: impl Fn(usize) -> (Vec3, u32) + Sync, tolerance: f64) -> (Vec<Vec3>, Vec<u32>) {
    let place = |i: usize| {
        let (position, number) = place(i);
        (plus_zero3(position), number)
    };
    // Join equal positions first: they must stay together even if a nearer point comes between them.
    let (firsts, mut point_of) = weld_exactly(count, place);
    if tolerance.is_nan() || tolerance <= 0.0 {
        let mut points: Vec<Vec3> = zeroed_vec(firsts.len());
        fill(&mut points, LEAST, |i| place(firsts[i] as usize).0);
        return (points, point_of);
    }
    let (points, merged) = merge_within(firsts.iter().map(|first| place(*first as usize)), tolerance);
    point_of.iter_mut().for_each(|point| *point = merged[*point as usize]);
    (points, point_of)
}

/// Joins distinct positions as [`weld_alike`] does, within a tolerance above 0.
pub(super) fn merge_within(distinct: impl Iterator<Item = (Vec3, u32)>, tolerance: f64) -> (Vec<Vec3>, Vec<u32>) {
    // Cells that are as narrow as a search allows: in wider ones there are more points to compare.
    let mut points = CellChains::with_capacity(CellChains::LEAST_WIDTH * tolerance, 0);
    let mut latest = 0;
    let joined = |(position, number): (Vec3, u32)| {
        let found = nearest(&points, latest, (position, number), tolerance);
        latest = found.unwrap_or_else(|| points.push(position, number));
        latest
    };
    let merged = distinct.map(joined).collect();
    (points.into_positions(), merged)
}

/// Within this part of the tolerance there is no more than one point, with room for rounding: points are more than one tolerance
/// apart.
const HALF: f64 = 0.5 - 1e-6;

/// Returns the nearest of points that are more than one tolerance apart, if it is within the tolerance of a position; of several at the
/// same distance, the lowest. `latest` is the point that was found last.
fn nearest(points: &CellChains, latest: u32, (position, number): (Vec3, u32), tolerance: f64) -> Option<u32> {
    let (none, half) = ((tolerance, u32::MAX), HALF * tolerance.min(f64::MAX));
    // Most positions lie near the one before.
    let of_latest = points.square(latest, position.as_dvec3(), number);
    let mut nearest = of_latest.map_or(none, |square| nearer((square, latest), none));
    if nearest.0 > half {
        // What a search finds is the same whether it breaks or not.
        let _ = points.near(position, number, nearest.0, |point, square, reach| {
            nearest = nearer((square, point), nearest);
            *reach = nearest.0;
            if nearest.0 > half { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
    }
    (nearest != none).then_some(nearest.1)
}

/// Returns the nearer one of two points, each after its distance, or the lower one of two at the same distance. That of the first is
/// still squared.
fn nearer((square, point): (f64, u32), other: (f64, u32)) -> (f64, u32) {
    // Most of what is too far away is so by its square, with room for rounding, and needs no root.
    if square > other.0 * other.0 * (1.0 + 1e-9) {
        return other;
    }
    let own = (square.sqrt(), point);
    if own < other { own } else { other }
}

/// Replaces -0 by +0, so that equal values have equal bits.
pub(super) fn plus_zero3(v: Vec3) -> Vec3 {
    // By IEEE 754, -0 + +0 is +0, and adding +0 changes nothing else.
    v + Vec3::ZERO
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::cores::on_threads;
    use proptest::prelude::*;

    fn weld(positions: &[Vec3]) -> (Vec<Vec3>, Vec<u32>) {
        super::weld(positions.len(), |i| positions[i])
    }

    fn weld_within(positions: &[Vec3], tolerance: f64) -> (Vec<Vec3>, Vec<u32>) {
        super::weld_alike(positions.len(), |i| (positions[i], 0), tolerance)
    }

    fn weld_alike(positions: &[(Vec3, u32)], tolerance: f64) -> (Vec<Vec3>, Vec<u32>) {
        super::weld_alike(positions.len(), |i| positions[i], tolerance)
    }

    #[test]
    fn minus_zero_is_zero() {
        let (points, of) = weld(&[Vec3::new(-0.0, 1.0, 2.0), Vec3::new(0.0, 1.0, 2.0)]);
        assert_eq!(of, [0, 0]);
        assert_eq!(points.len(), 1);
        assert_eq!(points[0].x.to_bits(), 0);
    }

    #[test]
    fn the_number_of_cores_makes_no_difference() {
        let place = |i: u32| Vec3::new((i.wrapping_mul(i) % 40_009) as f32, -0.0, (i % 3) as f32);
        let positions: Vec<Vec3> = (0..100_000).map(place).collect();
        let mut known = HashMap::new();
        let mut numbers = Vec::new();
        for position in &positions {
            let next = known.len() as u32;
            numbers.push(*known.entry([position.x, position.z].map(f32::to_bits)).or_insert(next));
        }
        for cores in [1, 2, 7] {
            let (points, of) = on_threads(cores, || weld(&positions)).expect("threads");
            assert!(points.len() == known.len() && of == numbers, "{cores}");
        }
        let one = on_threads(7, || weld(&[Vec3::ONE; 100_000])).expect("threads");
        assert_eq!(one, (vec![Vec3::ONE], vec![0; 100_000]));
    }

    #[test]
    fn a_table_has_room_for_the_positions_that_differ() {
        let (count, distinct) = (200_000, 100_000);
        let hashed: Vec<u64> = (0..count).map(|i| (i % distinct) << 32 | i).collect();
        let is_equal = |a: u32, b: u32| a % distinct as u32 == b % distinct as u32;
        let first: Vec<AtomicU32> = (0..count as u32).map(AtomicU32::new).collect();
        let mut table = HashTable::new();
        find_equal(&mut table, &[&hashed[..70_000], &hashed[70_000..]], is_equal, &first);
        assert!(table.len() == distinct as usize && table.capacity() > 2 * PART, "grown");
        assert!((0..).zip(&first).all(|(i, first)| first.load(Ordering::Relaxed) == i % distinct as u32));
        let equal: Vec<u64> = (0..count).map(|i| 7 << 32 | i).collect();
        find_equal(&mut table, &[&equal], |_, _| true, &first);
        assert!(table.len() == 1 && first.iter().all(|first| first.load(Ordering::Relaxed) == 0));
    }

    #[test]
    fn the_smallest_difference_keeps_points_apart() {
        let next = f32::from_bits(1.0_f32.to_bits() + 1);
        let (points, of) = weld(&[Vec3::ONE, Vec3::new(1.0, 1.0, next), Vec3::ONE]);
        assert_eq!((points.len(), of), (2, vec![0, 1, 0]));
    }

    #[test]
    fn the_nearest_point_wins_and_the_earlier_of_two() {
        let at = |x: &[f32]| x.iter().map(|&x| Vec3::X * x).collect::<Vec<_>>();
        let (points, of) = weld_within(&at(&[0.0, 1.5, 1.0, 0.75, 0.5]), 1.0);
        assert_eq!((points, of), (at(&[0.0, 1.5]), vec![0, 1, 1, 0, 0]));
    }

    #[test]
    fn chains_of_near_positions_do_not_become_one_point() {
        let chain: Vec<Vec3> = (0..100).map(|i| Vec3::Y * (i as f32 / 4.0)).collect();
        let (points, of) = weld_within(&chain, 0.5);
        // 0, 0.25 and 0.5 become one point. 0.75 is too far from 0, and becomes one point with 1.
        assert_eq!((points.len(), &of[..7]), (34, &[0, 0, 0, 1, 1, 1, 2][..]));
    }

    #[test]
    fn equal_positions_stay_together_whatever_comes_between() {
        let (points, of) = weld_within(&[0.0, 0.9, 1.5, 0.9].map(|x| Vec3::X * x), 1.0);
        assert_eq!((points.len(), of), (2, vec![0, 0, 1, 0]));
    }

    #[test]
    fn the_tolerance_itself_counts_as_within() {
        for (x, points) in [(0.25_f32, 1), (0.25_f32.next_up(), 2)] {
            assert_eq!(weld_within(&[Vec3::ZERO, Vec3::X * x], 0.25).0.len(), points);
        }
    }

    #[test]
    fn no_tolerance_is_the_exact_weld() {
        let positions = [1.0, -0.0, 0.0, 1e-45, 1e38, 1.0].map(Vec3::splat);
        for tolerance in [0.0, -1.0, f64::NAN] {
            assert_eq!(weld_within(&positions, tolerance), weld(&positions));
        }
    }

    #[test]
    fn huge_and_tiny_coordinates_weld_alike() {
        for scale in [1e-30_f32, 1e-7, 1.0, 1e7, 1e30] {
            let positions = [0.0, 1.0, 1.0001, 2.0].map(|x| Vec3::ONE * (x * scale));
            let (points, of) = weld_within(&positions, 1e-3 * f64::from(scale));
            assert_eq!((points.len(), of), (3, vec![0, 1, 1, 2]), "{scale}");
        }
        let (points, _) = weld_within(&[1e30, 2e30, 1e-30, 2e-30].map(Vec3::splat), 1e-40);
        assert_eq!(points.len(), 4);
        assert_eq!(weld_within(&[-f32::MAX, 0.0, f32::MAX].map(Vec3::splat), f64::INFINITY).1, [0, 0, 0]);
    }

    #[test]
    fn many_positions_on_one_spot_stay_fast() {
        let place = |i: u32| Vec3::new(1.0 + 1e-7 * (i % 1000) as f32, 1.0 + 1e-7 * (i / 1000) as f32, 1.0);
        let spot: Vec<Vec3> = (0..300_000).map(place).collect();
        let (points, _) = weld_within(&spot, 1e-3);
        assert_eq!(points.len(), 1);
    }

    #[test]
    fn positions_that_move_differently_stay_apart() {
        let positions = [(0.0, 7), (0.0, 9), (0.1, 9), (0.1, 7), (0.0, 7)].map(|(x, number)| (Vec3::X * x, number));
        assert_eq!(weld_alike(&positions, 0.0).1, [0, 1, 2, 3, 0]);
        let (points, of) = weld_alike(&positions, 0.5);
        assert_eq!((points, of), (vec![Vec3::ZERO; 2], vec![0, 1, 1, 0, 0]));
    }

    proptest! {
        #[test]
        fn the_grid_welds_as_a_slow_search_does(
            grid in prop::collection::vec(prop::array::uniform3(-6_i8..6), 0..60),
            tolerance in 0_u8..13,
            numbers in 1_u32..4,
        ) {
            let positions = (0..).zip(&grid).map(|(i, p)| (Vec3::from(p.map(f32::from)), i % numbers)).collect::<Vec<_>>();
            let tolerance = f64::from(tolerance) / 2.0;
            let (points, of) = weld_alike(&positions, tolerance);
            let mut expected: Vec<(Vec3, u32)> = Vec::new();
            let mut known: HashMap<([u32; 3], u32), u32> = HashMap::new();
            for (&(position, number), &point) in positions.iter().zip(&of) {
                let key = (plus_zero3(position).to_array().map(f32::to_bits), number);
                let slow = *known.entry(key).or_insert_with(|| {
                    let apart = |i: &u32| expected[*i as usize].0.as_dvec3().distance(position.as_dvec3());
                    // `min_by` keeps the first of several least values.
                    let alike = (0..expected.len() as u32).filter(|i| expected[*i as usize].1 == number);
                    let near = alike.min_by(|a, b| apart(a).total_cmp(&apart(b)));
                    near.filter(|i| apart(i) <= tolerance).unwrap_or_else(|| {
                        expected.push((position, number));
                        expected.len() as u32 - 1
                    })
                });
                prop_assert_eq!(point, slow);
            }
            prop_assert!(points.into_iter().eq(expected.into_iter().map(|(point, _)| point)));
        }

        #[test]
        fn points_and_positions_agree(grid in prop::collection::vec((-2i8..2, -2i8..2, -2i8..2), 0..60)) {
            let positions: Vec<Vec3> = grid.iter().map(|&(x, y, z)| Vec3::new(x.into(), y.into(), z.into())).collect();
            let (points, of) = weld(&positions);
            for (position, &point) in positions.iter().zip(&of) {
                prop_assert_eq!(*position, points[point as usize]);
            }
            for (i, a) in points.iter().enumerate() {
                prop_assert!(points[..i].iter().all(|b| b != a), "two points in one place");
            }
            let mut seen = 0;
            for point in of {
                prop_assert!(point <= seen, "not in order of first appearance");
                seen = seen.max(point + 1);
            }
        }
    }
}
