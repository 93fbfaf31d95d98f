//! What the pipelines of pictures draw.

use super::needs::{Cut, Needs};
use crate::settings::{Colors, NormalsAt};

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
