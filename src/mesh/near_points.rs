//! Finds out which points have another point nearby: only those can change when points are welded within a tolerance.

use std::ops::ControlFlow::{Break, Continue};

use glam::{DVec3, Vec3};

use super::cell_chains::CellChains;
use crate::cores::in_ranges;

/// How many other points are compared with a point at most. A point in a crowd counts as near to another one without a
/// search, which keeps the work linear.
const TRIES: usize = 64;

/// How many points of the mesh are tried to estimate how many have another one nearby.
const SAMPLES: usize = 512;

/// For each point, which of some tolerances are so large that another point may lie within them.
pub(super) struct NearPoints {
    /// For each point, the index of the first such tolerance.
    first: Vec<u8>,
}

impl NearPoints {
    /// Compares `points` with each other; only those with the same number can be near. There are no numbers if all are
    /// the same. `tolerances` are above 0, in object units, and ascending. Within those that most points have another one in,
    /// no search is made, and all points count as near. Takes linear time.
    pub(super) fn find(points: &[Vec3], numbers: &[u32], tolerances: &[f64]) -> Self {
        let grid = tolerances.iter().rev().map(|&reach| Grid::new(points, numbers, reach));
        let found = (0..tolerances.len() as u8).rev().zip(grid).find(|(_, grid)| grid.leaves_out_most());
        let Some((furthest, grid)) = found else { return Self { first: vec![0; points.len()] } };
        let tolerances = &tolerances[..=usize::from(furthest)];
        let first = |point: usize| match grid.nearest(point as u32) {
            Nearest::At(distance) => tolerances.partition_point(|tolerance| *tolerance < distance) as u8,
            // No search went further.
            Nearest::Beyond => furthest + 1,
            Nearest::Unknown => 0,
        };
        let first = in_ranges(points.len(), 1 << 14, |range| range.map(first).collect::<Vec<_>>()).concat();
        Self { first }
    }

    /// Returns the points that another one may be near to within a tolerance, given by its index; in ascending order. All
    /// others have none.
    pub(super) fn within(&self, tolerance: usize) -> impl Iterator<Item = u32> + Clone {
        (0..).zip(&self.first).filter(move |(_, first)| usize::from(**first) <= tolerance).map(|(point, _)| point)
    }
}

/// The nearest other point.
enum Nearest {
    /// At a distance that is no more than the grid's reach, in object units.
    At(f64),
    /// Beyond the grid's reach.
    Beyond,
    /// It wasn't searched for, since too many points are nearby.
    Unknown,
}

/// Points in cells of a grid.
struct Grid<'a> {
    points: &'a [Vec3],
    numbers: &'a [u32],
    /// How far one can search, in object units.
    reach: f64,
    chains: CellChains,
}

impl<'a> Grid<'a> {
    fn new(points: &'a [Vec3], numbers: &'a [u32], reach: f64) -> Self {
        // Wider than a search needs, so that most searches look at few cells.
        let chains = CellChains::with_capacity(4.0 * reach, points.len());
        let mut grid = Self { points, numbers, reach, chains };
        for point in 0..points.len() as u32 {
            let own = grid.point(point);
            // There is room for all, so no earlier point is asked for.
            grid.chains.push(own, |_| own);
        }
        grid
    }

    fn point(&self, point: u32) -> (DVec3, u32) {
        let number = self.numbers.get(point as usize).copied().unwrap_or_default();
        (self.points[point as usize].as_dvec3(), number)
    }

    /// Returns the nearest other point with the same number.
    fn nearest(&self, point: u32) -> Nearest {
        let (place, number) = self.point(point);
        let (mut least, mut count) = (f64::INFINITY, 0);
        // A little more than the reach, for the rounding of distances.
        let tried = self.chains.near((place, number), self.reach * (1.0 + 1e-6), |other, reach| {
            if count == TRIES {
                return Break(());
            }
            count += 1;
            let (at, of) = self.point(other);
            let square = at.distance_squared(place);
            if other != point && of == number && square < least {
                least = square;
                *reach = reach.min(square.sqrt());
            }
            Continue(())
        });
        match least.sqrt() {
            _ if tried.is_break() => Nearest::Unknown,
            distance if distance <= self.reach => Nearest::At(distance),
            _ => Nearest::Beyond,
        }
    }

    /// Estimates whether most points have no other one within reach. Only then is a search for all worth its time.
    fn leaves_out_most(&self) -> bool {
        let step = (self.points.len() / SAMPLES).max(1);
        let samples = (0..self.points.len() as u32).step_by(step);
        let (near, beyond): (Vec<_>, Vec<_>) =
            samples.partition(|&point| !matches!(self.nearest(point), Nearest::Beyond));
        near.len() <= beyond.len()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

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
    fn a_crowd_counts_as_near_and_takes_no_time() {
        let spot = |i: u32| Vec3::new(1.0 + 1e-7 * (i % 1000) as f32, 1.0 + 1e-7 * (i / 1000) as f32, 1.0);
        let points: Vec<Vec3> = (0..300_000).map(spot).collect();
        let found = NearPoints::find(&points, &[], &[1e-3, 1.0]);
        assert_eq!(found.within(0).count(), points.len());
    }
}
