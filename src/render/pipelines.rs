//! The pipelines that draw a scene, each made when it is first needed, and their bind group layouts.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::environment::{Backdrop, ENVIRONMENT};
use super::materials::Materials;
use super::needs::Needs;
use super::prefilter_pass::REFLECTANCE;
use super::scene::LineSegment;
use super::target::{COLOR_FORMAT, DEPTH_FORMAT, samples};
use crate::gpu::wgsl::{
    CONVENTION, FACTORS, LOAD_NET, LOADS, NORMAL, OCTAHEDRAL_NORMAL, SURFACE, TYPES, WgslFile, wgsl,
};
use crate::gpu::{Gpu, GpuError, Lazy, ShaderModule, VERTEX_HALF};
use crate::settings::NormalsAt;

pub(super) static DRAW_TYPES: WgslFile = wgsl!("draw_types", TYPES);
pub(super) static DRAW_BACKGROUND: WgslFile = wgsl!("draw_background", DRAW_TYPES, ENVIRONMENT, REFLECTANCE);
static DRAW_DENSITY: WgslFile = wgsl!("draw_density");
pub(super) static DRAW_GROUND: WgslFile = wgsl!("draw_ground", DRAW_DENSITY, DRAW_TYPES);
static DRAW_LIGHT: WgslFile = wgsl!("draw_light");
pub(super) static DRAW_LIT: WgslFile =
    wgsl!("draw_lit", DRAW_LIGHT, DRAW_MATERIAL, DRAW_NORMAL, DRAW_TYPES, OCTAHEDRAL_NORMAL, SURFACE, TYPES);
static DRAW_LOOKS: WgslFile = wgsl!("draw_looks", DRAW_DENSITY);
static PUNCTUAL: WgslFile = wgsl!("punctual");
static DRAW_MATERIAL: WgslFile =
    wgsl!("draw_material", DRAW_NORMAL, DRAW_TYPES, ENVIRONMENT, PUNCTUAL, REFLECTANCE, TYPES);
static DRAW_NORMAL: WgslFile = wgsl!("draw_normal", FACTORS, LOAD_NET, LOADS, NORMAL, TYPES);
pub(super) static DRAW_PLAIN: WgslFile =
    wgsl!("draw_plain", DRAW_LIGHT, DRAW_NORMAL, DRAW_TYPES, OCTAHEDRAL_NORMAL, SURFACE, TYPES);
pub(super) static DRAW_SURFACE: WgslFile = wgsl!(
    "draw_surface",
    CONVENTION,
    DRAW_DENSITY,
    DRAW_LIGHT,
    DRAW_LOOKS,
    DRAW_MATERIAL,
    DRAW_NORMAL,
    DRAW_TYPES,
    FACTORS,
    OCTAHEDRAL_NORMAL,
    SURFACE,
    TYPES
);
pub(super) static DRAW_LINES: WgslFile = wgsl!("draw_lines", DRAW_TYPES, FACTORS, OCTAHEDRAL_NORMAL, TYPES);

/// What a pipeline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Draw {
    /// Emitted triangles with the material's colour alone.
    Plain(Faces),
    /// Emitted triangles with the material's colour and texture.
    Textured(Faces),
    /// The same with normals that are evaluated at pixels.
    PixelNormals(Faces),
    /// Emitted triangles with overlays that need no data of whole triangles.
    Indexed(Faces, NormalsAt),
    /// Emitted triangles with any overlays. The shader pulls each corner from the vertex buffer, so that it knows the barycentric
    /// coordinates in the triangle.
    Pulled(Faces, NormalsAt),
    /// The input triangles, with any overlays.
    Source,
    /// Emitted triangles with materials in light from all around.
    Lit(Faces, NormalsAt, Needs),
    /// [`Self::Indexed`] with such materials.
    LitIndexed(Faces, NormalsAt, Needs),
    /// [`Self::Pulled`] with such materials.
    LitPulled(Faces, NormalsAt, Needs),
    /// [`Self::Source`] with such materials.
    LitSource(Needs),
    /// The light from all around, behind everything.
    Background,
    /// The grid on the ground.
    Ground,
    /// Lines over the mesh.
    Lines(Occluded),
    /// A line along the normal of every emitted vertex.
    Normals(Occluded),
}

/// Which faces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Faces {
    Both,
    /// Those that face the eye.
    Fronts,
}

/// Which part of a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Occluded {
    /// All of it, faintly, even behind surfaces.
    Through,
    /// The part that no surface hides.
    InSight,
}

impl Draw {
    /// Every pipeline that there is; of those that light materials, the ones with all that materials can need.
    pub(super) const ALL: [Self; 34] = [
        Self::Plain(Faces::Both),
        Self::Plain(Faces::Fronts),
        Self::Textured(Faces::Both),
        Self::Textured(Faces::Fronts),
        Self::PixelNormals(Faces::Both),
        Self::PixelNormals(Faces::Fronts),
        Self::Indexed(Faces::Both, NormalsAt::Vertices),
        Self::Indexed(Faces::Fronts, NormalsAt::Vertices),
        Self::Indexed(Faces::Both, NormalsAt::Pixels),
        Self::Indexed(Faces::Fronts, NormalsAt::Pixels),
        Self::Pulled(Faces::Both, NormalsAt::Vertices),
        Self::Pulled(Faces::Fronts, NormalsAt::Vertices),
        Self::Pulled(Faces::Both, NormalsAt::Pixels),
        Self::Pulled(Faces::Fronts, NormalsAt::Pixels),
        Self::Source,
        Self::Lit(Faces::Both, NormalsAt::Vertices, Needs::ALL),
        Self::Lit(Faces::Fronts, NormalsAt::Vertices, Needs::ALL),
        Self::Lit(Faces::Both, NormalsAt::Pixels, Needs::ALL),
        Self::Lit(Faces::Fronts, NormalsAt::Pixels, Needs::ALL),
        Self::LitIndexed(Faces::Both, NormalsAt::Vertices, Needs::ALL),
        Self::LitIndexed(Faces::Fronts, NormalsAt::Vertices, Needs::ALL),
        Self::LitIndexed(Faces::Both, NormalsAt::Pixels, Needs::ALL),
        Self::LitIndexed(Faces::Fronts, NormalsAt::Pixels, Needs::ALL),
        Self::LitPulled(Faces::Both, NormalsAt::Vertices, Needs::ALL),
        Self::LitPulled(Faces::Fronts, NormalsAt::Vertices, Needs::ALL),
        Self::LitPulled(Faces::Both, NormalsAt::Pixels, Needs::ALL),
        Self::LitPulled(Faces::Fronts, NormalsAt::Pixels, Needs::ALL),
        Self::LitSource(Needs::ALL),
        Self::Background,
        Self::Ground,
        Self::Lines(Occluded::Through),
        Self::Lines(Occluded::InSight),
        Self::Normals(Occluded::Through),
        Self::Normals(Occluded::InSight),
    ];

    /// The names of the vertex and the fragment shader.
    fn entry_points(self) -> (&'static str, &'static str) {
        let line = |part| match part {
            Occluded::Through => "hidden_line_fragment",
            Occluded::InSight => "line_fragment",
        };
        let surface = |places| match places {
            NormalsAt::Vertices => "surface_fragment",
            NormalsAt::Pixels => "pixel_surface_fragment",
        };
        let lit_surface = |places| match places {
            NormalsAt::Vertices => "lit_surface_fragment",
            NormalsAt::Pixels => "pixel_lit_surface_fragment",
        };
        match self {
            Self::Plain(_) => ("plain_vertex", "plain_fragment"),
            Self::Textured(_) => ("textured_vertex", "textured_fragment"),
            Self::PixelNormals(_) => ("pixel_vertex", "pixel_fragment"),
            Self::Indexed(_, places) => ("indexed_vertex", surface(places)),
            Self::Pulled(_, places) => ("pulled_vertex", surface(places)),
            Self::Source => ("source_vertex", "surface_fragment"),
            Self::Lit(_, NormalsAt::Vertices, _) => ("lit_vertex", "lit_fragment"),
            Self::Lit(_, NormalsAt::Pixels, _) => ("lit_vertex", "pixel_lit_fragment"),
            Self::LitIndexed(_, places, _) => ("indexed_vertex", lit_surface(places)),
            Self::LitPulled(_, places, _) => ("pulled_vertex", lit_surface(places)),
            Self::LitSource(_) => ("source_vertex", "lit_surface_fragment"),
            Self::Background => ("background_vertex", "background_fragment"),
            Self::Ground => ("ground_vertex", "ground_fragment"),
            Self::Lines(Occluded::Through) => ("hidden_line_vertex", line(Occluded::Through)),
            Self::Lines(Occluded::InSight) => ("line_vertex", line(Occluded::InSight)),
            Self::Normals(part) => ("normal_vertex", line(part)),
        }
    }

    /// The vertex buffers that it reads.
    fn vertex_buffers(self) -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
        match self {
            Self::Plain(_) => vertex_halves(wgpu::VertexStepMode::Vertex)[..1].to_vec(),
            Self::Textured(_) | Self::PixelNormals(_) | Self::Indexed(..) | Self::Lit(..) | Self::LitIndexed(..) => {
                vertex_halves(wgpu::VertexStepMode::Vertex).to_vec()
            }
            Self::Pulled(..) | Self::LitPulled(..) | Self::Source | Self::LitSource(_) => Vec::new(),
            Self::Background | Self::Ground => Vec::new(),
            Self::Lines(_) => vec![Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<LineSegment>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &SEGMENT,
            })],
            Self::Normals(_) => vertex_halves(wgpu::VertexStepMode::Instance).to_vec(),
        }
    }

    /// Depth is reversed, so that nearer surfaces have a greater depth.
    fn depth_compare(self) -> wgpu::CompareFunction {
        match self {
            Self::Lines(Occluded::Through) | Self::Normals(Occluded::Through) => wgpu::CompareFunction::Always,
            // It is first, and at the far end.
            Self::Background => wgpu::CompareFunction::Always,
            _ => wgpu::CompareFunction::Greater,
        }
    }

    /// Surfaces are opaque and write depth; the ground and lines are blended over them.
    fn is_opaque(self) -> bool {
        !matches!(self, Self::Ground | Self::Lines(_) | Self::Normals(_))
    }

    fn cull_mode(self) -> Option<wgpu::Face> {
        let (Self::Plain(faces)
        | Self::Textured(faces)
        | Self::PixelNormals(faces)
        | Self::Indexed(faces, _)
        | Self::Pulled(faces, _)
        | Self::Lit(faces, ..)
        | Self::LitIndexed(faces, ..)
        | Self::LitPulled(faces, ..)) = self
        else {
            return None;
        };
        (faces == Faces::Fronts).then_some(wgpu::Face::Back)
    }

    /// What it needs for the mesh's materials; none if it doesn't light them.
    fn needs(self) -> Option<Needs> {
        match self {
            Self::Lit(.., needs)
            | Self::LitIndexed(.., needs)
            | Self::LitPulled(.., needs)
            | Self::LitSource(needs) => Some(needs),
            _ => None,
        }
    }
}

/// The attributes of an emitted vertex's first half: position and normal.
const PLACE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32];
/// The attributes of its second half: key and texture coordinates.
const DETAIL: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![2 => Uint32x2, 3 => Float32x2];
/// The attributes of a [`LineSegment`]: start, end, colour, half its width, and how many lie over each other.
const SEGMENT: [wgpu::VertexAttribute; 5] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32, 4 => Float32];

/// The two halves of emitted vertices, as vertex buffers.
fn vertex_halves(step_mode: wgpu::VertexStepMode) -> [Option<wgpu::VertexBufferLayout<'static>>; 2] {
    let half = |attributes| wgpu::VertexBufferLayout { array_stride: VERTEX_HALF, step_mode, attributes };
    [Some(half(&PLACE)), Some(half(&DETAIL))]
}

/// The pipeline of each [`Draw`], and the layouts of their bind groups.
pub(super) struct DrawPipelines {
    /// Group 0: the frame, points, corners, patches, the arena's vertices and indices, the frame once more as a uniform, curve
    /// nets, the parameters of the passes, and details of corners.
    pub scene_layout: wgpu::BindGroupLayout,
    /// Group 1: a material's constants, texture and sampler.
    material_layout: wgpu::BindGroupLayout,
    /// Group 1 where materials are lit: all of a material, and the light.
    lit_layout: wgpu::BindGroupLayout,
    /// Group 1 of the background: a panorama, its sampler, and how the light is shown.
    pub background_layout: wgpu::BindGroupLayout,
    /// Group 2: the slab of the chunk that is drawn, and the factors of the slab's patches.
    pub chunk_layout: wgpu::BindGroupLayout,
    /// Group 3: what was measured of a chunk's triangles, their distances to the reference surface, and of patches, their own
    /// least.
    pub measured_layout: wgpu::BindGroupLayout,
    plain: ShaderModule,
    lit: ShaderModule,
    surface: ShaderModule,
    background: ShaderModule,
    ground: ShaderModule,
    lines: ShaderModule,
    pipelines: Mutex<HashMap<Draw, Arc<Lazy<wgpu::RenderPipeline>>>>,
}

impl DrawPipelines {
    /// Makes the layouts. Compiles nothing yet.
    pub(super) fn new(gpu: &Gpu, materials: &Materials) -> Self {
        Self {
            scene_layout: scene_layout(gpu),
            material_layout: materials.layout.clone(),
            lit_layout: materials.lit_layout.clone(),
            background_layout: background_layout(gpu),
            chunk_layout: chunk_layout(gpu),
            measured_layout: measured_layout(gpu),
            plain: ShaderModule::new(&DRAW_PLAIN),
            lit: ShaderModule::new(&DRAW_LIT),
            surface: ShaderModule::new(&DRAW_SURFACE),
            background: ShaderModule::new(&DRAW_BACKGROUND),
            ground: ShaderModule::new(&DRAW_GROUND),
            lines: ShaderModule::new(&DRAW_LINES),
            pipelines: Default::default(),
        }
    }

    /// The pipeline of a draw. It is made at the first call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn get(&self, gpu: &Gpu, draw: Draw) -> Result<wgpu::RenderPipeline, GpuError> {
        let module = match draw {
            Draw::Plain(_) | Draw::Textured(_) | Draw::PixelNormals(_) => &self.plain,
            Draw::Lit(..) => &self.lit,
            Draw::Indexed(..) | Draw::Pulled(..) | Draw::Source => &self.surface,
            Draw::LitIndexed(..) | Draw::LitPulled(..) | Draw::LitSource(_) => &self.surface,
            Draw::Background => &self.background,
            Draw::Ground => &self.ground,
            Draw::Lines(_) | Draw::Normals(_) => &self.lines,
        };
        let module = module.get(gpu)?;
        // Nothing is made while the lock is held, so that a picture doesn't wait for pipelines of another.
        let own = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner).entry(draw).or_default().clone();
        own.get_or_make(gpu, || pipeline(gpu, &self.layouts(draw), module, draw)).cloned()
    }

    /// The layouts of the groups that a pipeline binds.
    fn layouts(&self, draw: Draw) -> Vec<Option<&wgpu::BindGroupLayout>> {
        let (scene, material) = (Some(&self.scene_layout), Some(&self.material_layout));
        let (chunk, deviation) = (Some(&self.chunk_layout), Some(&self.measured_layout));
        let lit = Some(&self.lit_layout);
        match draw {
            Draw::Plain(_) | Draw::Textured(_) | Draw::PixelNormals(_) => vec![scene, material],
            Draw::Indexed(..) | Draw::Pulled(..) => vec![scene, material, chunk, deviation],
            Draw::Source => vec![scene, material, None, deviation],
            Draw::Lit(..) => vec![scene, lit],
            Draw::LitIndexed(..) | Draw::LitPulled(..) => vec![scene, lit, chunk, deviation],
            Draw::LitSource(_) => vec![scene, lit, None, deviation],
            Draw::Background => vec![scene, Some(&self.background_layout)],
            Draw::Ground | Draw::Lines(_) => vec![scene],
            Draw::Normals(_) => vec![scene, None, chunk],
        }
    }
}

fn scene_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
    let mut entries: Vec<_> = (0..4).map(|binding| buffer_entry(binding, READ, vertex | fragment)).collect();
    entries.extend((4..6).map(|binding| buffer_entry(binding, READ, vertex)));
    entries.push(buffer_entry(6, wgpu::BufferBindingType::Uniform, vertex | fragment));
    // Vertex shaders have as many storage buffers as WebGPU allows.
    entries.push(buffer_entry(7, READ, fragment));
    entries.push(buffer_entry(8, wgpu::BufferBindingType::Uniform, fragment));
    entries.push(buffer_entry(9, READ, fragment));
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("scene"), entries: &entries })
}

fn chunk_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = [(0, wgpu::BufferBindingType::Uniform), (1, READ)]
        .map(|(binding, ty)| buffer_entry(binding, ty, wgpu::ShaderStages::VERTEX));
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("chunk"), entries: &entries })
}

fn background_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = Backdrop::layout_entries();
    gpu.device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("background"), entries: &entries })
}

fn measured_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries =
        [buffer_entry(0, READ, wgpu::ShaderStages::FRAGMENT), buffer_entry(1, READ, wgpu::ShaderStages::VERTEX)];
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("measured"), entries: &entries })
}

const READ: wgpu::BufferBindingType = wgpu::BufferBindingType::Storage { read_only: true };

fn buffer_entry(
    binding: u32,
    ty: wgpu::BufferBindingType,
    visibility: wgpu::ShaderStages,
) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

fn pipeline(
    gpu: &Gpu,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    module: &wgpu::ShaderModule,
    draw: Draw,
) -> wgpu::RenderPipeline {
    let (vertex, fragment) = draw.entry_points();
    let constants = draw.needs().map(Needs::constants);
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(vertex),
        bind_group_layouts: layouts,
        ..Default::default()
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &draw.vertex_buffers(),
        },
        primitive: wgpu::PrimitiveState { cull_mode: draw.cull_mode(), ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(draw.is_opaque()),
            depth_compare: Some(draw.depth_compare()),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: samples(gpu), ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: constants.as_ref().map_or(&[], |constants| constants.as_slice()),
                ..Default::default()
            },
            targets: &[Some(wgpu::ColorTargetState {
                format: COLOR_FORMAT,
                blend: (!draw.is_opaque()).then_some(wgpu::BlendState::ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
