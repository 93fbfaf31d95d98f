//! The pipelines that draw a scene, each made when it is first needed, and their bind group layouts.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::environment::{Backdrop, ENVIRONMENT};
use super::look::Look;
use super::materials::Materials;
use super::needs::{Cut, Needs};
use super::prefilter_pass::REFLECTANCE;
use super::scene::LineSegment;
use super::target::{COLOR_FORMAT, DEPTH_FORMAT, samples};
use crate::gpu::wgsl::{
    CONVENTION, CURVATURE, FACTORS, LOAD_NET, LOADS, NORMAL, OCTAHEDRAL_NORMAL, SURFACE, TYPES, WgslFile, wgsl,
};
use crate::gpu::{Gpu, GpuError, Lazy, ShaderModule, VERTEX_HALF};
use crate::settings::{Choice, NormalsAt};

pub(super) static DRAW_TYPES: WgslFile = wgsl!("draw_types", TYPES);
pub(super) static DRAW_BACKGROUND: WgslFile = wgsl!("draw_background", DRAW_TYPES, ENVIRONMENT, REFLECTANCE);
pub(super) static DRAW_CLEAR: WgslFile = wgsl!("draw_clear");
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
    CURVATURE,
    DRAW_DENSITY,
    DRAW_LIGHT,
    DRAW_LOOKS,
    DRAW_MATERIAL,
    DRAW_NORMAL,
    DRAW_TYPES,
    FACTORS,
    LOAD_NET,
    NORMAL,
    OCTAHEDRAL_NORMAL,
    SURFACE,
    TYPES
);
pub(super) static DRAW_LINES: WgslFile = wgsl!("draw_lines", DRAW_TYPES, FACTORS, OCTAHEDRAL_NORMAL, TYPES);

/// The module that has it declares the depths that it compares with.
static DRAW_LAYERS: WgslFile = wgsl!("draw_layers", DRAW_MATERIAL);
static DRAW_LIT_LAYERS: WgslFile = wgsl!("draw_lit_layers", DRAW_LAYERS, DRAW_LIT, DRAW_MATERIAL, DRAW_NORMAL);
static DRAW_SURFACE_LAYERS: WgslFile =
    wgsl!("draw_surface_layers", DRAW_LAYERS, DRAW_MATERIAL, DRAW_NORMAL, DRAW_SURFACE);
pub(super) static LAYERS_SINGLE: WgslFile = wgsl!("layers_single", DRAW_LIT_LAYERS, DRAW_SURFACE_LAYERS);
pub(super) static LAYERS_MULTISAMPLED: WgslFile = wgsl!("layers_multisampled", DRAW_LIT_LAYERS, DRAW_SURFACE_LAYERS);

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
    /// [`Self::Indexed`], [`Self::Pulled`] or [`Self::Source`] of a material that a mask cuts.
    Cut(Triangles, Faces, NormalsAt, Cut),
    /// [`Self::Indexed`] in the variant of a look.
    LookIndexed(Faces, NormalsAt, Look),
    /// [`Self::Pulled`] in such a variant.
    LookPulled(Faces, NormalsAt, Look),
    /// [`Self::Source`] in such a variant.
    LookSource(Look),
    /// Triangles with such materials where they show what is behind them.
    Layer(LayerDraw, Triangles, NormalsAt, Needs),
    /// Depths of layers where nothing is found.
    LayerClear(LayerClear),
    /// The light from all around, behind everything.
    Background,
    /// The grid on the ground.
    Ground,
    /// Lines over the mesh.
    Lines(Occluded),
    /// A line along the normal of every emitted vertex.
    Normals(Occluded),
}

/// What a pipeline does with layers. The first three are numbers of LAYER_* in `shaders/draw_layers.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum LayerDraw {
    /// Composites the layer that was found, which covers what is behind.
    Over,
    /// Multiplies what is behind that layer by its colours.
    Filter,
    /// Adds the light that comes from that layer itself.
    Add,
    /// Finds the depths of the next layer away from the eye.
    Away,
    /// Finds those of the next layer toward the eye.
    Toward,
}

/// Which depths of layers a pipeline sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum LayerClear {
    /// Those before the search begins: the depth of the near plane.
    Begin,
    /// Those of a pass away from the eye: the depth at infinity.
    Away,
    /// Those of a pass back toward the eye, which has colours too: the depth of the near plane.
    Back,
}

/// How a pipeline for layers gets its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Triangles {
    /// As [`Draw::Lit`] does.
    Lit,
    /// As [`Draw::LitIndexed`] does.
    Indexed,
    /// As [`Draw::LitPulled`] does.
    Pulled,
    /// As [`Draw::LitSource`] does.
    Source,
}

/// Which faces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Faces {
    Both,
    /// Those that face the eye.
    Fronts,
}

impl Faces {
    const BOTH: [Self; 2] = [Self::Both, Self::Fronts];
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
    /// Every pipeline that there is but those of looks; of those that light materials, the ones with all that materials can need.
    pub(super) fn all() -> Vec<Self> {
        let triangles = [Triangles::Lit, Triangles::Indexed, Triangles::Pulled, Triangles::Source];
        let layers = triangles.into_iter().flat_map(|triangles| {
            let places: &[_] = match triangles {
                Triangles::Source => &[NormalsAt::Vertices],
                _ => &[NormalsAt::Vertices, NormalsAt::Pixels],
            };
            let composites = [LayerDraw::Over, LayerDraw::Filter, LayerDraw::Add].into_iter();
            let composites = composites.flat_map(|draw| places.iter().map(move |&at| (draw, at)));
            let finds = [LayerDraw::Away, LayerDraw::Toward].map(|draw| (draw, NormalsAt::Vertices));
            composites.chain(finds).map(move |(draw, at)| Self::Layer(draw, triangles, at, Needs::ALL))
        });
        let masked = Needs { masked_samples: true, ..Needs::ALL };
        let masks = NormalsAt::ALL.iter().flat_map(move |&at| {
            let kinds = [Self::Lit, Self::LitIndexed, Self::LitPulled];
            kinds.map(|kind: fn(Faces, NormalsAt, Needs) -> Self| kind(Faces::Both, at, masked))
        });
        let cuts = [false, true].into_iter().flat_map(|samples| {
            let cut = Cut { details: true, samples };
            let emitted = NormalsAt::ALL.iter().flat_map(move |&at| {
                [Triangles::Indexed, Triangles::Pulled].map(|triangles| Self::Cut(triangles, Faces::Both, at, cut))
            });
            emitted.chain([Self::Cut(Triangles::Source, Faces::Both, NormalsAt::Vertices, cut)])
        });
        Self::OTHERS.into_iter().chain(layers).chain(masks).chain([Self::LitSource(masked)]).chain(cuts).collect()
    }

    /// Those that don't draw layers.
    const OTHERS: [Self; 37] = [
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
        Self::LayerClear(LayerClear::Begin),
        Self::LayerClear(LayerClear::Away),
        Self::LayerClear(LayerClear::Back),
        Self::Background,
        Self::Ground,
        Self::Lines(Occluded::Through),
        Self::Lines(Occluded::InSight),
        Self::Normals(Occluded::Through),
        Self::Normals(Occluded::InSight),
    ];

    /// The pipelines of all looks.
    pub(super) fn of_looks() -> impl Iterator<Item = Self> {
        let kinds = Faces::BOTH.into_iter().flat_map(|faces| NormalsAt::ALL.iter().map(move |&places| (faces, places)));
        Look::ALL.into_iter().flat_map(move |look| {
            let emitted = kinds.clone().flat_map(move |(faces, places)| {
                [Self::LookIndexed(faces, places, look), Self::LookPulled(faces, places, look)]
            });
            emitted.chain([Self::LookSource(look)])
        })
    }

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
        let lit = |places, needs: Needs| match (places, needs.masked_samples) {
            (NormalsAt::Vertices, false) => "lit_fragment",
            (NormalsAt::Pixels, false) => "pixel_lit_fragment",
            (NormalsAt::Vertices, true) => "masked_lit_fragment",
            (NormalsAt::Pixels, true) => "pixel_masked_lit_fragment",
        };
        let lit_surface = |places, needs: Needs| match (places, needs.masked_samples) {
            (NormalsAt::Vertices, false) => "lit_surface_fragment",
            (NormalsAt::Pixels, false) => "pixel_lit_surface_fragment",
            (NormalsAt::Vertices, true) => "masked_surface_fragment",
            (NormalsAt::Pixels, true) => "pixel_masked_surface_fragment",
        };
        let layer = |triangles, draw, places| match (triangles, draw, places) {
            (Triangles::Lit, LayerDraw::Away | LayerDraw::Toward, _) => "lit_depth_fragment",
            (Triangles::Lit, _, NormalsAt::Vertices) => "lit_layer_fragment",
            (Triangles::Lit, _, NormalsAt::Pixels) => "pixel_lit_layer_fragment",
            (_, LayerDraw::Away | LayerDraw::Toward, _) => "surface_depth_fragment",
            (_, _, NormalsAt::Vertices) => "surface_layer_fragment",
            (_, _, NormalsAt::Pixels) => "pixel_surface_layer_fragment",
        };
        let vertex = |triangles| match triangles {
            Triangles::Lit => "lit_vertex",
            Triangles::Indexed => "indexed_vertex",
            Triangles::Pulled => "pulled_vertex",
            Triangles::Source => "source_vertex",
        };
        let cut = |places, cut: Cut| match (places, cut.samples) {
            (NormalsAt::Vertices, false) => "cut_surface_fragment",
            (NormalsAt::Pixels, false) => "pixel_cut_surface_fragment",
            (NormalsAt::Vertices, true) => "cut_samples_fragment",
            (NormalsAt::Pixels, true) => "pixel_cut_samples_fragment",
        };
        match self {
            Self::Layer(draw, triangles, places, _) => (vertex(triangles), layer(triangles, draw, places)),
            Self::Cut(triangles, _, places, own) => (vertex(triangles), cut(places, own)),
            Self::Plain(_) => ("plain_vertex", "plain_fragment"),
            Self::Textured(_) => ("textured_vertex", "textured_fragment"),
            Self::PixelNormals(_) => ("pixel_vertex", "pixel_fragment"),
            Self::Indexed(_, places) | Self::LookIndexed(_, places, _) => ("indexed_vertex", surface(places)),
            Self::Pulled(_, places) | Self::LookPulled(_, places, _) => ("pulled_vertex", surface(places)),
            Self::Source | Self::LookSource(_) => ("source_vertex", "surface_fragment"),
            Self::Lit(_, places, needs) => ("lit_vertex", lit(places, needs)),
            Self::LitIndexed(_, places, needs) => ("indexed_vertex", lit_surface(places, needs)),
            Self::LitPulled(_, places, needs) => ("pulled_vertex", lit_surface(places, needs)),
            Self::LitSource(needs) => ("source_vertex", lit_surface(NormalsAt::Vertices, needs)),
            Self::LayerClear(_) => ("clear_vertex", "clear_fragment"),
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
            Self::Textured(_)
            | Self::PixelNormals(_)
            | Self::Indexed(..)
            | Self::Lit(..)
            | Self::LitIndexed(..)
            | Self::LookIndexed(..)
            | Self::Cut(Triangles::Lit | Triangles::Indexed, ..)
            | Self::Layer(_, Triangles::Lit | Triangles::Indexed, ..) => {
                vertex_halves(wgpu::VertexStepMode::Vertex).to_vec()
            }
            Self::Pulled(..) | Self::LitPulled(..) | Self::LookPulled(..) => Vec::new(),
            Self::Layer(_, Triangles::Pulled | Triangles::Source, ..) => Vec::new(),
            Self::Cut(Triangles::Pulled | Triangles::Source, ..) => Vec::new(),
            Self::Source | Self::LitSource(_) | Self::LookSource(_) => Vec::new(),
            Self::Background | Self::Ground | Self::LayerClear(_) => Vec::new(),
            Self::Lines(_) => vec![Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<LineSegment>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &SEGMENT,
            })],
            Self::Normals(_) => vertex_halves(wgpu::VertexStepMode::Instance).to_vec(),
        }
    }

    /// How depths are tested and written. Depth is reversed, so that nearer surfaces have a greater depth.
    fn depth_stencil(self) -> wgpu::DepthStencilState {
        let compare = match self {
            // A shader compares the depth of what composites a layer.
            Self::Layer(LayerDraw::Over | LayerDraw::Filter | LayerDraw::Add, ..) => wgpu::CompareFunction::Always,
            Self::LayerClear(_) => wgpu::CompareFunction::Always,
            Self::Layer(LayerDraw::Toward, ..) => wgpu::CompareFunction::Less,
            Self::Lines(Occluded::Through) | Self::Normals(Occluded::Through) => wgpu::CompareFunction::Always,
            // It is first, and at the far end.
            Self::Background => wgpu::CompareFunction::Always,
            _ => wgpu::CompareFunction::Greater,
        };
        // The ground, lines and layers are blended over surfaces.
        let is_blended = matches!(self, Self::Ground | Self::Lines(_) | Self::Normals(_))
            || matches!(self, Self::Layer(LayerDraw::Over | LayerDraw::Filter | LayerDraw::Add, ..));
        wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(!is_blended),
            depth_compare: Some(compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }
    }

    /// How colours are written; `None` in passes without colours.
    fn color_target(self) -> Option<wgpu::ColorTargetState> {
        let blend = match self {
            Self::Layer(LayerDraw::Away, ..) | Self::LayerClear(LayerClear::Begin | LayerClear::Away) => return None,
            Self::Layer(LayerDraw::Toward, ..) | Self::LayerClear(LayerClear::Back) => {
                let write_mask = wgpu::ColorWrites::empty();
                return Some(wgpu::ColorTargetState { format: COLOR_FORMAT, blend: None, write_mask });
            }
            Self::Layer(LayerDraw::Over, ..) => Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            Self::Layer(LayerDraw::Filter, ..) => {
                Some(both(wgpu::BlendFactor::Zero, wgpu::BlendFactor::Src, wgpu::BlendFactor::SrcAlpha))
            }
            Self::Layer(LayerDraw::Add, ..) => {
                Some(both(wgpu::BlendFactor::One, wgpu::BlendFactor::One, wgpu::BlendFactor::One))
            }
            Self::Ground | Self::Lines(_) | Self::Normals(_) => Some(wgpu::BlendState::ALPHA_BLENDING),
            _ => None,
        };
        Some(wgpu::ColorTargetState { format: COLOR_FORMAT, blend, write_mask: wgpu::ColorWrites::ALL })
    }

    fn cull_mode(self) -> Option<wgpu::Face> {
        let (Self::Plain(faces)
        | Self::Textured(faces)
        | Self::PixelNormals(faces)
        | Self::Indexed(faces, _)
        | Self::Pulled(faces, _)
        | Self::Lit(faces, ..)
        | Self::LitIndexed(faces, ..)
        | Self::LitPulled(faces, ..)
        | Self::Cut(_, faces, ..)
        | Self::LookIndexed(faces, ..)
        | Self::LookPulled(faces, ..)) = self
        else {
            return None;
        };
        (faces == Faces::Fronts).then_some(wgpu::Face::Back)
    }

    /// The values of the shader's constants that aren't the usual ones.
    fn constants(self) -> Vec<(&'static str, f64)> {
        match self {
            Self::Lit(.., needs)
            | Self::LitIndexed(.., needs)
            | Self::LitPulled(.., needs)
            | Self::LitSource(needs) => needs.constants().to_vec(),
            Self::Layer(draw, .., needs) => {
                let toward_eye = f64::from(u8::from(draw == LayerDraw::Toward));
                let of_layer = [("TOWARD_EYE", toward_eye), ("LAYER_DRAW", f64::from(draw as u32))];
                needs.constants().into_iter().chain(of_layer).collect()
            }
            Self::Cut(.., cut) => {
                vec![("HAS_DETAILS", f64::from(u8::from(cut.details))), ("LIGHT_COUNT", 0.0)]
            }
            Self::LayerClear(clear) => {
                vec![("CLEAR_DEPTH", if clear == LayerClear::Away { 0.0 } else { 1.0 })]
            }
            Self::LookIndexed(.., look) | Self::LookPulled(.., look) => vec![("LOOK", f64::from(look as u32))],
            Self::LookSource(look) => vec![("LOOK", f64::from(look as u32)), ("DRAWS_SOURCE", 1.0)],
            _ => Vec::new(),
        }
    }
}

/// A sum of what is drawn and what is there, with these factors: of what is drawn, and of the colour and the alpha that are there.
fn both(drawn: wgpu::BlendFactor, color: wgpu::BlendFactor, alpha: wgpu::BlendFactor) -> wgpu::BlendState {
    let component =
        |there| wgpu::BlendComponent { src_factor: drawn, dst_factor: there, operation: wgpu::BlendOperation::Add };
    wgpu::BlendState { color: component(color), alpha: component(alpha) }
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
    /// Group 3 where layers are drawn: the same, the depths of the layer that was found last, and those of what hides everything
    /// behind it.
    pub layer_layout: wgpu::BindGroupLayout,
    plain: ShaderModule,
    lit: ShaderModule,
    surface: ShaderModule,
    layers: ShaderModule,
    clear: ShaderModule,
    background: ShaderModule,
    ground: ShaderModule,
    lines: ShaderModule,
    pipelines: Mutex<HashMap<Draw, Arc<Lazy<wgpu::RenderPipeline>>>>,
}

impl DrawPipelines {
    /// Makes the layouts. Compiles nothing yet.
    pub(super) fn new(gpu: &Gpu, materials: &Materials) -> Self {
        let is_multisampled = samples(gpu) > 1;
        Self {
            scene_layout: scene_layout(gpu),
            material_layout: materials.layout.clone(),
            lit_layout: materials.lit_layout.clone(),
            background_layout: background_layout(gpu),
            chunk_layout: chunk_layout(gpu),
            measured_layout: measured_layout(gpu),
            layer_layout: layer_layout(gpu, is_multisampled),
            plain: ShaderModule::new(&DRAW_PLAIN),
            lit: ShaderModule::new(&DRAW_LIT),
            surface: ShaderModule::new(&DRAW_SURFACE),
            layers: ShaderModule::new(if is_multisampled { &LAYERS_MULTISAMPLED } else { &LAYERS_SINGLE }),
            clear: ShaderModule::new(&DRAW_CLEAR),
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
            Draw::LookIndexed(..) | Draw::LookPulled(..) | Draw::LookSource(_) => &self.surface,
            Draw::Cut(..) => &self.surface,
            Draw::Layer(..) => &self.layers,
            Draw::LayerClear(_) => &self.clear,
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
        let (lit, layer) = (Some(&self.lit_layout), Some(&self.layer_layout));
        match draw {
            Draw::Plain(_) | Draw::Textured(_) | Draw::PixelNormals(_) => vec![scene, material],
            Draw::Indexed(..) | Draw::Pulled(..) | Draw::LookIndexed(..) | Draw::LookPulled(..) => {
                vec![scene, material, chunk, deviation]
            }
            Draw::Source | Draw::LookSource(_) => vec![scene, material, None, deviation],
            Draw::Cut(Triangles::Source, ..) => vec![scene, material, None, deviation],
            Draw::Cut(..) => vec![scene, material, chunk, deviation],
            Draw::Lit(..) => vec![scene, lit],
            Draw::LitIndexed(..) | Draw::LitPulled(..) => vec![scene, lit, chunk, deviation],
            Draw::LitSource(_) => vec![scene, lit, None, deviation],
            Draw::Layer(_, Triangles::Lit | Triangles::Source, ..) => vec![scene, lit, None, layer],
            Draw::Layer(_, Triangles::Indexed | Triangles::Pulled, ..) => vec![scene, lit, chunk, layer],
            Draw::LayerClear(_) => Vec::new(),
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

fn measured_entries() -> [wgpu::BindGroupLayoutEntry; 2] {
    [buffer_entry(0, READ, wgpu::ShaderStages::FRAGMENT), buffer_entry(1, READ, wgpu::ShaderStages::VERTEX)]
}

fn background_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = Backdrop::layout_entries();
    gpu.device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("background"), entries: &entries })
}

fn measured_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = measured_entries();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("measured"), entries: &entries })
}

fn layer_layout(gpu: &Gpu, multisampled: bool) -> wgpu::BindGroupLayout {
    let depths = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled,
        },
        count: None,
    };
    let entries = [&measured_entries()[..], &[depths(2), depths(3)]].concat();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("layer"), entries: &entries })
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
    let constants = draw.constants();
    let color = draw.color_target().map(Some);
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
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            buffers: &draw.vertex_buffers(),
        },
        primitive: wgpu::PrimitiveState { cull_mode: draw.cull_mode(), ..Default::default() },
        depth_stencil: Some(draw.depth_stencil()),
        multisample: wgpu::MultisampleState { count: samples(gpu), ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: color.as_slice(),
        }),
        multiview_mask: None,
        cache: None,
    })
}
