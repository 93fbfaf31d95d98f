//! The peer: draws the same patches with the same factors with the driver's tessellation stages, in the same way as our draw.

use std::rc::Rc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use geometry::tessellate::hull_factors::HullFactors;
use gpu::device::Gpu;
use image::RgbaImage;

use super::memory::{Buffer, Owned};
use super::pipelines::{Bound, FRAME_STAGES, Kind, Layout, tessellating};
use super::target::Target;
use super::vulkan::pass::Pass;
use super::vulkan::{Counted, Took, Vulkan, VulkanError};

/// A corner of a patch's control net. Twin of NetCorner in shaders/net.glsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct NetCorner {
    pub position_u: [f32; 4],
    pub normal_v: [f32; 4],
    pub near_center: [f32; 4],
    pub far: [f32; 4],
}

/// The constants of a picture: its view and material. Twin of Frame in shaders/frame.glsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct PeerFrame {
    pub clip_from_object: [[f32; 4]; 4],
    pub key_light: [f32; 4],
    pub fill_light: [f32; 4],
    /// Width and height in px; the rest is unused.
    pub viewport: [f32; 4],
    pub base_color: [f32; 4],
}

/// What the peer draws with.
pub(crate) struct Peer {
    pub vulkan: Rc<Vulkan>,
    layout: Layout,
    target: Target,
    /// The pass for pipelines that don't rasterise.
    nowhere: Pass,
}

/// Patches on the peer's device.
pub(crate) struct Patches {
    _nets: Buffer,
    _factors: Buffer,
    bound: Bound,
    count: u32,
}

/// A pipeline, and its kind.
pub(crate) struct Pipeline {
    kind: Kind,
    handle: Owned<vk::Pipeline>,
}

impl Peer {
    /// Opens wgpu's device once more, with a target of the same size and samples as ours.
    ///
    /// # Errors
    /// There is no Vulkan here, or the device has no tessellation stages.
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, VulkanError> {
        let vulkan = Vulkan::new(&gpu.info)?;
        let stages = vk::ShaderStageFlags::VERTEX
            | vk::ShaderStageFlags::TESSELLATION_CONTROL
            | vk::ShaderStageFlags::TESSELLATION_EVALUATION;
        Ok(Self {
            layout: Layout::new(&vulkan, stages)?,
            target: Target::new(&vulkan, size, inspect::render::target::samples(gpu))?,
            nowhere: Pass::nowhere(&vulkan)?,
            vulkan,
        })
    }

    /// Uploads patches, three corners each, and their factors.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn patches(&self, nets: &[NetCorner], factors: &[HullFactors]) -> Result<Patches, VulkanError> {
        let nets = Buffer::filled(&self.vulkan, nets)?;
        let uploaded = Buffer::filled(&self.vulkan, factors)?;
        let bound = self.layout.bind(&self.vulkan, [&nets, &uploaded])?;
        Ok(Patches { _nets: nets, _factors: uploaded, bound, count: factors.len() as u32 })
    }

    /// Makes a pipeline.
    ///
    /// # Errors
    /// The driver can't make it.
    pub(crate) fn pipeline(&self, kind: Kind) -> Result<Pipeline, VulkanError> {
        let pass = if kind.rasterises { &self.target.pass } else { &self.nowhere };
        let handle = tessellating(&self.vulkan, &self.layout, pass.handle(), self.target.samples, kind)?;
        Ok(Pipeline { kind, handle })
    }

    /// Draws, and returns how long it took.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn draw(&self, pipeline: &Pipeline, patches: &Patches, frame: &PeerFrame) -> Result<Took, VulkanError> {
        self.vulkan.run(|commands| self.record(commands, pipeline, patches, frame))
    }

    /// Draws, and returns what the pipeline counted; `None` if the driver doesn't count.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn count(
        &self,
        pipeline: &Pipeline,
        patches: &Patches,
        frame: &PeerFrame,
    ) -> Result<Option<Counted>, VulkanError> {
        self.vulkan.count(|commands| self.record(commands, pipeline, patches, frame))
    }

    /// Reads the last picture back.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn picture(&self) -> Result<RgbaImage, VulkanError> {
        self.target.read(&self.vulkan)
    }

    fn record(&self, commands: vk::CommandBuffer, pipeline: &Pipeline, patches: &Patches, frame: &PeerFrame) {
        let device = &self.vulkan.device;
        let pass = if pipeline.kind.rasterises { &self.target.pass } else { &self.nowhere };
        let [width, height] = self.target.size.map(|side| side as f32);
        // The negative height makes +Y point up in clip space, as in wgpu.
        let viewport = vk::Viewport { x: 0.0, y: height, width, height: -height, min_depth: 0.0, max_depth: 1.0 };
        let [width, height] = self.target.size;
        let scissor = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        let points = patches.count * pipeline.kind.nets.points();
        let (layout, constants) = (self.layout.pipeline.handle, bytemuck::bytes_of(frame));
        unsafe {
            pass.begin(device, commands);
            let graphics = vk::PipelineBindPoint::GRAPHICS;
            device.cmd_bind_pipeline(commands, graphics, pipeline.handle.handle);
            device.cmd_set_viewport(commands, 0, &[viewport]);
            device.cmd_set_scissor(commands, 0, &[scissor]);
            device.cmd_bind_descriptor_sets(commands, graphics, layout, 0, &[patches.bound.set], &[]);
            device.cmd_push_constants(commands, layout, FRAME_STAGES, 0, constants);
            device.cmd_draw(commands, points, 1, 0, 0);
            device.cmd_end_render_pass(commands);
        }
    }
}
