//! The error on screen: the distance in px between what was emitted and its limit surface.

use glam::{DMat4, DVec2, DVec3, DVec4};
use serde::{Serialize, Serializer};

use super::visitor::{EmittedChunk, Visitor};
use geometry::cores::in_ranges;
use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{ControlNet, Inputs, LimitSurface, LodView, Vertex};

/// Measures the largest distance on screen between an emitted point and the point of the limit surface at the same place of the
/// domain. It is at least the distance to the nearest point of that surface, and is the distance that LOD by error bounds. On flat
/// patches whose points may slide, the nearest point of the surface is taken, as LOD by error does.
pub struct ScreenErrorMeasurement<'a> {
    limit: LimitSurface<'a>,
    patches: u32,
    screen: Screen,
    /// The number of segments that each edge of a triangle is divided into for sampling.
    steps: u32,
    worst: Option<WorstPoint>,
    /// Patches with a larger distance than this, in px, are counted. Those of parts with a detail have a part of it.
    tolerance_px: f64,
    above: u64,
    /// The last patch that was counted.
    last_above: Option<u32>,
}

/// A view that distances are measured in.
pub(super) struct Screen {
    clip_from_object: DMat4,
    half_viewport: DVec2,
}

/// The place where a distance or angle is largest. As JSON it has the place alone, which stands beside intervals of the value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WorstPoint {
    /// The largest value that was found, in object units, px or degrees.
    #[serde(skip)]
    pub value: f64,
    /// The patch that emitted the point.
    pub patch: u32,
    /// The emitted point, in object units.
    #[serde(serialize_with = "coordinates")]
    pub emitted: DVec3,
    /// The point of the reference surface, or of the limit surface, in object units.
    #[serde(rename = "reference_surface", serialize_with = "coordinates")]
    pub reference_shape: DVec3,
}

fn coordinates<S: Serializer>(place: &DVec3, serializer: S) -> Result<S::Ok, S::Error> {
    place.to_array().serialize(serializer)
}

impl WorstPoint {
    /// The place with its distance on screen, in px; `None` if it isn't in view.
    pub(super) fn in_px(self, screen: &Screen) -> Option<Self> {
        screen.distance_px(self.emitted, self.reference_shape).map(|value| Self { value, ..self })
    }
}

/// The patches that are farther from their surface than a tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchesAbove {
    pub tolerance_px: f32,
    pub patches: u64,
    /// The worst place of all patches; none if nothing was in view.
    pub worst: Option<WorstPoint>,
}

/// Up to this many triangles, edges are divided into 8 segments for sampling; up to ten times as many, into 4; else into 2.
const FINE: u64 = 100_000;

impl<'a> ScreenErrorMeasurement<'a> {
    /// Starts to measure a tessellation with these inputs, in px of their view. `triangles` is the number in all chunks
    /// together: the more there are, the fewer samples each gets.
    pub fn new(mesh: &'a Mesh, topology: &'a Topology, inputs: &Inputs, triangles: u64) -> Self {
        let steps = match triangles {
            0..=FINE => 8,
            triangles if triangles <= 10 * FINE => 4,
            _ => 2,
        };
        let limit = LimitSurface::new(mesh, topology, inputs);
        let patches = topology.patches.len() as u32;
        let (screen, tolerance_px) = (Screen::new(&inputs.view), f64::INFINITY);
        Self { limit, patches, screen, steps, worst: None, tolerance_px, above: 0, last_above: None }
    }

    /// Counts the patches whose distance is above a tolerance, too.
    pub fn counting_above(self, tolerance_px: f32) -> Self {
        Self { tolerance_px: f64::from(tolerance_px), ..self }
    }

    /// The patches above the tolerance of [`Self::counting_above`], after all chunks were taken.
    pub fn above(&self) -> PatchesAbove {
        PatchesAbove { tolerance_px: self.tolerance_px as f32, patches: self.above, worst: self.worst }
    }

    /// The worst place so far; `None` if nothing was in view.
    pub fn worst(&self) -> Option<WorstPoint> {
        self.worst
    }

    /// The number of patches whose points may slide.
    pub fn flat_patches(&self) -> u64 {
        (0..self.patches).filter(|&patch| self.limit.slides(patch)).count() as u64
    }

    /// The worst place on some triangles, and the patches of these that are above the tolerance, in order.
    fn worst_of(&self, vertices: &[Vertex], triangles: &[[u32; 3]]) -> (Option<WorstPoint>, Vec<u32>) {
        let mut known: Option<(u32, ControlNet, bool)> = None;
        let mut above = Vec::new();
        let worst = triangles.iter().filter_map(|triangle| {
            let corners = triangle.map(|i| &vertices[i as usize]);
            // Triangles come patch after patch.
            let patch = corners[0].patch();
            let found = || (patch, self.limit.net(patch), self.limit.slides(patch));
            let (_, net, slides) = known.take().filter(|(of, ..)| *of == patch).unwrap_or_else(found);
            let worst = self.worst_on(corners, &net, slides);
            known = Some((patch, net, slides));
            let detail = || f64::from(self.limit.detail(patch));
            if worst.is_some_and(|worst| worst.value * detail() > self.tolerance_px) && above.last() != Some(&patch) {
                above.push(patch);
            }
            worst
        });
        (worst.reduce(worse), above)
    }

    fn worst_on(&self, corners: [&Vertex; 3], net: &ControlNet, slides: bool) -> Option<WorstPoint> {
        let (patch, steps) = (corners[0].patch(), self.steps);
        let domains = corners.map(|vertex| vertex.exact_domain());
        let positions = corners.map(|vertex| DVec3::from(vertex.position.map(f64::from)));
        let mut worst: Option<WorstPoint> = None;
        for i in 0..=steps {
            for j in 0..=steps - i {
                if [i, j, steps - i - j].contains(&steps) {
                    continue;
                }
                let weights = [i, j, steps - i - j].map(|x| f64::from(x) / f64::from(steps));
                let [u, v] = [0, 1].map(|k| (0..3).map(|c| weights[c] * domains[c][k]).sum());
                let emitted = (0..3).map(|c| positions[c] * weights[c]).sum();
                let reference_shape = match slides {
                    true => self.limit.nearest(net, [u, v], emitted, |p| self.screen.place(p)),
                    false => self.limit.position(patch, net, u, v),
                };
                let place = WorstPoint { value: 0.0, patch, emitted, reference_shape }.in_px(&self.screen);
                worst = worst.into_iter().chain(place).reduce(worse);
            }
        }
        worst
    }
}

impl Visitor for ScreenErrorMeasurement<'_> {
    /// Samples triangles on a grid that divides their edges. Corners aren't sampled, since they lie on the surface except for
    /// rounding.
    fn take(&mut self, chunk: &EmittedChunk) {
        let this = &*self;
        let found = in_ranges(chunk.triangles.len(), 1, |range| this.worst_of(chunk.vertices, &chunk.triangles[range]));
        for (worst, above) in found {
            self.worst = self.worst.into_iter().chain(worst).reduce(worse);
            // The triangles of a patch may have been divided among threads.
            let again = u64::from(self.last_above.is_some() && self.last_above == above.first().copied());
            self.above += above.len() as u64 - again;
            self.last_above = above.last().copied().or(self.last_above);
        }
    }
}

impl Screen {
    pub(super) fn new(view: &LodView) -> Self {
        Self { clip_from_object: view.clip_from_object.as_dmat4(), half_viewport: view.half_viewport.as_dvec2() }
    }

    /// The distance on screen between two points, in px; `None` if neither is in view, or the near plane cuts one off.
    pub(super) fn distance_px(&self, a: DVec3, b: DVec3) -> Option<f64> {
        let [a, b] = [a, b].map(|p| self.clip_from_object * p.extend(1.0));
        // Depth is reversed.
        let beyond_near = |clip: DVec4| clip.w > 0.0 && clip.z <= clip.w;
        if !(in_view(a) || in_view(b)) || !beyond_near(a) || !beyond_near(b) {
            return None;
        }
        Some(self.place_of(a).distance(self.place_of(b)))
    }

    /// The place of a point on screen, in px from the middle.
    fn place(&self, p: DVec3) -> DVec2 {
        self.place_of(self.clip_from_object * p.extend(1.0))
    }

    fn place_of(&self, clip: DVec4) -> DVec2 {
        clip.truncate().truncate() / clip.w * self.half_viewport
    }
}

fn in_view(clip: DVec4) -> bool {
    clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z <= clip.w
}

/// The point with the larger value, or `a` if both are equal.
pub(super) fn worse(a: WorstPoint, b: WorstPoint) -> WorstPoint {
    if b.value > a.value { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use geometry::mesh::Shape;
    use geometry::progress::Progress;
    use geometry::tessellate::{Surface, Tessellation, pack_key};
    use glam::{Mat4, Vec2, Vec3};

    #[test]
    fn a_shifted_corner_is_measured_at_the_sample_nearest_to_it() {
        let mesh = Shape::CubeSmooth.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let settings = Settings::from(Tessellation { surface: Surface::Flat, ..Tessellation::default() });
        let inputs = settings.inputs(LodView::new(Mat4::IDENTITY, Vec2::splat(100.0)));
        let positions = topology.patch_positions(0);
        for (triangles, steps) in [(1, 8), (FINE, 8), (FINE + 1, 4), (10 * FINE, 4), (10 * FINE + 1, 2)] {
            for shifted in 0..3 {
                let vertices = [0, 1, 2].map(|k| Vertex {
                    position: (positions[k] + if k == shifted { Vec3::X * 0.1 } else { Vec3::ZERO }).to_array(),
                    key: pack_key(0, [[65536, 0], [0, 65536], [0, 0]][k]),
                    ..bytemuck::Zeroable::zeroed()
                });
                let mut measurement = ScreenErrorMeasurement::new(&mesh, &topology, &inputs, triangles);
                measurement.take(&EmittedChunk::whole(&vertices, &[[0, 1, 2]]));
                assert_eq!(measurement.above().patches, 0, "no tolerance was given");
                // The corner itself is 10 px off, and isn't sampled.
                let expected = 10.0 * f64::from(steps - 1) / f64::from(steps);
                let worst = measurement.worst().expect("it is in view");
                assert!((worst.value - expected).abs() < 1e-4, "{triangles}, corner {shifted}: {worst:?}");
            }
        }
    }

    #[test]
    fn patches_above_a_tolerance_are_counted_once_however_they_are_divided() {
        let mesh = Shape::CubeSmooth.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let settings = Settings::from(Tessellation { surface: Surface::Flat, ..Tessellation::default() });
        let inputs = settings.inputs(LodView::new(Mat4::IDENTITY, Vec2::splat(100.0)));
        // Patch 1 lies on its surface, and patches 0 and 2 are moved aside, each with three triangles on top of each other.
        let corner = |patch: u32, k: usize| Vertex {
            position: (topology.patch_positions(patch)[k] + if patch == 1 { Vec3::ZERO } else { Vec3::X * 0.1 })
                .to_array(),
            key: pack_key(patch, [[65536, 0], [0, 65536], [0, 0]][k]),
            ..bytemuck::Zeroable::zeroed()
        };
        let vertices: Vec<Vertex> = (0..3).flat_map(|patch| [0, 1, 2].map(|k| corner(patch, k))).collect();
        let triangles: Vec<[u32; 3]> = (0..9).map(|triangle| [0, 1, 2].map(|k| triangle / 3 * 3 + k)).collect();
        for (tolerance, patches) in [(0.5, 2), (20.0, 0)] {
            let mut measurement = ScreenErrorMeasurement::new(&mesh, &topology, &inputs, 9).counting_above(tolerance);
            measurement.take(&EmittedChunk::whole(&vertices, &triangles));
            assert_eq!(measurement.above().patches, patches, "above {tolerance} px");
        }
    }
}
