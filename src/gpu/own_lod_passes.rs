//! The passes that run functions of the user's own for every side and every patch.

use std::sync::Arc;

use super::GpuError;
use super::bound_pass::{BoundPass, PassInputs};
use super::own_lod::LodShader;
use super::pipelines::grid;

/// The passes of one user's functions over a mesh.
pub(super) struct OwnLodPasses {
    start: BoundPass,
    edges: BoundPass,
    insides: BoundPass,
    finish: BoundPass,
}

impl OwnLodPasses {
    /// Binds them. They write their factors where given ones are.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn new(on: &PassInputs, shader: &Arc<LodShader>, report: &wgpu::Buffer) -> Result<Self, GpuError> {
        let (gpu, mesh, pipelines) = (on.gpu, on.mesh, on.pipelines.own_lod(shader));
        let finish = [(0, on.params), (8, on.given), (9, report)];
        let mesh = [(2, &mesh.points), (3, &mesh.patches), (4, &mesh.curve_nets), (5, &mesh.corners)];
        let whole = [&finish[..], &mesh].concat();
        Ok(Self {
            start: BoundPass::new(gpu, &pipelines.start, &[(9, report)])?,
            edges: BoundPass::new(gpu, &pipelines.edges, &whole)?,
            insides: BoundPass::new(gpu, &pipelines.insides, &whole)?,
            finish: BoundPass::new(gpu, &pipelines.finish, &finish)?,
        })
    }

    /// Runs them for so many patches.
    pub(super) fn dispatch(&self, pass: &mut wgpu::ComputePass, patches: u32) {
        self.start.dispatch(pass, [1, 1, 1]);
        self.edges.dispatch(pass, grid(3 * patches));
        self.insides.dispatch(pass, grid(patches));
        self.finish.dispatch(pass, grid(patches));
    }
}
