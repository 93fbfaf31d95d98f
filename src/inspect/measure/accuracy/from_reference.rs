//! The direction from the reference surface to what was emitted.

use std::ops::Range;

use super::peaks::Peaks;
use super::{AccuracyMeasurement, blocks};

impl AccuracyMeasurement<'_> {
    /// Measures from the reference surface to the triangles that are kept, and drops these.
    pub(super) fn drop_kept(&mut self) {
        let kept = std::mem::take(&mut self.emitted);
        let known = std::mem::take(&mut self.nearest);
        self.nearest = blocks(self.points.len(), self.options.threads, |range| {
            let nearer = |i: usize| {
                let known = known.get(i).copied().flatten();
                let within = known.map_or(f64::INFINITY, |place| place.value);
                kept.closest(self.points[i], within).map(|found| found.from(self.points[i])).or(known)
            };
            range.map(nearer).collect::<Vec<_>>()
        })
        .concat();
    }

    /// The squares of the distances from the points that are spread by area, and the worst places of all points.
    pub(super) fn measure_from_reference(&self) -> (f64, Peaks) {
        let (squares, mut all) = self.measure_points(0..self.spread, f64::NEG_INFINITY);
        // Points that are no farther than the worst so far needn't be measured exactly.
        let enough = all.places().next().map_or(f64::NEG_INFINITY, |worst| worst.value);
        let (_, of_edges) = self.measure_points(self.spread..self.points.len(), enough);
        all.join(&of_edges);
        (squares, all)
    }

    /// The squares of the distances from some points of the reference surface, and the worst places of those that are farther
    /// than `enough`. The squares of other distances may be too large.
    fn measure_points(&self, points: Range<usize>, enough: f64) -> (f64, Peaks) {
        let done = blocks(points.len(), self.options.threads, |range| {
            let (mut squares, mut peaks, mut hints) = (0.0, self.no_peaks.clone(), Vec::new());
            for i in range.map(|i| points.start + i) {
                let place = match self.nearest.get(i) {
                    Some(known) => *known,
                    None => self
                        .emitted
                        .closest_or_within(self.points[i], enough, &mut hints)
                        .map(|found| found.from(self.points[i])),
                };
                let Some(place) = place else { continue };
                squares += place.value * place.value;
                if place.value > enough {
                    peaks.add(place.reference_shape, place);
                }
            }
            (squares, peaks)
        });
        done.into_iter().fold((0.0, self.no_peaks.clone()), |(sum, mut all), (squares, peaks)| {
            all.join(&peaks);
            (sum + squares, all)
        })
    }
}
