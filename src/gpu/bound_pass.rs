//! Compute pipelines together with what they work on.

/// A compute pipeline, and its bind group 0.
#[derive(Clone)]
pub struct BoundPass {
    pub pipeline: wgpu::ComputePipeline,
    pub group: wgpu::BindGroup,
}

impl BoundPass {
    /// Runs it over a grid of workgroups.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, [x, y, z]: [u32; 3]) {
        self.set(pass);
        pass.dispatch_workgroups(x, y, z);
    }

    pub(crate) fn set(&self, pass: &mut wgpu::ComputePass) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
    }
}

/// A pass, and over how many workgroups it runs.
pub(crate) struct Step {
    pub bound: BoundPass,
    pub workgroups: Workgroups,
}

/// How many workgroups a pass has.
#[derive(Clone)]
pub(crate) enum Workgroups {
    Grid([u32; 3]),
    /// As many as this buffer says.
    Counted(wgpu::Buffer),
}

impl Step {
    pub(crate) fn run(&self, pass: &mut wgpu::ComputePass) {
        self.bound.set(pass);
        match &self.workgroups {
            Workgroups::Grid([x, y, z]) => pass.dispatch_workgroups(*x, *y, *z),
            Workgroups::Counted(buffer) => pass.dispatch_workgroups_indirect(buffer, 0),
        }
    }
}
