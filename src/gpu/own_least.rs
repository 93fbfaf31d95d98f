//! The own least of every patch: the fewest triangles with which it alone would keep the tolerance of LOD by error. Its passes
//! run only if someone wants to see that.

use std::sync::OnceLock;

use super::bound_pass::{BoundPass, PassInputs};
use super::buffer::{empty, uniform_buffer};
use super::layout::Params;
use super::mesh_passes::factor_buffers;
use super::pipelines::{ComputePipelines, MOST_WORKGROUPS, grid};
use super::recorder::RecordPasses;
use super::search_passes::asked_buffers;
use super::{Gpu, GpuError};
use geometry::tessellate::Partitioning;

/// The passes, bound to one set of mesh buffers: when those are replaced, so must this be.
pub(super) struct OwnLeast {
    /// Those of LOD by error, whichever LOD is used.
    params: wgpu::Buffer,
    /// What LOD by error needs, beside the factors that are in use: see [`super::MeshBuffers::edge_factors`].
    factors: wgpu::Buffer,
    /// The number of triangles of each patch.
    pub triangles: wgpu::Buffer,
    edge_factors: BoundPass,
    /// Bound once a displaced mesh needs it.
    heights_inside: OnceLock<BoundPass>,
    least_triangles: BoundPass,
    /// Of the patterns of Direct3D, then of rows. Each is bound once it is needed.
    searches: [OnceLock<BoundPass>; 2],
    /// The parameters that the numbers were computed with.
    done: Option<Params>,
}

impl OwnLeast {
    /// Binds the passes. They compute nothing yet.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a pipeline can't be made.
    pub(super) fn new(on: &PassInputs) -> Result<Self, GpuError> {
        let (gpu, mesh, pipelines) = (on.gpu, on.mesh, on.pipelines);
        let zeroed: Params = bytemuck::Zeroable::zeroed();
        let params = uniform_buffer(gpu, "least parameters", bytemuck::bytes_of(&zeroed));
        let room = mesh.edge_factors.size() as usize / size_of::<f32>();
        let factors = empty::<f32>(gpu, "least factors", room)?;
        let triangles = empty::<u32>(gpu, "least triangles", mesh.patch_count as usize)?;
        let of_patches = [&asked_buffers(mesh, &params, &factors)[..], &[(7, &triangles)]].concat();
        let edge_factors = BoundPass::new(gpu, &pipelines.edge_factors, &factor_buffers(mesh, &params, &factors))?;
        let least_triangles = BoundPass::new(gpu, &pipelines.least_triangles, &of_patches)?;
        Ok(Self {
            params,
            factors,
            triangles,
            edge_factors,
            heights_inside: OnceLock::new(),
            least_triangles,
            searches: Default::default(),
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
        let mesh = on.mesh;
        let heights_inside = if params.displacement == 0 {
            None
        } else {
            let buffers = [&factor_buffers(mesh, &self.params, &self.factors)[..], &[(7, &mesh.patches)]].concat();
            Some(BoundPass::once(&self.heights_inside, on.gpu, &on.pipelines.heights_inside, &buffers)?)
        };
        let kind = usize::from(params.partitioning == Partitioning::Rows as u32);
        let pipeline = on.pipelines.search_least_triangles[kind].of(on.gpu, mesh.patch_count);
        let of_patches = [&asked_buffers(mesh, &self.params, &self.factors)[..], &[(7, &self.triangles)]].concat();
        let search = BoundPass::once(&self.searches[kind], on.gpu, pipeline, &of_patches)?;
        on.gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(params));
        recorder.compute("least", |pass| {
            self.edge_factors.dispatch(pass, grid(mesh.factor_count));
            if let Some(heights_inside) = heights_inside {
                heights_inside.dispatch(pass, grid(mesh.patch_count));
            }
            self.least_triangles.dispatch(pass, grid(mesh.patch_count));
            search.dispatch(pass, [mesh.patch_count.min(MOST_WORKGROUPS), 1, 1]);
        });
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

/// Makes the pipelines of the passes for a number of patches, on any thread.
///
/// # Errors
/// Out of memory, or a lost device.
pub(super) fn prepare(gpu: &Gpu, pipelines: &ComputePipelines, patches: u32, has_rows: bool) -> Result<(), GpuError> {
    pipelines.edge_factors.get(gpu)?;
    pipelines.least_triangles.get(gpu)?;
    pipelines.search_least_triangles[usize::from(has_rows)].of(gpu, patches).get(gpu).map(|_| ())
}
