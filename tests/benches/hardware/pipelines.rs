//! The peer's shaders, layouts and pipelines.

use std::rc::Rc;

use ash::vk;
use geometry::tessellate::Partitioning;

use super::memory::{Buffer, Owned};
use super::peer::PeerFrame;
use super::vulkan::stages::module;
use super::vulkan::{Vulkan, VulkanError};

/// How the domain shader gets a patch's control net.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Nets {
    /// As the attributes of three control points, which the vertex and hull shader pass on.
    Handed,
    /// From memory. The patch is one point without attributes.
    InMemory,
}

impl Nets {
    pub(crate) const ALL: [Self; 2] = [Self::Handed, Self::InMemory];

    /// The number of points that are drawn for a patch.
    pub(crate) fn points(self) -> u32 {
        match self {
            Self::Handed => 3,
            Self::InMemory => 1,
        }
    }
}

/// The kind of a pipeline of the peer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Kind {
    pub nets: Nets,
    /// Fractional-odd or integer.
    pub partitioning: Partitioning,
    /// Whether the rasteriser culls triangles that face away, as our draw does for solids.
    pub fronts_only: bool,
    /// False if only the stages before the rasteriser run.
    pub rasterises: bool,
}

/// A shader that shaders/compile.sh has compiled.
macro_rules! spirv {
    ($name:literal) => {
        include_bytes!(concat!("shaders/", $name, ".spv"))
    };
}

pub(crate) const COPY: &[u8] = spirv!("copy.comp");

/// The layout of two storage buffers and, except for compute, a picture's constants.
pub(crate) struct Layout {
    pub set: Owned<vk::DescriptorSetLayout>,
    pub pipeline: Owned<vk::PipelineLayout>,
}

/// The stages that read [`PeerFrame`].
pub(crate) const FRAME_STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::TESSELLATION_EVALUATION.as_raw() | vk::ShaderStageFlags::FRAGMENT.as_raw(),
);

impl Layout {
    /// Makes the layout for buffers that `stages` read or write.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn new(vulkan: &Rc<Vulkan>, stages: vk::ShaderStageFlags) -> Result<Self, VulkanError> {
        let binding = |index| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(index)
                .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                .descriptor_count(1)
                .stage_flags(stages)
        };
        let frame = [vk::PushConstantRange::default().stage_flags(FRAME_STAGES).size(size_of::<PeerFrame>() as u32)];
        let constants = if stages == vk::ShaderStageFlags::COMPUTE { &[][..] } else { &frame };
        unsafe {
            let bindings = [binding(0), binding(1)];
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let set = vulkan.device.create_descriptor_set_layout(&info, None)?;
            let set = Owned::new(vulkan, set, |device, handle| device.destroy_descriptor_set_layout(handle, None));
            let sets = [set.handle];
            let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(constants);
            let pipeline = vulkan.device.create_pipeline_layout(&info, None)?;
            let pipeline = Owned::new(vulkan, pipeline, |device, handle| device.destroy_pipeline_layout(handle, None));
            Ok(Self { set, pipeline })
        }
    }

    /// Binds two buffers. The set is freed with its pool.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn bind(&self, vulkan: &Rc<Vulkan>, buffers: [&Buffer; 2]) -> Result<Bound, VulkanError> {
        let kind = vk::DescriptorType::STORAGE_BUFFER;
        unsafe {
            let sizes = [vk::DescriptorPoolSize::default().ty(kind).descriptor_count(2)];
            let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
            let pool = vulkan.device.create_descriptor_pool(&info, None)?;
            let pool = Owned::new(vulkan, pool, |device, handle| device.destroy_descriptor_pool(handle, None));
            let sets = [self.set.handle];
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool.handle).set_layouts(&sets);
            let set = vulkan.device.allocate_descriptor_sets(&info)?[0];
            for (binding, buffer) in (0..).zip(buffers) {
                let whole = [vk::DescriptorBufferInfo::default().buffer(buffer.handle).range(vk::WHOLE_SIZE)];
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(binding)
                    .descriptor_type(kind)
                    .buffer_info(&whole);
                vulkan.device.update_descriptor_sets(&[write], &[]);
            }
            Ok(Bound { _pool: pool, set })
        }
    }
}

/// Buffers bound to a layout.
pub(crate) struct Bound {
    _pool: Owned<vk::DescriptorPool>,
    pub set: vk::DescriptorSet,
}

/// Makes a pipeline of the peer for the only subpass of `pass`.
///
/// # Errors
/// The driver can't make it.
pub(crate) fn tessellating(
    vulkan: &Rc<Vulkan>,
    layout: &Layout,
    pass: vk::RenderPass,
    samples: vk::SampleCountFlags,
    kind: Kind,
) -> Result<Owned<vk::Pipeline>, VulkanError> {
    let is_odd = kind.partitioning == Partitioning::FractionalOdd;
    let [vertex, hull, domain]: [&[u8]; 3] = match (kind.nets, is_odd) {
        (Nets::Handed, true) => [spirv!("corners.vert"), spirv!("corners.tesc"), spirv!("corners_odd.tese")],
        (Nets::Handed, false) => [spirv!("corners.vert"), spirv!("corners.tesc"), spirv!("corners_equal.tese")],
        (Nets::InMemory, true) => [spirv!("point.vert"), spirv!("point.tesc"), spirv!("point_odd.tese")],
        (Nets::InMemory, false) => [spirv!("point.vert"), spirv!("point.tesc"), spirv!("point_equal.tese")],
    };
    let modules = [
        (vk::ShaderStageFlags::VERTEX, module(vulkan, vertex)?),
        (vk::ShaderStageFlags::TESSELLATION_CONTROL, module(vulkan, hull)?),
        (vk::ShaderStageFlags::TESSELLATION_EVALUATION, module(vulkan, domain)?),
        (vk::ShaderStageFlags::FRAGMENT, module(vulkan, spirv!("surface.frag"))?),
    ];
    let stages: Vec<_> = modules
        .iter()
        .take(if kind.rasterises { 4 } else { 3 })
        .map(|(stage, module)| {
            vk::PipelineShaderStageCreateInfo::default().stage(*stage).module(module.handle).name(c"main")
        })
        .collect();
    create(vulkan, layout, pass, samples, kind, &stages)
}

/// Makes a pipeline with the state of our own draw (src/render/pipelines.rs): reversed depth, counter-clockwise front faces, and
/// the same number of samples.
fn create(
    vulkan: &Rc<Vulkan>,
    layout: &Layout,
    pass: vk::RenderPass,
    samples: vk::SampleCountFlags,
    kind: Kind,
    stages: &[vk::PipelineShaderStageCreateInfo],
) -> Result<Owned<vk::Pipeline>, VulkanError> {
    let vertices = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::PATCH_LIST);
    let tessellation = vk::PipelineTessellationStateCreateInfo::default().patch_control_points(kind.nets.points());
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let culls = if kind.fronts_only { vk::CullModeFlags::BACK } else { vk::CullModeFlags::NONE };
    let raster = vk::PipelineRasterizationStateCreateInfo::default()
        .rasterizer_discard_enable(!kind.rasterises)
        .polygon_mode(vk::PolygonMode::FILL)
        .cull_mode(culls)
        .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
        .line_width(1.0);
    let multisample = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(samples);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(true)
        .depth_compare_op(vk::CompareOp::GREATER);
    let opaque = [vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA)];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&opaque);
    let later = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&later);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(stages)
        .vertex_input_state(&vertices)
        .input_assembly_state(&assembly)
        .tessellation_state(&tessellation)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout.pipeline.handle)
        .render_pass(pass);
    let made = unsafe { vulkan.device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    let handle = made.map_err(|(_, error)| error)?[0];
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_pipeline(handle, None) }))
}
