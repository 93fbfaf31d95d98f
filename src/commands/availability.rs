//! The state of the window that decides which commands are possible.

use std::path::PathBuf;

use inspect::settings::options::{LOD_IS_FIXED, NORMALS_FOLLOW_TRIANGLES};

/// The greatest number of bookmarks of a file: one for each key from 1 to 9.
pub(crate) const MOST_BOOKMARKS: usize = 9;

/// The window's state as far as commands depend on it.
#[derive(Clone, Debug, Default)]
pub struct Availability {
    pub has_document: bool,
    /// Whether the mesh is one that a file has, with axes and a unit, and not a shape that is made in code.
    pub is_of_a_file: bool,
    /// Whether a picture of the document has been drawn.
    pub has_picture: bool,
    /// Whether a reference surface was chosen for the mesh.
    pub has_truth: bool,
    /// Whether factors of a file take the place of LOD's.
    pub has_factors: bool,
    /// Whether a file with functions of the user's own is open in place of LOD.
    pub has_lod_shader: bool,
    /// Whether a file with a function of the user's own is open in place of the surface.
    pub has_surface_shader: bool,
    /// Whether no such function takes the place of the surface.
    pub takes_surface: bool,
    /// Whether a file of light is open.
    pub has_environment: bool,
    pub can_undo: bool,
    pub can_redo: bool,
    /// Whether there is a view before the present one, and one after it.
    pub has_view_before: bool,
    pub has_view_after: bool,
    /// The number of the file's bookmarks.
    pub bookmarks: usize,
    /// Whether an edge or a triangle is selected.
    pub has_selection: bool,
    pub has_selected_patch: bool,
    /// Whether the mesh has heights that can displace it.
    pub has_heights: bool,
    /// Whether the mesh has texture coordinates.
    pub has_texture_coordinates: bool,
    /// Whether normals can be evaluated at pixels.
    pub takes_normals_at: bool,
    /// Whether the LOD that is used takes a tessellation factor.
    pub takes_factor: bool,
    /// Whether the partitioning leaves a choice of LOD.
    pub takes_lod: bool,
    /// Whether backs of the mesh can't be seen, so that patches that face away can be left out.
    pub can_cull_back_faces: bool,
    pub is_split: bool,
    /// Whether LOD and clipping are frozen for a camera.
    pub is_frozen: bool,
    pub shows_deviation: bool,
    /// Whether the chart's panel is open, with something to measure.
    pub can_measure_chart: bool,
    /// Whether the chart has points.
    pub has_chart: bool,
    /// Whether a file is being written, other than the chart's.
    pub is_writing: bool,
    /// The names of the file's cameras.
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
            has_document: true,
            is_of_a_file: true,
            has_picture: true,
            has_truth: true,
            has_factors: true,
            has_lod_shader: true,
            has_surface_shader: true,
            takes_surface: true,
            has_environment: true,
            can_undo: true,
            can_redo: true,
            has_view_before: true,
            has_view_after: true,
            bookmarks: 1,
            has_selection: true,
            has_selected_patch: true,
            has_heights: true,
            has_texture_coordinates: true,
            takes_normals_at: true,
            takes_factor: true,
            takes_lod: true,
            can_cull_back_faces: true,
            is_split: true,
            is_frozen: true,
            shows_deviation: true,
            can_measure_chart: true,
            has_chart: true,
            is_writing: false,
            file_cameras: vec!["Shot".into()],
            clips: vec!["Walk".into()],
            recent: vec!["/meshes/vase.glb".into()],
        }
    }
}

/// Returns the sentence if the condition doesn't hold.
fn unless(holds: bool, why_not: &'static str) -> Option<&'static str> {
    if holds { None } else { Some(why_not) }
}

pub(super) fn always(_: &Availability) -> Option<&'static str> {
    None
}

pub(super) fn document(now: &Availability) -> Option<&'static str> {
    unless(now.has_document, "No mesh is open.")
}

/// Why a shape has neither axis nor unit.
pub(crate) const MADE_IN_CODE: &str = "Shapes are made in code with Y up. Files have axes and units.";

pub(super) fn file(now: &Availability) -> Option<&'static str> {
    document(now).or(unless(now.is_of_a_file, MADE_IN_CODE))
}

pub(super) fn picture(now: &Availability) -> Option<&'static str> {
    unless(now.has_picture, "Nothing is drawn yet.")
}

pub(super) fn export(now: &Availability) -> Option<&'static str> {
    document(now).or(unless(!now.is_writing, WRITES))
}

const WRITES: &str = "Another file is being written.";

pub(super) fn saved_picture(now: &Availability) -> Option<&'static str> {
    picture(now).or(unless(!now.is_writing, WRITES))
}

pub(super) fn truth(now: &Availability) -> Option<&'static str> {
    unless(now.has_truth, "No reference surface was chosen.")
}

pub(super) fn undo(now: &Availability) -> Option<&'static str> {
    unless(now.can_undo, "No setting was changed.")
}

pub(super) fn redo(now: &Availability) -> Option<&'static str> {
    unless(now.can_redo, "No change was undone.")
}

pub(super) fn factors(now: &Availability) -> Option<&'static str> {
    unless(now.has_factors, "No file of factors is open.")
}

pub(super) fn lod_shader(now: &Availability) -> Option<&'static str> {
    unless(now.has_lod_shader, "No LOD shader is open.")
}

pub(super) fn surface_shader(now: &Availability) -> Option<&'static str> {
    unless(now.has_surface_shader, "No surface shader is open.")
}

pub(super) fn surface(now: &Availability) -> Option<&'static str> {
    unless(now.takes_surface, "The control points come from a surface shader.")
}

pub(super) fn environment(now: &Availability) -> Option<&'static str> {
    unless(now.has_environment, "No environment is open.")
}

pub(super) fn view_before(now: &Availability) -> Option<&'static str> {
    unless(now.has_view_before, "The camera has not moved.")
}

pub(super) fn view_after(now: &Availability) -> Option<&'static str> {
    unless(now.has_view_after, "No movement of the camera was undone.")
}

pub(super) fn bookmarks(now: &Availability) -> Option<&'static str> {
    unless(now.bookmarks > 0, "This file has no bookmarks.")
}

pub(super) fn room_for_bookmarks(now: &Availability) -> Option<&'static str> {
    document(now).or(unless(now.bookmarks < MOST_BOOKMARKS, "A file has at most nine bookmarks: forget them first."))
}

/// Why patches that show their backs can't be left out.
pub(crate) const BACKS_ARE_SEEN: &str = "Backs of this mesh can be seen, because one of these holds: it is open, a \
                                         part of it is wound inward, a material is double-sided or has a mask, only some of its \
                                         materials blend or transmit light, it is displaced, or it moves.";

/// Why a checker can't be drawn.
pub(crate) const NO_TEXTURE_COORDINATES: &str = "The mesh has no texture coordinates.";

pub(super) fn selection(now: &Availability) -> Option<&'static str> {
    unless(now.has_selection, "Nothing is selected.")
}

pub(super) fn selected_patch(now: &Availability) -> Option<&'static str> {
    unless(now.has_selected_patch, "No patch is selected: click on one.")
}

pub(super) fn heights(now: &Availability) -> Option<&'static str> {
    unless(now.has_heights, "The mesh has no heights: choose a height image.")
}

pub(super) fn texture_coordinates(now: &Availability) -> Option<&'static str> {
    unless(now.has_texture_coordinates, NO_TEXTURE_COORDINATES)
}

pub(super) fn normals_at(now: &Availability) -> Option<&'static str> {
    unless(now.takes_normals_at, NORMALS_FOLLOW_TRIANGLES)
}

/// Why factors of LOD can't be set, unless factors come from a file or a shader.
fn from_lod(now: &Availability, why: &'static str) -> &'static str {
    match (now.has_factors, now.has_lod_shader) {
        (true, _) => "The factors come from a file.",
        (false, true) => "The factors come from an LOD shader.",
        (false, false) => why,
    }
}

pub(super) fn factor(now: &Availability) -> Option<&'static str> {
    unless(now.takes_factor, from_lod(now, "Adaptive LOD computes a factor for every edge."))
}

pub(super) fn lod(now: &Availability) -> Option<&'static str> {
    unless(now.takes_lod, from_lod(now, LOD_IS_FIXED))
}

pub(super) fn culling(now: &Availability) -> Option<&'static str> {
    unless(now.can_cull_back_faces, BACKS_ARE_SEEN)
}

pub(super) fn split(now: &Availability) -> Option<&'static str> {
    unless(now.is_split, "Only a split view has a left half.")
}

pub(super) fn frozen(now: &Availability) -> Option<&'static str> {
    unless(now.is_frozen, "The LOD camera is not frozen.")
}

pub(super) fn deviation(now: &Availability) -> Option<&'static str> {
    unless(now.shows_deviation, "Only the deviation overlay colours distances.")
}

pub(super) fn measure_chart(now: &Availability) -> Option<&'static str> {
    unless(now.can_measure_chart, "The chart is not open, or has no surface and LOD to measure.")
}

pub(super) fn chart(now: &Availability) -> Option<&'static str> {
    unless(now.has_chart, "The chart has no points yet.")
}

pub(super) fn clips(now: &Availability) -> Option<&'static str> {
    unless(!now.clips.is_empty(), "The mesh has no animation.")
}
