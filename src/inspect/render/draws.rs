//! What the pipelines of pictures draw, and how each is set up: shaders and their constants, vertex buffers, depths and colours.

use super::needs::{Cut, Needs};
use super::render_pipeline::{blended, depth_state};
use super::scene::LineSegment;
use super::target::COLOR_FORMAT;
use crate::settings::{Colors, NormalsAt};
use gpu::embed::VERTEX_LAYOUTS;

/// What a pipeline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Draw {
    Surface(SurfaceDraw),
    /// Depths of layers where nothing is found: that at infinity, or that of the near plane.
    LayerClear {
        at_infinity: bool,
        has_colors: bool,
    },
    /// The light from all around, behind everything.
    Background,
    /// The grid on the ground.
    Ground,
    /// Lines over the mesh.
    Lines(Occluded),
    /// A line along the normal of every emitted vertex.
    Normals(Occluded),
}

/// How triangles of the mesh are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct SurfaceDraw {
    pub triangles: Triangles,
    pub faces: Faces,
    pub normals: NormalsAt,
    pub shading: Shading,
    /// What is done where they show what is behind them; none where they hide it.
    pub layer: Option<LayerDraw>,
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

impl LayerDraw {
    /// Whether it finds depths, and composites nothing.
    pub(super) fn finds(self) -> bool {
        matches!(self, Self::Away | Self::Toward)
    }
}

/// How a pipeline gets its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Triangles {
    /// Emitted ones, without overlays.
    Bare,
    /// Emitted ones, with overlays that need no data of whole triangles.
    Indexed,
    /// Emitted ones, with any overlays. The shader pulls each corner from the vertex buffer, so that it knows the barycentric
    /// coordinates in the triangle.
    Pulled,
}

/// Colours that have a variant of the surface's shader for themselves, so that no other picture pays for what they need.
pub(super) const LOOKS: [Colors; 4] = [Colors::SurfaceNormals, Colors::Curvature, Colors::Matcap, Colors::TexelDensity];

/// What colours a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Shading {
    /// The material's colour alone, in the lights at the camera.
    Plain,
    /// Its colour and texture.
    Textured,
    /// The same where a mask cuts the material.
    Cut(Cut),
    /// One of [`LOOKS`].
    Look(Colors),
    /// Materials in light from all around.
    Lit(Needs),
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

impl Occluded {
    pub(super) const BOTH: [Self; 2] = [Self::Through, Self::InSight];
}

impl SurfaceDraw {
    fn module(self, samples: u32) -> &'static str {
        match (self.layer, self.triangles, self.shading) {
            (Some(_), ..) if samples > 1 => "layers_multisampled",
            (Some(_), ..) => "layers_single",
            (None, Triangles::Bare, Shading::Lit(_)) => "draw_lit",
            (None, Triangles::Bare, _) => "draw_plain",
            (None, Triangles::Indexed | Triangles::Pulled, _) => "draw_surface",
        }
    }

    fn vertex_entry(self) -> &'static str {
        match (self.triangles, self.shading) {
            (Triangles::Bare, Shading::Plain) => "plain_vertex",
            (Triangles::Bare, Shading::Lit(_)) => "lit_vertex",
            (Triangles::Bare, _) if self.normals == NormalsAt::Pixels => "pixel_vertex",
            (Triangles::Bare, _) => "textured_vertex",
            (Triangles::Indexed, _) => "indexed_vertex",
            (Triangles::Pulled, _) => "pulled_vertex",
        }
    }

    fn fragment_entry(self) -> &'static str {
        let [bare, with_overlays] = match (self.layer, self.shading) {
            (Some(layer), _) if layer.finds() => ["lit_depth_fragment", "surface_depth_fragment"],
            (Some(_), _) => ["lit_layer_fragment", "surface_layer_fragment"],
            (None, Shading::Lit(Needs { masked_samples: false, .. })) => ["lit_fragment", "lit_surface_fragment"],
            (None, Shading::Lit(_)) => ["masked_lit_fragment", "masked_surface_fragment"],
            (None, Shading::Cut(Cut { samples: false, .. })) => ["", "cut_surface_fragment"],
            (None, Shading::Cut(_)) => ["", "cut_samples_fragment"],
            (None, Shading::Plain) => ["plain_fragment", ""],
            (None, _) if self.normals == NormalsAt::Pixels => ["pixel_fragment", "surface_fragment"],
            (None, _) => ["textured_fragment", "surface_fragment"],
        };
        if self.triangles == Triangles::Bare { bare } else { with_overlays }
    }

    /// The values of the shader's constants that aren't the usual ones.
    fn constants(self) -> Vec<(&'static str, f64)> {
        let mut constants = match self.shading {
            Shading::Plain | Shading::Textured => Vec::new(),
            Shading::Lit(needs) => needs.constants(),
            Shading::Cut(cut) => vec![("HAS_DETAILS", f64::from(u8::from(cut.details))), ("LIGHT_COUNT", 0.0)],
            Shading::Look(look) => vec![("LOOK", f64::from(look as u32))],
        };
        if let Some(layer) = self.layer {
            let toward_eye = f64::from(u8::from(layer == LayerDraw::Toward));
            constants.extend([("TOWARD_EYE", toward_eye), ("LAYER_DRAW", f64::from(layer as u32))]);
        }
        constants.extend((self.normals == NormalsAt::Pixels).then_some(("NORMALS_AT_PIXELS", 1.0)));
        constants
    }
}

impl Draw {
    /// The module of the shaders, in a picture with so many samples, and the names of the vertex and the fragment shader.
    pub(super) fn shaders(self, samples: u32) -> (&'static str, [&'static str; 2]) {
        match self {
            Self::Surface(own) => (own.module(samples), [own.vertex_entry(), own.fragment_entry()]),
            Self::LayerClear { .. } => ("draw_clear", ["whole_vertex", "clear_fragment"]),
            Self::Background => ("draw_background", ["whole_vertex", "background_fragment"]),
            Self::Ground => ("draw_ground", ["ground_vertex", "ground_fragment"]),
            Self::Lines(_) => ("draw_lines", ["line_vertex", "line_fragment"]),
            Self::Normals(_) => ("draw_lines", ["normal_vertex", "line_fragment"]),
        }
    }

    /// The vertex buffers that it reads.
    pub(super) fn vertex_buffers(self) -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
        match self {
            Self::Surface(SurfaceDraw { shading: Shading::Plain, .. }) => VERTEX_LAYOUTS[..1].to_vec(),
            Self::Surface(SurfaceDraw { triangles: Triangles::Bare | Triangles::Indexed, .. }) => {
                VERTEX_LAYOUTS.to_vec()
            }
            Self::Surface(_) | Self::Background | Self::Ground | Self::LayerClear { .. } => Vec::new(),
            Self::Lines(_) => vec![Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<LineSegment>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &SEGMENT,
            })],
            Self::Normals(_) => {
                let step_mode = wgpu::VertexStepMode::Instance;
                VERTEX_LAYOUTS.map(|half| half.map(|half| wgpu::VertexBufferLayout { step_mode, ..half })).to_vec()
            }
        }
    }

    /// What it does with layers, if anything.
    fn layer(self) -> Option<LayerDraw> {
        match self {
            Self::Surface(surface) => surface.layer,
            _ => None,
        }
    }

    /// How depths are tested and written. Depth is reversed, so that nearer surfaces have a greater depth.
    pub(super) fn depth_stencil(self) -> wgpu::DepthStencilState {
        let composites = self.layer().is_some_and(|layer| !layer.finds());
        let compare = match self {
            // A shader compares the depth of what composites a layer.
            _ if composites => wgpu::CompareFunction::Always,
            _ if self.layer() == Some(LayerDraw::Toward) => wgpu::CompareFunction::Less,
            Self::LayerClear { .. } => wgpu::CompareFunction::Always,
            Self::Lines(Occluded::Through) | Self::Normals(Occluded::Through) => wgpu::CompareFunction::Always,
            // It is first, and at the far end.
            Self::Background => wgpu::CompareFunction::Always,
            _ => wgpu::CompareFunction::Greater,
        };
        // The ground, lines and layers are blended over surfaces.
        let is_blended = composites || matches!(self, Self::Ground | Self::Lines(_) | Self::Normals(_));
        depth_state(!is_blended, compare)
    }

    /// How colours are written; `None` in passes without colours.
    pub(super) fn color_target(self) -> Option<wgpu::ColorTargetState> {
        let (blend, write_mask) = match (self, self.layer()) {
            (_, Some(LayerDraw::Away)) | (Self::LayerClear { has_colors: false, .. }, _) => return None,
            (_, Some(LayerDraw::Toward)) | (Self::LayerClear { .. }, _) => (None, wgpu::ColorWrites::empty()),
            (_, Some(LayerDraw::Over)) => {
                (Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING), wgpu::ColorWrites::ALL)
            }
            (_, Some(LayerDraw::Filter)) => {
                let filter = blended(wgpu::BlendFactor::Zero, wgpu::BlendFactor::Src, wgpu::BlendFactor::SrcAlpha);
                (Some(filter), wgpu::ColorWrites::ALL)
            }
            (_, Some(LayerDraw::Add)) => {
                let add = blended(wgpu::BlendFactor::One, wgpu::BlendFactor::One, wgpu::BlendFactor::One);
                (Some(add), wgpu::ColorWrites::ALL)
            }
            (Self::Ground | Self::Lines(_) | Self::Normals(_), _) => {
                (Some(wgpu::BlendState::ALPHA_BLENDING), wgpu::ColorWrites::ALL)
            }
            _ => (None, wgpu::ColorWrites::ALL),
        };
        Some(wgpu::ColorTargetState { format: COLOR_FORMAT, blend, write_mask })
    }

    pub(super) fn cull_mode(self) -> Option<wgpu::Face> {
        let has_fronts_only = matches!(self, Self::Surface(SurfaceDraw { faces: Faces::Fronts, .. }));
        has_fronts_only.then_some(wgpu::Face::Back)
    }

    /// The values of the shader's constants that aren't the usual ones.
    pub(super) fn constants(self) -> Vec<(&'static str, f64)> {
        match self {
            Self::Surface(surface) => surface.constants(),
            Self::LayerClear { at_infinity, .. } => vec![("WHOLE_DEPTH", if at_infinity { 0.0 } else { 1.0 })],
            Self::Lines(Occluded::Through) | Self::Normals(Occluded::Through) => vec![("THROUGH_SURFACES", 1.0)],
            _ => Vec::new(),
        }
    }
}

/// The attributes of a [`LineSegment`]: start, end, colour, half its width, and how many lie over each other.
const SEGMENT: [wgpu::VertexAttribute; 5] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32, 4 => Float32];
