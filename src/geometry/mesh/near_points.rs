//! Finds out which points have another point nearby: only those can change when points are welded within a tolerance.

use std::ops::ControlFlow::{Break, Continue};

use glam::Vec3;

use super::cell_chains::CellChains;
use crate::casts::to_u32;
use crate::cores::in_ranges;

/// How many other points are compared with a point at most. A point in a crowd counts as near to another one without a
/// search, which keeps the work linear.
const TRIES: usize = 64;

/// How many points of the mesh are tried to estimate how many have another one nearby.
const SAMPLES: usize = 512;

/// The width of a cell, in reaches: wider than a search needs, so that most searches look at few cells.
const WIDTH: f64 = 4.0;

/// How much farther a search goes, for the rounding of distances.
const ROOM: f64 = 1.0 + 1e-6;

/// The least number of points that are worth a thread.
const LEAST: usize = 1 << 14;

/// For each point, which of some tolerances are so large that another point may lie within them.
pub(super) struct NearPoints {
    /// For each point, the index of the first such tolerance.
    first: Vec<u8>,
}

impl NearPoints {
    /// Compares `points` with each other; only those with the same number can be near. There are no numbers if all are
    /// the same. `tolerances` are above 0, in object units, and ascending. Within those that most points have another one in,
    /// no search is made, and all points count as near. Takes linear time.
    #[expect(clippy::cast_possible_truncation, reason = "there are few tolerances")]
    pub(super) fn find(points: &[Vec3], numbers: &[u32], tolerances: &[f64]) -> Self {
        let searches = tolerances.iter().map(|&reach| NearestPoint::new(points, numbers, reach));
        let Some((furthest, search)) = searches.enumerate().rev().find(|(_, search)| search.leaves_out_most()) else {
            return Self { first: vec![0; points.len()] };
        };
        // No search goes further.
        let tolerances = &tolerances[..=furthest];
        let first_of = |point: usize| {
            let distance = search.nearest(to_u32(point));
            tolerances.partition_point(|tolerance| *tolerance < distance) as u8
        };
        let first = in_ranges(points.len(), LEAST, |range| range.map(first_of).collect::<Vec<_>>()).concat();
        Self { first }
    }

    /// Returns the points that another one may be near to within a tolerance, given by its index; in ascending order. All
    /// others have none.
    pub(super) fn within(&self, tolerance: usize) -> impl Iterator<Item = u32> + Clone {
        (0..).zip(&self.first).filter(move |(_, first)| usize::from(**first) <= tolerance).map(|(point, _)| point)
    }

    /// Returns whether another one may be near to every point within a tolerance.
    pub(super) fn all_within(&self, tolerance: usize) -> bool {
        self.first.iter().all(|first| usize::from(*first) <= tolerance)
    }
}

/// Searches for the nearest other point.
struct NearestPoint<'a> {
    points: &'a [Vec3],
    /// There are none if all are 0.
    numbers: &'a [u32],
    /// How far one can search, in object units.
    reach: f64,
    /// The square of the largest distance between points of the cells that a search looks at. What is farther away has its cell's hash by
    /// chance, which is another chance in every search.
    widest: f64,
    chains: CellChains,
}

impl<'a> NearestPoint<'a> {
    fn new(points: &'a [Vec3], numbers: &'a [u32], reach: f64) -> Self {
        let chains = CellChains::with_capacity(WIDTH * reach, points.len());
        // Two cells along each axis.
        let widest = 3.0 * (2.0 * WIDTH * reach).powi(2) * ROOM;
        let mut search = Self { points, numbers, reach, widest, chains };
        for point in 0..to_u32(points.len()) {
            search.chains.push(points[point as usize], search.number(point));
        }
        search
    }

    fn number(&self, point: u32) -> u32 {
        self.numbers.get(point as usize).copied().unwrap_or_default()
    }

    /// Returns the distance of the nearest other point with the same number, in object units: more than the reach if none is within it,
    /// and 0 if it wasn't searched for, since too many points are nearby.
    fn nearest(&self, point: u32) -> f64 {
        let (position, number) = (self.points[point as usize], self.number(point));
        let (mut least, mut count) = (f64::INFINITY, 0);
        let tried = self.chains.near(position, number, self.reach * ROOM, |item, square, reach| {
            if square <= self.widest {
                if count == TRIES {
                    return Break(());
                }
                count += 1;
            }
            if square < least && item != point {
                least = square;
                *reach = reach.min(square.sqrt());
            }
            Continue(())
        });
        if tried.is_break() { 0.0 } else { least.sqrt() }
    }

    /// Returns whether most points have no other one within reach, by an estimate. Only then is a search for all worth its time.
    fn leaves_out_most(&self) -> bool {
        let step = (self.points.len() / SAMPLES).max(1);
        let samples = (0..to_u32(self.points.len())).step_by(step);
        let is_beyond = |point: &u32| self.nearest(*point) > self.reach;
        2 * samples.clone().filter(is_beyond).count() >= samples.len()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::cores::on_threads;

    /// The tolerances within which a slow search finds another point.
    fn slow(points: &[Vec3], numbers: &[u32], tolerances: &[f64]) -> Vec<Vec<u32>> {
        let is_near = |a: usize, b: usize, tolerance: f64| {
            a != b
                && numbers.get(a) == numbers.get(b)
                && points[a].as_dvec3().distance(points[b].as_dvec3()) <= tolerance
        };
        let all = 0..points.len();
        let near = |tolerance: f64| {
            all.clone().filter(move |&a| (0..points.len()).any(|b| is_near(a, b, tolerance))).map(|a| a as u32)
        };
        tolerances.iter().map(|&tolerance| near(tolerance).collect()).collect()
    }

    proptest! {
        #[test]
        fn no_near_point_is_missed_and_far_ones_are_left_out(
            places in prop::collection::vec(prop::array::uniform3(-20_i32..20), 1..60),
            mixed in any::<bool>(),
            scale in -100_i32..100,
        ) {
            // Whole numbers times a power of two: many distances are exactly a tolerance.
            let scale = f64::from(scale).exp2();
            let points: Vec<Vec3> = places.iter().map(|at| (DVec3::from(at.map(f64::from)) * scale).as_vec3()).collect();
            let numbers: Vec<u32> = if mixed { (0..points.len() as u32).map(|i| i % 3).collect() } else { Vec::new() };
            let tolerances = [1.0, 2.0, 5.0, 9.0].map(|tolerance| tolerance * scale);
            let found = NearPoints::find(&points, &numbers, &tolerances);
            let most = usize::from(found.first.iter().copied().max().unwrap_or_default());
            for (k, near) in slow(&points, &numbers, &tolerances).into_iter().enumerate() {
                let all: Vec<u32> = found.within(k).collect();
                prop_assert!(near.iter().all(|point| all.contains(point)), "missed within {k}");
                // Beyond the search, and in a crowd, every point counts as near.
                prop_assert!(k >= most || all.len() == near.len() || found.first.contains(&0), "too many within {k}");
            }
        }
    }

    #[test]
    fn single_points_of_a_sheet_are_left_out() {
        let sheet = |i: u32| Vec3::new((i % 100) as f32, (i / 100) as f32, 0.0);
        let mut points: Vec<Vec3> = (0..10_000).map(sheet).collect();
        points.push(Vec3::new(17.0, 30.0, 1e-3));
        let found = NearPoints::find(&points, &[], &[1e-4, 1e-2, 0.5]);
        assert_eq!(found.within(0).count(), 0);
        assert!((1..3).all(|k| found.within(k).eq([3017, 10_000])));
    }

    #[test]
    fn the_number_of_cores_makes_no_difference() {
        let mut random = fastrand::Rng::with_seed(1);
        let points: Vec<Vec3> = (0..100_000).map(|_| Vec3::new(random.f32(), random.f32(), random.f32())).collect();
        let tolerances = [1e-3, 3e-3, 1e-2];
        let alone = on_threads(1, || NearPoints::find(&points, &[], &tolerances)).expect("threads");
        let counts = [0, 1, 2].map(|k| alone.within(k).count());
        assert!(
            counts[0] > 0 && counts[0] < counts[1] && counts[1] < counts[2] && counts[2] < points.len(),
            "{counts:?}"
        );
        for cores in [2, 7] {
            assert!(
                on_threads(cores, || NearPoints::find(&points, &[], &tolerances)).expect("threads").first
                    == alone.first,
                "{cores}"
            );
        }
    }

    #[test]
    fn a_crowd_counts_as_near_and_takes_no_time() {
        let spot = |i: u32| Vec3::new(1.0 + 1e-7 * (i % 1000) as f32, 1.0 + 1e-7 * (i / 1000) as f32, 1.0);
        let points: Vec<Vec3> = (0..300_000).map(spot).collect();
        let found = NearPoints::find(&points, &[], &[1e-3, 1.0]);
        assert_eq!(found.within(0).count(), points.len());
    }
}
