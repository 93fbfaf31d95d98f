//! Exported shaders on the driver's own tessellation stages. A geometry shader, which is ours, writes down what comes out of the
//! domain shader.

use std::path::Path;
use std::process::Command;
use std::rc::Rc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use thiserror::Error;

use super::device::{Vulkan, VulkanError};
use super::memory::{Buffer, Owned};
use super::pass::Pass;

/// Why exported shaders didn't run.
#[derive(Debug, Error)]
pub enum StageError {
    #[error(transparent)]
    Vulkan(#[from] VulkanError),
    #[error("glslangValidator can't be run ({0}): install glslang-tools, as ./setup.sh does")]
    NoCompiler(std::io::Error),
    #[error("{file} doesn't compile: {messages}")]
    Compiler { file: &'static str, messages: String },
    #[error("a file can't be written or read ({0})")]
    File(#[from] std::io::Error),
}

/// The texts of exported shaders.
#[derive(Clone, Copy, Debug)]
pub enum Exported<'a> {
    Glsl { vertex: &'a str, control: &'a str, evaluation: &'a str },
    Hlsl(&'a str),
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<'a> {
    /// Position, normal and texture coordinates of every corner.
    pub vertices: &'a [[f32; 8]],
    pub indices: &'a [u32],
    pub per_patch: u32,
    /// The contents of the constant buffer.
    pub constants: &'a [f32; 48],
    /// For so many triangles there is room.
    pub room: usize,
}

/// What came out of the domain shader at a corner of a triangle.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct CapturedCorner {
    pub position: [f32; 4],
    pub normal: [f32; 4],
    pub uv: [f32; 4],
    /// The domain point's U, V and W, and the patch.
    pub place: [f32; 4],
    /// The factors that the hull shader wrote: of the three edges, and inside.
    pub factors: [f32; 4],
}

/// What comes before the corners in the buffer: how many triangles there were, and for how many there is room.
const HEAD_BYTES: usize = 16;

/// What is appended to the exported evaluation stage: two outputs more. Texture coordinates hold the patch: see [`marked`].
const GLSL_CAPTURE: &str = "
#undef main
layout(location = 3) out vec4 captured_place;
layout(location = 4) out vec4 captured_factors;
void main() {
    exported_main();
    captured_place = vec4(gl_TessCoord, round(uv.x));
    captured_factors = vec4(gl_TessLevelOuter[0], gl_TessLevelOuter[1], gl_TessLevelOuter[2], gl_TessLevelInner[0]);
}
";

/// The same for a domain shader.
const HLSL_CAPTURE: &str = "
struct CapturedVertex
{
    Vertex vertex;
    float4 captured_place : CAPTURED_PLACE;
    float4 captured_factors : CAPTURED_FACTORS;
};

[domain(\"tri\")]
CapturedVertex captured_main(
    PatchFactors factors,
    float3 location : SV_DomainLocation,
    const OutputPatch<Corner, 3> corners)
{
    CapturedVertex captured;
    captured.vertex = ds_main(factors, location, corners);
    captured.captured_place = float4(location, round(captured.vertex.uv.x));
    captured.captured_factors = float4(factors.edges[0], factors.edges[1], factors.edges[2], factors.inside);
    return captured;
}
";

const GEOMETRY: &str = "#version 450
layout(triangles) in;
layout(points, max_vertices = 1) out;
layout(location = 0) in vec3 position[];
layout(location = 1) in vec3 normal[];
layout(location = 2) in vec2 uv[];
layout(location = 3) in vec4 place[];
layout(location = 4) in vec4 factors[];
struct Corner {
    vec4 position;
    vec4 normal;
    vec4 uv;
    vec4 place;
    vec4 factors;
};
layout(std430, set = 0, binding = 1) buffer Captured {
    uint count;
    uint room;
    uvec2 unused;
    Corner corners[];
};
void main() {
    uint at = atomicAdd(count, 1u);
    if (at < room) {
        for (int k = 0; k < 3; k++) {
            corners[3u * at + uint(k)] = Corner(
                vec4(position[k], 1.0), vec4(normal[k], 0.0), vec4(uv[k], 0.0, 0.0), place[k], factors[k]);
        }
    }
}
";

/// A stage with its SPIR-V.
struct Stage {
    flag: vk::ShaderStageFlags,
    code: Vec<u8>,
}

/// Compiles one text. `options` say its language, stage and entry point.
fn compiled(folder: &Path, file: &'static str, text: &str, options: &[&str]) -> Result<Vec<u8>, StageError> {
    let (source, out) = (folder.join(file), folder.join("out.spv"));
    std::fs::write(&source, text)?;
    let made = Command::new("glslangValidator").arg("-V").args(options).arg(&source).arg("-o").arg(&out).output();
    let made = made.map_err(StageError::NoCompiler)?;
    if !made.status.success() {
        return Err(StageError::Compiler { file, messages: String::from_utf8_lossy(&made.stdout).into_owned() });
    }
    Ok(std::fs::read(out)?)
}

impl Exported<'_> {
    /// The stages in the order of the pipeline.
    fn compile(self) -> Result<Vec<Stage>, StageError> {
        let folder = tempfile::tempdir()?;
        let at = folder.path();
        let [vertex, control, evaluation] = match self {
            Exported::Glsl { vertex, control, evaluation } => {
                // The file as it was exported must compile, too.
                compiled(at, "patch.tese", evaluation, &[])?;
                let captured = evaluation.to_owned() + GLSL_CAPTURE;
                [
                    compiled(at, "patch.vert", vertex, &[])?,
                    compiled(at, "patch.tesc", control, &[])?,
                    compiled(at, "captured.tese", &captured, &["-Dmain=exported_main"])?,
                ]
            }
            Exported::Hlsl(text) => {
                let of = |file, text: &str, stage, entry| {
                    compiled(at, file, text, &["-D", "-S", stage, "-e", entry, "--source-entrypoint", entry])
                };
                of("patch.hlsl", text, "tese", "ds_main")?;
                [
                    of("patch.hlsl", text, "vert", "vs_main")?,
                    of("patch.hlsl", text, "tesc", "hs_main")?,
                    of("captured.hlsl", &(text.to_owned() + HLSL_CAPTURE), "tese", "captured_main")?,
                ]
            }
        };
        Ok(vec![
            Stage { flag: vk::ShaderStageFlags::VERTEX, code: vertex },
            Stage { flag: vk::ShaderStageFlags::TESSELLATION_CONTROL, code: control },
            Stage { flag: vk::ShaderStageFlags::TESSELLATION_EVALUATION, code: evaluation },
            Stage { flag: vk::ShaderStageFlags::GEOMETRY, code: compiled(at, "capture.geom", GEOMETRY, &[])? },
        ])
    }

    /// The names of the entry points in SPIR-V.
    fn entries(self) -> [&'static std::ffi::CStr; 4] {
        match self {
            Exported::Glsl { .. } => [c"main"; 4],
            Exported::Hlsl(_) => [c"vs_main", c"hs_main", c"captured_main", c"main"],
        }
    }

    /// Draws patches, and returns every triangle that the tessellator made.
    ///
    /// # Errors
    /// A text doesn't compile, or the driver doesn't take it.
    pub fn capture(self, vulkan: &Rc<Vulkan>, drawn: &Drawn) -> Result<Vec<[CapturedCorner; 3]>, StageError> {
        let stages = self.compile()?;
        let nowhere = Pass::nowhere(vulkan)?;
        let set = Bindings::new(vulkan, drawn)?;
        let pipeline = pipeline(vulkan, &set, nowhere.handle(), &stages, self.entries(), drawn.per_patch)?;
        let vertices = Buffer::filled(vulkan, &marked(drawn))?;
        let indices: Vec<_> = (0..drawn.indices.len() as u32).collect();
        let indices = Buffer::filled(vulkan, &indices)?;
        let device = &vulkan.device;
        vulkan.run(|commands| unsafe {
            nowhere.begin(device, commands);
            let graphics = vk::PipelineBindPoint::GRAPHICS;
            device.cmd_bind_pipeline(commands, graphics, pipeline.handle);
            device.cmd_bind_descriptor_sets(commands, graphics, set.pipeline.handle, 0, &[set.set], &[]);
            device.cmd_bind_vertex_buffers(commands, 0, &[vertices.handle], &[0]);
            device.cmd_bind_index_buffer(commands, indices.handle, 0, vk::IndexType::UINT32);
            device.cmd_draw_indexed(commands, drawn.indices.len() as u32, 1, 0, 0, 0);
            device.cmd_end_render_pass(commands);
        })?;
        set.triangles(vulkan, drawn.room)
    }
}

/// The vertices in the order of the indices, each with its patch as texture coordinate u. The stages have the patch's number, too, but
/// glslang doesn't know it in HLSL's domain shaders, and Mesa 22.3 counts it from 0 again in every batch of a draw.
fn marked(drawn: &Drawn) -> Vec<[f32; 8]> {
    let of_patch = |(at, &index): (usize, &u32)| {
        let [x, y, z, nx, ny, nz, ..] = drawn.vertices[index as usize];
        [x, y, z, nx, ny, nz, (at / drawn.per_patch as usize) as f32, 0.0]
    };
    drawn.indices.iter().enumerate().map(of_patch).collect()
}

/// The constants and the captured triangles, bound.
struct Bindings {
    _layout: Owned<vk::DescriptorSetLayout>,
    _pool: Owned<vk::DescriptorPool>,
    pipeline: Owned<vk::PipelineLayout>,
    set: vk::DescriptorSet,
    _constants: Buffer,
    captured: Buffer,
}

impl Bindings {
    fn new(vulkan: &Rc<Vulkan>, drawn: &Drawn) -> Result<Self, VulkanError> {
        let constants = Buffer::filled(vulkan, drawn.constants)?;
        let mut head = vec![0u8; HEAD_BYTES + drawn.room * size_of::<[CapturedCorner; 3]>()];
        head[4..8].copy_from_slice(&(drawn.room as u32).to_le_bytes());
        let captured = Buffer::filled(vulkan, &head)?;
        let tessellation = vk::ShaderStageFlags::TESSELLATION_CONTROL | vk::ShaderStageFlags::TESSELLATION_EVALUATION;
        let kinds = [
            (vk::DescriptorType::UNIFORM_BUFFER, tessellation, &constants),
            (vk::DescriptorType::STORAGE_BUFFER, vk::ShaderStageFlags::GEOMETRY, &captured),
        ];
        let bindings: Vec<_> = (0..)
            .zip(kinds)
            .map(|(binding, (kind, stages, _))| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding)
                    .descriptor_type(kind)
                    .descriptor_count(1)
                    .stage_flags(stages)
            })
            .collect();
        let sizes = kinds.map(|(kind, ..)| vk::DescriptorPoolSize::default().ty(kind).descriptor_count(1));
        let device = &vulkan.device;
        unsafe {
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let layout = device.create_descriptor_set_layout(&info, None)?;
            let layout =
                Owned::new(vulkan, layout, |device, handle| device.destroy_descriptor_set_layout(handle, None));
            let layouts = [layout.handle];
            let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts);
            let pipeline = device.create_pipeline_layout(&info, None)?;
            let pipeline = Owned::new(vulkan, pipeline, |device, handle| device.destroy_pipeline_layout(handle, None));
            let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
            let pool = device.create_descriptor_pool(&info, None)?;
            let pool = Owned::new(vulkan, pool, |device, handle| device.destroy_descriptor_pool(handle, None));
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool.handle).set_layouts(&layouts);
            let set = device.allocate_descriptor_sets(&info)?[0];
            for (binding, (kind, _, buffer)) in (0..).zip(kinds) {
                let whole = [vk::DescriptorBufferInfo::default().buffer(buffer.handle).range(vk::WHOLE_SIZE)];
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(binding)
                    .descriptor_type(kind)
                    .buffer_info(&whole);
                device.update_descriptor_sets(&[write], &[]);
            }
            Ok(Self { _layout: layout, _pool: pool, pipeline, set, _constants: constants, captured })
        }
    }

    /// Reads the captured triangles back.
    fn triangles(&self, vulkan: &Rc<Vulkan>, room: usize) -> Result<Vec<[CapturedCorner; 3]>, StageError> {
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

/// A pipeline that ends before the rasteriser.
fn pipeline(
    vulkan: &Rc<Vulkan>,
    set: &Bindings,
    pass: vk::RenderPass,
    stages: &[Stage],
    entries: [&std::ffi::CStr; 4],
    per_patch: u32,
) -> Result<Owned<vk::Pipeline>, VulkanError> {
    let modules = stages.iter().map(|stage| module(vulkan, &stage.code)).collect::<Result<Vec<_>, _>>()?;
    let stages: Vec<_> = stages
        .iter()
        .zip(&modules)
        .zip(entries)
        .map(|((stage, module), entry)| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage.flag).module(module.handle).name(entry)
        })
        .collect();
    let bindings = [vk::VertexInputBindingDescription::default().stride(32)];
    let attribute = |location, format, offset| {
        vk::VertexInputAttributeDescription::default().location(location).format(format).offset(offset)
    };
    let attributes = [
        attribute(0, vk::Format::R32G32B32_SFLOAT, 0),
        attribute(1, vk::Format::R32G32B32_SFLOAT, 12),
        attribute(2, vk::Format::R32G32_SFLOAT, 24),
    ];
    let vertices = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&bindings)
        .vertex_attribute_descriptions(&attributes);
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::PATCH_LIST);
    let tessellation = vk::PipelineTessellationStateCreateInfo::default().patch_control_points(per_patch);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().rasterizer_discard_enable(true).line_width(1.0);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&vertices)
        .input_assembly_state(&assembly)
        .tessellation_state(&tessellation)
        .rasterization_state(&raster)
        .layout(set.pipeline.handle)
        .render_pass(pass);
    let made = unsafe { vulkan.device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    let handle = made.map_err(|(_, error)| error)?[0];
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_pipeline(handle, None) }))
}

/// Makes a shader module from SPIR-V.
///
/// # Errors
/// It isn't SPIR-V, or the driver doesn't take it.
pub fn module(vulkan: &Rc<Vulkan>, code: &[u8]) -> Result<Owned<vk::ShaderModule>, VulkanError> {
    let words = ash::util::read_spv(&mut std::io::Cursor::new(code))?;
    let info = vk::ShaderModuleCreateInfo::default().code(&words);
    let handle = unsafe { vulkan.device.create_shader_module(&info, None)? };
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_shader_module(handle, None) }))
}
