//! What the peer draws into: colour and depth with the same number of samples as ours, resolved, or nothing.

use std::rc::Rc;

use ash::vk;
use image::RgbaImage;

use super::memory::{Buffer, Picture};
use super::vulkan::pass::Pass;
use super::vulkan::{Vulkan, VulkanError};

/// The formats of our target (src/render/target.rs).
const COLOR: vk::Format = vk::Format::R8G8B8A8_SRGB;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// The pictures for colour, depth, and resolved colour.
pub(crate) struct Target {
    pub size: [u32; 2],
    pub samples: vk::SampleCountFlags,
    pub pass: Pass,
    /// The last one is read back.
    pictures: Vec<Picture>,
}

impl Target {
    /// Makes a target of this width and height in px.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn new(vulkan: &Rc<Vulkan>, size: [u32; 2], samples: u32) -> Result<Self, VulkanError> {
        let samples = vk::SampleCountFlags::from_raw(samples);
        let one = vk::SampleCountFlags::TYPE_1;
        let shown = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let depth = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        let mut pictures = vec![
            Picture::new(vulkan, size, DEPTH, samples, depth)?,
            Picture::new(vulkan, size, COLOR, samples, shown)?,
        ];
        if samples != one {
            pictures.push(Picture::new(vulkan, size, COLOR, one, shown)?);
        }
        let views: Vec<_> = pictures.iter().map(|picture| picture.view).collect();
        let pass = drawing(vulkan, size, samples, &views)?;
        Ok(Self { size, samples, pass, pictures })
    }

    /// Reads the last picture back.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn read(&self, vulkan: &Rc<Vulkan>) -> Result<RgbaImage, VulkanError> {
        let [width, height] = self.size;
        let staging = Buffer::for_host(vulkan, u64::from(width) * u64::from(height) * 4)?;
        let color = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let region = vk::BufferImageCopy::default().image_subresource(color).image_extent(vk::Extent3D {
            width,
            height,
            depth: 1,
        });
        let (from, layout) = (&self.pictures[self.pictures.len() - 1], vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        vulkan.run(|commands| unsafe {
            vulkan.device.cmd_copy_image_to_buffer(commands, from.image, layout, staging.handle, &[region]);
        })?;
        let bytes = staging.with_host(|bytes| bytes.to_vec())?;
        Ok(RgbaImage::from_raw(width, height, bytes).unwrap_or_default())
    }
}

/// Makes the pass that draws: it clears and stores depth and colour, as our draw does, and resolves several samples.
fn drawing(
    vulkan: &Rc<Vulkan>,
    size: [u32; 2],
    samples: vk::SampleCountFlags,
    views: &[vk::ImageView],
) -> Result<Pass, VulkanError> {
    let attachment = |format, samples, load, to| {
        vk::AttachmentDescription::default()
            .format(format)
            .samples(samples)
            .load_op(load)
            .store_op(vk::AttachmentStoreOp::STORE)
            .final_layout(to)
    };
    let (clear, any) = (vk::AttachmentLoadOp::CLEAR, vk::AttachmentLoadOp::DONT_CARE);
    let resolves = views.len() == 3;
    let (drawn, shown) = (vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    let depth_layout = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    let attachments = [
        attachment(DEPTH, samples, clear, depth_layout),
        attachment(COLOR, samples, clear, if resolves { drawn } else { shown }),
        attachment(COLOR, vk::SampleCountFlags::TYPE_1, any, shown),
    ];
    let reference = |attachment, layout| vk::AttachmentReference { attachment, layout };
    let (depth, color) = (reference(0, depth_layout), [reference(1, drawn)]);
    let resolved = [reference(2, drawn)];
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&color)
        .depth_stencil_attachment(&depth);
    if resolves {
        subpass = subpass.resolve_attachments(&resolved);
    }
    let subpasses = [subpass];
    let info = vk::RenderPassCreateInfo::default().attachments(&attachments[..views.len()]).subpasses(&subpasses);
    let background = inspect::settings::Settings::default().background_color().map(linear);
    let [red, green, blue] = background;
    let color = vk::ClearValue { color: vk::ClearColorValue { float32: [red, green, blue, 1.0] } };
    // Depth is reversed.
    let depth = vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 0.0, stencil: 0 } };
    Pass::new(vulkan, &info, views, size, vec![depth, color])
}

/// Converts an sRGB byte to linear light, which a clear takes.
fn linear(byte: u8) -> f32 {
    let x = f32::from(byte) / 255.0;
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}
