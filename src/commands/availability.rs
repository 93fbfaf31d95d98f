//! The state of the window that decides which commands are possible.

use std::path::PathBuf;

use geometry::names::every;
use inspect::settings::options::{LOD_IS_FIXED, NORMALS_FOLLOW_TRIANGLES};

/// The greatest number of bookmarks of a file: one for each key from 1 to 9.
pub(crate) const MOST_BOOKMARKS: usize = 9;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    Document,
    /// A mesh that a file has, with axes and a unit, and not a shape that is made in code.
    File,
    /// Another mesh in the folder, or among those that were dropped together.
    Neighbours,
    /// A picture of the document.
    Picture,
    /// No other file is being written.
    NoWriting,
    /// A reference surface that was chosen for the mesh.
    ReferenceShape,
    /// Another mesh left of the split.
    LeftMesh,
    /// The mesh before its file changed.
    Before,
    /// Factors of a file in place of LOD's.
    Factors,
    LodShader,
    SurfaceShader,
    /// No function of the user's own in place of the surface.
    Surface,
    Environment,
    Undo,
    Redo,
    ViewBefore,
    ViewAfter,
    Bookmarks,
    RoomForBookmarks,
    /// An edge or a triangle.
    Selection,
    SelectedPatch,
    /// Heights of the mesh, which can displace it.
    Heights,
    TextureCoordinates,
    /// Normals that can be evaluated at pixels.
    NormalsAt,
    /// An LOD that takes a tessellation factor.
    Factor,
    /// A partitioning that leaves a choice of LOD.
    Lod,
    /// Backs of the mesh that can't be seen.
    Culling,
    Split,
    Frozen,
    Deviation,
    /// The chart's panel, with something to measure.
    MeasurableChart,
    /// Points in the chart.
    Chart,
    Clips,
}

impl Need {
    pub const ALL: [Self; 33] = every![Need:
        Document, File, Neighbours, Picture, NoWriting, ReferenceShape, LeftMesh, Before, Factors, LodShader, SurfaceShader, Surface, Environment, Undo, Redo, ViewBefore,
        ViewAfter, Bookmarks, RoomForBookmarks, Selection, SelectedPatch, Heights, TextureCoordinates, NormalsAt, Factor, Lod, Culling,
        Split, Frozen, Deviation, MeasurableChart, Chart, Clips,
    ];

    /// Why a command is not possible without it, in a sentence.
    fn why_not(self) -> &'static str {
        match self {
            Self::Document => "No mesh is open.",
            Self::File => MADE_IN_CODE,
            Self::Neighbours => "There is no other mesh in this file's folder.",
            Self::Picture => "Nothing is drawn yet.",
            Self::NoWriting => "Another file is being written.",
            Self::ReferenceShape => "No reference surface was chosen.",
            Self::LeftMesh => "Both halves show the same mesh.",
            Self::Before => "The file has not changed since it was opened.",
            Self::Factors => "No file of factors is open.",
            Self::LodShader => "No LOD shader is open.",
            Self::SurfaceShader => "No surface shader is open.",
            Self::Surface => "The control points come from a surface shader.",
            Self::Environment => "No environment is open.",
            Self::Undo => "No setting was changed.",
            Self::Redo => "No change was undone.",
            Self::ViewBefore => "The camera has not moved.",
            Self::ViewAfter => "No movement of the camera was undone.",
            Self::Bookmarks => "This file has no bookmarks.",
            Self::RoomForBookmarks => "A file has at most nine bookmarks: forget them first.",
            Self::Selection => "Nothing is selected.",
            Self::SelectedPatch => "No patch is selected: click on one.",
            Self::Heights => "The mesh has no heights: choose a height image.",
            Self::TextureCoordinates => NO_TEXTURE_COORDINATES,
            Self::NormalsAt => NORMALS_FOLLOW_TRIANGLES,
            Self::Factor => "Adaptive LOD computes a factor for every edge.",
            Self::Lod => LOD_IS_FIXED,
            Self::Culling => BACKS_ARE_SEEN,
            Self::Split => "Only a split view has a left half.",
            Self::Frozen => "The LOD camera is not frozen.",
            Self::Deviation => "Only the deviation overlay colours distances.",
            Self::MeasurableChart => "The chart is not open, or has no surface and LOD to measure.",
            Self::Chart => "The chart has no points yet.",
            Self::Clips => "The mesh has no animation.",
        }
    }
}

/// Why a shape has neither axis nor unit.
pub(crate) const MADE_IN_CODE: &str = "Shapes are made in code with Y up. Files have axes and units.";

/// Why patches that show their backs can't be left out.
pub(crate) const BACKS_ARE_SEEN: &str = "Backs of this mesh can be seen, because one of these holds: it is open, a \
                                         part of it is wound inward, a material is double-sided or has a mask, only some of its \
                                         materials blend or transmit light, it is displaced, or it moves.";

/// Why a checker can't be drawn.
pub(crate) const NO_TEXTURE_COORDINATES: &str = "The mesh has no texture coordinates.";

/// The window's state as far as commands depend on it.
#[derive(Clone, Debug, Default)]
pub struct Availability {
    /// What there is.
    pub has: Vec<Need>,
    pub bookmarks: usize,
    pub file_cameras: Vec<String>,
    /// The names of the mesh's animation clips.
    pub clips: Vec<String>,
    /// Files that were opened last, the last one first.
    pub recent: Vec<PathBuf>,
}

impl Availability {
    /// A state in which every command is possible.
    pub fn everything() -> Self {
        Self {
            has: Need::ALL.into(),
            bookmarks: 1,
            file_cameras: vec!["Shot".into()],
            clips: vec!["Walk".into()],
            recent: vec!["/meshes/vase.glb".into()],
        }
    }

    /// Why what has these needs isn't possible, in a sentence; none if it is.
    pub(super) fn why_not(&self, needs: &[Need]) -> Option<&'static str> {
        let has = |need| self.has.contains(&need);
        let lacking = needs.iter().find(|need| !has(**need))?;
        Some(match lacking {
            Need::Factor | Need::Lod if has(Need::Factors) => "The factors come from a file.",
            Need::Factor | Need::Lod if has(Need::LodShader) => "The factors come from an LOD shader.",
            _ => lacking.why_not(),
        })
    }
}
