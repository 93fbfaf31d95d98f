//! Cases that break tessellators: every method is run on them and measured, and the results are compared with what this
//! program promises. Like the window and the command line, it uses [`inspect::engine`], since a case is tessellated and drawn
//! like any mesh.

pub mod cases;
mod gates;
mod meshes;
mod picture;
mod report;
mod run;
mod sweep_chart;
mod views;

pub(crate) use cases::DEFAULT_VIEW;
pub use cases::{CASES, Case, CaseView, Probe};
pub use gates::{Failure, are_judged, failures};
pub use meshes::soup;
pub use picture::picture;
pub use report::{LEGEND, Line, PAGE, Verdict, lines, page, table};
pub use run::{Effort, run};
pub use views::{random as random_camera, viewport};

use serde::Serialize;

use geometry::mesh::{Mesh, Moment};
use geometry::tessellate::{Clip, Displacement, Edges, Lod, Partitioning, Surface, Tessellation};
use inspect::gates::GateKind;
use inspect::render::Camera;
use inspect::settings::{Choice, Settings};

/// A mesh that the methods are run on: a case's, or any other.
#[derive(Clone, Debug)]
pub struct Subject {
    pub name: String,
    /// See [`Case::about`]; empty for other meshes.
    pub about: String,
    pub mesh: Mesh,
    /// The weld tolerance, as a part of the bounding diagonal.
    pub weld: f32,
    /// Those of loading it.
    pub warnings: Vec<String>,
    pub probe: Probe,
    pub view: CaseView,
}

impl Subject {
    /// A mesh that is no case: only the agreement of edges is measured.
    pub fn new(name: String, mesh: Mesh, weld: f32) -> Self {
        let (about, warnings) = (String::new(), Vec::new());
        Self { name, about, mesh, weld, warnings, probe: Probe::Edges, view: DEFAULT_VIEW }
    }
}

/// A way to tessellate that is run on every case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    Surface(Surface),
    /// PN-AEN with all that the white paper publishes: edges, LOD and clipping.
    AsPublished,
}

impl Method {
    /// Every surface, and the published method before the surface that it publishes.
    pub fn all() -> Vec<Self> {
        let methods = |surface| {
            let published = (surface == Self::AsPublished.surface()).then_some(Self::AsPublished);
            published.into_iter().chain([Self::Surface(surface)])
        };
        Surface::ALL.into_iter().flat_map(methods).collect()
    }

    /// The name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Surface(surface) if surface.is_flat() => "flat",
            Self::Surface(surface) => surface.label(),
            Self::AsPublished => "PN-AEN as published",
        }
    }

    pub const fn surface(self) -> Surface {
        match self {
            Self::Surface(surface) => surface,
            Self::AsPublished => Surface::PnAen,
        }
    }

    /// The name on the command line.
    pub fn option(self) -> String {
        self.name().to_lowercase().replace(' ', "-")
    }

    /// The settings for this method with a uniform factor.
    pub fn settings(self, partitioning: Partitioning, factor: f32) -> Settings {
        let edges = if self == Self::AsPublished { Edges::AsPublished } else { Edges::PerEdge };
        Settings::from(Tessellation { surface: self.surface(), edges, partitioning, factor, ..Tessellation::default() })
    }

    /// The same settings with displacement, if the mesh has a height image: without cracks, or as published with dominance
    /// alone.
    pub fn displacing(self, mesh: &Mesh, settings: Settings) -> Settings {
        let displacement = match self {
            Self::AsPublished if mesh.heights.is_some() => Displacement::AsPublished,
            _ => Displacement::usual(mesh.heights.is_some()),
        };
        settings.with(Tessellation { displacement, height_scale: 0.15, ..settings.tessellation })
    }

    /// The settings for this method with clipping and adaptive LOD, of about `pixels` px a segment. The method as published
    /// uses the white paper's own. Subtriangulation, which is always uniform, has clipping at one factor.
    pub fn adaptive(self, partitioning: Partitioning, pixels: f32) -> Settings {
        let (lod, clip) = match self {
            Self::AsPublished => (Lod::Paper, Clip::Paper),
            Self::Surface(_) => (Lod::EdgeLength, Clip::Frustum),
        };
        let settings = self.settings(partitioning, 5.0);
        settings.with(Tessellation { lod, clip, pixels, ..settings.tessellation })
    }
}

/// What is measured. Each number is 0 if nothing is wrong, except for [`Self::Segment`], [`Self::Jump`] and [`Self::Pop`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// Points of edges whose positions differ between sides in at least one bit.
    Points,
    /// Edges for which LOD gave the sides different factors.
    Factors,
    /// Points of edges whose normals differ between sides although the mesh's normals agree.
    Normals,
    /// Vertices with a coordinate that is infinite or NaN.
    NotFinite,
    /// Pixels that show the inside of a closed mesh.
    Leaks,
    /// Triangles that face away from the side that their patch faces.
    Folds,
    /// Pixels that clipping changes.
    Missing,
    /// The length of the longest visible segment, divided by the length asked for, on edges that could be cut finer.
    Segment,
    /// The difference between the number of T-junctions in the mesh and the number found.
    TJunctions,
    /// Open edges of a mesh that should be closed.
    OpenEdges,
    /// The largest distance that any surface point moves as the factor grows by 1/64, as a part of the mesh's diagonal,
    /// under fractional partitioning.
    Jump,
    /// The same under the other partitionings: integer, pow2, subtriangulation and rows.
    Pop,
}

impl Quantity {
    /// The text that follows a number of it; the gate that judges it, if there is one; and the largest number that still counts
    /// as holding.
    const fn declared(self) -> (&'static str, Option<GateKind>, f64) {
        match self {
            Self::Points => ("edge points that differ", Some(GateKind::Cracks), 0.0),
            Self::Factors => ("edges whose factors differ", Some(GateKind::Factors), 0.0),
            Self::Normals => ("edge normals that differ", None, 0.0),
            Self::NotFinite => ("vertices not finite", None, 0.0),
            Self::Leaks => ("px leaking", Some(GateKind::Leaks), 0.0),
            Self::Folds => ("folded triangles", Some(GateKind::Folds), 0.0),
            Self::Missing => ("px clipped away", None, 0.0),
            // Segments are equally long along the curve, but perspective makes the near ones longer on screen.
            Self::Segment => ("times the segment asked for", None, 4.0),
            Self::TJunctions => ("T-junctions missed", None, 0.0),
            Self::OpenEdges => ("open edges left", None, 0.0),
            // Several times what was measured under fractional partitioning, and far below the others.
            Self::Jump => ("of the diagonal (the largest jump in a fractional step)", None, 0.004),
            Self::Pop => ("of the diagonal (the largest pop)", None, 0.004),
        }
    }

    pub const fn unit(self) -> &'static str {
        self.declared().0
    }

    pub(crate) const fn gate(self) -> Option<GateKind> {
        self.declared().1
    }

    pub const fn limit(self) -> f64 {
        self.declared().2
    }
}

/// One tessellation that was tried, and from where it was seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tried {
    pub settings: Settings,
    /// LOD and clipping are those of this camera, in a picture of the size of [`viewport`]. The mesh is seen from it, too.
    pub camera: Camera,
    /// None at rest.
    pub moment: Option<Moment>,
}

impl Tried {
    /// The mesh itself, from where its case's picture is taken.
    pub fn from_mesh(subject: &Subject) -> Self {
        let settings = Method::Surface(Surface::Flat).settings(Partitioning::Integer, 1.0);
        let camera = views::camera(&subject.mesh.bounds(), &subject.view, viewport());
        Self { settings, camera, moment: None }
    }
}

/// One measurement: the worst number of a quantity over factors and views.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    pub case: String,
    pub method: &'static str,
    /// The adapter's name, or `cpu`.
    pub device: String,
    pub partitioning: &'static str,
    pub measured: f64,
    pub unit: &'static str,
    /// Whether this program promises that `holds` is true.
    pub promised: bool,
    /// Whether `measured` is at most [`Quantity::limit`].
    pub holds: bool,
    #[serde(skip)]
    pub quantity: Quantity,
    /// The first tessellation with that number; none for what isn't about a single one.
    #[serde(skip)]
    pub tried: Option<Tried>,
}
