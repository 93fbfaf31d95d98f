//! What exported stages read, and the buffer into which their triangles are captured, bound.

use std::rc::Rc;

use ash::vk;

use super::device::{Vulkan, VulkanError};
use super::height_image::HeightImage;
use super::memory::{Buffer, Owned};
use super::stages::{CapturedCorner, Drawn, HEAD_BYTES, StageError};

/// The binding of the captured triangles, behind those of exported files.
pub(crate) const CAPTURED_BINDING: u32 = 3;

/// What is bound somewhere. An image may come with a sampler, as GLSL has it.
pub(crate) enum Resource<'a> {
    Uniform(&'a Buffer),
    Storage(&'a Buffer),
    Image(&'a HeightImage, vk::DescriptorType),
}

/// Where something is bound.
pub(crate) type Bound<'a> = (u32, Resource<'a>);

/// The stages of a draw that read or write what is bound.
const DRAWING: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::TESSELLATION_CONTROL.as_raw()
        | vk::ShaderStageFlags::TESSELLATION_EVALUATION.as_raw()
        | vk::ShaderStageFlags::GEOMETRY.as_raw(),
);

/// The constants, the height image and the captured triangles, bound.
pub(crate) struct Bindings {
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
    pub(crate) fn new(vulkan: &Rc<Vulkan>, drawn: &Drawn, samples: bool) -> Result<Self, VulkanError> {
        let constants = Buffer::filled(vulkan, drawn.constants)?;
        let relief = match drawn.displaced {
            Some(own) => Some((Buffer::filled(vulkan, &own.constants)?, HeightImage::new(vulkan, own.map)?)),
            None => None,
        };
        let mut head = vec![0u8; HEAD_BYTES + drawn.room * size_of::<[CapturedCorner; 3]>()];
        head[4..8].copy_from_slice(&(drawn.room as u32).to_le_bytes());
        let captured = Buffer::filled(vulkan, &head)?;
        let mut bound = vec![(0, Resource::Uniform(&constants)), (CAPTURED_BINDING, Resource::Storage(&captured))];
        let image =
            if samples { vk::DescriptorType::COMBINED_IMAGE_SAMPLER } else { vk::DescriptorType::SAMPLED_IMAGE };
        if let Some((constants, own)) = &relief {
            bound.extend([(1, Resource::Uniform(constants)), (2, Resource::Image(own, image))]);
        }
        let layout = layout(vulkan, &bound, DRAWING)?;
        // The geometry shader gets the number of the patch as a push constant.
        let number = [vk::PushConstantRange::default().stage_flags(vk::ShaderStageFlags::GEOMETRY).size(4)];
        let pipeline = pipeline_layout(vulkan, layout.handle, &number)?;
        let (pool, set) = set(vulkan, layout.handle, &bound)?;
        Ok(Self { _layout: layout, _pool: pool, pipeline, set, _constants: constants, _relief: relief, captured })
    }

    /// Reads the captured triangles back.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn triangles(&self, vulkan: &Rc<Vulkan>, room: usize) -> Result<Vec<[CapturedCorner; 3]>, StageError> {
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

fn kind(resource: &Resource) -> vk::DescriptorType {
    match resource {
        Resource::Uniform(_) => vk::DescriptorType::UNIFORM_BUFFER,
        Resource::Storage(_) => vk::DescriptorType::STORAGE_BUFFER,
        Resource::Image(_, kind) => *kind,
    }
}

/// Makes the layout of what is bound in these stages.
///
/// # Errors
/// No memory.
pub(crate) fn layout(
    vulkan: &Rc<Vulkan>,
    bound: &[Bound],
    stages: vk::ShaderStageFlags,
) -> Result<Owned<vk::DescriptorSetLayout>, VulkanError> {
    let binding = |(binding, resource): &Bound| {
        let own = vk::DescriptorSetLayoutBinding::default().binding(*binding).descriptor_count(1);
        own.descriptor_type(kind(resource)).stage_flags(stages)
    };
    let bindings: Vec<_> = bound.iter().map(binding).collect();
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    let handle = unsafe { vulkan.device.create_descriptor_set_layout(&info, None)? };
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_descriptor_set_layout(handle, None) }))
}

/// Makes the layout of a pipeline with one set and these push constants.
///
/// # Errors
/// No memory.
pub(crate) fn pipeline_layout(
    vulkan: &Rc<Vulkan>,
    layout: vk::DescriptorSetLayout,
    pushed: &[vk::PushConstantRange],
) -> Result<Owned<vk::PipelineLayout>, VulkanError> {
    let layouts = [layout];
    let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(pushed);
    let handle = unsafe { vulkan.device.create_pipeline_layout(&info, None)? };
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_pipeline_layout(handle, None) }))
}

/// Binds. The set is one of the pool's, which must live as long.
///
/// # Errors
/// No memory.
pub(crate) fn set(
    vulkan: &Rc<Vulkan>,
    layout: vk::DescriptorSetLayout,
    bound: &[Bound],
) -> Result<(Owned<vk::DescriptorPool>, vk::DescriptorSet), VulkanError> {
    let size = |(_, own): &Bound| vk::DescriptorPoolSize::default().ty(kind(own)).descriptor_count(1);
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
        let write = write.descriptor_type(kind(resource));
        let (buffers, images);
        let write = match resource {
            Resource::Uniform(buffer) | Resource::Storage(buffer) => {
                buffers = [vk::DescriptorBufferInfo::default().buffer(buffer.handle).range(vk::WHOLE_SIZE)];
                write.buffer_info(&buffers)
            }
            Resource::Image(own, _) => {
                images = [own.descriptor()];
                write.image_info(&images)
            }
        };
        unsafe { device.update_descriptor_sets(&[write], &[]) };
    }
    Ok((pool, set))
}
