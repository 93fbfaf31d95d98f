//! Everything that a picture is a function of, besides mesh and camera. The window edits it, commands parse into it.

mod overlays;
#[cfg(test)]
pub mod random;

use clap::ValueEnum;
use glam::{Mat4, Vec2};

use crate::mesh::Mesh;
use crate::tessellate::{
    Clip, Convention, Displacement, Edges, Inputs, Lod, LodView, Normals, Partitioning, Surface, displacement_reach,
};

pub use overlays::{Colors, Control, Overlay, Overlays};

/// The smallest and largest tessellation factor.
pub const FACTOR_RANGE: std::ops::RangeInclusive<f32> = 1.0..=64.0;
/// The least and most height of displacement, in bounding radii.
pub const HEIGHT_RANGE: std::ops::RangeInclusive<f32> = -1.0..=1.0;
/// The least and most midlevel.
pub const MIDLEVEL_RANGE: std::ops::RangeInclusive<f32> = 0.0..=1.0;
/// The least and most strength of Phong tessellation.
pub const ALPHA_RANGE: std::ops::RangeInclusive<f32> = 0.0..=1.0;
/// The smallest and largest length of a segment that adaptive LOD is asked for, in px.
pub const PIXELS_RANGE: std::ops::RangeInclusive<f32> = 1.0..=256.0;
/// The smallest and largest tolerance of LOD by error, in px.
pub const TOLERANCE_RANGE: std::ops::RangeInclusive<f32> = 0.01..=100.0;
/// The smallest and largest distance of LOD by distance, in bounding radii.
pub const DISTANCE_RANGE: std::ops::RangeInclusive<f32> = 0.1..=1000.0;
/// Memory for a tessellation's output, in bytes.
pub const ARENA_BYTES: u64 = 256 << 20;

/// The whole state of a view but mesh and camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    pub surface: Surface,
    /// How strong Phong tessellation is, 0 (flat) to 1.
    pub alpha: f32,
    pub normals: Normals,
    pub edges: Edges,
    /// Tessellation factor under uniform LOD, 1 to 64.
    pub factor: f32,
    pub partitioning: Partitioning,
    /// What is chosen; see [`Self::used_lod`].
    pub lod: Lod,
    /// Under adaptive LOD: length of a segment on screen, in px.
    pub pixels: f32,
    /// Under LOD by error: the distance in px that what is emitted keeps to the surface.
    pub tolerance: f32,
    /// Under LOD by distance: up to which the factor is `factor`, and from which on it is 1, in bounding radii; the latter
    /// is larger.
    pub near: f32,
    pub far: f32,
    pub clip: Clip,
    /// Whether patches that show their backs only are left out, of meshes that are closed and single-sided.
    pub cull_back_faces: bool,
    pub convention: Convention,
    pub displacement: Displacement,
    /// How far the greatest height is above the least, in bounding radii.
    pub height_scale: f32,
    /// The height that stays where it is, 0 to 1.
    pub midlevel: f32,
    pub overlays: Overlays,
    /// What distances to the truth are coloured by.
    pub deviation_in: DeviationUnit,
    /// Where the picture is split, tessellated right of it: a fraction of its width.
    pub split: Option<f32>,
    /// What is left of the split, all else the same; none for the mesh as it came.
    pub split_surface: Option<Surface>,
    /// sRGB behind the mesh.
    pub background: [u8; 3],
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            surface: Surface::PnAen,
            alpha: 0.75,
            normals: Normals::Linear,
            edges: Edges::PerEdge,
            factor: 8.0,
            partitioning: Partitioning::FractionalOdd,
            lod: Lod::Uniform,
            pixels: 8.0,
            tolerance: 0.25,
            near: 2.0,
            far: 10.0,
            clip: Clip::Off,
            cull_back_faces: false,
            convention: Convention::D3d11,
            displacement: Displacement::Off,
            height_scale: 0.05,
            midlevel: 0.5,
            overlays: Overlays::default(),
            deviation_in: DeviationUnit::Units,
            split: None,
            split_surface: None,
            background: [0x2b, 0x2e, 0x33],
        }
    }
}

/// Of a picture that is split; one that isn't is all right half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    Left,
    Right,
}

impl Half {
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];
}

/// What a distance on the surface is counted in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum DeviationUnit {
    /// Object units: the same from wherever one looks
    #[default]
    Units,
    /// Px that the distance takes across the view, at its depth
    Px,
}

impl Settings {
    /// What the window opens with: no more than the picture needs, and its triangles.
    pub fn opening() -> Self {
        Self {
            lod: Lod::Error,
            partitioning: Partitioning::Integer,
            clip: Clip::Frustum,
            cull_back_faces: true,
            overlays: Overlays { wireframe: true, ..Overlays::default() },
            ..Self::default()
        }
    }

    /// Changes who computes what an edge's sides agree on. As published, LOD by length and clipping are the white paper's
    /// too, and otherwise their forms that hold near the eye.
    pub fn set_edges(&mut self, edges: Edges) {
        if edges == self.edges {
            return;
        }
        self.edges = edges;
        let published = edges == Edges::AsPublished;
        self.lod = match self.lod {
            Lod::EdgeLength if published => Lod::Paper,
            Lod::Paper if !published => Lod::EdgeLength,
            other => other,
        };
        self.clip = match self.clip {
            Clip::Frustum if published => Clip::Paper,
            Clip::Paper if !published => Clip::Frustum,
            other => other,
        };
    }

    /// Where factors come from. Subtriangulation has one number of segments everywhere, so that it is uniform whatever is
    /// chosen; what is chosen is kept for other partitionings.
    pub fn used_lod(&self) -> Lod {
        if self.partitioning == Partitioning::Subtriangulation { Lod::Uniform } else { self.lod }
    }

    /// What a half is tessellated by; none where the mesh is shown as it came, or there is no such half.
    pub fn half(&self, half: Half) -> Option<Self> {
        match half {
            Half::Left => Some(Self { surface: self.split_surface.filter(|_| self.split.is_some())?, ..*self }),
            Half::Right => Some(*self),
        }
    }

    /// How far heights move any point of a mesh at most, in object units.
    pub fn reach(&self, mesh: &Mesh) -> f32 {
        displacement_reach(mesh, &self.inputs(LodView::new(Mat4::IDENTITY, Vec2::ONE)))
    }

    /// What the tessellation depends on, seen from `view`.
    pub fn inputs(&self, view: LodView) -> Inputs {
        let Self { surface, alpha, normals, edges, factor, partitioning, pixels, tolerance, .. } = *self;
        let Self { near, far, clip, cull_back_faces, convention, displacement, height_scale, midlevel, .. } = *self;
        Inputs {
            surface,
            alpha,
            normals,
            edges,
            factor,
            partitioning,
            lod: self.used_lod(),
            pixels,
            tolerance,
            near,
            far,
            clip,
            cull_back_faces,
            convention,
            displacement,
            height_scale,
            midlevel,
            view,
        }
    }
}

/// What a value is called on the command line, and wherever settings are written down.
pub fn option_name(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subtriangulation_is_uniform_and_forgets_no_lod() {
        let view = LodView::new(glam::Mat4::IDENTITY, glam::Vec2::ONE);
        for partitioning in Partitioning::ALL {
            for lod in [Lod::Uniform, Lod::Paper, Lod::EdgeLength, Lod::Error, Lod::Distance] {
                let settings = Settings { partitioning, lod, ..Settings::opening() };
                let used = if partitioning == Partitioning::Subtriangulation { Lod::Uniform } else { lod };
                assert_eq!((settings.used_lod(), settings.inputs(view).lod), (used, used), "{partitioning} {lod:?}");
            }
        }
    }

    #[test]
    fn as_published_takes_lod_and_clipping_along() {
        let adaptive = Settings { lod: Lod::EdgeLength, clip: Clip::Frustum, ..Settings::default() };
        let mut settings = adaptive;
        settings.set_edges(Edges::AsPublished);
        assert_eq!((settings.lod, settings.clip), (Lod::Paper, Clip::Paper));
        settings.set_edges(Edges::PerEdge);
        assert_eq!(settings, adaptive);
        for lod in [Lod::Uniform, Lod::Error, Lod::Distance] {
            let mut other = Settings { lod, ..Settings::default() };
            other.set_edges(Edges::AsPublished);
            assert_eq!((other.lod, other.clip), (lod, Clip::Off));
        }
    }
}
