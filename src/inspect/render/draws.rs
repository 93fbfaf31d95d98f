//! What the pipelines of pictures draw.

use super::look::Look;
use super::needs::{Cut, Needs};
use crate::settings::{Choice, NormalsAt};

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
    LitSource(Faces, Needs),
    /// [`Self::Indexed`], [`Self::Pulled`] or [`Self::Source`] of a material that a mask cuts.
    Cut(Triangles, Faces, NormalsAt, Cut),
    /// [`Self::Indexed`] in the variant of a look.
    LookIndexed(Faces, NormalsAt, Look),
    /// [`Self::Pulled`] in such a variant.
    LookPulled(Faces, NormalsAt, Look),
    /// [`Self::Source`] in such a variant.
    LookSource(Look),
    /// Triangles with such materials where they show what is behind them.
    Layer(LayerDraw, Triangles, Faces, NormalsAt, Needs),
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

impl LayerDraw {
    /// Whether it finds depths, and composites nothing.
    pub(super) fn finds(self) -> bool {
        matches!(self, Self::Away | Self::Toward)
    }
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
            composites.chain(finds).map(move |(draw, at)| Self::Layer(draw, triangles, Faces::Both, at, Needs::ALL))
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
        Self::OTHERS
            .into_iter()
            .chain(layers)
            .chain(masks)
            .chain([Self::LitSource(Faces::Both, masked)])
            .chain(cuts)
            .collect()
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
        Self::LitSource(Faces::Both, Needs::ALL),
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
}
