//! Measures the bandwidth of the device's memory, which our passes are compared with.

use std::rc::Rc;

use ash::vk;

use super::memory::{Buffer, Owned};
use super::numbers::Spread;
use super::ours::Effort;
use super::pipelines::{COPY, Layout};
use super::vulkan::stages::module;
use super::vulkan::{Took, Vulkan, VulkanError};

/// The bandwidth of copying one large buffer into another, in bytes per second, read and written.
pub(crate) struct Copies {
    pub bytes: u64,
    /// With the copy command.
    pub command: f64,
    /// With a compute shader, 16 bytes per invocation.
    pub shader: f64,
}

impl Copies {
    /// Measures with buffers of this size.
    ///
    /// # Errors
    /// No memory, or a lost device.
    pub(crate) fn measure(vulkan: &Rc<Vulkan>, bytes: u64, effort: Effort) -> Result<Self, VulkanError> {
        let (from, to) = (Buffer::on_device(vulkan, bytes)?, Buffer::on_device(vulkan, bytes)?);
        let rate = |took: Vec<Took>| {
            let ms = Spread::from_times(took.iter().map(|took| took.gpu)).median;
            2.0 * bytes as f64 / (ms * 1e-3)
        };
        let command = rate(effort.repeat(|_| to.copy_from(&from))?);
        let layout = Layout::new(vulkan, vk::ShaderStageFlags::COMPUTE)?;
        let bound = layout.bind(vulkan, [&from, &to])?;
        let pipeline = pipeline(vulkan, &layout)?;
        let workgroups = (bytes / 16).div_ceil(256) as u32;
        let (width, compute) = (workgroups.min(32768), vk::PipelineBindPoint::COMPUTE);
        let copy = |commands: vk::CommandBuffer| unsafe {
            let device = &vulkan.device;
            device.cmd_bind_pipeline(commands, compute, pipeline.handle);
            device.cmd_bind_descriptor_sets(commands, compute, layout.pipeline.handle, 0, &[bound.set], &[]);
            device.cmd_dispatch(commands, width, workgroups.div_ceil(width), 1);
        };
        let shader = rate(effort.repeat(|_| vulkan.run(copy))?);
        Ok(Self { bytes, command, shader })
    }

    /// The larger of the two.
    pub(crate) fn best(&self) -> f64 {
        self.command.max(self.shader)
    }
}

fn pipeline(vulkan: &Rc<Vulkan>, layout: &Layout) -> Result<Owned<vk::Pipeline>, VulkanError> {
    let module = module(vulkan, COPY)?;
    let stage = vk::PipelineShaderStageCreateInfo::default()
        .stage(vk::ShaderStageFlags::COMPUTE)
        .module(module.handle)
        .name(c"main");
    let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout.pipeline.handle);
    let made = unsafe { vulkan.device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
    let handle = made.map_err(|(_, error)| error)?[0];
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_pipeline(handle, None) }))
}
