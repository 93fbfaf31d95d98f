//! Cases that break tessellators, and what each method makes of them: run, measured, and held against what this program
//! promises. Stands on [`crate::engine`] as the two faces do, since a case is tessellated and drawn like any mesh.

pub(crate) mod cases;
mod meshes;
mod picture;
mod report;
mod run;
mod sweep_chart;
mod views;

pub(crate) use cases::{CASES, Case, LOOK, Look, Probe};
#[cfg(test)]
pub(crate) use meshes::soup;
pub(crate) use picture::{PictureError, picture};
pub(crate) use report::{LEGEND, PAGE, Section, Verdict, lines, page, table};
pub(crate) use run::{Effort, run};
#[cfg(test)]
pub(crate) use views::random as random_camera;

use serde::Serialize;

use crate::mesh::Mesh;
use crate::settings::Settings;
use crate::tessellate::{Clip, Displacement, Edges, Lod, Partitioning, Surface, Tessellation};

/// What is run: a case, or any other mesh.
#[derive(Clone, Debug)]
pub(crate) struct Subject {
    pub name: String,
    /// What it is, and what becomes of it; empty where nobody knows.
    pub about: String,
    pub mesh: Mesh,
    /// Within which part of the bounding diagonal points are welded.
    pub weld: f32,
    pub probe: Probe,
    pub look: Look,
}

impl Subject {
    /// A mesh of which no more is known.
    pub(crate) fn new(name: String, mesh: Mesh, weld: f32) -> Self {
        Self { name, about: String::new(), mesh, weld, probe: Probe::Edges, look: LOOK }
    }
}

/// A way to tessellate that cases are held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Method {
    Flat,
    Pn,
    PnAenAsPublished,
    PnAen,
    PnCrease,
    Phong,
    PhongAen,
    Nagata,
    NagataAen,
}

impl Method {
    pub(crate) const ALL: [Self; 9] = [
        Self::Flat,
        Self::Pn,
        Self::PnAenAsPublished,
        Self::PnAen,
        Self::PnCrease,
        Self::Phong,
        Self::PhongAen,
        Self::Nagata,
        Self::NagataAen,
    ];

    /// The name in tables and files.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Pn => "PN",
            Self::PnAenAsPublished => "PN-AEN as published",
            Self::PnAen => "PN-AEN",
            Self::PnCrease => "PN crease",
            Self::Phong => "Phong",
            Self::PhongAen => "Phong AEN",
            Self::Nagata => "Nagata",
            Self::NagataAen => "Nagata AEN",
        }
    }

    /// The surface that it makes.
    pub(crate) const fn surface(self) -> Surface {
        match self {
            Self::Flat => Surface::Flat,
            Self::Pn => Surface::Pn,
            Self::PnAenAsPublished | Self::PnAen => Surface::PnAen,
            Self::PnCrease => Surface::PnCrease,
            Self::Phong => Surface::Phong,
            Self::PhongAen => Surface::PhongAen,
            Self::Nagata => Surface::Nagata,
            Self::NagataAen => Surface::NagataAen,
        }
    }

    /// The settings that mean this method, at one factor.
    pub(crate) fn settings(self, partitioning: Partitioning, factor: f32) -> Settings {
        let edges = if self == Self::PnAenAsPublished { Edges::AsPublished } else { Edges::PerEdge };
        Settings::from(Tessellation { surface: self.surface(), edges, partitioning, factor, ..Tessellation::default() })
    }

    /// The same for a mesh that can be displaced: without cracks, or as published by dominance alone.
    pub(crate) fn displacing(self, mesh: &Mesh, settings: Settings) -> Settings {
        let displacement = match self {
            _ if mesh.heights.is_none() => Displacement::Off,
            Self::PnAenAsPublished => Displacement::AsPublished,
            _ => Displacement::On,
        };
        settings.with(Tessellation { displacement, height_scale: 0.15, ..settings.tessellation })
    }

    /// The same with adaptive LOD and clipping: the paper's own for what is as published. Under subtriangulation, which is
    /// uniform, clipping at one factor.
    pub(crate) fn adaptive(self, partitioning: Partitioning, pixels: f32) -> Settings {
        let (lod, clip) = match self {
            Self::PnAenAsPublished => (Lod::Paper, Clip::Paper),
            _ => (Lod::EdgeLength, Clip::Frustum),
        };
        self.settings(partitioning, 5.0).with(Tessellation {
            lod,
            clip,
            pixels,
            ..self.settings(partitioning, 5.0).tessellation
        })
    }
}

/// What is measured. All are 0 where all is well, but for [`Self::Segment`], [`Self::Jump`] and
/// [`Self::Pop`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Quantity {
    /// Points of edges whose positions differ in at least one bit.
    Points,
    /// Edges for which LOD gave the sides different factors.
    Factors,
    /// Points of edges whose normals differ though the source's agree.
    Normals,
    /// Vertices that are no finite numbers.
    NotFinite,
    /// Pixels through which one looks into a closed mesh.
    Leaks,
    /// Triangles that face away from the side that their patch faces.
    Folds,
    /// Pixels that clipping changes.
    Missing,
    /// The longest visible segment over the length asked for, on edges that could be cut finer.
    Segment,
    /// T-junctions that were made and not found, or found and not made.
    TJunctions,
    /// Open edges of a mesh that should be closed.
    OpenEdges,
    /// The largest step of any surface point as the factor grows by 1/64, as a part of the mesh's diagonal, under
    /// fractional partitioning.
    Jump,
    /// The same under integer, pow2 and subtriangulation.
    Pop,
}

impl Quantity {
    /// What a number of it counts.
    pub(crate) const fn unit(self) -> &'static str {
        match self {
            Self::Points => "edge points that differ",
            Self::Factors => "edges whose factors differ",
            Self::Normals => "edge normals that differ",
            Self::NotFinite => "vertices not finite",
            Self::Leaks => "px leaking",
            Self::Folds => "folded triangles",
            Self::Missing => "px clipped away",
            Self::Segment => "times the segment asked for",
            Self::TJunctions => "T-junctions missed",
            Self::OpenEdges => "open edges left",
            Self::Jump => "of the diagonal at most in a fractional step",
            Self::Pop => "of the diagonal at most in a pop",
        }
    }

    /// The most that still holds.
    pub(crate) const fn limit(self) -> f64 {
        match self {
            // Segments are equal along the curve, not on screen: perspective makes the near ones longer.
            Self::Segment => 4.0,
            // Several times what fractional modes were measured at, and far below what the others were.
            Self::Jump | Self::Pop => 0.004,
            _ => 0.0,
        }
    }
}

/// One measurement, the worst of its kind over factors and views.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Row {
    pub case: String,
    pub method: &'static str,
    /// The adapter's name, or `cpu`.
    pub device: String,
    pub partitioning: &'static str,
    pub measured: f64,
    pub unit: &'static str,
    /// Whether this program promises that it holds.
    pub promised: bool,
    pub holds: bool,
    #[serde(skip)]
    pub quantity: Quantity,
}
