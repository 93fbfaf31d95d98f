//! The survey: cracks, folds and counts, gathered chunk by chunk from what was emitted on the CPU or the device.

use glam::Vec3;

use super::cracks::Cracks;
use super::folds::{self, FoldedPatch};
use super::outlines::Outlines;
use super::requested_factors::RequestedFactors;
use super::seams::Seams;
use super::visitor::{EmittedChunk, LEAST, Visitor};
use geometry::cores::in_ranges;
use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{FACING_AWAY, OUT_OF_VIEW, PatchFactors, Tessellated, Vertex, patch_is_culled};
use geometry::view::ulp;

/// The measurements so far.
pub struct Survey<'a> {
    mesh: &'a Mesh,
    topology: &'a Topology,
    ulp: f64,
    found: Measured,
}

/// The numbers of patches that emitted nothing, for each reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Culled {
    pub out_of_view: u32,
    pub facing_away: u32,
    /// A factor wasn't greater than zero.
    pub by_factors: u32,
}

impl Culled {
    fn new(factors: &[PatchFactors]) -> Self {
        let mut culled = Self::default();
        for patch in factors.iter().filter(|patch| patch_is_culled(**patch)) {
            *match patch.inside {
                OUT_OF_VIEW => &mut culled.out_of_view,
                FACING_AWAY => &mut culled.facing_away,
                _ => &mut culled.by_factors,
            } += 1;
        }
        culled
    }

    pub fn total(&self) -> u32 {
        self.out_of_view + self.facing_away + self.by_factors
    }
}

/// The measurements of a survey.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    pub culled: Culled,
    /// Emitted patches whose factors are all below 2.
    pub patches_low: u32,
    /// Emitted patches with a factor at the largest: see [`Outlines::at_limit`].
    pub patches_at_limit: u32,
    pub cracks: Cracks,
    pub seams: Seams,
    /// Triangles that face away from the side that their patch faces.
    pub folds: u64,
    /// The patches with such triangles, those with the largest area first.
    pub folded: Vec<FoldedPatch>,
    /// Vertices with an infinite or NaN position or uv.
    pub not_finite: u64,
    /// Least and greatest coordinates of what was emitted, in object units.
    pub extent: [Vec3; 2],
    pub outlines: Outlines,
}

impl<'a> Survey<'a> {
    /// A survey of patches with these factors.
    pub fn new(
        mesh: &'a Mesh,
        topology: &'a Topology,
        factors: Vec<PatchFactors>,
        requested: RequestedFactors,
    ) -> Self {
        let extent = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        let culled = Culled::new(&factors);
        let outlines = Outlines::new(factors, requested);
        let found = Measured { culled, extent, outlines, ..Measured::default() };
        Self { mesh, topology, ulp: ulp(topology), found }
    }

    /// Compares the sides of every edge, after all chunks are taken.
    pub fn finish(self) -> Measured {
        let Self { mesh, topology, mut found, .. } = self;
        let (mut cracks, outlines) = (Cracks::default(), &found.outlines);
        for (edge, sides) in outlines.shared_edges(topology) {
            cracks.take(mesh, topology, edge, &sides, &outlines.discarded(topology, edge));
            found.seams.take(mesh, topology, outlines, edge, &sides);
        }
        found.cracks = cracks.sorted();
        (found.patches_low, found.patches_at_limit) = (outlines.low(), outlines.at_limit());
        found.folds = found.folded.iter().map(|patch| u64::from(patch.folds)).sum();
        found.folded.sort_by(|a, b| b.area.total_cmp(&a.area));
        found
    }
}

/// How many vertices have an infinite or NaN position or uv, and the least and greatest coordinates of the others.
fn extent_of(vertices: &[Vertex]) -> (u64, [Vec3; 2]) {
    let (mut not_finite, mut extent) = (0, [Vec3::INFINITY, Vec3::NEG_INFINITY]);
    for vertex in vertices {
        let position = Vec3::from(vertex.position);
        if position.is_finite() && vertex.uv.iter().all(|x| x.is_finite()) {
            extent = [extent[0].min(position), extent[1].max(position)];
        } else {
            not_finite += 1;
        }
    }
    (not_finite, extent)
}

impl Visitor for Survey<'_> {
    fn take(&mut self, chunk: &EmittedChunk) {
        let EmittedChunk { first_patch, vertices, triangles } = *chunk;
        let found = &mut self.found;
        found.outlines.take(first_patch, vertices);
        found.folded.extend(folds::find(self.topology, self.ulp, vertices, triangles));
        for (not_finite, [least, most]) in in_ranges(vertices.len(), LEAST, |range| extent_of(&vertices[range])) {
            found.not_finite += not_finite;
            found.extent = [found.extent[0].min(least), found.extent[1].max(most)];
        }
    }
}

impl Measured {
    /// Measures what the CPU emitted.
    pub fn new(mesh: &Mesh, topology: &Topology, requested: RequestedFactors, out: &Tessellated) -> Self {
        let mut survey = Survey::new(mesh, topology, out.patch_factors.clone(), requested);
        survey.take(&EmittedChunk::whole(&out.vertices, &out.triangles));
        survey.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::cores::on_threads;
    use geometry::mesh::Shape;
    use geometry::progress::Progress;
    use geometry::tessellate::{Inputs, LodView, Partitioning, Tessellation, tessellate};
    use glam::{Mat4, Vec2};

    #[test]
    fn any_number_of_cores_finds_the_same() {
        let mesh = Shape::Torus.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let tessellation = Tessellation { factor: 32.0, ..Tessellation::default() };
        let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::ONE));
        let mut out = tessellate(&mesh, &topology, &inputs, None);
        // Points on the other side of the torus turn the triangles around them over.
        let far = |vertex: &mut Vertex| vertex.position = vertex.position.map(|x| -x);
        out.vertices.iter_mut().step_by(997).for_each(far);
        out.vertices.iter_mut().step_by(10_007).for_each(|vertex| vertex.uv = [f32::NAN, 0.0]);
        let measured = |threads| {
            let requested =
                RequestedFactors::new(tessellation.edges, tessellation.convention, out.edge_factors.clone());
            on_threads(threads, || Measured::new(&mesh, &topology, requested, &out)).expect("threads")
        };
        let alone = measured(1);
        assert!(alone.folds > 300 && alone.folded.iter().any(|patch| patch.folds > 1), "{}", alone.folds);
        for threads in [2, 5] {
            let own = measured(threads);
            assert_eq!((own.folds, &own.folded, own.not_finite), (alone.folds, &alone.folded, alone.not_finite));
            assert_eq!(own.extent, alone.extent);
        }
    }

    #[test]
    fn a_torus_is_measured_from_end_to_end() {
        let mesh = Shape::Torus.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        for (factor, low, at_limit) in [(1.0, 256, 0), (4.0, 0, 0), (64.0, 0, 256)] {
            let tessellation = Tessellation { factor, partitioning: Partitioning::Integer, ..Tessellation::default() };
            let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::ONE));
            let mut out = tessellate(&mesh, &topology, &inputs, None);
            out.vertices[0].uv = [f32::NAN, 0.0];
            let requested =
                RequestedFactors::new(tessellation.edges, tessellation.convention, out.edge_factors.clone());
            let own = Measured::new(&mesh, &topology, requested, &out);
            assert_eq!((own.patches_low, own.patches_at_limit, own.culled.total()), (low, at_limit, 0), "{factor}");
            assert_eq!((own.cracks.edges_compared, own.folds, own.not_finite), (384, 0, 1), "{factor}");
            let positions = out.vertices[1..].iter().map(|vertex| Vec3::from(vertex.position));
            assert_eq!(own.extent[1], positions.reduce(Vec3::max).expect("vertices"), "{factor}");
        }
    }
}
