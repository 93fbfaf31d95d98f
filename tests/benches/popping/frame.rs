//! What is emitted in one frame.

use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::factors::{point_count, triangle_count};
use geometry::tessellate::{Inputs, PatchFactors, Tessellated, Tessellation, Vertex, tessellate, unpack_normal};
use glam::{DVec3, Vec3};
use inspect::render::camera::Camera;

use crate::VIEWPORT;
use crate::places::{PER_PATCH, places_within};

/// The bits of a factor's word that hold the factor, in 16.16 fixed point.
const FACTOR_VALUE: u32 = 0x7f_ffff;
/// The largest factor of fractional-odd partitioning. The others have 64.
const LARGEST: u32 = 63;

/// What is emitted in one frame.
pub(crate) struct Frame {
    emitted: Tessellated,
    /// The first vertex and the first triangle of each patch.
    starts: Vec<[usize; 2]>,
}

/// What is emitted at a place: the position in object units, and the interpolated unit normal.
#[derive(Clone, Copy)]
pub(crate) struct Emitted {
    pub position: DVec3,
    pub normal: DVec3,
}

impl Frame {
    pub(crate) fn new(mesh: &Mesh, topology: &Topology, tessellation: &Tessellation, camera: &Camera) -> Self {
        let inputs = Inputs::new(tessellation, camera.lod_view(VIEWPORT, &mesh.bounds()));
        let emitted = tessellate(mesh, topology, &inputs, None);
        let start = |at: &mut [usize; 2], &factors: &PatchFactors| {
            let own = *at;
            *at = [own[0] + point_count(factors) as usize, own[1] + triangle_count(factors) as usize];
            Some(own)
        };
        let starts = emitted.patch_factors.iter().scan([0; 2], start).collect();
        Self { emitted, starts }
    }

    /// The number of triangles of all patches.
    pub(crate) fn triangles(&self) -> usize {
        self.emitted.triangles.len()
    }

    pub(crate) fn patches(&self) -> usize {
        self.starts.len()
    }

    pub(crate) fn factors(&self, patch: usize) -> PatchFactors {
        self.emitted.patch_factors[patch]
    }

    /// Whether a factor of a patch is the largest that there is. LOD by error may then not keep the tolerance.
    pub(crate) fn is_capped(&self, patch: usize) -> bool {
        let PatchFactors { outside: [u, v, w], inside } = self.factors(patch);
        [u, v, w, inside].iter().any(|word| (word & FACTOR_VALUE) >> 16 >= LARGEST)
    }

    /// The triangles of a patch.
    fn triangles_of(&self, patch: usize) -> impl Iterator<Item = [&Vertex; 3]> {
        let count = triangle_count(self.factors(patch)) as usize;
        let own = &self.emitted.triangles[self.starts[patch][1]..][..count];
        own.iter().map(|triangle| triangle.map(|i| &self.emitted.vertices[i as usize]))
    }

    /// The triangles of a patch as domain points, in an order that doesn't depend on how they are numbered.
    fn pattern(&self, patch: usize) -> Vec<[[u32; 2]; 3]> {
        let sorted = |triangle: [&Vertex; 3]| {
            let mut corners = triangle.map(|vertex| vertex.domain());
            corners.sort_unstable();
            corners
        };
        let mut pattern: Vec<_> = self.triangles_of(patch).map(sorted).collect();
        pattern.sort_unstable();
        pattern
    }

    /// Whether a patch has the same triangles in another frame.
    pub(crate) fn has_same_pattern(&self, other: &Self, patch: usize) -> bool {
        let (own, others) = (self.factors(patch), other.factors(patch));
        own == others || triangle_count(own) == triangle_count(others) && self.pattern(patch) == other.pattern(patch)
    }

    /// What is emitted at all places of a patch.
    pub(crate) fn at_places(&self, patch: usize) -> [Option<Emitted>; PER_PATCH] {
        let mut all = [None; PER_PATCH];
        for triangle in self.triangles_of(patch) {
            places_within(triangle.map(|vertex| vertex.domain()), |place, weights| {
                let mix = |of: &dyn Fn(&Vertex) -> Vec3| -> DVec3 {
                    (0..3).map(|k| of(triangle[k]).as_dvec3() * weights[k]).sum()
                };
                let position = mix(&|vertex| vertex.position.into());
                let normal = mix(&|vertex| unpack_normal(vertex.normal)).normalize_or_zero();
                all[place] = Some(Emitted { position, normal });
            });
        }
        all
    }
}
