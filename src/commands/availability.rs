//! The state of the window that decides which commands are possible.

use std::path::PathBuf;

use geometry::choice::texts;
use inspect::settings::options::{LOD_IS_FIXED, NORMALS_FOLLOW_TRIANGLES};

/// The greatest number of bookmarks of a file: one for each key from 1 to 9.
pub(crate) const MOST_BOOKMARKS: usize = 9;

texts! {
    /// What commands need.
    pub enum Need,
    /// Why a command is not possible without it, in a sentence.
    fn why_not {
        Document => "No mesh is open.",
        /// A mesh that a file has, with axes and a unit, and not a shape that is made in code.
        File => MADE_IN_CODE,
        /// Polygons of the mesh's file, which can be the cage of a subdivision surface.
        Cage => "Shapes and glTF files have triangles alone, and no polygons to subdivide.",
        /// Another mesh in the folder, or among those that were dropped together.
        Neighbours => "There is no other mesh in this file's folder.",
        /// A picture of the document.
        Picture => "Nothing is drawn yet.",
        /// No other file is being written.
        NoWriting => "Another file is being written.",
        /// A reference surface that was chosen for the mesh.
        ReferenceShape => "No reference surface was chosen.",
        /// Another mesh left of the split, or the same one as it was or with weights of its own.
        LeftMesh => "Both halves show the same mesh.",
        /// The mesh before its file changed.
        Before => "The file has not changed since it was opened.",
        /// Factors of a file in place of LOD's.
        Factors => "No file of factors is open.",
        LodShader => "No LOD shader is open.",
        SurfaceShader => "No surface shader is open.",
        /// No function of the user's own in place of the surface.
        Surface => "The control points come from a surface shader.",
        Environment => "No environment is open.",
        Undo => "No setting was changed.",
        Redo => "No change was undone.",
        ViewBefore => "The camera has not moved.",
        ViewAfter => "No movement of the camera was undone.",
        Bookmarks => "This file has no bookmarks.",
        RoomForBookmarks => "A file has at most nine bookmarks: forget them first.",
        /// An edge or a triangle.
        Selection => "Nothing is selected.",
        SelectedPatch => "No patch is selected: click on one.",
        /// Heights of the mesh, which can displace it.
        Heights => "The mesh has no heights: choose a height image.",
        TextureCoordinates => "The mesh has no texture coordinates.",
        Bones => "The mesh has no bones: no skin moves it.",
        /// Normals that can be evaluated at pixels.
        NormalsAt => NORMALS_FOLLOW_TRIANGLES,
        /// An LOD that takes a tessellation factor.
        Factor => "Adaptive LOD computes a factor for every edge.",
        /// A partitioning that leaves a choice of LOD.
        Lod => LOD_IS_FIXED,
        /// Backs of the mesh that can't be seen.
        Culling => BACKS_ARE_SEEN,
        Split => "Only a split view has a left half.",
        Frozen => "The LOD camera is not frozen.",
        Deviation => "Only the deviation overlay colours distances.",
        /// The chart's panel, with something to measure.
        MeasurableChart => "The chart is not open, or has no surface and LOD to measure.",
        /// Points in the chart.
        Chart => "The chart has no points yet.",
        Clips => "The mesh has no animation.",
    }
}

/// Why a shape has neither axis nor unit.
pub(crate) const MADE_IN_CODE: &str = "Shapes are made in code with Y up. Files have axes and units.";

/// Why patches that show their backs can't be left out.
pub(crate) const BACKS_ARE_SEEN: &str = "Backs of this mesh can be seen, because one of these holds: it is open, a \
                                         part of it is wound inward, a material is double-sided or has a mask, only some of its \
                                         materials blend or transmit light, it is displaced, or it moves.";

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
    #[cfg(test)]
    pub(super) fn everything() -> Self {
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
