//! Exported shaders on the driver's own tessellation stages. A geometry shader, which is ours, writes down what comes out of the
//! domain shader.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::rc::Rc;
use std::sync::Mutex;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use geometry::mesh::HeightMap;
use geometry::tessellate::mesh_displacement::DisplacedCorner;
use thiserror::Error;

use super::bindings::{Bindings, CAPTURED_BINDING};
use super::device::{Vulkan, VulkanError};
use super::levels::levels;
use super::memory::{Buffer, Owned};
use super::pass::Pass;

/// Why exported shaders didn't run.
#[derive(Debug, Error)]
pub(crate) enum StageError {
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
pub(crate) enum Exported<'a> {
    Glsl { vertex: &'a str, control: &'a str, evaluation: &'a str },
    Hlsl(&'a str),
}

/// What displaces, laid out as exported files say.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Displaced<'a> {
    pub corners: &'a [DisplacedCorner],
    pub map: &'a HeightMap,
    /// The contents of the second constant buffer.
    pub constants: [u32; 8],
    /// The text of the compute shader that finds the levels at points, if the export has one.
    pub levels: Option<&'a str>,
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn<'a> {
    /// Position, normal and texture coordinates of every corner.
    pub vertices: &'a [[f32; 8]],
    pub indices: &'a [u32],
    pub per_patch: u32,
    /// The contents of the constant buffer.
    pub constants: &'a [f32; 48],
    pub displaced: Option<Displaced<'a>>,
    /// For so many triangles there is room.
    pub room: usize,
}

/// What came out of the domain shader at a corner of a triangle.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct CapturedCorner {
    pub position: [f32; 4],
    pub normal: [f32; 4],
    pub uv: [f32; 4],
    /// The domain point's U, V and W, and the patch.
    pub place: [f32; 4],
    /// The factors that the hull shader wrote: of the three edges, and inside.
    pub factors: [f32; 4],
}

/// What comes before the corners in the buffer: how many triangles there were, and for how many there is room.
pub(crate) const HEAD_BYTES: usize = 16;

/// What is appended to the exported evaluation stage: two outputs more.
const GLSL_CAPTURE: &str = "
#undef main
layout(location = 3) out vec4 captured_place;
layout(location = 4) out vec4 captured_factors;
void main() {
    exported_main();
    captured_place = vec4(gl_TessCoord, 0.0);
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
    HullOutput factors,
    float3 location : SV_DomainLocation,
    const OutputPatch<HullCorner, 3> corners)
{
    CapturedVertex captured;
    captured.vertex = ds_main(factors, location, corners);
    captured.captured_place = float4(location, 0.0);
    captured.captured_factors = float4(factors.edges[0], factors.edges[1], factors.edges[2], factors.inside);
    return captured;
}
";

/// Every patch is a draw of its own, which is told its number. The stages have it, too, but glslang doesn't know it in HLSL's domain
/// shaders, and Mesa 22.3 counts it from 0 again in every batch of a draw.
const GEOMETRY: &str = "#version 450
layout(push_constant) uniform Draw {
    uint patch_index;
};
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
layout(std430, set = 0, binding = CAPTURED_BINDING) buffer Captured {
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
                vec4(position[k], 1.0),
                vec4(normal[k], 0.0),
                vec4(uv[k], 0.0, 0.0),
                vec4(place[k].xyz, float(patch_index)),
                factors[k]);
        }
    }
}
";

/// A stage with its SPIR-V.
pub(crate) struct Stage {
    pub flag: vk::ShaderStageFlags,
    pub code: Vec<u8>,
}

/// What was compiled, by the file's name, the options, and the text without its comments: many exports differ in few of their files.
static COMPILED: Mutex<BTreeMap<[String; 3], Vec<u8>>> = Mutex::new(BTreeMap::new());

/// Compiles one text, once. `options` say its language, stage and entry point.
///
/// # Errors
/// It doesn't compile, or the compiler can't be run.
pub(crate) fn compiled(folder: &Path, file: &'static str, text: &str, options: &[&str]) -> Result<Vec<u8>, StageError> {
    // A comment that ends with a backslash would go on in the next line.
    let lines = text.lines().filter(|line| !line.starts_with("//") || line.ends_with('\\'));
    let key = [file.to_owned(), options.join(" "), lines.collect::<Vec<_>>().join("\n")];
    let known = COMPILED.lock().expect("nobody panics with it").get(&key).cloned();
    if let Some(known) = known {
        return Ok(known);
    }
    let (source, out) = (folder.join(file), folder.join("out.spv"));
    std::fs::write(&source, text)?;
    let made = Command::new("glslangValidator").arg("-V").args(options).arg(&source).arg("-o").arg(&out).output();
    let made = made.map_err(StageError::NoCompiler)?;
    if !made.status.success() {
        return Err(StageError::Compiler { file, messages: String::from_utf8_lossy(&made.stdout).into_owned() });
    }
    let code = std::fs::read(out)?;
    COMPILED.lock().expect("nobody panics with it").insert(key, code.clone());
    Ok(code)
}

/// The text with a patch constant function that computes the sides itself. It gets them of the control points' function, which glslang 12
/// calls again with corners that nothing was written to.
fn with_sides(text: &str) -> String {
    let handed = ", OutputPatch<HullCorner, 3> hull)\n{\n";
    assert!(text.contains(handed), "the patch constant function isn't handed the sides");
    let sides = [0, 1, 2].map(|k| format!("    hull[{k}] = hull_corner(corners, {k});\n")).concat();
    text.replace(handed, &format!(")\n{{\n    HullCorner hull[3];\n{sides}"))
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
                of("patch.hlsl", text, "tesc", "hs_main")?;
                [
                    of("patch.hlsl", text, "vert", "vs_main")?,
                    of("patch.hlsl", &with_sides(text), "tesc", "hs_main")?,
                    of("captured.hlsl", &(text.to_owned() + HLSL_CAPTURE), "tese", "captured_main")?,
                ]
            }
        };
        let geometry = GEOMETRY.replace("CAPTURED_BINDING", &CAPTURED_BINDING.to_string());
        let geometry = compiled(at, "capture.geom", &geometry, &[])?;
        Ok(vec![
            Stage { flag: vk::ShaderStageFlags::VERTEX, code: vertex },
            Stage { flag: vk::ShaderStageFlags::TESSELLATION_CONTROL, code: control },
            Stage { flag: vk::ShaderStageFlags::TESSELLATION_EVALUATION, code: evaluation },
            Stage { flag: vk::ShaderStageFlags::GEOMETRY, code: geometry },
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
    pub(crate) fn capture(self, vulkan: &Rc<Vulkan>, drawn: &Drawn) -> Result<Vec<[CapturedCorner; 3]>, StageError> {
        let stages = self.compile()?;
        let nowhere = Pass::nowhere(vulkan)?;
        let samples = matches!(self, Exported::Glsl { .. });
        let set = Bindings::new(vulkan, drawn, samples)?;
        let (buffers, attributes) = vertex_input(drawn.displaced.as_ref());
        let input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&buffers)
            .vertex_attribute_descriptions(&attributes);
        let pass = nowhere.handle();
        let layout = set.pipeline.handle;
        let pipeline = pipeline(vulkan, layout, pass, &stages, self.entries(), &input, drawn.per_patch)?;
        let vertices = Buffer::filled(vulkan, drawn.vertices)?;
        let relief = drawn.displaced.map(|displaced| Buffer::filled(vulkan, displaced.corners)).transpose()?;
        let levels = levels(vulkan, self, drawn)?;
        let buffers = [Some(&vertices), relief.as_ref(), levels.as_ref()];
        let buffers: Vec<_> = buffers.into_iter().flatten().map(|own| own.handle).collect();
        let indices = Buffer::filled(vulkan, drawn.indices)?;
        let device = &vulkan.device;
        vulkan.run(|commands| unsafe {
            nowhere.begin(device, commands);
            let graphics = vk::PipelineBindPoint::GRAPHICS;
            device.cmd_bind_pipeline(commands, graphics, pipeline.handle);
            device.cmd_bind_descriptor_sets(commands, graphics, set.pipeline.handle, 0, &[set.set], &[]);
            device.cmd_bind_vertex_buffers(commands, 0, &buffers, &vec![0; buffers.len()]);
            device.cmd_bind_index_buffer(commands, indices.handle, 0, vk::IndexType::UINT32);
            for patch in 0..drawn.indices.len() as u32 / drawn.per_patch {
                let (stage, number) = (vk::ShaderStageFlags::GEOMETRY, patch.to_ne_bytes());
                device.cmd_push_constants(commands, set.pipeline.handle, stage, 0, &number);
                device.cmd_draw_indexed(commands, drawn.per_patch, 1, patch * drawn.per_patch, 0, 0);
            }
            device.cmd_end_render_pass(commands);
        })?;
        set.triangles(vulkan, drawn.room)
    }
}

/// Makes a pipeline of patches with so many corners that ends before the rasteriser.
///
/// # Errors
/// The driver doesn't take it.
pub(crate) fn pipeline(
    vulkan: &Rc<Vulkan>,
    layout: vk::PipelineLayout,
    pass: vk::RenderPass,
    stages: &[Stage],
    entries: [&std::ffi::CStr; 4],
    vertices: &vk::PipelineVertexInputStateCreateInfo,
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
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::PATCH_LIST);
    let tessellation = vk::PipelineTessellationStateCreateInfo::default().patch_control_points(per_patch);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().rasterizer_discard_enable(true).line_width(1.0);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(vertices)
        .input_assembly_state(&assembly)
        .tessellation_state(&tessellation)
        .rasterization_state(&raster)
        .layout(layout)
        .render_pass(pass);
    let made = unsafe { vulkan.device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    let handle = made.map_err(|(_, error)| error)?[0];
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_pipeline(handle, None) }))
}

/// The vertex buffers, laid out as exported files say.
fn vertex_input(
    displaced: Option<&Displaced>,
) -> (Vec<vk::VertexInputBindingDescription>, Vec<vk::VertexInputAttributeDescription>) {
    let buffer = |binding, stride| vk::VertexInputBindingDescription::default().binding(binding).stride(stride);
    let attribute = |binding, location, format, offset| {
        let own = vk::VertexInputAttributeDescription::default().binding(binding).location(location);
        own.format(format).offset(offset)
    };
    let three = vk::Format::R32G32B32_SFLOAT;
    let mut buffers = vec![buffer(0, 32)];
    let mut attributes =
        vec![attribute(0, 0, three, 0), attribute(0, 1, three, 12), attribute(0, 2, vk::Format::R32G32_SFLOAT, 24)];
    if let Some(displaced) = displaced {
        buffers.push(buffer(1, 40));
        attributes.extend([attribute(1, 3, three, 0), attribute(1, 4, three, 12), attribute(1, 5, three, 24)]);
        if displaced.levels.is_some() {
            buffers.push(buffer(2, 4));
            attributes.push(attribute(2, 6, vk::Format::R32_UINT, 0));
        } else {
            attributes.push(attribute(1, 6, vk::Format::R32_SFLOAT, 36));
        }
    }
    (buffers, attributes)
}

/// Makes a shader module from SPIR-V.
///
/// # Errors
/// It isn't SPIR-V, or the driver doesn't take it.
pub(crate) fn module(vulkan: &Rc<Vulkan>, code: &[u8]) -> Result<Owned<vk::ShaderModule>, VulkanError> {
    let words = ash::util::read_spv(&mut std::io::Cursor::new(code))?;
    let info = vk::ShaderModuleCreateInfo::default().code(&words);
    let handle = unsafe { vulkan.device.create_shader_module(&info, None)? };
    Ok(Owned::new(vulkan, handle, |device, handle| unsafe { device.destroy_shader_module(handle, None) }))
}
