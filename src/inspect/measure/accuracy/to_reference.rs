//! The direction from what was emitted to the reference surface.

use std::cmp::Reverse;

use glam::{DVec3, Vec3};

use super::peaks::Peaks;
use super::{AccuracyMeasurement, Sampling, Screen, WorstPoint, blocks, worse};
use crate::reference_shape::ReferenceShape;
use geometry::tessellate::{Vertex, unpack_normal};

/// The most segments that a triangle's edges are cut into for sampling.
const MAX_STEPS: u32 = 200;

impl AccuracyMeasurement<'_> {
    /// Measures from the emitted triangles to the reference surface.
    pub(super) fn take_triangles(&mut self, vertices: &[Vertex], triangles: &[[u32; 3]]) {
        let this = &*self;
        let none = || Sums::new(&this.no_peaks);
        let mut used = vec![false; vertices.len()];
        triangles.iter().flatten().for_each(|index| used[*index as usize] = true);
        let corners = blocks(vertices.len(), this.options.threads, |range| {
            let mut sums = none();
            for vertex in range.filter(|vertex| used[*vertex]).map(|vertex| &vertices[vertex]) {
                let point = Point { position: position(vertex), normal: normal(vertex), patch: vertex.patch() };
                sums.add(&point, 0.0, this.reference_shape, this.screen.as_ref());
            }
            sums
        });
        let insides = blocks(triangles.len(), this.options.threads, |range| {
            let mut sums = none();
            let sampled = triangles[range].iter().map(|triangle| triangle.map(|index| &vertices[index as usize]));
            sampled.for_each(|corners| this.sample(corners, &mut sums));
            sums
        });
        let edges = this.edges(vertices, triangles);
        let on_edges = blocks(edges.len(), this.options.threads, |range| {
            let mut sums = none();
            for edge in &edges[range] {
                let ends = edge.ends.map(|index| &vertices[index as usize]);
                sums.add_edge(ends, edge.steps, this.reference_shape, this.screen.as_ref());
            }
            sums
        });
        self.sums = corners.into_iter().chain(insides).chain(on_edges).fold(std::mem::take(&mut self.sums), Sums::with);
    }

    /// The number of segments that a triangle's edges are cut into to sample its inside. It isn't a multiple of 3, since then
    /// no sample would lie in the middle of the triangle itself.
    fn steps(&self, area: f64) -> u32 {
        let requested = (area * self.options.samples as f64 / self.reference_shape.area()).sqrt().ceil();
        let n = (requested as u32).clamp(2, MAX_STEPS);
        if n.is_multiple_of(3) { n + 1 } else { n }
    }

    /// The edges of triangles, each once. They are cut into segments that are no longer than the spacing of samples, but
    /// into no more than twice as many as the triangle: a sliver has little area and long edges.
    fn edges(&self, vertices: &[Vertex], triangles: &[[u32; 3]]) -> Vec<Edge> {
        let at = |index: u32| position(&vertices[index as usize]);
        let of_triangle = |triangle: &[u32; 3]| {
            let most = self.steps(area(triangle.map(at)));
            let [a, b, c] = *triangle;
            [[a, b], [b, c], [c, a]].map(|[a, b]| {
                let halves = (at(a).distance(at(b)) / (2.0 * self.spacing)).ceil() as u32;
                Edge { ends: [a.min(b), a.max(b)], steps: 2 * halves.clamp(1, most) }
            })
        };
        let mut edges: Vec<Edge> = triangles.iter().flat_map(of_triangle).collect();
        edges.sort_unstable_by_key(|edge| (edge.ends, Reverse(edge.steps)));
        edges.dedup_by_key(|edge| edge.ends);
        edges
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
}

/// The area of a triangle, in square object units.
fn area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length() / 2.0
}

/// An edge of emitted triangles.
struct Edge {
    /// The indices of its ends, the lower one first.
    ends: [u32; 2],
    /// The number of segments that it is cut into for sampling.
    steps: u32,
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
    pub area: f64,
    /// The squares of distances, and of angles in degrees, each times the area.
    pub squares: f64,
    pub angles: f64,
    pub sampling: Sampling,
    /// Places by their distance in object units.
    pub peaks: Peaks,
    /// Places by their distance on screen, in px.
    pub peaks_px: Peaks,
    pub worst_normal: Option<WorstPoint>,
    pub not_finite: u64,
}

impl Sums {
    pub(super) fn new(no_peaks: &Peaks) -> Self {
        Self { peaks: no_peaks.clone(), peaks_px: no_peaks.clone(), ..Self::default() }
    }

    /// Adds a point that stands for some area.
    fn add(&mut self, point: &Point, area: f64, reference_shape: &ReferenceShape, screen: Option<&Screen>) {
        let nearest = reference_shape.closest_facing(point.position, point.normal);
        // Unlike the arc cosine, this is exact for angles near 0.
        let angle = point.normal.cross(nearest.normal).length().atan2(point.normal.dot(nearest.normal)).to_degrees();
        let place =
            WorstPoint { value: angle, patch: point.patch, emitted: point.position, reference_shape: nearest.point };
        self.area += area;
        self.squares += area * nearest.distance * nearest.distance;
        self.angles += area * angle * angle;
        self.worst_normal = self.worst_normal.into_iter().chain([place]).reduce(worse);
        self.add_place(WorstPoint { value: nearest.distance, ..place }, screen);
        self.sampling.spacing = self.sampling.spacing.max(area.sqrt());
    }

    /// Adds the points between the ends of an edge. Their angles don't count: an edge along a curved crease belongs to triangles
    /// on both sides, but lies on one side of the reference surface's crease.
    fn add_edge(&mut self, ends: [&Vertex; 2], steps: u32, reference_shape: &ReferenceShape, screen: Option<&Screen>) {
        let [a, b] = ends.map(position);
        for i in 1..steps {
            let emitted = a.lerp(b, f64::from(i) / f64::from(steps));
            let (point, value) = reference_shape.closest_point(emitted);
            self.add_place(WorstPoint { value, patch: ends[0].patch(), emitted, reference_shape: point }, screen);
        }
        self.sampling.spacing = self.sampling.spacing.max(a.distance(b) / f64::from(steps));
    }

    /// Adds a place with its distance in object units.
    fn add_place(&mut self, place: WorstPoint, screen: Option<&Screen>) {
        self.peaks.add(place.emitted, place);
        if let Some(in_px) = screen.and_then(|screen| place.in_px(screen)) {
            self.peaks_px.add(place.emitted, in_px);
        }
        self.sampling.samples += 1;
    }

    fn with(mut self, other: Self) -> Self {
        let worst = |a: Option<WorstPoint>, b: Option<WorstPoint>| a.into_iter().chain(b).reduce(worse);
        self.peaks.join(&other.peaks);
        self.peaks_px.join(&other.peaks_px);
        Self {
            area: self.area + other.area,
            squares: self.squares + other.squares,
            angles: self.angles + other.angles,
            sampling: self.sampling.with(other.sampling),
            peaks: self.peaks,
            peaks_px: self.peaks_px,
            worst_normal: worst(self.worst_normal, other.worst_normal),
            not_finite: self.not_finite + other.not_finite,
        }
    }
}
