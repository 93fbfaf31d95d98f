//! Finds out which points have another point nearby: only those can change when points are welded within a tolerance.

use glam::{DVec3, Vec3};

use crate::cores::in_ranges;

/// The number that ends a chain.
const NONE: u32 = u32::MAX;

/// How many other points are compared with a point at most. A point in a crowd counts as near to another one without a
/// search, which keeps the work linear.
const TRIES: usize = 64;

/// How many comparisons a point may take on average, for a search as far as a distance to be worthwhile.
const WORTHWHILE: usize = 16;

/// How many points of the mesh are tried to estimate that average.
const SAMPLES: usize = 512;

/// For each point, which of some tolerances are so large that another point may lie within them.
pub(super) struct NearPoints {
    /// For each point, the index of the first such tolerance.
    first: Vec<u8>,
}

impl NearPoints {
    /// Compares `points` with each other; only those with the same number can be near. There are no numbers if all are
    /// the same. `tolerances` are above 0, in object units, and ascending; no coordinate lies further than 2^30 of the
    /// first one from `origin`, which is the least in each. Takes linear time.
    pub(super) fn find(points: &[Vec3], numbers: &[u32], tolerances: &[f64], origin: DVec3) -> Self {
        let grid = tolerances.iter().rev().map(|&reach| Grid::new(points, reach, origin));
        let found = (0..tolerances.len() as u8).rev().zip(grid).find(|(_, grid)| grid.comparisons() <= WORTHWHILE);
        let Some((furthest, grid)) = found else { return Self { first: vec![0; points.len()] } };
        let tolerances = &tolerances[..=usize::from(furthest)];
        let first = |point: usize| match grid.nearest(point as u32, numbers) {
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

/// Points in cells of a grid. Cells that have the same hash share a chain, so that no cell must be stored.
struct Grid<'a> {
    points: &'a [Vec3],
    origin: DVec3,
    /// How far one can search, in object units. Cells are twice as wide.
    reach: f64,
    /// The last point of each chain.
    last: Vec<u32>,
    /// For each point, the one before it in its chain.
    before: Vec<u32>,
}

impl<'a> Grid<'a> {
    fn new(points: &'a [Vec3], reach: f64, origin: DVec3) -> Self {
        let chains = points.len().next_power_of_two();
        let mut grid =
            Self { points, origin, reach, last: vec![NONE; chains], before: Vec::with_capacity(points.len()) };
        for (point, place) in (0..).zip(points) {
            let [x, y, z] = grid.offset(*place).map(|along| grid.cell(along));
            let chain = grid.chain(x, y, z);
            grid.before.push(std::mem::replace(&mut grid.last[chain], point));
        }
        grid
    }

    fn offset(&self, place: Vec3) -> [f64; 3] {
        (place.as_dvec3() - self.origin).to_array()
    }

    /// Returns the number of the cell at an offset from the origin; 0 below it, where no points are.
    fn cell(&self, along: f64) -> u32 {
        (along / (2.0 * self.reach)) as u32
    }

    fn chain(&self, x: u32, y: u32, z: u32) -> usize {
        // Large odd numbers without a pattern in their bits. Neighbours along x lie side by side in memory.
        let hash = x.wrapping_add(y.wrapping_mul(0x9e37_79b1)).wrapping_add(z.wrapping_mul(0x85eb_ca77));
        hash as usize & (self.last.len() - 1)
    }

    /// Calls `visit` with the points that may lie within reach of a point, and with it itself; a point may come several
    /// times. Returns how many there were, or none if there are more than [`TRIES`].
    fn around(&self, point: u32, mut visit: impl FnMut(u32)) -> Option<usize> {
        // A little more than the reach, for the rounding of offsets.
        let reach = self.reach * (1.0 + 1e-6);
        let [x, y, z] =
            self.offset(self.points[point as usize]).map(|at| self.cell(at - reach)..=self.cell(at + reach));
        let mut count = 0;
        for x in x {
            for y in y.clone() {
                for z in z.clone() {
                    let mut next = self.last[self.chain(x, y, z)];
                    while next != NONE {
                        if count == TRIES {
                            return None;
                        }
                        count += 1;
                        visit(next);
                        next = self.before[next as usize];
                    }
                }
            }
        }
        Some(count)
    }

    /// Returns the nearest other point with the same number.
    fn nearest(&self, point: u32, numbers: &[u32]) -> Nearest {
        let place = self.points[point as usize].as_dvec3();
        let number = |point: u32| numbers.get(point as usize);
        let mut least = f64::INFINITY;
        let tried = self.around(point, |other| {
            if other != point && number(other) == number(point) {
                least = least.min(self.points[other as usize].as_dvec3().distance_squared(place));
            }
        });
        match least.sqrt() {
            _ if tried.is_none() => Nearest::Unknown,
            distance if distance <= self.reach => Nearest::At(distance),
            _ => Nearest::Beyond,
        }
    }

    /// Estimates how many points a point is compared with.
    fn comparisons(&self) -> usize {
        let step = (self.points.len() / SAMPLES).max(1);
        let tried =
            (0..self.points.len()).step_by(step).map(|point| self.around(point as u32, |_| ()).unwrap_or(TRIES));
        tried.sum::<usize>() / self.points.len().div_ceil(step).max(1)
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

    fn origin(points: &[Vec3]) -> DVec3 {
        points.iter().fold(Vec3::INFINITY, |least, point| least.min(*point)).as_dvec3()
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
            let found = NearPoints::find(&points, &numbers, &tolerances, origin(&points));
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
        let found = NearPoints::find(&points, &[], &[1e-4, 1e-2, 0.5], DVec3::ZERO);
        assert_eq!(found.within(0).count(), 0);
        assert!((1..3).all(|k| found.within(k).eq([3017, 10_000])));
    }

    #[test]
    fn a_crowd_counts_as_near_and_takes_no_time() {
        let spot = |i: u32| Vec3::new(1.0 + 1e-7 * (i % 1000) as f32, 1.0 + 1e-7 * (i / 1000) as f32, 1.0);
        let points: Vec<Vec3> = (0..300_000).map(spot).collect();
        let found = NearPoints::find(&points, &[], &[1e-3, 1.0], origin(&points));
        assert_eq!(found.within(0).count(), points.len());
    }
}
