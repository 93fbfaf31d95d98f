//! Render passes.

use std::rc::Rc;

use ash::vk;

use super::device::{Vulkan, VulkanError};
use super::memory::Owned;

/// A render pass with its framebuffer.
pub(crate) struct Pass {
    pass: Owned<vk::RenderPass>,
    framebuffer: Owned<vk::Framebuffer>,
    size: [u32; 2],
    clears: Vec<vk::ClearValue>,
}

impl Pass {
    /// Makes a pass without any picture, for pipelines that don't rasterise.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn nowhere(vulkan: &Rc<Vulkan>) -> Result<Self, VulkanError> {
        let subpasses = [vk::SubpassDescription::default().pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)];
        Self::new(vulkan, &vk::RenderPassCreateInfo::default().subpasses(&subpasses), &[], [1, 1], Vec::new())
    }

    /// Makes a pass that draws into pictures of this width and height in px, and clears them to these values.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn new(
        vulkan: &Rc<Vulkan>,
        info: &vk::RenderPassCreateInfo,
        views: &[vk::ImageView],
        [width, height]: [u32; 2],
        clears: Vec<vk::ClearValue>,
    ) -> Result<Self, VulkanError> {
        unsafe {
            let pass = vulkan.device.create_render_pass(info, None)?;
            let pass = Owned::new(vulkan, pass, |device, handle| device.destroy_render_pass(handle, None));
            let framebuffer = vk::FramebufferCreateInfo::default()
                .render_pass(pass.handle)
                .attachments(views)
                .width(width)
                .height(height)
                .layers(1);
            let framebuffer = vulkan.device.create_framebuffer(&framebuffer, None)?;
            let framebuffer =
                Owned::new(vulkan, framebuffer, |device, handle| device.destroy_framebuffer(handle, None));
            Ok(Self { pass, framebuffer, size: [width, height], clears })
        }
    }

    pub(crate) fn handle(&self) -> vk::RenderPass {
        self.pass.handle
    }

    /// Begins the pass and clears its pictures.
    ///
    /// # Safety
    /// `commands` is being recorded, on this pass's device.
    pub(crate) unsafe fn begin(&self, device: &ash::Device, commands: vk::CommandBuffer) {
        let [width, height] = self.size;
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(self.pass.handle)
            .framebuffer(self.framebuffer.handle)
            .render_area(vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() })
            .clear_values(&self.clears);
        unsafe { device.cmd_begin_render_pass(commands, &info, vk::SubpassContents::INLINE) };
    }
}
