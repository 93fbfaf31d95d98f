//! The state of the window that decides which commands are possible.

use std::path::PathBuf;

use crate::settings::options::{LOD_IS_FIXED, NORMALS_FOLLOW_TRIANGLES};

/// The window's state as far as commands depend on it.
#[derive(Clone, Debug, Default)]
pub struct Availability {
    pub has_document: bool,
    /// Whether a picture of the document has been drawn.
    pub has_picture: bool,
    /// Whether a reference surface was chosen for the mesh.
    pub has_truth: bool,
    pub can_undo: bool,
    pub can_redo: bool,
    /// Whether an edge or a triangle is selected.
    pub has_selection: bool,
    pub has_selected_patch: bool,
    /// Whether the mesh has heights that can displace it.
    pub has_heights: bool,
    /// Whether normals can be evaluated at pixels.
    pub takes_normals_at: bool,
    /// Whether the LOD that is used takes a tessellation factor.
    pub takes_factor: bool,
    /// Whether the partitioning leaves a choice of LOD.
    pub takes_lod: bool,
    /// Whether backs of the mesh can't be seen, so that patches that face away can be left out.
    pub can_cull_back_faces: bool,
    pub is_split: bool,
    pub shows_deviation: bool,
    /// Whether the chart's panel is open, with something to measure.
    pub can_measure_chart: bool,
    /// Whether the chart has points.
    pub has_chart: bool,
    /// Whether a mesh is being exported.
    pub is_exporting: bool,
    /// The names of the mesh's animation clips.
    pub clips: Vec<String>,
    /// Files that were opened last, the last one first.
    pub recent: Vec<PathBuf>,
}

impl Availability {
    /// A state in which every command is possible.
    #[cfg(test)]
    pub fn everything() -> Self {
        Self {
            has_document: true,
            has_picture: true,
            has_truth: true,
            can_undo: true,
            can_redo: true,
            has_selection: true,
            has_selected_patch: true,
            has_heights: true,
            takes_normals_at: true,
            takes_factor: true,
            takes_lod: true,
            can_cull_back_faces: true,
            is_split: true,
            shows_deviation: true,
            can_measure_chart: true,
            has_chart: true,
            is_exporting: false,
            clips: vec!["Walk".into()],
            recent: vec!["/meshes/vase.glb".into()],
        }
    }
}

/// Returns the sentence if the condition doesn't hold.
fn unless(holds: bool, why_not: &'static str) -> Option<&'static str> {
    if holds { None } else { Some(why_not) }
}

pub(super) fn document(now: &Availability) -> Option<&'static str> {
    unless(now.has_document, "No mesh is open.")
}

pub(super) fn picture(now: &Availability) -> Option<&'static str> {
    unless(now.has_picture, "Nothing is drawn yet.")
}

pub(super) fn export(now: &Availability) -> Option<&'static str> {
    document(now).or(unless(!now.is_exporting, "A mesh is being exported."))
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

/// Why patches that show their backs can't be left out.
pub(crate) const BACKS_ARE_SEEN: &str = "Backs of this mesh can be seen, because one of these holds: it is open, a \
                                         part of it is wound inward, a material is double-sided, it is displaced, or \
                                         it moves.";

pub(super) fn selection(now: &Availability) -> Option<&'static str> {
    unless(now.has_selection, "Nothing is selected.")
}

pub(super) fn selected_patch(now: &Availability) -> Option<&'static str> {
    unless(now.has_selected_patch, "No patch is selected: click on one.")
}

pub(super) fn heights(now: &Availability) -> Option<&'static str> {
    unless(now.has_heights, "The mesh has no heights: choose a height image.")
}

pub(super) fn normals_at(now: &Availability) -> Option<&'static str> {
    unless(now.takes_normals_at, NORMALS_FOLLOW_TRIANGLES)
}

pub(super) fn factor(now: &Availability) -> Option<&'static str> {
    unless(now.takes_factor, "Adaptive LOD computes a factor for every edge.")
}

pub(super) fn lod(now: &Availability) -> Option<&'static str> {
    unless(now.takes_lod, LOD_IS_FIXED)
}

pub(super) fn culling(now: &Availability) -> Option<&'static str> {
    unless(now.can_cull_back_faces, BACKS_ARE_SEEN)
}

pub(super) fn split(now: &Availability) -> Option<&'static str> {
    unless(now.is_split, "Only a split view has a left half.")
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
