//! The selection: a triangle of the mesh, one of its edges, and the emitted triangle that was clicked on.

use egui::Response;
use glam::Vec3;

use crate::app::App;
use geometry::mesh::Topology;
use geometry::tessellate::{Convention, domain_side};
use gpu::GpuError;
use inspect::gates::{PatchSpot, Spot};
use inspect::measure::{patch_edges, patch_facing, patch_width};
use inspect::render::{LineSegment, Picked, PickedTriangle, Picking, Pixel, patch_lines};
use inspect::settings::SplitSide;

/// The selected triangle and edge, and a click that is still being answered.
#[derive(Default)]
pub(crate) struct Selection {
    /// Index into the mesh's triangles.
    triangle: Option<u32>,
    /// Index into the edges of the topology that is shown.
    pub edge: Option<u32>,
    /// The emitted triangle that was clicked on, and its tessellation's number.
    hit: Option<(u64, PickedTriangle)>,
    /// A click on a picture whose tessellation isn't known yet.
    clicked: Option<(SplitSide, Pixel)>,
    /// The search for the triangle under a click: in which half, its tessellation's number, and where the click was.
    picking: Option<(SplitSide, u64, Pixel, Picking)>,
}

impl Selection {
    /// Keeps what is selected, and forgets everything about the tessellation.
    pub(crate) fn forget_tessellation(&mut self) {
        *self = Self { triangle: self.triangle, edge: self.edge, ..Self::default() };
    }

    /// Whether a click is still being answered.
    pub(crate) fn is_busy(&self) -> bool {
        self.clicked.is_some() || self.picking.is_some()
    }
}

impl App {
    /// The selected triangle: an index into the mesh's triangles.
    pub fn selected_triangle(&self) -> Option<u32> {
        self.document.as_ref()?.selection.triangle
    }

    /// The emitted triangle that was clicked on, until the tessellation changes.
    pub fn hit(&self) -> Option<&PickedTriangle> {
        let emitted = self.document.as_ref()?.scene.tessellator.generation();
        self.document.as_ref()?.selection.hit.as_ref().filter(|(of, _)| *of == emitted).map(|(_, triangle)| triangle)
    }

    pub(in crate::app) fn selected_patch(&self) -> Option<u32> {
        self.document.as_ref()?.loaded.topology.patch_of(self.selected_triangle()?)
    }

    /// The half whose factors of the selected patch are shown: the one that is edited, if it shows the same mesh.
    pub(in crate::app) fn patch_half(&self) -> SplitSide {
        let own = self.panels.edited;
        let is_shown = self.document.as_ref().is_some_and(|document| document.scene.shares_pose(own));
        if is_shown && self.settings.split.is_some() { own } else { SplitSide::Right }
    }

    pub(in crate::app) fn convention(&self) -> Convention {
        self.settings.tessellation.convention
    }

    /// Selects a triangle. The selected edge stays if it is one of its edges.
    pub fn select_triangle(&mut self, triangle: Option<u32>) {
        let Some(document) = &mut self.document else { return };
        let triangle = triangle.filter(|&triangle| (triangle as usize) < document.loaded.mesh.triangles.len());
        document.selection = Selection { triangle, edge: document.selection.edge, ..Selection::default() };
        if self.selected_edge().is_some_and(|edge| !self.patch_has(edge)) {
            self.select_only_edge(None);
        }
    }

    /// Selects an edge or none. The selected triangle stays.
    pub(in crate::app) fn select_only_edge(&mut self, edge: Option<u32>) {
        self.document.iter_mut().for_each(|document| document.selection.edge = edge);
    }

    /// Whether it is an edge of the selected patch.
    pub(in crate::app) fn patch_has(&self, edge: u32) -> bool {
        let (Some(patch), Some(document)) = (self.selected_patch(), &self.document) else { return false };
        let topology = &document.loaded.topology;
        topology.patches[patch as usize].sides.iter().any(|&side| topology.sides[side as usize].edge == edge)
    }

    pub(in crate::app) fn deselect(&mut self) {
        self.document.iter_mut().for_each(|document| document.selection = Selection::default());
    }

    /// Notes whether the pointer is pressed while a list is open: such a click only closes the list. Must come before the lists are
    /// shown, since they close themselves.
    pub(in crate::app) fn note_press(&mut self, context: &egui::Context) {
        if context.input(|input| input.pointer.any_pressed()) {
            self.viewport.closes_list = egui::Popup::is_any_open(context);
        }
    }

    /// Starts to answer a click on the picture.
    pub(in crate::app) fn click(&mut self, response: &Response, pixels_per_point: f32) {
        let is_clicked = response.clicked() || response.secondary_clicked();
        let Some(pointer) = response.interact_pointer_pos().filter(|_| is_clicked) else { return };
        let Some(document) = self.document.as_mut().filter(|_| !self.viewport.closes_list) else { return };
        let place = (pointer - response.rect.min) * pixels_per_point;
        document.selection.clicked =
            self.viewport.picture.pixel(&document.scene, [place.x.max(0.0) as u32, place.y.max(0.0) as u32]);
    }

    /// Searches for what was clicked on, on the device. Returns true once the result is taken.
    ///
    /// # Errors
    /// The device was lost.
    pub(in crate::app) fn pick(&mut self) -> Result<bool, GpuError> {
        let Some(document) = &mut self.document else { return Ok(false) };
        if document.scene.tessellator.is_counted()
            && let Some((half, pixel)) = document.selection.clicked.take()
            && let Some(scene) = document.scene.half_mut(half)
        {
            // Picking in a tessellation of many chunks would take as long as drawing it, so its emitted triangles are left out.
            let is_short = scene.tessellator.chunk_count() <= self.viewport.picture.short;
            let pixel = Pixel { has_input: !is_short, ..pixel };
            let picking = self.engine.picker.start(&self.engine.gpu, scene, &pixel)?;
            document.selection.picking = Some((half, scene.tessellator.generation(), pixel, picking));
        }
        let Some((half, of, pixel, mut picking)) = document.selection.picking.take() else { return Ok(false) };
        let Some(found) = picking.poll()? else {
            document.selection.picking = Some((half, of, pixel, picking));
            return Ok(false);
        };
        let is_of_mesh = document.scene.shares_mesh(half);
        if !self.measure_to(half, &pixel, found.as_ref()) && is_of_mesh {
            self.take_picked((half == SplitSide::Right).then_some(of), found);
        }
        Ok(true)
    }

    fn take_picked(&mut self, emitted: Option<u64>, found: Option<Picked>) {
        let (Some(picked), Some(document)) = (found, &mut self.document) else { return self.deselect() };
        let topology = &document.loaded.topology;
        let Some(patch) = topology.patches.get(picked.patch as usize) else { return self.deselect() };
        // The weight is a corner's number, and side k + 1 lies opposite corner k.
        let side = patch.sides[(picked.weight as usize + 1) % 3];
        let edge = Some(topology.sides[side as usize].edge);
        let hit = emitted.zip(picked.triangle);
        document.selection = Selection { triangle: Some(patch.triangle), edge, hit, ..Selection::default() };
    }

    pub(in crate::app) fn frame_patch(&mut self) {
        let (Some(patch), Some(document)) = (self.selected_patch(), &self.document) else { return };
        let topology = &document.shown().1;
        let corners = topology.patch_positions(patch);
        // As far from the middle of the flat triangle, which may lie below the surface, as edges bulge from their chords.
        let bulge = |edge: &Vec<Vec3>| -> Vec3 {
            let chord = edge.first().zip(edge.last()).map_or(Vec3::ZERO, |(a, b)| a * 0.5 + b * 0.5);
            edge.iter().map(|point| (point - chord) / edge.len() as f32).sum()
        };
        let edges = self.patch_edges(topology, patch, SplitSide::Right);
        let at = corners.into_iter().sum::<Vec3>() / 3.0 + edges.iter().map(bulge).sum::<Vec3>() / 3.0;
        let outlines = self.results().map(|results| &results.found.outlines);
        let facing = patch_facing(topology, patch, outlines).normalize_or_zero().as_vec3();
        let spot = PatchSpot { facing, ..PatchSpot::new(corners, at) };
        self.show_place(SplitSide::Right, &Spot::Patch(spot), Some(patch));
    }

    /// See [`patch_edges`].
    pub(in crate::app) fn patch_edges(&self, topology: &Topology, patch: u32, half: SplitSide) -> [Vec<Vec3>; 3] {
        patch_edges(topology, patch, self.found(half).map(|found| &found.outlines), self.convention())
    }

    /// The lines that mark the selected patch: the emitted triangle that was clicked on, and the patch's edges in their factors'
    /// colours.
    pub(in crate::app) fn patch_outline(&self, topology: &Topology, half: SplitSide) -> Vec<LineSegment> {
        let Some(patch) = self.selected_patch() else { return Vec::new() };
        let mut lines = if half == SplitSide::Right { self.hit_lines() } else { Vec::new() };
        let mut edges = self.patch_edges(topology, patch, half);
        // Lines along a crack would cover it.
        let cracked = self.selected_gap(half).map(|crack| crack.edge);
        let sides = topology.patches[patch as usize].sides.map(|side| topology.sides[side as usize].edge);
        (0..3)
            .filter(|&i| Some(sides[domain_side(self.convention(), i) as usize]) == cracked)
            .for_each(|i| edges[i as usize].clear());
        let outlines = self.found(half).map(|found| &found.outlines);
        lines.extend(patch_lines(&edges, patch_width(topology, patch, outlines)));
        lines
    }

    /// The lines around the emitted triangle that was clicked on.
    pub(in crate::app) fn hit_lines(&self) -> Vec<LineSegment> {
        let Some(hit) = self.hit() else { return Vec::new() };
        let corners = hit.vertices.map(|vertex| Vec3::from(vertex.position));
        let edges = [0, 1, 2].map(|k| (corners[k], corners[(k + 1) % 3]));
        let edge = |(a, b)| LineSegment { half_width: 1.25, ..LineSegment::new(a, b, [255; 3]) };
        edges.map(edge).into()
    }
}
