//! Factor sweep: how far the surface jumps from one tessellation factor to the next.
//!
//! A surface point is a place (u, v) on a patch. At each factor it lies on the emitted triangle that holds (u, v) in the domain,
//! with the same weights. Its jump is the distance between its positions before and after a step, in object units.
//!
//! All patches have the same factor and so the same triangles in the domain. A place's triangle is found once per factor.

use std::ops::RangeInclusive;

use glam::{DVec3, Vec3};

use super::accuracy::blocks;
use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{
    Convention, FIXED_ONE, Inputs, Partitioning, PatchFactors, Tessellated, Tessellation, Vertex, process, tessellate,
};

/// The step of the factor in charts.
pub const SWEEP_STEP: f32 = 1.0 / 64.0;

/// The sweep of one partitioning.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    pub partitioning: Partitioning,
    /// The difference between one factor and the next.
    pub step: f32,
    /// In the order of their factors.
    pub steps: Vec<SweepStep>,
}

/// One step of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepStep {
    /// The factor after the step.
    pub factor: f32,
    /// The largest distance that any surface point moved, in object units.
    pub jump: f64,
    /// The patch with this point; 0 if nothing moved.
    pub patch: u32,
    /// U and V of this point in 16.16 fixed point; 0 if nothing moved.
    pub place: [u32; 2],
}

impl Sweep {
    /// The step with the largest jump, the first one if there are several; `None` without steps.
    pub fn largest(&self) -> Option<SweepStep> {
        self.steps.iter().copied().reduce(|best, step| if step.jump > best.jump { step } else { best })
    }
}

/// Sweeps the factor over a range, with the surface and partitioning of `inputs`. Their factor, LOD, clipping and convention
/// are ignored. `step` must be a positive power of two, so that every factor is exact.
///
/// Every patch is measured at 7,225 places: a grid of 48 segments, which includes the corners, the outline and the centre, and
/// 6,000 places between its points. (At factor 64 a patch has 6,144 triangles.) From 1 to 64 by [`SWEEP_STEP`], a dozen patches
/// take seconds for each fractional partitioning, and less for the others, whose steps mostly change nothing. Time and memory
/// grow with the number of patches; memory is two tessellations of the mesh for each processor.
pub fn sweep(mesh: &Mesh, topology: &Topology, inputs: &Inputs, factors: RangeInclusive<f32>, step: f32) -> Sweep {
    let (first, last) = factors.into_inner();
    let count = ((last - first) / step).floor().max(0.0) as u32;
    let still = |k: u32| SweepStep { factor: first + k as f32 * step, jump: 0.0, patch: 0, place: [0, 0] };
    let steps: Vec<_> = (1..=count).map(still).collect();

    let inputs = Inputs {
        tessellation: Tessellation { convention: Convention::D3d11, ..inputs.tessellation.with_one_factor(first) },
        ..*inputs
    };
    let places = Places::new(places());
    let states = States { mesh, topology, inputs, places: &places };
    // Blocks keep all cores busy, since high factors take far longer than low ones.
    let steps = blocks(steps.len(), |range| {
        let mut block = steps[range].to_vec();
        states.measure(&mut block, step);
        block
    })
    .concat();
    Sweep { partitioning: inputs.tessellation.partitioning, step, steps }
}

/// The segments of a patch's side in the grid of places. The grid includes the middles of edges and the centre. It is coarser
/// than the finest tessellation; the scattered places reach the triangles between its points.
const GRID: u32 = 48;
/// The number of places besides those of the grid.
const SCATTERED: u32 = 6000;

/// The places of all surface points that are followed: (U, V) in 16.16 fixed point.
fn places() -> Vec<[u32; 2]> {
    let on_grid = |i: u32| (i * FIXED_ONE + GRID / 2) / GRID;
    let grid = (0..=GRID).flat_map(|i| (0..=GRID - i).map(move |j| [on_grid(i), on_grid(j)]));
    // An additive recurrence with the inverse powers of the plastic number, times 2^32, which keeps places apart.
    let scattered = (1..=SCATTERED).map(|k| {
        let [u, v] = [3_242_174_889_u32, 2_447_445_414].map(|a| k.wrapping_mul(a) >> 16);
        if u + v > FIXED_ONE { [FIXED_ONE - u, FIXED_ONE - v] } else { [u, v] }
    });
    grid.chain(scattered).collect()
}

/// The triangle that holds a place, and the place's weights in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// The indices of the patch's points.
    corners: [u32; 3],
    weights: [f64; 3],
}

impl Spot {
    /// The position on a patch with these vertices, in object units.
    pub(super) fn position(&self, vertices: &[Vertex]) -> DVec3 {
        let corner = |k: usize| Vec3::from(vertices[self.corners[k] as usize].position).as_dvec3() * self.weights[k];
        corner(0) + corner(1) + corner(2)
    }
}

/// Places, sorted into bins over the domain.
pub(super) struct Places {
    /// All places, bin after bin.
    places: Vec<[u32; 2]>,
    /// The places of bin b are `starts[b]..starts[b + 1]`.
    starts: Vec<u32>,
    /// The number of bins along U and along V: a power of two.
    bins: u32,
}

impl Places {
    /// Sorts places into about as many bins as there are places.
    pub(super) fn new(mut places: Vec<[u32; 2]>) -> Self {
        let bins = 1 << (places.len().max(1).ilog2() / 2).min(FIXED_ONE.ilog2());
        let mut sorted = Self { places: Vec::new(), starts: Vec::new(), bins };
        let bin_of = |place: &[u32; 2]| sorted.bin(place[1]) * bins + sorted.bin(place[0]);
        places.sort_by_key(bin_of);
        let mut next = 0;
        let mut start = |b: u32| {
            while places.get(next).is_some_and(|place| bin_of(place) < b) {
                next += 1;
            }
            next as u32
        };
        let starts = (0..=bins * bins).map(&mut start).collect();
        (sorted.places, sorted.starts) = (places, starts);
        sorted
    }

    /// The bin of a coordinate.
    fn bin(&self, x: u32) -> u32 {
        (x / (FIXED_ONE / self.bins)).min(self.bins - 1)
    }

    /// Finds the triangle of every place. The triangles cover the domain, so every place has one.
    pub(super) fn locate(&self, points: &[[u32; 2]], triangles: &[[u32; 3]]) -> Vec<Option<Spot>> {
        let mut spots = vec![None; self.places.len()];
        for &corners in triangles {
            let at = corners.map(|i| points[i as usize]);
            let [[left, right], [bottom, top]] = [0, 1].map(|k| {
                let [a, b, c] = at.map(|point| point[k]);
                [self.bin(a.min(b).min(c)), self.bin(a.max(b).max(c))]
            });
            for row in bottom..=top {
                let first = self.starts[(row * self.bins + left) as usize] as usize;
                let end = self.starts[(row * self.bins + right) as usize + 1] as usize;
                for (spot, &place) in spots[first..end].iter_mut().zip(&self.places[first..end]) {
                    if spot.is_none() {
                        *spot = weights(at, place).map(|weights| Spot { corners, weights });
                    }
                }
            }
        }
        spots
    }
}

/// The weights of a triangle's corners at a place; `None` outside the triangle, or if it has no area. The test of which side
/// of an edge a place lies on is exact.
fn weights(triangle: [[u32; 2]; 3], place: [u32; 2]) -> Option<[f64; 3]> {
    let [a, b, c] = triangle.map(|point| [0, 1].map(|k| i64::from(point[k]) - i64::from(place[k])));
    let doubled = |p: [i64; 2], q: [i64; 2]| p[0] * q[1] - p[1] * q[0];
    let areas = [doubled(b, c), doubled(c, a), doubled(a, b)];
    let total: i64 = areas.iter().sum();
    let inside = total > 0 && areas.iter().all(|area| *area >= 0);
    inside.then(|| areas.map(|area| area as f64 / total as f64))
}

/// The surface at one factor.
struct State {
    out: Tessellated,
    /// The number of vertices in each patch.
    points: usize,
    spots: Vec<Option<Spot>>,
}

/// Computes the surface at any factor.
struct States<'a> {
    mesh: &'a Mesh,
    topology: &'a Topology,
    inputs: Inputs,
    places: &'a Places,
}

impl States<'_> {
    /// Measures the jumps of consecutive steps.
    fn measure(&self, steps: &mut [SweepStep], step: f32) {
        let Some(first) = steps.first() else { return };
        let mut factors = self.factors(first.factor - step);
        let mut before = self.at(first.factor - step);
        for step in steps {
            if self.factors(step.factor) != factors {
                factors = self.factors(step.factor);
                let after = self.at(step.factor);
                self.compare(&before, &after, step);
                before = after;
            }
        }
    }

    /// The processed factors of every patch.
    fn factors(&self, factor: f32) -> PatchFactors {
        let partitioning = self.inputs.tessellation.partitioning;
        let factor = partitioning.hull_factor(factor);
        process(partitioning, [factor; 3], factor)
    }

    fn at(&self, factor: f32) -> State {
        let tessellation = Tessellation { factor, ..self.inputs.tessellation };
        let out = tessellate(self.mesh, self.topology, &Inputs { tessellation, ..self.inputs }, None);
        let patches = self.topology.patches.len().max(1);
        let (points, triangles) = (out.vertices.len() / patches, out.triangles.len() / patches);
        let domain: Vec<_> = out.vertices[..points].iter().map(Vertex::domain).collect();
        let spots = self.places.locate(&domain, &out.triangles[..triangles]);
        State { out, points, spots }
    }

    /// Finds the largest jump between two factors, and stores it in `step`.
    fn compare(&self, before: &State, after: &State, step: &mut SweepStep) {
        let [old, new] = [before, after].map(|state| state.out.vertices.chunks_exact(state.points.max(1)));
        for (patch, (old, new)) in old.zip(new).enumerate() {
            for (place, spots) in self.places.places.iter().zip(before.spots.iter().zip(&after.spots)) {
                let (Some(from), Some(to)) = spots else { continue };
                let jump = from.position(old).distance(to.position(new));
                if jump > step.jump {
                    *step = SweepStep { jump, patch: patch as u32, place: *place, ..*step };
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::settings::Settings;
    use Partitioning::{FractionalEven, FractionalOdd, Integer, Pow2, Subtriangulation};
    use geometry::mesh::Shape;
    use geometry::tessellate::{
        LodView, Surface, domain_plan, domain_point, domain_triangle, point_count, triangle_count,
    };

    /// Sweeps the first face of the cube with split normals: two patches, and the diagonal between them.
    fn swept(surface: Surface, partitioning: Partitioning, factors: RangeInclusive<f32>, step: f32) -> Sweep {
        let mut mesh = Shape::CubeSplit.build();
        Arc::make_mut(&mut mesh.triangles).truncate(2);
        mesh.materials[0].triangles = 0..2;
        let topology = Topology::build(&mesh, &Default::default()).expect("nobody cancels");
        let view = LodView::new(glam::Mat4::IDENTITY, glam::Vec2::ONE);
        let settings = Settings::from(Tessellation { surface, partitioning, ..Tessellation::default() });
        sweep(&mesh, &topology, &settings.inputs(view), factors, step)
    }

    fn largest(partitioning: Partitioning, factors: RangeInclusive<f32>, step: f32) -> SweepStep {
        swept(Surface::PnAen, partitioning, factors, step).largest().expect("it has steps")
    }

    /// The steps at which anything moved.
    fn moves(sweep: &Sweep) -> Vec<SweepStep> {
        sweep.steps.iter().copied().filter(|step| step.jump > 0.0).collect()
    }

    #[test]
    fn a_flat_surface_never_jumps() {
        // Weights are exact. A coordinate of a vertex is the sum of three rounded products of at most 0.6 in all, with two
        // rounded sums: its error is at most 3 * 2^-24 * 0.6. The distance is between two such positions in space.
        let rounding = 2.0 * 3.0 * 3f64.sqrt() * 2f64.powi(-24) * 0.6;
        for partitioning in Partitioning::ALL {
            let largest = swept(Surface::Flat, partitioning, 1.0..=9.0, 0.25).largest().expect("it has steps");
            assert!(largest.jump <= rounding, "{partitioning:?}: {largest:?}");
        }
    }

    #[test]
    fn whole_factors_pop_where_they_change() {
        let integer = swept(Surface::PnAen, Integer, 1.0..=9.0, 0.25);
        assert_eq!(integer.steps.len(), 32);
        let pops = moves(&integer);
        assert!(pops.iter().map(|step| step.factor).eq((1..9).map(|n| n as f32 + 0.25)));
        assert!(pops.is_sorted_by(|a, b| a.jump > b.jump), "the first is the largest: {pops:?}");
        let equal = moves(&swept(Surface::PnAen, Subtriangulation, 1.0..=9.0, 0.25));
        assert!(equal.iter().map(|step| step.factor).eq(pops.iter().map(|step| step.factor)));
        let pow2 = moves(&swept(Surface::PnAen, Pow2, 1.0..=9.0, 0.25));
        assert!(pow2.iter().map(|step| step.factor).eq([1.25, 2.25, 4.25, 8.25]));
        // Half the step gives the same pops.
        let finer = moves(&swept(Surface::PnAen, Integer, 1.0..=9.0, 0.125));
        assert!(finer.iter().map(|step| step.jump).eq(pops.iter().map(|step| step.jump)));
    }

    #[test]
    fn the_first_pop_is_in_the_middle_of_the_diagonal() {
        // The cubic's middle lies 3/8 (ab + ba - a - b) = (n_a w_a + n_b w_b) / -8 from the chord's, w = edge . normal
        // (Vlachos et al. 2001, section 3.1). On a face's diagonal (1.2, 1.2, 0) between normals that are (-0.36, -0.36,
        // 1.36) and (0.36, 0.36, 1.36), each over its length, only the part along z stays.
        let length_squared = 2.0 * 0.36 * 0.36 + 1.36 * 1.36;
        let expected = 2.0 * (0.36 * 2.4) * 1.36 / length_squared / 8.0;
        for partitioning in [Integer, Pow2, Subtriangulation] {
            let pop = largest(partitioning, 1.0..=9.0, 0.25);
            assert!((pop.jump - expected).abs() < 1e-6, "{pop:?} and {expected}");
            assert_eq!((pop.factor, pop.place), (1.25, [FIXED_ONE / 2, 0]));
        }
    }

    #[test]
    fn under_fractional_partitioning_smaller_steps_move_the_surface_less() {
        let pop = largest(Integer, 1.0..=5.0, SWEEP_STEP).jump;
        for partitioning in [FractionalOdd, FractionalEven] {
            let [whole, half] = [1.0, 0.5].map(|part| largest(partitioning, 1.0..=5.0, SWEEP_STEP * part).jump);
            assert!(whole > 0.0 && whole < pop / 80.0, "{partitioning:?}: {whole} and {pop}");
            assert!((half / whole - 0.5).abs() < 0.02, "{partitioning:?}: {half} and {whole}");
        }
    }

    #[test]
    fn under_fractional_partitioning_new_points_cause_no_pop() {
        // After each of these factors rows have two more points, and the patch has one more ring of points. At 30 the new ring
        // first lies 7 / 65536 beyond the centre, since the specification's 1 / 30, rounded, times 15 is more than a half.
        let appear = [(FractionalOdd, [1, 3, 7, 17, 31, 61]), (FractionalEven, [2, 4, 8, 16, 30, 62])];
        let step = 2f32.powi(-14);
        for (partitioning, factors) in appear {
            for factor in factors.map(|n| n as f32) {
                let pop = largest(Integer, factor..=factor + step, step).jump;
                let jump = largest(partitioning, factor..=factor + step, step).jump;
                assert!(jump < pop / 32.0, "{partitioning:?} {factor}: {jump} and {pop}");
            }
        }
    }

    #[test]
    fn every_place_is_on_a_triangle() {
        let places = Places::new(places());
        for partitioning in Partitioning::ALL {
            // Some of these factors have triangles without area.
            for factor in [1.0, 1.0001, 2.0, 3.00002, 5.3, 12.00002, 30.0001, 64.0] {
                let factors = process(partitioning, [factor; 3], factor);
                let plan = domain_plan(factors);
                let points: Vec<_> = (0..point_count(factors)).map(|i| domain_point(&plan, i)).collect();
                let triangles: Vec<_> = (0..triangle_count(factors)).map(|t| domain_triangle(&plan, t)).collect();
                for (place, spot) in places.places.iter().zip(places.locate(&points, &triangles)) {
                    let spot = spot.expect("the triangles cover the domain");
                    for axis in 0..2 {
                        let at = |k: usize| spot.weights[k] * f64::from(points[spot.corners[k] as usize][axis]);
                        let back = at(0) + at(1) + at(2);
                        assert!((back - f64::from(place[axis])).abs() < 1e-9, "{partitioning:?} {factor}: {spot:?}");
                    }
                }
            }
        }
    }
}
