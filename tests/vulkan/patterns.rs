//! The driver's own tessellator alone: factors in, domain points at the corners of triangles or the ends of lines out.

use std::rc::Rc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use geometry::tessellate::{DomainKind, Partitioning};

use super::bindings::{Resource, layout, pipeline_layout, set};
use super::device::Vulkan;
use super::memory::{Buffer, Owned};
use super::pass::Pass;
use super::stages::{HEAD_BYTES, Stage, StageError, compiled, pipeline};

/// Factors in Vulkan's order, four outside and two inside, and how many triangles or lines are expected of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FactorSet {
    pub factors: [f32; 6],
    pub primitives: u32,
}

/// A corner of what came out of the tessellator: its patch, and its U and V.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Corner {
    patch: u32,
    place: [f32; 2],
}

const VERTEX: &str = "#version 450
void main() {
    gl_Position = vec4(0.0);
}
";

/// Every patch is a draw of its own, which is told its number.
const CONTROL: &str = "#version 450
layout(vertices = 1) out;
layout(push_constant) uniform Draw {
    uint patch_index;
};
layout(std430, set = 0, binding = 0) readonly buffer Factors {
    float factors[];
};
void main() {
    for (uint k = 0u; k < 4u; k++) {
        gl_TessLevelOuter[k] = factors[6u * patch_index + k];
    }
    gl_TessLevelInner[0] = factors[6u * patch_index + 4u];
    gl_TessLevelInner[1] = factors[6u * patch_index + 5u];
}
";

const EVALUATION: &str = "#version 450
layout(DOMAIN, SPACING, cw) in;
layout(location = 0) out vec2 place;
void main() {
    place = gl_TessCoord.xy;
}
";

const GEOMETRY: &str = "#version 450
layout(push_constant) uniform Draw {
    uint patch_index;
};
layout(PRIMITIVES) in;
layout(points, max_vertices = 1) out;
layout(location = 0) in vec2 place[];
struct Corner {
    uint patch_index;
    float u;
    float v;
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
        for (int k = 0; k < CORNERS; k++) {
            corners[CORNERS * at + uint(k)] = Corner(patch_index, place[k].x, place[k].y);
        }
    }
}
";

/// So many sets are tessellated at once.
const BATCH: usize = 512;

/// The tessellator of a driver for one domain and partitioning, whose primitives have `CORNERS` corners.
pub(crate) struct Tessellator<const CORNERS: usize> {
    vulkan: Rc<Vulkan>,
    nowhere: Pass,
    set_layout: Owned<vk::DescriptorSetLayout>,
    layout: Owned<vk::PipelineLayout>,
    pipeline: Owned<vk::Pipeline>,
}

/// The stages that read and write buffers.
const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::TESSELLATION_CONTROL.as_raw() | vk::ShaderStageFlags::GEOMETRY.as_raw(),
);

fn stages(kind: DomainKind, partitioning: Partitioning, corners: usize) -> Result<Vec<Stage>, StageError> {
    let folder = tempfile::tempdir()?;
    let compile = |flag, file, text: &str| Ok(Stage { flag, code: compiled(folder.path(), file, text, &[])? });
    let domain = match kind {
        DomainKind::Tri => "triangles",
        DomainKind::Quad => "quads",
        DomainKind::Isoline => "isolines",
    };
    let spacing = match partitioning {
        Partitioning::FractionalOdd => "fractional_odd_spacing",
        Partitioning::FractionalEven => "fractional_even_spacing",
        _ => "equal_spacing",
    };
    let primitives = if corners == 3 { "triangles" } else { "lines" };
    let evaluation = EVALUATION.replace("DOMAIN", domain).replace("SPACING", spacing);
    let geometry = GEOMETRY.replace("PRIMITIVES", primitives).replace("CORNERS", &corners.to_string());
    [
        compile(vk::ShaderStageFlags::VERTEX, "pattern.vert", VERTEX),
        compile(vk::ShaderStageFlags::TESSELLATION_CONTROL, "pattern.tesc", CONTROL),
        compile(vk::ShaderStageFlags::TESSELLATION_EVALUATION, "pattern.tese", &evaluation),
        compile(vk::ShaderStageFlags::GEOMETRY, "pattern.geom", &geometry),
    ]
    .into_iter()
    .collect()
}

impl<const CORNERS: usize> Tessellator<CORNERS> {
    /// Makes its pipeline. Lines have two corners, and all others three.
    ///
    /// # Errors
    /// A text doesn't compile, or the driver doesn't take it.
    pub(crate) fn new(vulkan: &Rc<Vulkan>, kind: DomainKind, partitioning: Partitioning) -> Result<Self, StageError> {
        let stages = stages(kind, partitioning, CORNERS)?;
        let nowhere = Pass::nowhere(vulkan)?;
        // The layout depends on kinds of resources only.
        let any = Buffer::on_device(vulkan, 4)?;
        let set_layout = layout(vulkan, &[(0, Resource::Storage(&any)), (1, Resource::Storage(&any))], STAGES)?;
        let number = [vk::PushConstantRange::default().stage_flags(STAGES).size(4)];
        let layout = pipeline_layout(vulkan, set_layout.handle, &number)?;
        let vertices = vk::PipelineVertexInputStateCreateInfo::default();
        let pipeline = pipeline(vulkan, layout.handle, nowhere.handle(), &stages, [c"main"; 4], &vertices, 1)?;
        Ok(Self { vulkan: vulkan.clone(), nowhere, set_layout, layout, pipeline })
    }

    /// Tessellates each set. Returns the places (U, V) of the corners in 16.16 fixed point, in the order in which they came
    /// out.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn run(&self, sets: &[FactorSet]) -> Result<Vec<Vec<[[u32; 2]; CORNERS]>>, StageError> {
        let mut all = Vec::new();
        for batch in sets.chunks(BATCH) {
            let mut patches = vec![Vec::new(); batch.len()];
            for primitive in self.captured(batch)? {
                patches[primitive[0].patch as usize].push(primitive.map(|corner| corner.place.map(fixed)));
            }
            all.append(&mut patches);
        }
        Ok(all)
    }

    fn captured(&self, batch: &[FactorSet]) -> Result<Vec<[Corner; CORNERS]>, StageError> {
        let factors: Vec<_> = batch.iter().map(|set| set.factors).collect();
        let factors = Buffer::filled(&self.vulkan, &factors)?;
        // A few more may come than are expected, and are seen then.
        let room = batch.iter().map(|set| set.primitives as usize).sum::<usize>() + 64;
        let mut head = vec![0u8; HEAD_BYTES + room * CORNERS * size_of::<Corner>()];
        head[4..8].copy_from_slice(&(room as u32).to_le_bytes());
        let captured = Buffer::filled(&self.vulkan, &head)?;
        let bound = [(0, Resource::Storage(&factors)), (1, Resource::Storage(&captured))];
        let (_pool, set) = set(&self.vulkan, self.set_layout.handle, &bound)?;
        let device = &self.vulkan.device;
        self.vulkan.run(|commands| unsafe {
            self.nowhere.begin(device, commands);
            let graphics = vk::PipelineBindPoint::GRAPHICS;
            device.cmd_bind_pipeline(commands, graphics, self.pipeline.handle);
            device.cmd_bind_descriptor_sets(commands, graphics, self.layout.handle, 0, &[set], &[]);
            for patch in 0..batch.len() as u32 {
                device.cmd_push_constants(commands, self.layout.handle, STAGES, 0, &patch.to_ne_bytes());
                device.cmd_draw(commands, 1, 1, 0, 0);
            }
            device.cmd_end_render_pass(commands);
        })?;
        let staging = Buffer::for_host(&self.vulkan, captured.bytes)?;
        staging.copy_from(&captured)?;
        let read = |bytes: &mut [u8]| {
            let count: u32 = bytemuck::pod_read_unaligned(&bytes[..4]);
            let end = HEAD_BYTES + room.min(count as usize) * CORNERS * size_of::<Corner>();
            let corners: Vec<Corner> = bytemuck::pod_collect_to_vec(&bytes[HEAD_BYTES..end]);
            corners.as_chunks::<CORNERS>().0.to_vec()
        };
        Ok(staging.with_host(read)?)
    }
}

/// A coordinate in 16.16 fixed point; no coordinate if it isn't one.
fn fixed(x: f32) -> u32 {
    let fixed = x * 65536.0;
    if fixed.fract() == 0.0 { fixed as u32 } else { u32::MAX }
}
