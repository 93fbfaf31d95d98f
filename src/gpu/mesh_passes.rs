//! The passes that run over a whole mesh, each bound to the mesh's buffers when it first runs.

use std::sync::OnceLock;

use super::GpuError;
use super::bound_pass::{BoundPass, PassInputs};
use super::mesh_buffers::MeshBuffers;
use super::relief_buffers::{HeightImages, ReliefBuffers};
use crate::tessellate::ROUNDS;

/// These belong to one set of mesh buffers: when those are replaced, so must this be.
#[derive(Default)]
pub(super) struct MeshPasses {
    curve_nets: OnceLock<BoundPass>,
    centers: OnceLock<BoundPass>,
    directions: OnceLock<BoundPass>,
    frames: OnceLock<BoundPass>,
    edge_factors: OnceLock<BoundPass>,
    heights_inside: OnceLock<BoundPass>,
    asked_factors: OnceLock<BoundPass>,
    search_workgroups: OnceLock<BoundPass>,
    search_asked_factors: OnceLock<BoundPass>,
    inside_factors: OnceLock<BoundPass>,
    search_inside_factors: OnceLock<BoundPass>,
    keep_factors: OnceLock<BoundPass>,
    sum_triangles: OnceLock<BoundPass>,
    candidates: OnceLock<BoundPass>,
    search_uniform_factor: OnceLock<BoundPass>,
    take_uniform_factor: OnceLock<BoundPass>,
    factor_levels: OnceLock<BoundPass>,
    point_levels: OnceLock<BoundPass>,
}

/// What a pass of LOD by error has an invocation or a workgroup for.
#[derive(Clone, Copy)]
pub(super) enum Each<'a> {
    Edge,
    Patch,
    /// It has so many workgroups.
    Workgroups(u32),
    /// It has as many workgroups as this buffer says, so many bytes into it.
    Counted(&'a wgpu::Buffer, u64),
}

/// The most workgroups of a search: enough for the largest GPUs.
const SEARCH_WORKGROUPS: u32 = 8192;

/// The same for one factor for all edges. Mostly each looks at one patch, and then no factor is left.
const UNIFORM_WORKGROUPS: u32 = 2048;

type Bound<'a> = Result<&'a BoundPass, GpuError>;

impl MeshPasses {
    /// The control points of every curve.
    pub(super) fn curve_nets(&self, on: &PassInputs) -> Bound<'_> {
        let mesh = on.mesh;
        let buffers = [
            (0, on.params),
            (1, &mesh.points),
            (2, &mesh.corners),
            (3, &mesh.curves),
            (4, &mesh.curve_sides),
            (6, &mesh.curve_nets),
        ];
        BoundPass::once(&self.curve_nets, on.gpu, &on.pipelines.curve_nets, &buffers)
    }

    /// The control point at the centre of every patch.
    pub(super) fn centers(&self, on: &PassInputs) -> Bound<'_> {
        let mesh = on.mesh;
        let buffers = [(0, on.params), (1, &mesh.points), (5, &mesh.patches), (6, &mesh.curve_nets)];
        BoundPass::once(&self.centers, on.gpu, &on.pipelines.centers, &buffers)
    }

    /// The direction in which displacement moves every point.
    pub(super) fn directions(&self, on: &PassInputs, relief: &ReliefBuffers) -> Bound<'_> {
        let buffers =
            [(0, on.params), (2, &on.mesh.corners), (6, &on.mesh.shares), (7, &relief.part_starts), (8, &relief.parts)];
        BoundPass::once(&self.directions, on.gpu, &on.pipelines.directions, &buffers)
    }

    /// How texture coordinates change at every corner.
    pub(super) fn frames(&self, on: &PassInputs, relief: &ReliefBuffers) -> Bound<'_> {
        let mesh = on.mesh;
        let buffers = [
            (0, on.params),
            (1, &mesh.points),
            (2, &mesh.corners),
            (3, &mesh.patches),
            (6, &mesh.shares),
            (7, &relief.corner_starts),
            (9, &relief.corner_patches),
        ];
        BoundPass::once(&self.frames, on.gpu, &on.pipelines.frames, &buffers)
    }

    /// LOD's factor of every edge.
    pub(super) fn edge_factors(&self, on: &PassInputs) -> Bound<'_> {
        BoundPass::once(
            &self.edge_factors,
            on.gpu,
            &on.pipelines.edge_factors,
            &factor_buffers(on.mesh, on.params, &on.mesh.edge_factors),
        )
    }

    /// The factor that the heights of every patch need inside it.
    pub(super) fn heights_inside(&self, on: &PassInputs) -> Bound<'_> {
        let edges = factor_buffers(on.mesh, on.params, &on.mesh.edge_factors);
        let buffers = [&edges[..], &[(7, &on.mesh.patches)]].concat();
        BoundPass::once(&self.heights_inside, on.gpu, &on.pipelines.heights_inside, &buffers)
    }

    /// The passes of LOD by error in their order, and what each has an invocation for: see `shaders/pass_asked.wgsl`.
    pub(super) fn asked<'a>(&'a self, on: &PassInputs<'a>) -> Result<Vec<(&'a BoundPass, Each<'a>)>, GpuError> {
        let (mesh, pipelines) = (on.mesh, on.pipelines);
        let buffers = asked_buffers(mesh, on.params, &mesh.edge_factors);
        let counters = [(0, on.params), (4, &mesh.edge_factors), (7, &mesh.search_workgroups)];
        let asked = BoundPass::once(&self.asked_factors, on.gpu, &pipelines.asked_factors, &buffers)?;
        let count = BoundPass::once(&self.search_workgroups, on.gpu, &pipelines.search_workgroups, &counters)?;
        let search_asked = pipelines.search_asked_factors.of(on.gpu, mesh.patch_count);
        let search_asked = BoundPass::once(&self.search_asked_factors, on.gpu, search_asked, &buffers)?;
        let inside = BoundPass::once(&self.inside_factors, on.gpu, &pipelines.inside_factors, &buffers)?;
        let search_inside = pipelines.search_inside_factors.of(on.gpu, mesh.patch_count);
        let search_inside = BoundPass::once(&self.search_inside_factors, on.gpu, search_inside, &buffers)?;
        let keep = BoundPass::once(&self.keep_factors, on.gpu, &pipelines.keep_factors, &counters)?;
        // What a search has nothing for costs a software driver microseconds a workgroup, and a GPU less than counting them.
        let counts = on.gpu.is_software();
        let searched = |search: u64| match counts {
            true => Each::Counted(&mesh.search_workgroups, search * size_of::<[u32; 3]>() as u64),
            false => Each::Workgroups(mesh.patch_count.min(SEARCH_WORKGROUPS)),
        };
        let count = counts.then_some((count, Each::Workgroups(1)));
        let take_insides = || [(inside, Each::Patch)].into_iter().chain(count).chain([(search_inside, searched(1))]);
        let mut passes = vec![(asked, Each::Patch)];
        passes.extend(count);
        passes.push((search_asked, searched(0)));
        passes.extend(take_insides());
        for _ in 1..ROUNDS {
            // What ends a round counts the workgroups of the next search.
            passes.extend([(keep, Each::Edge), (search_asked, searched(2))]);
            passes.extend(take_insides());
        }
        passes.push((keep, Each::Edge));
        passes.extend(self.uniform(on)?);
        passes.extend(take_insides());
        Ok(passes)
    }

    /// The passes that give all edges one factor where that takes fewer triangles: see `shaders/pass_uniform.wgsl`.
    fn uniform<'a>(&'a self, on: &PassInputs<'a>) -> Result<[(&'a BoundPass, Each<'a>); 4], GpuError> {
        let (mesh, pipelines) = (on.mesh, on.pipelines);
        let factors = [(0, on.params), (4, &mesh.edge_factors)];
        let patches = [&factors[..], &[(2, &mesh.patches)]].concat();
        let sum = BoundPass::once(&self.sum_triangles, on.gpu, &pipelines.sum_triangles, &patches)?;
        let candidates = BoundPass::once(&self.candidates, on.gpu, &pipelines.candidates, &factors)?;
        let buffers = asked_buffers(mesh, on.params, &mesh.edge_factors);
        let search = pipelines.search_uniform_factor.of(on.gpu, mesh.patch_count);
        let search = BoundPass::once(&self.search_uniform_factor, on.gpu, search, &buffers)?;
        let take = BoundPass::once(&self.take_uniform_factor, on.gpu, &pipelines.take_uniform_factor, &factors)?;
        let searched = Each::Workgroups(mesh.patch_count.min(UNIFORM_WORKGROUPS));
        Ok([(sum, Each::Patch), (candidates, Each::Workgroups(1)), (search, searched), (take, Each::Edge)])
    }

    /// The level at which heights are looked up on every edge.
    pub(super) fn factor_levels(&self, on: &PassInputs, images: &HeightImages) -> Bound<'_> {
        let mesh = on.mesh;
        let buffers = [
            (0, on.params),
            (1, &mesh.points),
            (2, &mesh.corners),
            (3, &mesh.patches),
            (4, &mesh.edge_factors),
            (5, on.given),
            (6, &mesh.shares),
            (21, &images.maps),
        ];
        BoundPass::once(&self.factor_levels, on.gpu, &on.pipelines.factor_levels, &buffers)
    }

    /// The level at which heights are looked up at every point.
    pub(super) fn point_levels(&self, on: &PassInputs, relief: &ReliefBuffers) -> Bound<'_> {
        let buffers = [(0, on.params), (6, &on.mesh.shares), (7, &relief.factor_starts), (9, &relief.factors)];
        BoundPass::once(&self.point_levels, on.gpu, &on.pipelines.point_levels, &buffers)
    }
}

/// What passes over patches read under LOD by error. `factors` are laid out as [`MeshBuffers::edge_factors`].
pub(super) fn asked_buffers<'a>(
    mesh: &'a MeshBuffers,
    params: &'a wgpu::Buffer,
    factors: &'a wgpu::Buffer,
) -> [(u32, &'a wgpu::Buffer); 7] {
    [
        (0, params),
        (1, &mesh.points),
        (2, &mesh.patches),
        (3, &mesh.curve_nets),
        (4, factors),
        (5, &mesh.corners),
        (6, &mesh.textured),
    ]
}

/// What passes over edges read, and the factors that they write.
pub(super) fn factor_buffers<'a>(
    mesh: &'a MeshBuffers,
    params: &'a wgpu::Buffer,
    factors: &'a wgpu::Buffer,
) -> [(u32, &'a wgpu::Buffer); 8] {
    [
        (0, params),
        (1, &mesh.points),
        (2, &mesh.curves),
        (3, &mesh.curve_nets),
        (4, &mesh.factor_curves),
        (5, factors),
        (6, &mesh.shares),
        (22, &mesh.details),
    ]
}
