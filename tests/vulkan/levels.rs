//! The compute shader of an export that finds the mip levels at points, which runs before the patches are drawn.

use std::ffi::CStr;
use std::rc::Rc;

use ash::vk;

use super::bindings::{Resource, layout, pipeline_layout, set};
use super::device::{Vulkan, VulkanError};
use super::memory::{Buffer, Owned};
use super::stages::{Drawn, Exported, StageError, compiled, module};

/// Runs the compute shader if the export has one. Returns the levels, a number for each corner.
///
/// # Errors
/// The text doesn't compile, or the driver doesn't take it.
pub(crate) fn levels(vulkan: &Rc<Vulkan>, exported: Exported, drawn: &Drawn) -> Result<Option<Buffer>, StageError> {
    let Some(displaced) = drawn.displaced else { return Ok(None) };
    let Some(text) = displaced.levels else { return Ok(None) };
    let (code, entry) = code(exported, text)?;
    let constants = Buffer::filled(vulkan, drawn.constants)?;
    let height_constants = Buffer::filled(vulkan, &displaced.constants)?;
    let (vertices, indices) = (Buffer::filled(vulkan, drawn.vertices)?, Buffer::filled(vulkan, drawn.indices)?);
    // HLSL is told how many patches there are, and GLSL asks the index buffer.
    let patches = drawn.indices.len() as u32 / drawn.per_patch;
    let patch_count = Buffer::filled(vulkan, &[patches, 0, 0, 0])?;
    // What other views have left.
    let levels = Buffer::filled(vulkan, &vec![u32::MAX; drawn.vertices.len()])?;
    let bound = [
        (0, Resource::Uniform(&constants)),
        (1, Resource::Uniform(&height_constants)),
        (2, Resource::Storage(&vertices)),
        (3, Resource::Storage(&indices)),
        (4, Resource::Storage(&levels)),
        (5, Resource::Uniform(&patch_count)),
    ];
    let layout = layout(vulkan, &bound, vk::ShaderStageFlags::COMPUTE)?;
    let pipeline_layout = pipeline_layout(vulkan, layout.handle, &[])?;
    let (_pool, set) = set(vulkan, layout.handle, &bound)?;
    let pipeline = pipeline(vulkan, &code, entry, pipeline_layout.handle)?;
    let groups = patches.div_ceil(64);
    let device = &vulkan.device;
    vulkan.run(|commands| unsafe {
        let between = |from, to| barrier(device, commands, from, to);
        let (fill, compute) = (vk::PipelineStageFlags::TRANSFER, vk::PipelineStageFlags::COMPUTE_SHADER);
        let (written, read) = (vk::AccessFlags::SHADER_WRITE, vk::AccessFlags::SHADER_READ);
        device.cmd_fill_buffer(commands, levels.handle, 0, vk::WHOLE_SIZE, 0);
        between((fill, vk::AccessFlags::TRANSFER_WRITE), (compute, read | written));
        device.cmd_bind_pipeline(commands, vk::PipelineBindPoint::COMPUTE, pipeline.handle);
        let point = vk::PipelineBindPoint::COMPUTE;
        device.cmd_bind_descriptor_sets(commands, point, pipeline_layout.handle, 0, &[set], &[]);
        device.cmd_dispatch(commands, groups.min(65_535), groups.div_ceil(65_535), 1);
        let input = (vk::PipelineStageFlags::VERTEX_INPUT, vk::AccessFlags::VERTEX_ATTRIBUTE_READ);
        between((compute, written), input);
    })?;
    Ok(Some(levels))
}

/// Compiles the text, which is in the language of the other stages. Returns its SPIR-V and the name of its entry point.
fn code(exported: Exported, text: &str) -> Result<(Vec<u8>, &'static CStr), StageError> {
    let folder = tempfile::tempdir()?;
    let (file, options, entry): (_, &[&str], _) = match exported {
        Exported::Glsl { .. } => ("levels.comp", &[], c"main"),
        Exported::Hlsl(_) => {
            let options = &["-D", "-S", "comp", "-e", "levels_main", "--source-entrypoint", "levels_main"];
            ("levels.hlsl", options, c"levels_main")
        }
    };
    Ok((compiled(folder.path(), file, text, options)?, entry))
}

/// What a stage does with memory.
type Access = (vk::PipelineStageFlags, vk::AccessFlags);

/// Records that what was written before is seen after.
unsafe fn barrier(device: &ash::Device, commands: vk::CommandBuffer, before: Access, after: Access) {
    let own = [vk::MemoryBarrier::default().src_access_mask(before.1).dst_access_mask(after.1)];
    let flags = vk::DependencyFlags::empty();
    unsafe { device.cmd_pipeline_barrier(commands, before.0, after.0, flags, &own, &[], &[]) };
}

fn pipeline(
    vulkan: &Rc<Vulkan>,
    code: &[u8],
    entry: &CStr,
    layout: vk::PipelineLayout,
) -> Result<Owned<vk::Pipeline>, VulkanError> {
    let module = module(vulkan, code)?;
    let stage = vk::PipelineShaderStageCreateInfo::default().stage(vk::ShaderStageFlags::COMPUTE);
    let stage = stage.module(module.handle).name(entry);
    let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
    let made = unsafe { vulkan.device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
    let handle = made.map_err(|(_, error)| error)?[0];
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_pipeline(handle, None) }))
}
