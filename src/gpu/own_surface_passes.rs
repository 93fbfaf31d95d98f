//! The passes that run a function of the user's own for the control points of every side.

use std::sync::Arc;

use super::GpuError;
use super::bound_pass::{BoundPass, PassInputs};
use super::own_surface::SurfaceShader;
use super::pipelines::grid;

/// The passes of one user's function over a mesh, whose sides have curves of their own.
pub(super) struct OwnSurfacePasses {
    start: BoundPass,
    points: BoundPass,
    finish: BoundPass,
}

impl OwnSurfacePasses {
    /// Binds them. They write the control points of all curves.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn new(on: &PassInputs, shader: &Arc<SurfaceShader>, report: &wgpu::Buffer) -> Result<Self, GpuError> {
        let (gpu, mesh, pipelines) = (on.gpu, on.mesh, on.pipelines.own_surface(shader));
        let finish = [(0, on.params), (1, &mesh.points), (3, &mesh.curves), (6, &mesh.curve_nets), (9, report)];
        let points = [&finish[..], &[(2, &mesh.corners), (4, &mesh.curve_sides), (5, &mesh.patches)]].concat();
        Ok(Self {
            start: BoundPass::new(gpu, &pipelines.start, &[(9, report)])?,
            points: BoundPass::new(gpu, &pipelines.points, &points)?,
            finish: BoundPass::new(gpu, &pipelines.finish, &finish)?,
        })
    }

    /// Runs them for so many patches and curves.
    pub(super) fn dispatch(&self, pass: &mut wgpu::ComputePass, patches: u32, curves: u32) {
        self.start.dispatch(pass, [1, 1, 1]);
        self.points.dispatch(pass, grid(3 * patches));
        self.finish.dispatch(pass, grid(curves));
    }
}
