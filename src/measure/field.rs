//! The distance from what was emitted to what it should have been, all over every triangle: what the overlay shows.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use glam::DVec3;

use super::accuracy::{Place, blocks, worse};
use crate::mesh::{Mesh, Topology};
use crate::progress::{Cancelled, Progress};
use crate::tessellate::{FIXED_ONE, Inputs, Limit, Vertex};
use crate::truth::Truth;

/// What deviation is measured from.
#[derive(Clone)]
pub enum Yardstick {
    Truth(Arc<Truth>),
    /// The limit surface under these inputs.
    Limit(Box<Inputs>),
}

impl Yardstick {
    /// Calls `work` with what is measured against on this mesh.
    pub fn with<T>(&self, mesh: &Mesh, topology: &Topology, work: impl FnOnce(&Against) -> T) -> T {
        match self {
            Self::Truth(truth) => work(&Against::Truth(truth)),
            Self::Limit(inputs) => work(&Against::Limit(&Limit::new(mesh, topology, inputs))),
        }
    }
}

/// What is measured against.
pub enum Against<'a> {
    /// The nearest point of a truth.
    Truth(&'a Truth),
    /// The point of the limit surface at the same place of the patch.
    Limit(&'a Limit<'a>),
}

/// Into how many segments triangles' edges are cut, finest first. Multiples of 3 have a sample in the middle, where a flat
/// triangle is mostly farthest from what it stands for; 0 is that sample alone.
const STEPS: [u32; 5] = [24, 12, 6, 3, 0];
/// Samples that are taken at most, where fewer a triangle will do.
const SAMPLES: u64 = 1_000_000;
/// Triangles that are looked at: as many numbers as any adapter binds at once.
pub const MOST_TRIANGLES: u64 = 1 << 24;

/// Distances in object units. Samples of a triangle lie on a grid that cuts its edges into equal segments: row i has the
/// weight i / steps of corner 1, and in it sample j the weight j / steps of corner 2.
#[derive(Clone, Debug)]
pub struct Field {
    pub steps: u32,
    /// Those of each chunk, triangle after triangle. A triangle with a corner that is no number has no numbers.
    pub chunks: Vec<Vec<f32>>,
    /// Triangles that were too many.
    pub left_out: u64,
    worst: Option<Place>,
    area: f64,
    /// Of distances, times area.
    squares: f64,
    room: u64,
    /// Triangles in all.
    total: u64,
}

/// How many samples a triangle has.
pub fn samples_of(steps: u32) -> u32 {
    (steps + 1) * (steps + 2) / 2
}

impl Field {
    /// Nothing seen yet of so many triangles.
    pub fn new(triangles: u64) -> Self {
        let fits = |steps: &u32| triangles.saturating_mul(samples_of(*steps).into()) <= SAMPLES;
        let steps = STEPS.into_iter().find(fits).unwrap_or(0);
        let room = MOST_TRIANGLES;
        Self { steps, chunks: Vec::new(), left_out: 0, worst: None, area: 0.0, squares: 0.0, room, total: triangles }
    }

    /// Takes the next chunk: triangles are indices into `vertices`. Tells `wanted` how far all are.
    ///
    /// # Errors
    /// `wanted` was cancelled.
    pub fn take(
        &mut self,
        against: &Against,
        vertices: &[Vertex],
        triangles: &[[u32; 3]],
        wanted: &Progress,
    ) -> Result<(), Cancelled> {
        let taken = triangles.len().min(self.room as usize);
        self.room -= taken as u64;
        self.left_out += (triangles.len() - taken) as u64;
        let threads = thread::available_parallelism().map_or(1, |cores| cores.get());
        let (steps, total) = (self.steps, self.total.clamp(1, MOST_TRIANGLES));
        let finished = AtomicU64::new(MOST_TRIANGLES - self.room - taken as u64);
        let done = blocks(taken, threads, |range| {
            let (mut sums, count) = (Sums::default(), range.len() as u64);
            for triangle in &triangles[range] {
                wanted.check()?;
                sums.take(against, triangle.map(|index| &vertices[index as usize]), steps);
            }
            wanted.set((finished.fetch_add(count, Ordering::Relaxed) + count) as f32 / total as f32);
            Ok(sums)
        });
        let mut samples = Vec::with_capacity(taken * samples_of(steps) as usize);
        for sums in done {
            let sums = sums?;
            samples.extend(sums.samples);
            self.area += sums.area;
            self.squares += sums.squares;
            self.worst = self.worst.into_iter().chain(sums.worst).reduce(worse);
        }
        self.chunks.push(samples);
        Ok(())
    }

    /// Where the distance is largest; none if nothing was emitted.
    pub fn worst(&self) -> Option<Place> {
        self.worst
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
    worst: Option<Place>,
}

impl Sums {
    fn take(&mut self, against: &Against, corners: [&Vertex; 3], steps: u32) {
        let positions = corners.map(|vertex| DVec3::from(vertex.position.map(f64::from)));
        if !positions.iter().all(|position| position.is_finite()) {
            self.samples.extend(std::iter::repeat_n(f32::NAN, samples_of(steps) as usize));
            return;
        }
        let [a, b, c] = positions;
        let area = (b - a).cross(c - a).length() / 2.0;
        let net = match against {
            Against::Limit(limit) => Some(limit.net(corners[0].patch())),
            Against::Truth(_) => None,
        };
        let domains = corners.map(|vertex| vertex.domain().map(|x| f64::from(x) / f64::from(FIXED_ONE)));
        for (weights, share) in grid(steps) {
            let emitted = (0..3).map(|k| positions[k] * weights[k]).sum();
            let truth = match (against, &net) {
                (Against::Limit(limit), Some(net)) => {
                    let [u, v] = [0, 1].map(|i| (0..3).map(|k| weights[k] * domains[k][i]).sum());
                    limit.position(corners[0].patch(), net, u, v)
                }
                (Against::Truth(truth), _) => truth.closest(emitted).point,
                (Against::Limit(_), None) => emitted,
            };
            let value = emitted.distance(truth);
            self.samples.push(value as f32);
            self.squares += area * share * value * value;
            let place = Place { value, patch: corners[0].patch(), emitted, truth };
            self.worst = self.worst.into_iter().chain([place]).reduce(worse);
        }
        self.area += area;
    }
}

/// The weights of a triangle's samples in their order, and which share of its area each stands for if what is between
/// them is linear.
fn grid(steps: u32) -> impl Iterator<Item = ([f64; 3], f64)> {
    let n = f64::from(steps);
    let at = move |i: u32, j: u32| {
        if steps == 0 {
            return ([1.0 / 3.0; 3], 1.0);
        }
        let k = steps - i - j;
        // Small triangles that meet here, of n^2 that share their area among three.
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
    use crate::mesh::Shape;

    /// A triangle of one patch.
    fn triangle(corners: [[f32; 3]; 3]) -> Vec<Vertex> {
        corners.map(|position| Vertex { position, ..bytemuck::Zeroable::zeroed() }).to_vec()
    }

    fn field(corners: [[f32; 3]; 3], truth: &Truth) -> Field {
        let mut field = Field::new(1);
        let taken = field.take(&Against::Truth(truth), &triangle(corners), &[[0, 1, 2]], &Progress::new());
        taken.expect("nobody cancels");
        field
    }

    #[test]
    fn shares_of_a_grid_are_the_whole_and_its_middle_is_one_of_it() {
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
        let sphere = Truth::of_shape(Shape::Icosphere).expect("a sphere");
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
        assert!((worst.truth.length() - 1.0).abs() < 1e-9);
        assert!(field.rms() > 0.0 && field.rms() < expected);
        let largest = samples.iter().copied().fold(0.0, f32::max);
        assert_eq!(largest, worst.value as f32);
    }

    #[test]
    fn what_is_no_number_has_none_and_hides_nothing() {
        let sphere = Truth::of_shape(Shape::Icosphere).expect("a sphere");
        let field = field([[f32::NAN, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &sphere);
        assert!(field.chunks[0].iter().all(|sample| sample.is_nan()));
        assert_eq!((field.worst(), field.rms()), (None, 0.0));
    }

    #[test]
    fn many_triangles_have_fewer_samples_each_and_a_cancelled_field_stops() {
        assert_eq!([1, 5_000, 20_000, 60_000, 1_000_000].map(|count| Field::new(count).steps), STEPS);
        let sphere = Truth::of_shape(Shape::Icosphere).expect("a sphere");
        let wanted = Progress::new();
        wanted.cancel();
        let vertices = triangle([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let taken = Field::new(1).take(&Against::Truth(&sphere), &vertices, &[[0, 1, 2]], &wanted);
        assert_eq!(taken, Err(Cancelled));
    }
}
