//! What exported stages read, and the buffer into which their triangles are captured, bound.

use std::rc::Rc;

use ash::vk;

use super::device::{Vulkan, VulkanError};
use super::height_image::HeightImage;
use super::memory::{Buffer, Owned};
use super::stages::{CapturedCorner, Drawn, HEAD_BYTES, StageError};

/// The binding of the captured triangles, behind those of exported files.
pub const CAPTURED_BINDING: u32 = 3;

/// What is bound somewhere.
enum Resource<'a> {
    Uniform(&'a Buffer),
    Storage(&'a Buffer),
    Image(&'a HeightImage),
}

/// The constants, the height image and the captured triangles, bound.
pub struct Bindings {
    _layout: Owned<vk::DescriptorSetLayout>,
    _pool: Owned<vk::DescriptorPool>,
    pub pipeline: Owned<vk::PipelineLayout>,
    pub set: vk::DescriptorSet,
    _constants: Buffer,
    _relief: Option<(Buffer, HeightImage)>,
    captured: Buffer,
}

impl Bindings {
    /// `samples`: the height image comes with a sampler, as GLSL has it.
    ///
    /// # Errors
    /// No memory, or a lost device.
    pub fn new(vulkan: &Rc<Vulkan>, drawn: &Drawn, samples: bool) -> Result<Self, VulkanError> {
        let constants = Buffer::filled(vulkan, drawn.constants)?;
        let relief = match drawn.displaced {
            Some(own) => Some((Buffer::filled(vulkan, &own.constants)?, HeightImage::new(vulkan, own.map)?)),
            None => None,
        };
        let mut head = vec![0u8; HEAD_BYTES + drawn.room * size_of::<[CapturedCorner; 3]>()];
        head[4..8].copy_from_slice(&(drawn.room as u32).to_le_bytes());
        let captured = Buffer::filled(vulkan, &head)?;
        let mut bound = vec![(0, Resource::Uniform(&constants)), (CAPTURED_BINDING, Resource::Storage(&captured))];
        if let Some((constants, image)) = &relief {
            bound.extend([(1, Resource::Uniform(constants)), (2, Resource::Image(image))]);
        }
        let image =
            if samples { vk::DescriptorType::COMBINED_IMAGE_SAMPLER } else { vk::DescriptorType::SAMPLED_IMAGE };
        let layout = layout(vulkan, &bound, image)?;
        let pipeline = pipeline_layout(vulkan, layout.handle)?;
        let (pool, set) = set(vulkan, layout.handle, &bound, image)?;
        Ok(Self { _layout: layout, _pool: pool, pipeline, set, _constants: constants, _relief: relief, captured })
    }

    /// Reads the captured triangles back.
    ///
    /// # Errors
    /// The device was lost.
    pub fn triangles(&self, vulkan: &Rc<Vulkan>, room: usize) -> Result<Vec<[CapturedCorner; 3]>, StageError> {
        let staging = Buffer::for_host(vulkan, self.captured.bytes)?;
        staging.copy_from(&self.captured)?;
        let read = |bytes: &mut [u8]| {
            let count: u32 = bytemuck::pod_read_unaligned(&bytes[..4]);
            let end = HEAD_BYTES + room.min(count as usize) * size_of::<[CapturedCorner; 3]>();
            bytemuck::pod_collect_to_vec(&bytes[HEAD_BYTES..end])
        };
        Ok(staging.with_host(read)?)
    }
}

/// The kind of a resource; `image` is that of images.
fn kind(resource: &Resource, image: vk::DescriptorType) -> vk::DescriptorType {
    match resource {
        Resource::Uniform(_) => vk::DescriptorType::UNIFORM_BUFFER,
        Resource::Storage(_) => vk::DescriptorType::STORAGE_BUFFER,
        Resource::Image(_) => image,
    }
}

fn layout(
    vulkan: &Rc<Vulkan>,
    bound: &[(u32, Resource)],
    image: vk::DescriptorType,
) -> Result<Owned<vk::DescriptorSetLayout>, VulkanError> {
    let stages = vk::ShaderStageFlags::TESSELLATION_CONTROL
        | vk::ShaderStageFlags::TESSELLATION_EVALUATION
        | vk::ShaderStageFlags::GEOMETRY;
    let binding = |(binding, resource): &(u32, Resource)| {
        let own = vk::DescriptorSetLayoutBinding::default().binding(*binding).descriptor_count(1);
        own.descriptor_type(kind(resource, image)).stage_flags(stages)
    };
    let bindings: Vec<_> = bound.iter().map(binding).collect();
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    let handle = unsafe { vulkan.device.create_descriptor_set_layout(&info, None)? };
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_descriptor_set_layout(handle, None) }))
}

/// The geometry shader gets the number of the patch as a push constant.
fn pipeline_layout(
    vulkan: &Rc<Vulkan>,
    layout: vk::DescriptorSetLayout,
) -> Result<Owned<vk::PipelineLayout>, VulkanError> {
    let layouts = [layout];
    let number = [vk::PushConstantRange::default().stage_flags(vk::ShaderStageFlags::GEOMETRY).size(4)];
    let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&number);
    let handle = unsafe { vulkan.device.create_pipeline_layout(&info, None)? };
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_pipeline_layout(handle, None) }))
}

fn set(
    vulkan: &Rc<Vulkan>,
    layout: vk::DescriptorSetLayout,
    bound: &[(u32, Resource)],
    image: vk::DescriptorType,
) -> Result<(Owned<vk::DescriptorPool>, vk::DescriptorSet), VulkanError> {
    let size = |(_, own): &(u32, Resource)| vk::DescriptorPoolSize::default().ty(kind(own, image)).descriptor_count(1);
    let sizes: Vec<_> = bound.iter().map(size).collect();
    let device = &vulkan.device;
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
    let pool = unsafe { device.create_descriptor_pool(&info, None)? };
    let pool = Owned::new(vulkan, pool, |device, handle| unsafe { device.destroy_descriptor_pool(handle, None) });
    let layouts = [layout];
    let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool.handle).set_layouts(&layouts);
    let set = unsafe { device.allocate_descriptor_sets(&info)?[0] };
    for (binding, resource) in bound {
        let write = vk::WriteDescriptorSet::default().dst_set(set).dst_binding(*binding);
        let write = write.descriptor_type(kind(resource, image));
        let (buffers, images);
        let write = match resource {
            Resource::Uniform(buffer) | Resource::Storage(buffer) => {
                buffers = [vk::DescriptorBufferInfo::default().buffer(buffer.handle).range(vk::WHOLE_SIZE)];
                write.buffer_info(&buffers)
            }
            Resource::Image(own) => {
                images = [own.descriptor()];
                write.image_info(&images)
            }
        };
        unsafe { device.update_descriptor_sets(&[write], &[]) };
    }
    Ok((pool, set))
}
