//! Samples from what was emitted to the reference surface.

use glam::{DVec3, Vec3};

use super::{AccuracyMeasurement, MeanSquare, Screen, WorstPoint, blocks, worse};
use crate::reference_shape::ReferenceShape;
use geometry::tessellate::{Vertex, unpack_normal};

/// The most segments that a triangle's edges are cut into for sampling.
const MAX_STEPS: u32 = 200;

impl AccuracyMeasurement<'_> {
    /// Measures from the emitted triangles to the reference surface.
    pub(super) fn take_triangles(&mut self, vertices: &[Vertex], triangles: &[[u32; 3]]) {
        let this = &*self;
        let mut used = vec![false; vertices.len()];
        triangles.iter().flatten().for_each(|index| used[*index as usize] = true);
        let corners = blocks(vertices.len(), |range| {
            let mut sums = Sums::default();
            for vertex in range.filter(|vertex| used[*vertex]).map(|vertex| &vertices[vertex]) {
                let point = Point { position: position(vertex), normal: normal(vertex), patch: vertex.patch() };
                sums.add(&point, 0.0, this.reference_shape, this.screen.as_ref());
            }
            sums
        });
        let insides = blocks(triangles.len(), |range| {
            let mut sums = Sums::default();
            let sampled = triangles[range].iter().map(|triangle| triangle.map(|index| &vertices[index as usize]));
            sampled.for_each(|corners| this.sample(corners, &mut sums));
            sums
        });
        self.sums = corners.into_iter().chain(insides).fold(std::mem::take(&mut self.sums), Sums::with);
    }

    /// The number of segments that a triangle's edges are cut into to sample its inside. It isn't a multiple of 3, since then
    /// no sample would lie in the middle of the triangle itself.
    fn steps(&self, area: f64) -> u32 {
        let requested = (area * self.options.samples as f64 / self.reference_shape.area()).sqrt().ceil();
        let n = (requested as u32).clamp(2, MAX_STEPS);
        if n.is_multiple_of(3) { n + 1 } else { n }
    }

    /// Cuts a triangle into equal ones, n along each edge, and takes the middle of each.
    fn sample(&self, corners: [&Vertex; 3], sums: &mut Sums) {
        let positions = corners.map(position);
        let area = area(positions);
        if area <= 0.0 {
            return;
        }
        let n = self.steps(area);
        let (normals, patch) = (corners.map(normal), corners[0].patch());
        self.sample_edges(positions, patch, n, sums);
        let mut take = |thirds: [u32; 2]| {
            let [u, v] = thirds.map(|x| f64::from(x) / f64::from(3 * n));
            let weights = [1.0 - u - v, u, v];
            let mixed = |of: [DVec3; 3]| of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2];
            let normal = mixed(normals).try_normalize().unwrap_or(normals[0]);
            let point = Point { position: mixed(positions), normal, patch };
            sums.add(&point, area / f64::from(n * n), self.reference_shape, self.screen.as_ref());
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

    /// Takes points on a triangle's edges. They stand for no area, but on a crease they are the farthest. Their angles don't count:
    /// such an edge belongs to triangles on both sides, but lies on one side of the reference surface's crease.
    fn sample_edges(&self, corners: [DVec3; 3], patch: u32, n: u32, sums: &mut Sums) {
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            for i in 1..n {
                let emitted = corners[a].lerp(corners[b], f64::from(i) / f64::from(n));
                let (reference_shape, value) = self.reference_shape.closest_point(emitted);
                sums.add_place(WorstPoint { value, patch, emitted, reference_shape }, self.screen.as_ref());
            }
        }
    }
}

/// The area of a triangle, in square object units.
fn area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length() / 2.0
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
#[derive(Default)]
pub(super) struct Sums {
    /// Of distances, in object units.
    pub squares: MeanSquare,
    /// Of angles, in degrees.
    pub angles: MeanSquare,
    pub samples: u64,
    /// The sample with the largest distance, in object units.
    pub farthest: Option<WorstPoint>,
    /// The sample with the largest distance on screen, in px.
    pub worst_px: Option<WorstPoint>,
    pub worst_normal: Option<WorstPoint>,
    pub not_finite: u64,
}

impl Sums {
    /// Adds a point that stands for some area.
    fn add(&mut self, point: &Point, area: f64, reference_shape: &ReferenceShape, screen: Option<&Screen>) {
        let nearest = reference_shape.closest_facing(point.position, point.normal);
        // Unlike the arc cosine, this is exact for angles near 0.
        let angle = point.normal.cross(nearest.normal).length().atan2(point.normal.dot(nearest.normal)).to_degrees();
        let place =
            WorstPoint { value: angle, patch: point.patch, emitted: point.position, reference_shape: nearest.point };
        self.squares.add(nearest.distance, area);
        self.angles.add(angle, area);
        self.worst_normal = self.worst_normal.into_iter().chain([place]).reduce(worse);
        self.add_place(WorstPoint { value: nearest.distance, ..place }, screen);
    }

    /// Adds a place with its distance in object units.
    fn add_place(&mut self, place: WorstPoint, screen: Option<&Screen>) {
        let in_px = screen.and_then(|screen| place.in_px(screen));
        self.farthest = self.farthest.into_iter().chain([place]).reduce(worse);
        self.worst_px = self.worst_px.into_iter().chain(in_px).reduce(worse);
        self.samples += 1;
    }

    fn with(self, other: Self) -> Self {
        let worst = |a: Option<WorstPoint>, b: Option<WorstPoint>| a.into_iter().chain(b).reduce(worse);
        Self {
            squares: self.squares.with(other.squares),
            angles: self.angles.with(other.angles),
            samples: self.samples + other.samples,
            farthest: worst(self.farthest, other.farthest),
            worst_px: worst(self.worst_px, other.worst_px),
            worst_normal: worst(self.worst_normal, other.worst_normal),
            not_finite: self.not_finite + other.not_finite,
        }
    }
}
