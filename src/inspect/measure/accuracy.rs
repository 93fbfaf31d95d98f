//! Accuracy: the distances between what was emitted and a reference surface, in both directions, and the angles between their
//! normals.

mod emitted;
mod largest;
mod mean_square;
mod to_reference;

use std::ops::Range;
use std::thread::available_parallelism;

use glam::Vec3;
use serde::Serialize;

use super::screen_error::{Screen, WorstPoint, worse};
use super::visitor::{EmittedChunk, Visitor};
use crate::reference_shape::ReferenceShape;
use geometry::cores::{in_blocks, on_threads};
use geometry::defaults::with_defaults;
use geometry::near::Interval;
use geometry::progress::{Cancelled, Progress};
use geometry::tessellate::{LodView, Vertex};
use to_reference::Sums;

pub(crate) use emitted::Emitted;
pub use largest::Narrow;
pub(crate) use largest::{Comparison, Largest};
pub(crate) use mean_square::MeanSquare;
pub use mean_square::Rms;

with_defaults! {
    /// How finely accuracy is measured.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct AccuracyOptions {
        /// The number of samples that are spread over the reference surface by area, for means. What was emitted gets about as
        /// many, but at least four per triangle.
        pub samples: usize = 100_000,
        /// When the intervals of the largest distances are narrow enough.
        pub narrow: Narrow = Narrow::default(),
        /// The number of threads. The result doesn't depend on it.
        pub threads: usize = available_parallelism().map_or(1, |cores| cores.get()),
    }
}

impl AccuracyOptions {
    fn on_threads<R: Send>(&self, mut work: impl FnMut() -> R + Send) -> R {
        // Where the system starts no more threads, those that there are do the work.
        on_threads(self.threads, &mut work).unwrap_or_else(|_| work())
    }
}

/// Compares what was emitted, on the CPU or the device, with a reference surface, chunk by chunk.
///
/// All of the mesh must be emitted: parts that are clipped or culled count as distance from the reference surface.
pub(crate) struct AccuracyMeasurement<'a> {
    reference_shape: &'a ReferenceShape,
    options: AccuracyOptions,
    progress: &'a Progress,
    screen: Option<Screen>,
    emitted: Emitted,
    most_kept: usize,
    /// The largest distance from the triangles that weren't kept, and whether there were any.
    largest: Option<Largest>,
    sums: Sums,
    cancelled: Option<Cancelled>,
}

/// Distances in one direction, in object units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distances {
    /// The largest distance is in this interval for certain.
    pub largest: Interval,
    /// Root mean square over the area, from samples.
    pub rms: Rms,
}

/// Angles between normals, in degrees, from samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Angles {
    /// The largest one of the samples.
    #[serde(rename = "max")]
    pub largest: f64,
    /// Root mean square over the area of what was emitted.
    pub rms: Rms,
}

/// The results of the comparison with a reference surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The diagonal of the reference surface's bounding box, in object units. Distances are often given as parts of it.
    pub diagonal: f64,
    /// From what was emitted to the reference surface.
    pub to_reference: Distances,
    pub worst_to_reference: WorstPoint,
    /// From the reference surface to what was emitted, and the farthest place; `None` if more than [`MOST_KEPT`] triangles
    /// were emitted.
    pub from_reference: Option<(Distances, WorstPoint)>,
    /// The largest distance on screen between an emitted point and the nearest point of the reference surface, of all samples
    /// and the worst place; `None` if no such point is in view, or there is no view.
    pub worst_px: Option<WorstPoint>,
    /// Between shading normals and the normals of the reference surface at the nearest points.
    pub normals: Angles,
    pub worst_normal: WorstPoint,
    /// The number of samples for means and angles, in both directions.
    pub samples: u64,
    /// The number of vertices with infinite or NaN coordinates. Their triangles are left out.
    pub not_finite: u64,
}

impl Accuracy {
    /// Combines both directions, if both are known: the larger of the largest distances, and the root of the mean of both mean
    /// squares.
    pub fn both_ways(&self) -> Distances {
        let a = self.to_reference;
        let Some((b, _)) = self.from_reference else { return a };
        let value = a.rms.value.hypot(b.rms.value) / 2.0_f64.sqrt();
        // Errors of the squares, which are twice the values times the values' errors.
        let squares = (a.rms.value * a.rms.error).hypot(b.rms.value * b.rms.error);
        let error = if value > 0.0 { squares / (2.0 * value) } else { 0.0 };
        Distances { largest: a.largest.or(b.largest), rms: Rms { value, error } }
    }

    /// Distances as parts of [`Self::diagonal`].
    pub fn relative(&self, distances: Distances) -> Distances {
        let part = |x: f64| if self.diagonal > 0.0 { x / self.diagonal } else { 0.0 };
        let Distances { largest: Interval { at_least, at_most }, rms: Rms { value, error } } = distances;
        Distances {
            largest: Interval { at_least: part(at_least), at_most: part(at_most) },
            rms: Rms { value: part(value), error: part(error) },
        }
    }
}

/// The number of blocks that cores take one after another, and the most items in one. Sums are made block by block, so that they
/// don't depend on the number of cores.
const BLOCKS: usize = 256;
const LARGEST_BLOCK: usize = 1024;

/// The most triangles that are kept until all are emitted. They take about 130 bytes each.
pub const MOST_KEPT: usize = 1 << 24;

impl<'a> AccuracyMeasurement<'a> {
    /// Starts a measurement. With a view, distances are also measured in px.
    pub(crate) fn new(
        reference_shape: &'a ReferenceShape,
        view: Option<&LodView>,
        options: AccuracyOptions,
        progress: &'a Progress,
    ) -> Self {
        Self {
            reference_shape,
            options,
            progress,
            screen: view.map(Screen::new),
            emitted: Emitted::default(),
            most_kept: MOST_KEPT,
            largest: None,
            sums: Sums::default(),
            cancelled: None,
        }
    }

    /// How the triangles that are kept are compared. The farthest sample says how finely.
    fn comparison(&self) -> Comparison<'_> {
        let Self { reference_shape, emitted, options: AccuracyOptions { narrow, .. }, .. } = self;
        Comparison { reference_shape, emitted, narrow: *narrow, farthest: self.sums.farthest }
    }

    /// The largest distance from all triangles so far.
    fn largest_to_reference(&self) -> Result<Option<Largest>, Cancelled> {
        let found = self.comparison().to_reference(self.progress)?;
        Ok(self.largest.into_iter().chain(found).reduce(Largest::or))
    }

    /// The distances from the reference surface to the triangles that are kept, and the number of samples.
    fn to_emitted(&self) -> Result<Option<(Distances, WorstPoint, u64)>, Cancelled> {
        let Some(tree) = self.emitted.tree() else { return Ok(None) };
        let points = self.reference_shape.samples(self.options.samples);
        let sums = blocks(points.len(), |range| {
            self.progress.check()?;
            let (mut sums, mut hint) = (MeanSquare::default(), 0);
            for sample in &points[range] {
                let closest = tree.closest_near(sample.point, &mut hint);
                sums.add(closest.distance, 1.0);
            }
            Ok(sums)
        });
        let sums = sums.into_iter().try_fold(MeanSquare::default(), |sum, next| Ok(sum.with(next?)))?;
        let Some(Largest { distance, place }) = self.comparison().to_emitted(&tree, self.progress)? else {
            return Ok(None);
        };
        let rms = sums.rms().unwrap_or_default();
        Ok(Some((Distances { largest: distance, rms }, place, points.len() as u64)))
    }

    /// The results; `None` if nothing with an area was emitted.
    ///
    /// # Errors
    /// The progress was cancelled.
    pub(crate) fn finish(self) -> Result<Option<Accuracy>, Cancelled> {
        if let Some(cancelled) = self.cancelled {
            return Err(cancelled);
        }
        self.options.on_threads(|| self.results())
    }

    fn results(&self) -> Result<Option<Accuracy>, Cancelled> {
        let (Some(rms), Some(angles)) = (self.sums.squares.rms(), self.sums.angles.rms()) else { return Ok(None) };
        let (Some(Largest { distance, place }), Some(worst_normal)) =
            (self.largest_to_reference()?, self.sums.worst_normal)
        else {
            return Ok(None);
        };
        let from_reference = if self.largest.is_none() { self.to_emitted()? } else { None };
        let in_px = self.screen.as_ref().and_then(|screen| place.in_px(screen));
        Ok(Some(Accuracy {
            diagonal: self.reference_shape.diagonal(),
            to_reference: Distances { largest: distance, rms },
            worst_to_reference: place,
            from_reference: from_reference.map(|(distances, place, _)| (distances, place)),
            worst_px: self.sums.worst_px.into_iter().chain(in_px).reduce(worse),
            normals: Angles { largest: worst_normal.value, rms: angles },
            worst_normal,
            samples: self.sums.samples + from_reference.map_or(0, |(_, _, samples)| samples),
            not_finite: self.sums.not_finite,
        }))
    }

    fn take_chunk(&mut self, vertices: &[Vertex], triangles: &[[u32; 3]]) -> Result<(), Cancelled> {
        self.progress.check()?;
        self.take_triangles(vertices, triangles);
        self.emitted.add(vertices, triangles);
        if self.emitted.soup().triangles.len() > self.most_kept {
            self.largest = self.largest_to_reference()?;
            self.emitted = Emitted::default();
        }
        Ok(())
    }
}

impl Visitor for AccuracyMeasurement<'_> {
    /// Does nothing after it was cancelled.
    fn take(&mut self, chunk: &EmittedChunk) {
        if self.cancelled.is_some() {
            return;
        }
        let EmittedChunk { vertices, triangles, .. } = *chunk;
        let is_finite = |vertex: &Vertex| Vec3::from(vertex.position).is_finite();
        self.sums.not_finite += vertices.iter().filter(|vertex| !is_finite(vertex)).count() as u64;
        let whole = |triangle: &&[u32; 3]| triangle.iter().all(|index| is_finite(&vertices[*index as usize]));
        let triangles: Vec<[u32; 3]> = triangles.iter().filter(whole).copied().collect();
        let options = self.options;
        self.cancelled = options.on_threads(|| self.take_chunk(vertices, &triangles)).err();
    }
}

/// Cuts `count` items into blocks, runs `work` on each, and returns the results in order.
pub(super) fn blocks<T: Send>(count: usize, work: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    in_blocks(count, (count / BLOCKS).clamp(1, LARGEST_BLOCK), work)
}

#[cfg(test)]
mod tests;
