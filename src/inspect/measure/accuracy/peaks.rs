//! Peaks: the places where distances are largest, and the way uphill from there.

use glam::DVec3;

use super::{WorstPoint, worse};
use crate::reference_shape::radical_inverse;

/// The places with the largest values so far, one for each region of space. They don't depend on the order of the places,
/// unless values are equal.
#[derive(Clone, Debug, Default)]
pub(super) struct Peaks {
    /// The most places that are kept.
    most: usize,
    /// The width of a region, in object units.
    width: f64,
    /// The largest value first.
    places: Vec<([i64; 3], WorstPoint)>,
}

impl Peaks {
    pub(super) fn new(most: usize, width: f64) -> Self {
        Self { most, width, places: Vec::new() }
    }

    /// Adds a place, which lies at `at`.
    pub(super) fn add(&mut self, at: DVec3, place: WorstPoint) {
        let is_full = self.places.len() >= self.most;
        if is_full && self.places.last().is_none_or(|(_, least)| place.value <= least.value) {
            return;
        }
        self.insert((at / self.width).floor().to_array().map(|x| x as i64), place);
    }

    fn insert(&mut self, region: [i64; 3], place: WorstPoint) {
        if let Some(known) = self.places.iter().position(|(other, _)| *other == region) {
            if self.places[known].1.value >= place.value {
                return;
            }
            self.places.remove(known);
        }
        let rank = self.places.partition_point(|(_, other)| other.value >= place.value);
        self.places.insert(rank, (region, place));
        self.places.truncate(self.most);
    }

    /// Adds the places of `other`, which has regions of the same width.
    pub(super) fn join(&mut self, other: &Self) {
        other.places.iter().for_each(|(region, place)| self.insert(*region, *place));
    }

    /// The places, those with the largest values first.
    pub(super) fn places(&self) -> impl ExactSizeIterator<Item = WorstPoint> {
        self.places.iter().map(|(_, place)| *place)
    }
}

/// The number of times that places are tried all around, each time within a smaller distance; and how many each time.
const ROUNDS: usize = 14;
const TRIES: usize = 12;
/// The factor from one round's distance to the next one's.
const NARROWING: f64 = 0.6;

/// Searches for a place with a larger value, within about `reach` at first and 1/800 of that in the end. `at` is the point
/// of a place that is moved. `measure` returns the place at the surface's point nearest to a point, and needn't be exact
/// for a place whose value is at most the given one.
pub(super) fn climb(
    start: WorstPoint,
    reach: f64,
    at: impl Fn(&WorstPoint) -> DVec3,
    measure: impl Fn(DVec3, f64) -> Option<WorstPoint>,
) -> WorstPoint {
    let (mut best, mut reach) = (start, reach);
    for round in 0..ROUNDS {
        for i in 0..TRIES {
            // Points in a cube around the place. On the surface, the nearest ones to these lie around it.
            let offset = [2, 3, 5].map(|base| 2.0 * radical_inverse(base, 1 + round * TRIES + i) - 1.0);
            let found = measure(at(&best) + reach * DVec3::from(offset), best.value);
            best = found.map_or(best, |found| worse(best, found));
        }
        reach *= NARROWING;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(value: f64, x: f64) -> WorstPoint {
        WorstPoint { value, patch: 0, emitted: DVec3::X * x, reference_shape: DVec3::ZERO }
    }

    #[test]
    fn the_largest_place_of_each_region_is_kept() {
        let all = [(3.0, 0.5), (5.0, 1.5), (4.0, 0.7), (1.0, 2.5), (2.0, 3.5), (4.5, 1.2)];
        for parts in [[0..6, 6..6], [0..3, 3..6], [0..1, 1..6]] {
            let mut peaks = Peaks::new(3, 1.0);
            for part in parts {
                let mut of_part = Peaks::new(3, 1.0);
                all[part].iter().for_each(|(value, x)| of_part.add(DVec3::X * *x, place(*value, *x)));
                peaks.join(&of_part);
            }
            let values: Vec<f64> = peaks.places().map(|place| place.value).collect();
            assert_eq!(values, [5.0, 4.0, 2.0]);
        }
    }

    /// The value falls from (0.3, 0, -0.2) of the plane in all directions, and ten times as fast across a diagonal.
    #[test]
    fn a_ridge_is_climbed() {
        let value = |p: DVec3| {
            let (along, across) = ((p.x + p.z - 0.1).abs(), (p.x - p.z - 0.5).abs());
            10.0 - along - 10.0 * across
        };
        let on_plane = |p: DVec3, _: f64| {
            let emitted = DVec3::new(p.x, 0.0, p.z);
            Some(WorstPoint { value: value(emitted), patch: 0, emitted, reference_shape: DVec3::ZERO })
        };
        let start = on_plane(DVec3::ZERO, 0.0).expect("every point has a place");
        let found = climb(start, 0.5, |place| place.emitted, on_plane);
        assert!(found.value > 9.97, "{found:?}");
    }
}
