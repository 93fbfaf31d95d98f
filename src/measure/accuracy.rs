//! Accuracy: the distances between what was emitted and a reference surface, in both directions, and the angles between their
//! normals.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use glam::{DVec3, Vec3};

use super::screen_error::Screen;
use super::visitor::{EmittedChunk, Visitor};
use crate::tessellate::{LodView, Vertex, unpack_normal};
use crate::truth::{Sample, Triangles, Truth};

/// How finely accuracy is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccuracyOptions {
    /// The number of samples on the reference surface. What was emitted gets about as many, but at least four per triangle.
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
    truth: &'a Truth,
    options: AccuracyOptions,
    screen: Option<Screen>,
    /// Points of the reference surface, each with the nearest emitted point so far.
    samples: Vec<(Sample, Option<WorstPoint>)>,
    sums: Sums,
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
    pub truth: DVec3,
}

/// The results of the comparison with a reference surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The diagonal of the reference surface's bounding box, in object units. Distances are often given as parts of it.
    pub diagonal: f64,
    /// From what was emitted to the reference surface.
    pub to_truth: Distances,
    pub worst_to_truth: WorstPoint,
    /// From the reference surface to what was emitted.
    pub from_truth: Distances,
    pub worst_from_truth: WorstPoint,
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
        let [a, b] = [self.to_truth, self.from_truth];
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
/// The most segments that a triangle's edges are cut into for sampling.
const MAX_STEPS: u32 = 200;

impl<'a> AccuracyMeasurement<'a> {
    /// Starts a measurement. With a view, distances are also measured in px.
    pub(crate) fn new(truth: &'a Truth, view: Option<&LodView>, options: AccuracyOptions) -> Self {
        let samples = truth.samples(options.samples).into_iter().map(|sample| (sample, None)).collect();
        Self { truth, options, screen: view.map(Screen::new), samples, sums: Sums::default() }
    }

    /// Measures from the emitted triangles to the reference surface.
    fn take_triangles(&mut self, vertices: &[Vertex], triangles: &[[u32; 3]]) {
        let this = &*self;
        let mut used = vec![false; vertices.len()];
        triangles.iter().flatten().for_each(|index| used[*index as usize] = true);
        let corners = blocks(vertices.len(), this.options.threads, |range| {
            let mut sums = Sums::default();
            for vertex in range.filter(|vertex| used[*vertex]).map(|vertex| &vertices[vertex]) {
                let point = Point { position: position(vertex), normal: normal(vertex), patch: vertex.patch() };
                sums.add(&point, 0.0, this.truth, this.screen.as_ref());
            }
            sums
        });
        let insides = blocks(triangles.len(), this.options.threads, |range| {
            let mut sums = Sums::default();
            let sampled = triangles[range].iter().map(|triangle| triangle.map(|index| &vertices[index as usize]));
            sampled.for_each(|corners| this.sample(corners, &mut sums));
            sums
        });
        self.sums = corners.into_iter().chain(insides).fold(std::mem::take(&mut self.sums), Sums::with);
    }

    /// Cuts a triangle into equal ones, n along each edge, and takes the middle of each. n isn't a multiple of 3, since then no
    /// sample would lie in the middle of the triangle itself.
    fn sample(&self, corners: [&Vertex; 3], sums: &mut Sums) {
        let positions = corners.map(position);
        let [a, b, c] = positions;
        let area = (b - a).cross(c - a).length() / 2.0;
        if area <= 0.0 {
            return;
        }
        let asked = (area * self.options.samples as f64 / self.truth.area()).sqrt().ceil();
        let n = (asked as u32).clamp(2, MAX_STEPS);
        let n = if n.is_multiple_of(3) { n + 1 } else { n };
        let (normals, patch) = (corners.map(normal), corners[0].patch());
        let mut take = |thirds: [u32; 2]| {
            let [u, v] = thirds.map(|x| f64::from(x) / f64::from(3 * n));
            let weights = [1.0 - u - v, u, v];
            let mixed = |of: [DVec3; 3]| of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2];
            let normal = mixed(normals).try_normalize().unwrap_or(normals[0]);
            let point = Point { position: mixed(positions), normal, patch };
            sums.add(&point, area / f64::from(n * n), self.truth, self.screen.as_ref());
        };
        for i in 0..n {
            for j in 0..n - i {
                take([3 * i + 1, 3 * j + 1]);
                if i + j + 1 < n {
                    take([3 * i + 2, 3 * j + 2]);
                }
            }
        }
    }

    /// The results; `None` if nothing with an area was emitted.
    pub(crate) fn finish(self) -> Option<Accuracy> {
        let Sums { area, squares, angles, worst, worst_px, worst_normal, not_finite } = self.sums;
        let (worst_to_truth, worst_normal) = (worst?, worst_normal?);
        if area <= 0.0 {
            return None;
        }
        let missed: Vec<WorstPoint> = self.samples.iter().filter_map(|(_, place)| *place).collect();
        let worst_from_truth = missed.iter().copied().reduce(worse)?;
        let mean = missed.iter().map(|place| place.value * place.value).sum::<f64>() / missed.len() as f64;
        Some(Accuracy {
            diagonal: self.truth.diagonal(),
            to_truth: Distances { largest: worst_to_truth.value, rms: (squares / area).sqrt() },
            worst_to_truth,
            from_truth: Distances { largest: worst_from_truth.value, rms: mean.sqrt() },
            worst_from_truth,
            worst_px,
            normals: Angles { largest: worst_normal.value, rms: (angles / area).sqrt() },
            worst_normal,
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
        let corners = |triangle: &[u32; 3]| triangle.map(|index| Vec3::from(vertices[index as usize].position));
        let Some(tree) = Triangles::new(triangles.iter().map(corners)) else { return };
        self.take_triangles(vertices, &triangles);
        let samples = std::mem::take(&mut self.samples);
        self.samples = blocks(samples.len(), self.options.threads, |range| {
            let nearer = |(sample, known): &(Sample, Option<WorstPoint>)| {
                let within = known.map_or(f64::INFINITY, |place| place.value);
                let found = tree.closest(sample.point, within).map(|closest| WorstPoint {
                    value: closest.distance,
                    patch: vertices[triangles[closest.triangle as usize][0] as usize].patch(),
                    emitted: closest.point,
                    truth: sample.point,
                });
                (*sample, found.or(*known))
            };
            samples[range].iter().map(nearer).collect::<Vec<_>>()
        })
        .concat();
    }
}

/// An emitted point, and its shading normal.
struct Point {
    position: DVec3,
    normal: DVec3,
    patch: u32,
}

fn position(vertex: &Vertex) -> DVec3 {
    Vec3::from(vertex.position).as_dvec3()
}

fn normal(vertex: &Vertex) -> DVec3 {
    unpack_normal(vertex.normal).as_dvec3()
}

/// The sums and worst points so far, from what was emitted to the reference surface.
#[derive(Clone, Copy, Default)]
struct Sums {
    area: f64,
    /// The squares of distances, and of angles in degrees, each times the area.
    squares: f64,
    angles: f64,
    worst: Option<WorstPoint>,
    worst_px: Option<WorstPoint>,
    worst_normal: Option<WorstPoint>,
    not_finite: u64,
}

impl Sums {
    /// Adds a point that stands for some area.
    fn add(&mut self, point: &Point, area: f64, truth: &Truth, screen: Option<&Screen>) {
        let nearest = truth.closest_facing(point.position, point.normal);
        // Unlike the arc cosine, this is exact for angles near 0.
        let angle = point.normal.cross(nearest.normal).length().atan2(point.normal.dot(nearest.normal)).to_degrees();
        let place = |value| WorstPoint { value, patch: point.patch, emitted: point.position, truth: nearest.point };
        let px = screen.and_then(|screen| screen.distance_px(point.position, nearest.point));
        self.area += area;
        self.squares += area * nearest.distance * nearest.distance;
        self.angles += area * angle * angle;
        self.worst = self.worst.into_iter().chain([place(nearest.distance)]).reduce(worse);
        self.worst_normal = self.worst_normal.into_iter().chain([place(angle)]).reduce(worse);
        self.worst_px = self.worst_px.into_iter().chain(px.map(place)).reduce(worse);
    }

    fn with(self, other: Self) -> Self {
        let worst = |a: Option<WorstPoint>, b: Option<WorstPoint>| a.into_iter().chain(b).reduce(worse);
        Self {
            area: self.area + other.area,
            squares: self.squares + other.squares,
            angles: self.angles + other.angles,
            worst: worst(self.worst, other.worst),
            worst_px: worst(self.worst_px, other.worst_px),
            worst_normal: worst(self.worst_normal, other.worst_normal),
            not_finite: self.not_finite + other.not_finite,
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
