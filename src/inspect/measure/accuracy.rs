//! Accuracy: the distances between what was emitted and a reference surface, in both directions, and the angles between their
//! normals.

mod emitted;
mod from_reference;
mod peaks;
mod to_reference;

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use glam::{DVec3, Vec3};

use super::screen_error::Screen;
use super::visitor::{EmittedChunk, Visitor};
use crate::reference_shape::{EdgePoints, ReferenceShape};
use emitted::Emitted;
use geometry::tessellate::{LodView, Vertex};
use peaks::{Peaks, climb};
use to_reference::Sums;

/// How finely accuracy is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccuracyOptions {
    /// The number of samples that are spread over the reference surface by area. Its vertices, and points along its edges, are
    /// taken besides. What was emitted gets about as many, but at least four per triangle and the middle of every edge.
    pub samples: usize,
    /// The number of threads. The result doesn't depend on it.
    pub threads: usize,
}

impl Default for AccuracyOptions {
    fn default() -> Self {
        Self { samples: 100_000, threads: thread::available_parallelism().map_or(1, |cores| cores.get()) }
    }
}

/// Compares what was emitted, on the CPU or the device, with a reference surface, chunk by chunk.
///
/// All of the mesh must be emitted: parts that are clipped or culled count as distance from the reference surface.
pub(crate) struct AccuracyMeasurement<'a> {
    reference_shape: &'a ReferenceShape,
    options: AccuracyOptions,
    screen: Option<Screen>,
    /// What collects the worst places, still without any.
    no_peaks: Peaks,
    /// Points of the reference surface: first those that are spread by area, then those of its vertices and edges.
    points: Vec<DVec3>,
    spread: usize,
    /// The spacing of points that are spread by area, in object units: the side of the square that each stands for.
    spacing: f64,
    /// How finely `points` sample the reference surface.
    sampling: Sampling,
    /// What was emitted so far, while it is no more than [`MOST_KEPT`] triangles.
    emitted: Emitted,
    most_kept: usize,
    /// The emitted point that is nearest to each of `points`, in the chunks that aren't kept. Empty if all are kept.
    nearest: Vec<Option<WorstPoint>>,
    sums: Sums,
}

/// How finely one direction was sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sampling {
    /// The number of points whose distance was measured, before the search around the worst of them.
    pub samples: u64,
    /// Their largest spacing, in object units: that of neighbours on an edge, or the side of the square that a point inside a
    /// triangle stands for.
    pub spacing: f64,
}

impl Sampling {
    fn with(self, other: Self) -> Self {
        Self { samples: self.samples + other.samples, spacing: self.spacing.max(other.spacing) }
    }
}

/// Distances in one direction, in object units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distances {
    pub largest: f64,
    /// Root mean square over the area.
    pub rms: f64,
}

/// Angles between normals, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Angles {
    pub largest: f64,
    /// Root mean square over the area of what was emitted.
    pub rms: f64,
}

/// The place where a distance or angle is largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPoint {
    /// The largest value, in object units, px or degrees.
    pub value: f64,
    /// The patch that emitted the point.
    pub patch: u32,
    /// The emitted point, in object units.
    pub emitted: DVec3,
    /// The point of the reference surface, in object units.
    pub reference_shape: DVec3,
}

impl WorstPoint {
    /// The place with its distance on screen, in px; `None` if it isn't in view.
    fn in_px(self, screen: &Screen) -> Option<Self> {
        screen.distance_px(self.emitted, self.reference_shape).map(|value| Self { value, ..self })
    }
}

/// The results of the comparison with a reference surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The diagonal of the reference surface's bounding box, in object units. Distances are often given as parts of it.
    pub diagonal: f64,
    /// From what was emitted to the reference surface.
    pub to_reference: Distances,
    pub to_reference_sampling: Sampling,
    pub worst_to_reference: WorstPoint,
    /// From the reference surface to what was emitted.
    pub from_reference: Distances,
    pub from_reference_sampling: Sampling,
    pub worst_from_reference: WorstPoint,
    /// The largest distance on screen between an emitted point and the nearest point of the reference surface; `None` if no
    /// point is in view, or there is no view.
    pub worst_px: Option<WorstPoint>,
    /// Between shading normals and the normals of the reference surface at the nearest points.
    pub normals: Angles,
    pub worst_normal: WorstPoint,
    /// The number of vertices with infinite or NaN coordinates. Their triangles are left out.
    pub not_finite: u64,
}

impl Accuracy {
    /// Combines both directions: the larger of the largest distances, and the root of the mean of both mean squares.
    pub fn both_ways(&self) -> Distances {
        let [a, b] = [self.to_reference, self.from_reference];
        Distances { largest: a.largest.max(b.largest), rms: a.rms.hypot(b.rms) / 2.0_f64.sqrt() }
    }

    /// Distances as parts of [`Self::diagonal`].
    pub fn relative(&self, distances: Distances) -> Distances {
        let part = |x: f64| if self.diagonal > 0.0 { x / self.diagonal } else { 0.0 };
        Distances { largest: part(distances.largest), rms: part(distances.rms) }
    }
}

/// The number of blocks that threads take one after another, and the most items in one. Sums are made block by block, so that
/// they don't depend on the number of threads.
const BLOCKS: usize = 256;
const LARGEST_BLOCK: usize = 1024;
/// The most triangles that are kept until all are emitted: as many as a chunk has under the largest limit of output memory.
/// They take about 100 bytes each.
const MOST_KEPT: usize = 1 << 23;
/// One place in so many samples is searched for a larger distance nearby, [`MOST_CLIMBS`] at most.
const SAMPLES_A_CLIMB: usize = 3000;
const MOST_CLIMBS: usize = 32;
/// The number of regions along the reference surface's diagonal, each of which counts with its worst place.
const REGIONS: f64 = 32.0;

impl<'a> AccuracyMeasurement<'a> {
    /// Starts a measurement. With a view, distances are also measured in px.
    pub(crate) fn new(reference_shape: &'a ReferenceShape, view: Option<&LodView>, options: AccuracyOptions) -> Self {
        let spread = reference_shape.samples(options.samples).into_iter().map(|sample| sample.point);
        let EdgePoints { points: of_edges, spacing: of_neighbours } = reference_shape.edge_points(options.samples);
        let points: Vec<DVec3> = spread.chain(of_edges).collect();
        let spacing = reference_shape.spacing(options.samples);
        let most = (options.samples / SAMPLES_A_CLIMB).clamp(1, MOST_CLIMBS);
        let no_peaks = Peaks::new(most, reference_shape.diagonal() / REGIONS);
        Self {
            reference_shape,
            options,
            screen: view.map(Screen::new),
            spread: options.samples,
            spacing,
            sampling: Sampling { samples: points.len() as u64, spacing: spacing.max(of_neighbours) },
            points,
            emitted: Emitted::default(),
            most_kept: MOST_KEPT,
            nearest: Vec::new(),
            sums: Sums::new(&no_peaks),
            no_peaks,
        }
    }

    /// The worst place on the way uphill from every one of `peaks`, or the worst of these if triangles weren't kept. `at` is the
    /// point of a place that is moved.
    fn summit(
        &self,
        peaks: &Peaks,
        at: impl Fn(&WorstPoint) -> DVec3 + Sync,
        measure: impl Fn(DVec3, f64) -> Option<WorstPoint> + Sync,
    ) -> Option<WorstPoint> {
        if !self.nearest.is_empty() {
            return peaks.places().next();
        }
        let starts: Vec<WorstPoint> = peaks.places().collect();
        let climbed = blocks(starts.len(), self.options.threads, |range| {
            starts[range].iter().map(|start| climb(*start, self.spacing, &at, &measure)).collect::<Vec<_>>()
        });
        climbed.into_iter().flatten().reduce(worse)
    }

    /// The worst place from what was emitted to the reference surface, among those on the way uphill from `peaks`. `value` is the
    /// value of a place with a distance.
    fn worst_to_reference(
        &self,
        peaks: &Peaks,
        value: impl Fn(WorstPoint) -> Option<WorstPoint> + Sync,
    ) -> Option<WorstPoint> {
        let measure = |p: DVec3, _: f64| {
            let place = self.emitted.closest(p, f64::INFINITY)?;
            let (reference_shape, distance) = self.reference_shape.closest_point(place.point);
            value(WorstPoint { value: distance, patch: place.patch, emitted: place.point, reference_shape })
        };
        self.summit(peaks, |place| place.emitted, measure)
    }

    /// The worst place from the reference surface to what was emitted, among those on the way uphill from `peaks`.
    fn worst_from_reference(&self, peaks: &Peaks) -> Option<WorstPoint> {
        let measure = |p: DVec3, enough: f64| {
            let (reference_shape, _) = self.reference_shape.closest_point(p);
            self.emitted
                .closest_or_within(reference_shape, enough, &mut Vec::new())
                .map(|found| found.from(reference_shape))
        };
        self.summit(peaks, |place| place.reference_shape, measure)
    }

    /// The results; `None` if nothing with an area was emitted.
    pub(crate) fn finish(mut self) -> Option<Accuracy> {
        if !self.nearest.is_empty() {
            self.drop_kept();
        }
        let (squares_from_reference, peaks) = self.measure_from_reference();
        let worst_from_reference = self.worst_from_reference(&peaks)?;
        let worst_to_reference = self.worst_to_reference(&self.sums.peaks, Some)?;
        let in_px = |place: WorstPoint| place.in_px(self.screen.as_ref()?);
        let worst_px = self.worst_to_reference(&self.sums.peaks_px, in_px);
        let Sums { area, squares, angles, sampling, worst_normal, not_finite, .. } = self.sums;
        if area <= 0.0 {
            return None;
        }
        Some(Accuracy {
            diagonal: self.reference_shape.diagonal(),
            to_reference: Distances { largest: worst_to_reference.value, rms: (squares / area).sqrt() },
            to_reference_sampling: sampling,
            worst_to_reference,
            from_reference: Distances {
                largest: worst_from_reference.value,
                rms: (squares_from_reference / self.spread as f64).sqrt(),
            },
            from_reference_sampling: self.sampling,
            worst_from_reference,
            worst_px,
            normals: Angles { largest: worst_normal?.value, rms: (angles / area).sqrt() },
            worst_normal: worst_normal?,
            not_finite,
        })
    }
}

impl Visitor for AccuracyMeasurement<'_> {
    fn take(&mut self, chunk: &EmittedChunk) {
        let EmittedChunk { vertices, triangles, .. } = *chunk;
        let is_finite = |vertex: &Vertex| Vec3::from(vertex.position).is_finite();
        self.sums.not_finite += vertices.iter().filter(|vertex| !is_finite(vertex)).count() as u64;
        let whole = |triangle: &&[u32; 3]| triangle.iter().all(|index| is_finite(&vertices[*index as usize]));
        let triangles: Vec<[u32; 3]> = triangles.iter().filter(whole).copied().collect();
        self.take_triangles(vertices, &triangles);
        self.emitted.add(vertices, &triangles);
        if self.emitted.triangles() > self.most_kept {
            self.drop_kept();
        }
    }
}

/// The point with the larger value, or `a` if both are equal.
pub(super) fn worse(a: WorstPoint, b: WorstPoint) -> WorstPoint {
    if b.value > a.value { b } else { a }
}

/// Cuts `count` items into blocks, runs `work` on each, and returns the results in order.
pub(super) fn blocks<T: Send>(count: usize, threads: usize, work: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    let block_size = (count / BLOCKS).clamp(1, LARGEST_BLOCK);
    let next = AtomicUsize::new(0);
    let run = || {
        let mut done = Vec::new();
        loop {
            let block = next.fetch_add(1, Ordering::Relaxed);
            let start = block * block_size;
            if start >= count {
                return done;
            }
            done.push((block, work(start..count.min(start + block_size))));
        }
    };
    let mut done: Vec<(usize, T)> = thread::scope(|scope| {
        let threads: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(run)).collect();
        let join = |thread: thread::ScopedJoinHandle<_>| {
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        threads.into_iter().flat_map(join).collect()
    });
    done.sort_unstable_by_key(|(block, _)| *block);
    done.into_iter().map(|(_, made)| made).collect()
}

#[cfg(test)]
mod tests;
