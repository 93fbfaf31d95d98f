//! The passes of LOD by error in which patches look for factors: see `shaders/pass_asked.wgsl` and `shaders/pass_uniform.wgsl`.

use std::sync::OnceLock;

use super::GpuError;
use super::bound_pass::{BoundPass, PassInputs};
use super::compute_pipeline::ComputePipeline;
use super::mesh_buffers::MeshBuffers;
use super::pipelines::{SearchPipelines, WORKGROUP};
use geometry::tessellate::rounds;

/// These belong to one set of mesh buffers: when those are replaced, so must this be.
#[derive(Default)]
pub(super) struct SearchPasses {
    /// For the patterns of Direct3D, then for rows; by [`SearchPass`].
    bound: [[OnceLock<BoundPass>; 12]; 2],
}

/// The entry points, without `_main`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum SearchPass {
    AskedFactors,
    FirstPatterns,
    SearchWorkgroups,
    RoundWorkgroups,
    SearchAskedFactors,
    InsideFactors,
    SearchInsideFactors,
    KeepFactors,
    SumTriangles,
    Candidates,
    SearchUniformFactor,
    TakeUniformFactor,
}

/// Software drivers take time for what has nothing to do, and GPUs take less for that than for counting what has.
const SOFTWARE_ONLY: [SearchPass; 3] =
    [SearchPass::FirstPatterns, SearchPass::SearchWorkgroups, SearchPass::RoundWorkgroups];

/// What a pass has an invocation or a workgroup for.
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

/// For one factor for all edges: the most workgroups that add up triangles (each of so few patches that 32 bits hold the sum), and
/// the most that search. Mostly each looks at one patch, and then no factor is left. First on a GPU, then on a software driver.
const UNIFORM_WORKGROUPS: [[u32; 2]; 2] = [[1024, 2048], [32, 128]];

/// The places of `search_workgroups`, as in `shaders/pass_asked.wgsl` and `shaders/search_state.wgsl`.
pub const SEARCH_ASKED: u32 = 0;
pub const SEARCH_INSIDE: u32 = 1;
pub const SEARCH_AGAIN: u32 = 2;
pub const NEXT_PATCHES: u32 = 3;
pub const NEXT_EDGES: u32 = 4;

impl SearchPasses {
    /// All passes in their order, for rows or for the patterns of Direct3D.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn steps<'a>(
        &'a self,
        on: &PassInputs<'a>,
        has_rows: bool,
    ) -> Result<Vec<(&'a BoundPass, Each<'a>)>, GpuError> {
        use SearchPass::*;
        let (patches, software) = (on.mesh.patch_count, on.gpu.is_software());
        let counted = |place: u32, otherwise| match software {
            true => Each::Counted(&on.mesh.search_workgroups, u64::from(place) * size_of::<[u32; 3]>() as u64),
            false => otherwise,
        };
        let searched = |search| counted(search, Each::Workgroups(patches.min(SEARCH_WORKGROUPS)));
        let [next_patches, next_edges] = [counted(NEXT_PATCHES, Each::Patch), counted(NEXT_EDGES, Each::Edge)];
        let [adding, searching] = UNIFORM_WORKGROUPS[usize::from(software)];
        let one = Each::Workgroups(1);
        let take_insides =
            |each| [(InsideFactors, each), (SearchWorkgroups, one), (SearchInsideFactors, searched(SEARCH_INSIDE))];

        let mut steps = vec![(AskedFactors, Each::Patch), (SearchWorkgroups, one), (FirstPatterns, next_patches)];
        steps.extend([(SearchWorkgroups, one), (SearchAskedFactors, searched(SEARCH_ASKED))]);
        steps.extend(take_insides(Each::Patch));
        for round in 1..rounds(has_rows) {
            steps.push((KeepFactors, if round == 1 { Each::Edge } else { next_edges }));
            steps.extend([(RoundWorkgroups, one), (SearchAskedFactors, searched(SEARCH_AGAIN))]);
            steps.extend(take_insides(next_patches));
        }
        steps.push((KeepFactors, next_edges));
        steps.push((SumTriangles, Each::Workgroups(patches.div_ceil(WORKGROUP).min(adding))));
        steps.extend([(Candidates, one), (SearchUniformFactor, Each::Workgroups(patches.min(searching)))]);
        steps.push((TakeUniformFactor, Each::Edge));
        steps.extend(take_insides(next_patches));

        steps.retain(|(pass, _)| software || !SOFTWARE_ONLY.contains(pass));
        steps.into_iter().map(|(pass, each)| Ok((self.bound(on, pass, has_rows)?, each))).collect()
    }

    fn bound<'a>(&'a self, on: &PassInputs<'a>, pass: SearchPass, has_rows: bool) -> Result<&'a BoundPass, GpuError> {
        use SearchPass::*;
        let (mesh, pipelines, kind) = (on.mesh, on.pipelines, usize::from(has_rows));
        let of_patches = asked_buffers(mesh, on.params, &mesh.edge_factors);
        let factors = [(0, on.params), (4, &mesh.edge_factors)];
        let counted = [factors[0], factors[1], (7, &mesh.search_workgroups)];
        let summed = [factors[0], factors[1], (2, &mesh.patches)];
        let sized = |search: &'a SearchPipelines| search.of(on.gpu, mesh.patch_count);
        let (pipeline, buffers): (&ComputePipeline, &[_]) = match pass {
            AskedFactors if on.gpu.is_software() => (&pipelines.asked_before_first_patterns, &of_patches),
            AskedFactors => (&pipelines.asked_factors, &of_patches),
            FirstPatterns => (&pipelines.first_patterns, &of_patches),
            SearchWorkgroups => (&pipelines.search_workgroups, &counted),
            RoundWorkgroups => (&pipelines.round_workgroups, &counted),
            SearchAskedFactors => (sized(&pipelines.search_asked_factors[kind]), &of_patches),
            InsideFactors => (&pipelines.inside_factors, &of_patches),
            SearchInsideFactors => (sized(&pipelines.search_inside_factors[kind]), &of_patches),
            KeepFactors => (&pipelines.keep_factors, &factors),
            SumTriangles => (&pipelines.sum_triangles, &summed),
            Candidates => (&pipelines.candidates, &factors),
            SearchUniformFactor => (sized(&pipelines.search_uniform_factor), &of_patches),
            TakeUniformFactor => (&pipelines.take_uniform_factor, &counted),
        };
        BoundPass::once(&self.bound[kind][pass as usize], on.gpu, pipeline, buffers)
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
