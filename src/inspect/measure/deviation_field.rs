//! Deviation over every triangle: the distances from what was emitted to a reference surface, which the overlay shows.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;

use super::accuracy::{Comparison, Emitted, Largest, Narrow, blocks};
use super::screen_error::{WorstPoint, worse};
use super::visitor::{EmittedChunk, Visitor};
use crate::reference_shape::ReferenceShape;
use geometry::mesh::{Mesh, Topology};
use geometry::near::Interval;
use geometry::progress::{Cancelled, Progress};
use geometry::tessellate::{Inputs, LimitSurface, Vertex};

/// The surface that deviation is measured from.
#[derive(Clone)]
pub enum DeviationTarget {
    /// A reference surface.
    ReferenceShape(Arc<ReferenceShape>),
    /// The limit surface under these inputs.
    Limit(Box<Inputs>),
}

/// The numbers of segments that triangles' edges are cut into, finest first. With multiples of 3 there is a sample in the
/// middle, where a flat triangle is mostly farthest from its surface. 0 means that sample alone.
const STEPS: [u32; 5] = [24, 12, 6, 3, 0];
/// The most samples that are taken, as long as triangles can have fewer each.
const SAMPLES: u64 = 1_000_000;
/// The most triangles that are measured: any adapter can bind a number for each.
pub const MOST_TRIANGLES: u64 = 1 << 24;

/// Distances in object units. Samples of a triangle lie on a grid that cuts its edges into equal segments: row i has the
/// weight i / steps of corner 1, and in it sample j the weight j / steps of corner 2.
#[derive(Clone, Debug)]
pub struct DeviationField {
    pub steps: u32,
    /// The samples of each chunk, triangle after triangle. They are NaN for a triangle with a corner that isn't finite.
    pub chunks: Vec<Vec<f32>>,
    /// The number of triangles beyond [`MOST_TRIANGLES`], which weren't measured.
    pub left_out: u64,
    worst: Option<WorstPoint>,
    /// A number that no distance exceeds for certain, in object units; infinite if none is known.
    at_most: f64,
    area: f64,
    /// The sum of squared distances, each times its area.
    squares: f64,
}

/// The number of samples in a triangle.
pub(super) fn samples_of(steps: u32) -> u32 {
    (steps + 1) * (steps + 2) / 2
}

/// Measures a [`DeviationField`].
pub struct DeviationMeasurement<'a> {
    target: &'a DeviationTarget,
    /// The target's limit surface on the mesh.
    limit: Option<Box<LimitSurface<'a>>>,
    /// Shows how far the measurement is, and can cancel it.
    progress: &'a Progress,
    field: DeviationField,
    /// What was measured, if its largest distance is to be known for certain.
    emitted: Emitted,
    /// Triangles in all chunks together.
    triangles: u64,
    /// How many more triangles may be measured.
    room: u64,
    cancelled: Option<Cancelled>,
}

impl<'a> DeviationMeasurement<'a> {
    /// Starts to measure a tessellation of this mesh with this number of triangles.
    pub fn new(
        target: &'a DeviationTarget,
        mesh: &'a Mesh,
        topology: &'a Topology,
        triangles: u64,
        progress: &'a Progress,
    ) -> Self {
        let limit = match target {
            DeviationTarget::ReferenceShape(_) => None,
            DeviationTarget::Limit(inputs) => Some(Box::new(LimitSurface::new(mesh, topology, inputs))),
        };
        let (field, emitted) = (DeviationField::unknown(triangles), Emitted::default());
        Self { target, limit, progress, field, emitted, triangles, room: MOST_TRIANGLES, cancelled: None }
    }

    /// The field, once all chunks are taken.
    ///
    /// # Errors
    /// The progress was cancelled before all was measured.
    pub fn finish(mut self) -> Result<DeviationField, Cancelled> {
        if let Some(cancelled) = self.cancelled {
            return Err(cancelled);
        }
        if let DeviationTarget::ReferenceShape(reference_shape) = self.target {
            let (emitted, farthest) = (&self.emitted, self.field.worst);
            let comparison = Comparison { reference_shape, emitted, narrow: Narrow::QUICK, farthest };
            if let Some(Largest { distance, place }) = comparison.to_reference(self.progress)? {
                (self.field.worst, self.field.at_most) = (Some(place), distance.at_most);
            }
        }
        Ok(self.field)
    }

    fn measure(&mut self, chunk: &EmittedChunk) -> Result<(), Cancelled> {
        let taken = chunk.triangles.len().min(self.room as usize);
        self.room -= taken as u64;
        self.field.left_out += (chunk.triangles.len() - taken) as u64;
        let (steps, total) = (self.field.steps, self.triangles.clamp(1, MOST_TRIANGLES));
        let finished = AtomicU64::new(MOST_TRIANGLES - self.room - taken as u64);
        let (this, progress) = (&*self, self.progress);
        let done = blocks(taken, |range| {
            let (mut sums, count) = (Sums::default(), range.len() as u64);
            for triangle in &chunk.triangles[range] {
                progress.check()?;
                sums.take(this, triangle.map(|index| &chunk.vertices[index as usize]), steps);
            }
            progress.set((finished.fetch_add(count, Ordering::Relaxed) + count) as f32 / total as f32);
            Ok(sums)
        });
        let mut samples = Vec::with_capacity(taken * samples_of(steps) as usize);
        let field = &mut self.field;
        for sums in done {
            let sums = sums?;
            samples.extend(sums.samples);
            field.area += sums.area;
            field.squares += sums.squares;
            field.worst = field.worst.into_iter().chain(sums.worst).reduce(worse);
        }
        field.chunks.push(samples);
        if matches!(self.target, DeviationTarget::ReferenceShape(_)) {
            let is_finite = |index: &u32| chunk.vertices[*index as usize].position.iter().all(|x| x.is_finite());
            let finite = chunk.triangles[..taken].iter().filter(|triangle| triangle.iter().all(is_finite));
            self.emitted.add(chunk.vertices, &finite.copied().collect::<Vec<_>>());
        }
        Ok(())
    }
}

impl Visitor for DeviationMeasurement<'_> {
    /// Does nothing after it was cancelled.
    fn take(&mut self, chunk: &EmittedChunk) {
        if self.cancelled.is_none() {
            self.cancelled = self.measure(chunk).err();
        }
    }
}

impl DeviationField {
    /// A field without samples yet, for this number of triangles.
    fn unknown(triangles: u64) -> Self {
        let fits = |steps: &u32| triangles.saturating_mul(samples_of(*steps).into()) <= SAMPLES;
        let steps = STEPS.into_iter().find(fits).unwrap_or(0);
        let (chunks, at_most) = (Vec::new(), f64::INFINITY);
        Self { steps, chunks, left_out: 0, worst: None, at_most, area: 0.0, squares: 0.0 }
    }

    /// A field without triangles.
    pub fn empty() -> Self {
        Self::unknown(0)
    }

    /// The place with the largest distance; `None` if nothing was emitted.
    pub fn worst(&self) -> Option<WorstPoint> {
        self.worst
    }

    /// The largest distance of what was measured. Its upper end is infinite where distances go to a limit surface: these are
    /// sampled.
    pub fn largest(&self) -> Interval {
        let at_least = self.worst.map_or(0.0, |worst| worst.value);
        let at_most = if self.worst.is_some() { self.at_most } else { 0.0 };
        Interval { at_least, at_most: at_most.max(at_least) }
    }

    /// The root of the mean square over the area.
    pub fn rms(&self) -> f64 {
        if self.area > 0.0 { (self.squares / self.area).sqrt() } else { 0.0 }
    }
}

#[derive(Default)]
struct Sums {
    samples: Vec<f32>,
    area: f64,
    squares: f64,
    worst: Option<WorstPoint>,
}

impl Sums {
    fn take(&mut self, of: &DeviationMeasurement, corners: [&Vertex; 3], steps: u32) {
        let positions = corners.map(|vertex| DVec3::from(vertex.position.map(f64::from)));
        if !positions.iter().all(|position| position.is_finite()) {
            self.samples.extend(std::iter::repeat_n(f32::NAN, samples_of(steps) as usize));
            return;
        }
        let [a, b, c] = positions;
        let area = (b - a).cross(c - a).length() / 2.0;
        let limit = of.limit.as_ref().map(|limit| (limit, limit.net(corners[0].patch())));
        let domains = corners.map(|vertex| vertex.exact_domain());
        for (weights, share) in grid(steps) {
            let emitted = (0..3).map(|k| positions[k] * weights[k]).sum();
            let reference_shape = match (of.target, &limit) {
                (DeviationTarget::Limit(_), Some((limit, net))) => {
                    let [u, v] = [0, 1].map(|i| (0..3).map(|k| weights[k] * domains[k][i]).sum());
                    limit.position(corners[0].patch(), net, u, v)
                }
                (DeviationTarget::ReferenceShape(reference_shape), _) => reference_shape.closest(emitted).point,
                (DeviationTarget::Limit(_), None) => emitted,
            };
            let value = emitted.distance(reference_shape);
            self.samples.push(value as f32);
            self.squares += area * share * value * value;
            let place = WorstPoint { value, patch: corners[0].patch(), emitted, reference_shape };
            self.worst = self.worst.into_iter().chain([place]).reduce(worse);
        }
        self.area += area;
    }
}

/// The weights of a triangle's samples in their order, and the share of its area that each stands for, with linear
/// interpolation between samples.
fn grid(steps: u32) -> impl Iterator<Item = ([f64; 3], f64)> {
    let n = f64::from(steps);
    let at = move |i: u32, j: u32| {
        if steps == 0 {
            return ([1.0 / 3.0; 3], 1.0);
        }
        let k = steps - i - j;
        // The number of small triangles that meet here. There are n^2, and each gives a third of its area to each corner.
        let meet = match [i, j, k].iter().filter(|&&x| x == 0).count() {
            0 => 6.0,
            1 => 3.0,
            _ => 1.0,
        };
        ([k, i, j].map(|x| f64::from(x) / n), meet / (3.0 * n * n))
    };
    (0..=steps).flat_map(move |i| (0..=steps - i).map(move |j| at(i, j)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::Shape;

    /// A triangle of one patch.
    fn triangle(corners: [[f32; 3]; 3]) -> Vec<Vertex> {
        corners.map(|position| Vertex { position, ..bytemuck::Zeroable::zeroed() }).to_vec()
    }

    fn measured(
        corners: [[f32; 3]; 3],
        reference_shape: &Arc<ReferenceShape>,
        progress: &Progress,
    ) -> Result<DeviationField, Cancelled> {
        let (target, mesh, topology) =
            (DeviationTarget::ReferenceShape(reference_shape.clone()), Mesh::default(), Topology::default());
        let mut measurement = DeviationMeasurement::new(&target, &mesh, &topology, 1, progress);
        measurement.take(&EmittedChunk::whole(&triangle(corners), &[[0, 1, 2]]));
        measurement.finish()
    }

    fn field(corners: [[f32; 3]; 3], reference_shape: &Arc<ReferenceShape>) -> DeviationField {
        measured(corners, reference_shape, &Progress::new()).expect("nobody cancels")
    }

    #[test]
    fn shares_of_a_grid_add_up_to_1_and_it_has_a_sample_in_the_middle() {
        for steps in STEPS {
            let all: Vec<_> = grid(steps).collect();
            assert_eq!(all.len(), samples_of(steps) as usize);
            let whole: f64 = all.iter().map(|(_, share)| share).sum();
            assert!((whole - 1.0).abs() < 1e-12, "{steps}: {whole}");
            let middle = |weights: &[f64; 3]| weights.iter().all(|weight| (weight - 1.0 / 3.0).abs() < 1e-15);
            assert!(all.iter().any(|(weights, _)| middle(weights)), "{steps}");
        }
    }

    #[test]
    fn a_face_in_a_sphere_is_farthest_from_it_in_its_middle() {
        let sphere = Arc::new(ReferenceShape::from_shape(Shape::Icosphere).expect("a sphere"));
        let field = field([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &sphere);
        let [samples] = &field.chunks[..] else { panic!("one chunk") };
        assert_eq!(field.steps, 24);
        // Corner 0 is first, corner 1 last, and corner 2 at the end of the first row.
        for corner in [0, 24, samples.len() - 1] {
            assert!(samples[corner] < 1e-7, "{corner}: {}", samples[corner]);
        }
        let worst = field.worst().expect("a triangle");
        let expected = 1.0 - 1.0 / 3.0_f64.sqrt();
        assert!((worst.value - expected).abs() < 1e-9 && worst.emitted.distance(DVec3::splat(1.0 / 3.0)) < 1e-7);
        assert!((worst.reference_shape.length() - 1.0).abs() < 1e-9);
        assert!(field.rms() > 0.0 && field.rms() < expected);
        let largest = samples.iter().copied().fold(0.0, f32::max);
        assert_eq!(largest, worst.value as f32);
    }

    #[test]
    fn a_triangle_with_nan_has_no_samples_and_does_not_count() {
        let sphere = Arc::new(ReferenceShape::from_shape(Shape::Icosphere).expect("a sphere"));
        let field = field([[f32::NAN, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &sphere);
        assert!(field.chunks[0].iter().all(|sample| sample.is_nan()));
        assert_eq!((field.worst(), field.rms()), (None, 0.0));
    }

    #[test]
    fn many_triangles_have_fewer_samples_each_and_a_cancelled_field_stops() {
        assert_eq!([1, 5_000, 20_000, 60_000, 1_000_000].map(|count| DeviationField::unknown(count).steps), STEPS);
        let sphere = Arc::new(ReferenceShape::from_shape(Shape::Icosphere).expect("a sphere"));
        let progress = Progress::new();
        progress.cancel();
        let field = measured([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &sphere, &progress);
        assert!(matches!(field, Err(Cancelled)));
    }

    #[test]
    fn progress_goes_on_from_chunk_to_chunk() {
        let (reference_shape, progress) =
            (ReferenceShape::from_shape(Shape::Icosphere).expect("a sphere"), Progress::new());
        let (target, mesh, topology) =
            (DeviationTarget::ReferenceShape(Arc::new(reference_shape)), Mesh::default(), Topology::default());
        let mut measurement = DeviationMeasurement::new(&target, &mesh, &topology, 4, &progress);
        let vertices = triangle([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let fractions = [0, 1, 2, 3].map(|_| {
            measurement.take(&EmittedChunk::whole(&vertices, &[[0, 1, 2]]));
            progress.fraction()
        });
        assert_eq!(fractions, [0.25, 0.5, 0.75, 1.0]);
    }
}
