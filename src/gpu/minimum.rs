//! The minimum triangle count of every patch: the fewest triangles with which it alone would keep the tolerance of LOD by error. Its passes
//! run only if someone wants to see that.

use super::buffer::{empty, uniform_buffer};
use super::compute_pipeline::{Pass, Step, Workgroups};
use super::layout::Params;
use super::mesh_buffers::MeshBuffers;
use super::pass_inputs::{BoundPasses, PassInputs};
use super::pipelines::{
    ComputePipelines, EDGE_FACTORS, LEAST_TRIANGLES, MOST_WORKGROUPS, PATCH_DIRECTIONS, SEARCH_LEAST_TRIANGLES,
};
use super::recorder::RecordPasses;
use super::{Gpu, GpuError};
use geometry::tessellate::Partitioning;

/// What the passes have of their own, beside one set of mesh buffers: when those are replaced, so must this be.
pub(super) struct Minimum {
    /// Those of LOD by error, whichever LOD is used.
    params: wgpu::Buffer,
    /// What LOD by error needs, beside the factors that are in use: see [`super::MeshBuffers::edge_factors`].
    factors: wgpu::Buffer,
    /// The number of triangles of each patch.
    pub triangles: wgpu::Buffer,
    bound: BoundPasses,
    /// The parameters that the numbers were computed with.
    done: Option<Params>,
}

impl Minimum {
    /// Computes nothing yet.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for.
    pub(super) fn new(gpu: &Gpu, mesh: &MeshBuffers) -> Result<Self, GpuError> {
        let zeroed: Params = bytemuck::Zeroable::zeroed();
        let room = mesh.edge_factors.size() as usize / size_of::<f32>();
        Ok(Self {
            params: uniform_buffer(gpu, "least parameters", bytemuck::bytes_of(&zeroed)),
            factors: empty::<f32>(gpu, "least factors", room)?,
            triangles: empty::<u32>(gpu, "least triangles", mesh.patch_count as usize)?,
            bound: BoundPasses::default(),
            done: None,
        })
    }

    /// Records the passes, unless the numbers are there already. `params` are those of LOD by error.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn record(
        &mut self,
        on: &PassInputs,
        params: &Params,
        recorder: &mut impl RecordPasses,
    ) -> Result<(), GpuError> {
        if self.done.as_ref() == Some(params) {
            return Ok(());
        }
        let own = [("params", &self.params), ("edge_factors", &self.factors), ("least_triangles", &self.triangles)];
        let (mesh, on) = (on.mesh, PassInputs { own: &own, bound: &self.bound, ..*on });
        let mut steps = vec![on.over(EDGE_FACTORS, mesh.factor_count)?];
        if params.displacement != 0 {
            steps.push(on.over(PATCH_DIRECTIONS, mesh.patch_count)?);
        }
        steps.push(on.over(LEAST_TRIANGLES, mesh.patch_count)?);
        let search = search(on.gpu, on.pipelines, mesh.patch_count, params.partitioning == Partitioning::Rows as u32);
        let workgroups = Workgroups::Grid([mesh.patch_count.min(MOST_WORKGROUPS), 1, 1]);
        steps.push(Step { bound: on.bound(search)?, workgroups });
        on.gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(params));
        recorder.compute("least", |pass| steps.iter().for_each(|step| step.run(pass)));
        self.done = Some(*params);
        Ok(())
    }

    /// Forgets what was computed, since the surface or its pose has changed.
    pub(super) fn forget(&mut self) {
        self.done = None;
    }

    pub(super) fn bytes(&self) -> u64 {
        self.factors.size() + self.triangles.size()
    }
}

/// The pass that searches the fewest triangles of so many patches.
pub(super) fn search(gpu: &Gpu, pipelines: &ComputePipelines, patches: u32, has_rows: bool) -> Pass {
    pipelines.search(gpu, SEARCH_LEAST_TRIANGLES, patches).with("SEARCHES_ROWS", has_rows.into())
}
