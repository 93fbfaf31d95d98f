//! How the pipeline of each draw is set up: shaders and their constants, vertex buffers, depths and colours.

use super::draws::{Draw, Faces, LayerClear, LayerDraw, Occluded, Triangles};
use super::needs::{Cut, Needs};
use super::scene::LineSegment;
use super::target::{COLOR_FORMAT, DEPTH_FORMAT};
use crate::settings::NormalsAt;
use gpu::VERTEX_HALF;

impl Draw {
    /// The name of the vertex shader.
    pub(super) fn vertex_entry(self) -> &'static str {
        match self {
            Self::Plain(_) => "plain_vertex",
            Self::Textured(_) => "textured_vertex",
            Self::PixelNormals(_) => "pixel_vertex",
            Self::Lit(..) => "lit_vertex",
            Self::Indexed(..) | Self::LitIndexed(..) | Self::LookIndexed(..) => "indexed_vertex",
            Self::Pulled(..) | Self::LitPulled(..) | Self::LookPulled(..) => "pulled_vertex",
            Self::Source | Self::LitSource(..) | Self::LookSource(_) => "source_vertex",
            Self::Layer(_, triangles, ..) | Self::Cut(triangles, ..) => match triangles {
                Triangles::Lit => "lit_vertex",
                Triangles::Indexed => "indexed_vertex",
                Triangles::Pulled => "pulled_vertex",
                Triangles::Source => "source_vertex",
            },
            Self::LayerClear(_) => "clear_vertex",
            Self::Background => "background_vertex",
            Self::Ground => "ground_vertex",
            Self::Lines(Occluded::Through) => "hidden_line_vertex",
            Self::Lines(Occluded::InSight) => "line_vertex",
            Self::Normals(_) => "normal_vertex",
        }
    }

    /// The name of the fragment shader.
    pub(super) fn fragment_entry(self) -> &'static str {
        match self {
            Self::Plain(_) => "plain_fragment",
            Self::Textured(_) => "textured_fragment",
            Self::PixelNormals(_) => "pixel_fragment",
            Self::Indexed(_, places)
            | Self::Pulled(_, places)
            | Self::LookIndexed(_, places, _)
            | Self::LookPulled(_, places, _) => at(places, ["surface_fragment", "pixel_surface_fragment"]),
            Self::Source | Self::LookSource(_) => "surface_fragment",
            Self::Lit(_, places, Needs { masked_samples: false, .. }) => {
                at(places, ["lit_fragment", "pixel_lit_fragment"])
            }
            Self::Lit(_, places, _) => at(places, ["masked_lit_fragment", "pixel_masked_lit_fragment"]),
            Self::LitIndexed(_, places, needs) | Self::LitPulled(_, places, needs) => lit_surface(places, needs),
            Self::LitSource(_, needs) => lit_surface(NormalsAt::Vertices, needs),
            Self::Cut(_, _, places, Cut { samples: false, .. }) => {
                at(places, ["cut_surface_fragment", "pixel_cut_surface_fragment"])
            }
            Self::Cut(_, _, places, _) => at(places, ["cut_samples_fragment", "pixel_cut_samples_fragment"]),
            Self::Layer(draw, Triangles::Lit, ..) if draw.finds() => "lit_depth_fragment",
            Self::Layer(draw, ..) if draw.finds() => "surface_depth_fragment",
            Self::Layer(_, Triangles::Lit, _, places, _) => {
                at(places, ["lit_layer_fragment", "pixel_lit_layer_fragment"])
            }
            Self::Layer(_, _, _, places, _) => at(places, ["surface_layer_fragment", "pixel_surface_layer_fragment"]),
            Self::LayerClear(_) => "clear_fragment",
            Self::Background => "background_fragment",
            Self::Ground => "ground_fragment",
            Self::Lines(Occluded::Through) | Self::Normals(Occluded::Through) => "hidden_line_fragment",
            Self::Lines(Occluded::InSight) | Self::Normals(Occluded::InSight) => "line_fragment",
        }
    }

    /// The vertex buffers that it reads.
    pub(super) fn vertex_buffers(self) -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
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
            Self::Source | Self::LitSource(..) | Self::LookSource(_) => Vec::new(),
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
    pub(super) fn depth_stencil(self) -> wgpu::DepthStencilState {
        let compare = match self {
            // A shader compares the depth of what composites a layer.
            Self::Layer(draw, ..) if !draw.finds() => wgpu::CompareFunction::Always,
            Self::LayerClear(_) => wgpu::CompareFunction::Always,
            Self::Layer(LayerDraw::Toward, ..) => wgpu::CompareFunction::Less,
            Self::Lines(Occluded::Through) | Self::Normals(Occluded::Through) => wgpu::CompareFunction::Always,
            // It is first, and at the far end.
            Self::Background => wgpu::CompareFunction::Always,
            _ => wgpu::CompareFunction::Greater,
        };
        // The ground, lines and layers are blended over surfaces.
        let is_blended = matches!(self, Self::Ground | Self::Lines(_) | Self::Normals(_))
            || matches!(self, Self::Layer(draw, ..) if !draw.finds());
        wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(!is_blended),
            depth_compare: Some(compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }
    }

    /// How colours are written; `None` in passes without colours.
    pub(super) fn color_target(self) -> Option<wgpu::ColorTargetState> {
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

    pub(super) fn cull_mode(self) -> Option<wgpu::Face> {
        let (Self::Plain(faces)
        | Self::Textured(faces)
        | Self::PixelNormals(faces)
        | Self::Indexed(faces, _)
        | Self::Pulled(faces, _)
        | Self::Lit(faces, ..)
        | Self::LitIndexed(faces, ..)
        | Self::LitPulled(faces, ..)
        | Self::LitSource(faces, _)
        | Self::Layer(_, _, faces, ..)
        | Self::Cut(_, faces, ..)
        | Self::LookIndexed(faces, ..)
        | Self::LookPulled(faces, ..)) = self
        else {
            return None;
        };
        (faces == Faces::Fronts).then_some(wgpu::Face::Back)
    }

    /// The values of the shader's constants that aren't the usual ones.
    pub(super) fn constants(self) -> Vec<(&'static str, f64)> {
        match self {
            Self::Lit(.., needs)
            | Self::LitIndexed(.., needs)
            | Self::LitPulled(.., needs)
            | Self::LitSource(_, needs) => needs.constants().to_vec(),
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

/// The one of two shaders that gets normals from vertices, or evaluates them at pixels.
fn at(places: NormalsAt, [vertices, pixels]: [&'static str; 2]) -> &'static str {
    match places {
        NormalsAt::Vertices => vertices,
        NormalsAt::Pixels => pixels,
    }
}

/// The fragment shader for materials in light from all around, with overlays.
fn lit_surface(places: NormalsAt, needs: Needs) -> &'static str {
    if needs.masked_samples {
        return at(places, ["masked_surface_fragment", "pixel_masked_surface_fragment"]);
    }
    at(places, ["lit_surface_fragment", "pixel_lit_surface_fragment"])
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
