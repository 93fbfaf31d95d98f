//! A height map on the device, as exported shaders read it: a picture of one channel with all its levels.

use std::rc::Rc;

use ash::vk;
use geometry::mesh::HeightMap;

use super::device::{Vulkan, VulkanError};
use super::memory::{Buffer, Owned, Picture};

/// The picture, and a sampler that filters nothing.
pub(crate) struct HeightImage {
    picture: Picture,
    sampler: Owned<vk::Sampler>,
}

impl HeightImage {
    /// Uploads a map.
    ///
    /// # Errors
    /// No memory, or a lost device.
    pub(crate) fn new(vulkan: &Rc<Vulkan>, map: &HeightMap) -> Result<Self, VulkanError> {
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let format = vk::Format::R32_SFLOAT;
        let picture = Picture::with_levels(vulkan, map.size, map.levels, format, vk::SampleCountFlags::TYPE_1, usage)?;
        upload(vulkan, &picture, map)?;
        let info = vk::SamplerCreateInfo::default().max_lod(vk::LOD_CLAMP_NONE);
        let sampler = unsafe { vulkan.device.create_sampler(&info, None)? };
        let destroy = |device: &ash::Device, handle| unsafe { device.destroy_sampler(handle, None) };
        Ok(Self { picture, sampler: Owned::new(vulkan, sampler, destroy) })
    }

    pub(crate) fn descriptor(&self) -> vk::DescriptorImageInfo {
        let own = vk::DescriptorImageInfo::default().image_view(self.picture.view).sampler(self.sampler.handle);
        own.image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
    }
}

/// Copies the levels, which lie one after another in the map, to the picture's.
fn upload(vulkan: &Rc<Vulkan>, picture: &Picture, map: &HeightMap) -> Result<(), VulkanError> {
    let staging = Buffer::filled(vulkan, &map.heights)?;
    let mut start = 0;
    let copy = |level| {
        let [width, height] = map.level_size(level);
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .mip_level(level)
            .layer_count(1);
        let extent = vk::Extent3D { width, height, depth: 1 };
        let own = vk::BufferImageCopy::default().buffer_offset(start).image_subresource(layers).image_extent(extent);
        start += 4 * u64::from(width * height);
        own
    };
    let copies: Vec<_> = (0..map.levels).map(copy).collect();
    let whole = vk::ImageSubresourceRange::default()
        .aspect_mask(vk::ImageAspectFlags::COLOR)
        .level_count(map.levels)
        .layer_count(1);
    let to = |from, to| {
        let own = vk::ImageMemoryBarrier::default().image(picture.image).subresource_range(whole);
        let own = own.src_access_mask(vk::AccessFlags::MEMORY_WRITE).dst_access_mask(vk::AccessFlags::MEMORY_READ);
        [own.old_layout(from).new_layout(to)]
    };
    let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    let device = &vulkan.device;
    vulkan.run(|commands| unsafe {
        let barrier = |barriers: &[vk::ImageMemoryBarrier]| {
            let all = vk::PipelineStageFlags::ALL_COMMANDS;
            device.cmd_pipeline_barrier(commands, all, all, vk::DependencyFlags::empty(), &[], &[], barriers);
        };
        barrier(&to(vk::ImageLayout::UNDEFINED, target));
        device.cmd_copy_buffer_to_image(commands, staging.handle, picture.image, target, &copies);
        barrier(&to(target, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL));
    })?;
    Ok(())
}
