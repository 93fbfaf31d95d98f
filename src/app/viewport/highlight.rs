//! The lines over the mesh: the axes, cracks, T-junctions, bones, the worst point, the frozen LOD camera, and the selection.

use super::frozen_camera::FrozenCamera;
use super::ruler::Ruler;
use crate::app::{App, Document};
use geometry::mesh::{Bounds, Moment, Topology};
use inspect::render::{
    LeftPose, LineSegment, axis_lines, bone_lines, crack_lines, lod_camera_lines, t_junction_lines, worst_lines,
};
use inspect::settings::{Overlays, SplitSide};

/// Everything that the lines over the mesh depend on.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Highlight {
    /// The number of each half's measurement.
    measured: [u64; 2],
    /// The number of the scene in the left half; 0 for none.
    left: u64,
    left_pose: LeftPose,
    /// Whose axes are drawn, if they are.
    axes: Option<Bounds>,
    /// What is shown in each half.
    overlays: [Option<Overlays>; 2],
    t_junctions: bool,
    selected_edge: Option<u32>,
    selected_triangle: Option<u32>,
    /// Number of the emitted triangle that was clicked on, in its patch.
    hit: Option<u32>,
    worst: [u64; 2],
    ruler: Option<Ruler>,
    frozen: Option<(FrozenCamera, Bounds)>,
    /// The moment, if lines depend on it, and whether the pose is known on the CPU.
    moment: Option<(Moment, bool)>,
    /// Counts changes of the lines.
    pub generation: u64,
}

impl App {
    /// Updates the lines over the mesh if anything that they depend on has changed.
    pub(in crate::app) fn mark(&mut self) {
        let Some(document) = &self.document else { return };
        let overlays = SplitSide::BOTH.map(|half| self.settings.half(half).map(|own| own.overlays));
        let shows = |is_on: fn(&Overlays) -> bool| overlays.iter().flatten().any(is_on);
        let junctions = document.checks.t_junctions().filter(|_| shows(|own| own.t_junctions));
        let is_selected = self.selected_edge().is_some() || self.selected_triangle().is_some();
        let is_marked = junctions.is_some() || is_selected;
        let shows_pose = is_marked || shows(|own| own.bones);
        let posed = if is_marked { document.posed() } else { None };
        let shows_measured = shows(|own| own.cracks) || is_selected;
        let wanted = Highlight {
            measured: document.halves.each_ref().map(|half| if shows_measured { half.measure.generation } else { 0 }),
            left: document.scene.half(SplitSide::Left).map_or(0, |_| document.left_made),
            left_pose: document.scene.left_pose(),
            axes: shows(|own| own.grid).then_some(document.scene.bounds),
            overlays,
            t_junctions: junctions.is_some(),
            selected_edge: self.selected_edge(),
            selected_triangle: self.selected_triangle(),
            hit: self.hit().map(|hit| hit.number),
            worst: self.worst_marked(),
            ruler: self.viewport.ruler,
            frozen: self.frozen_shown(),
            moment: document.moment.filter(|_| shows_pose).map(|moment| (moment, posed.is_some())),
            generation: document.highlight.map_or(0, |marked| marked.generation),
        };
        if document.highlight == Some(wanted) {
            return;
        }
        let lines =
            SplitSide::BOTH.map(|half| self.marks(half, document, posed.as_ref().map(|(_, topology)| &**topology)));
        if let Some(document) = &mut self.document {
            document.highlight = Some(Highlight { generation: wanted.generation + 1, ..wanted });
            for (half, lines) in SplitSide::BOTH.into_iter().zip(lines) {
                if let Some(scene) = document.scene.half_mut(half) {
                    scene.set_lines(&self.engine.gpu, &lines);
                }
            }
        }
    }

    /// The lines over a half, in its pose if that is known on the CPU.
    fn marks(&self, half: SplitSide, document: &Document, posed: Option<&Topology>) -> Vec<LineSegment> {
        let posed = posed.filter(|_| document.scene.shares_pose(half));
        let overlays = self.settings.half(half).unwrap_or(self.settings).overlays;
        let mut lines = if overlays.grid { axis_lines(&document.scene.bounds) } else { Vec::new() };
        if let Some((topology, junctions)) = posed.zip(document.checks.t_junctions()).filter(|_| overlays.t_junctions) {
            lines.extend(t_junction_lines(topology, junctions));
        }
        if let Some(found) = self.found(half).filter(|_| overlays.cracks) {
            let own = document.scene.half(half).map(|own| own.tessellator.topology());
            lines.extend(crack_lines(found, own.unwrap_or(&document.loaded.topology)));
        }
        if let Some(own) = document.scene.half(half).filter(|_| overlays.bones) {
            lines.extend(bone_lines(own));
        }
        if let Some(worst) = self.marked_worst(half) {
            lines.extend(worst_lines(worst.emitted.as_vec3(), worst.reference_shape.as_vec3()));
        }
        if let Some((frozen, bounds)) = self.frozen_shown() {
            lines.extend(lod_camera_lines(&frozen.camera, frozen.viewport, &bounds));
        }
        lines.extend(self.ruler_lines());
        // The selection comes last, so that it is over all other lines, and the colours of factors are over that of an edge.
        if let Some(topology) = posed {
            lines.extend(self.selection_lines(topology, half));
            lines.extend(self.patch_outline(topology, half));
        }
        lines
    }
}
