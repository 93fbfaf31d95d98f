//! The panel on the left: the settings.

use crate::app::App;
use crate::app::text::short;
use crate::app::widgets::{chooser, fixed, heading, value_chooser};
use crate::commands::value_names::{
    BACKS_ARE_SEEN, CLIPS, COLORS, CONVENTIONS, DEVIATION_UNITS, EDGES, LOD_FIXED, LODS, NORMALS, OVERLAYS,
    PARTITIONINGS, SURFACES, explanation, surface_name,
};
use crate::commands::{Action, Change, key_name, with_key};
use crate::settings::{
    ALPHA_RANGE, Colors, Control, DISTANCE_RANGE, FACTOR_RANGE, Half, Overlay, Overlays, PIXELS_RANGE, Settings,
    TOLERANCE_RANGE,
};
use crate::tessellate::{Displacement, Lod, Partitioning};

impl App {
    pub(in crate::app) fn settings_panel(&mut self, ui: &mut egui::Ui) {
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            heading(ui, "Surface");
            egui::Grid::new("surface").num_columns(2).min_col_width(84.0).show(ui, |ui| self.surface_rows(ui));
            heading(ui, "Level of detail");
            self.lod_rows(ui);
            heading(ui, "Mesh");
            egui::Grid::new("weld").num_columns(2).min_col_width(84.0).show(ui, |ui| {
                self.weld_row(ui);
                self.crease_band_row(ui);
                self.height_rows(ui);
            });
            self.animation_section(ui);
            heading(ui, "Overlays");
            let Settings { overlays, deviation_in: unit, .. } = &mut self.settings;
            egui::Grid::new("colors").num_columns(2).min_col_width(84.0).show(ui, |ui| {
                let texts = COLORS.map(|(colors, _, text)| with_key(text, &colors_action(colors)));
                let choices: Vec<_> =
                    COLORS.iter().zip(&texts).map(|(&(colors, name, _), text)| (colors, name, text.as_str())).collect();
                chooser(ui, "Colours", "What the surface's colours mean.", &mut overlays.colors, &choices);
                let hover = "What distances are coloured by (--deviation-in).";
                if overlays.colors == Colors::Deviation {
                    value_chooser(ui, "Distances in", hover, unit, &DEVIATION_UNITS);
                } else {
                    let shown = DEVIATION_UNITS.iter().find(|(choice, _)| choice == unit).map_or("", |(_, name)| name);
                    fixed(ui, "Distances in", shown, "Only deviation colours distances.");
                }
            });
            for (overlay, name, hover) in OVERLAYS {
                if let Control::Switch(switch) = overlays.control(overlay) {
                    ui.checkbox(switch, name).on_hover_text(with_key(hover, &overlay_action(overlay)));
                }
            }
            heading(ui, "View");
            self.view_rows(ui);
        });
    }

    fn surface_rows(&mut self, ui: &mut egui::Ui) {
        let settings = &mut self.settings;
        let takes_factor = matches!(settings.used_lod(), Lod::Uniform | Lod::Distance);
        value_chooser(ui, "Surface", "What each triangle becomes (--surface).", &mut settings.surface, &SURFACES);
        let hover = "How strong Phong tessellation is, from 0, flat, to 1; its authors use 0.75 (--alpha).";
        let label = ui.label("Alpha").on_hover_text(hover);
        let has_strength = |half| settings.half(half).is_some_and(|half| half.surface.is_phong());
        let is_phong = Half::BOTH.into_iter().any(has_strength);
        let slider = egui::Slider::new(&mut settings.alpha, ALPHA_RANGE).max_decimals(2);
        ui.add_enabled(is_phong, slider)
            .labelled_by(label.id)
            .on_hover_text(hover)
            .on_disabled_hover_text("Only Phong tessellation has a strength.");
        ui.end_row();
        value_chooser(
            ui,
            "Shading",
            "Which normals the surface is shaded with (--normals).",
            &mut settings.normals,
            &NORMALS,
        );
        let hover = format!(
            "Tessellation factor: segments that each edge is cut into, 1 to 64 ({} and {}). Under LOD by distance, the largest.",
            key_name(&Action::Setting(Change::FactorUp)),
            key_name(&Action::Setting(Change::FactorDown)),
        );
        let label = ui.label("Factor").on_hover_text(&hover);
        let slider = egui::Slider::new(&mut settings.factor, FACTOR_RANGE)
            .max_decimals(3)
            .logarithmic(true)
            .update_while_editing(false);
        ui.add_enabled(takes_factor, slider)
            .labelled_by(label.id)
            .on_hover_text(hover)
            .on_disabled_hover_text("Adaptive LOD computes a factor for every edge.");
        ui.end_row();
        chooser(
            ui,
            "Partitioning",
            "How factors become segments (--partitioning).",
            &mut settings.partitioning,
            &PARTITIONINGS,
        );
        let mut edges = settings.edges;
        value_chooser(
            ui,
            "Edges",
            &format!(
                "Shared edges: computed once, which is watertight, or by each patch, as published ({}; --edges).",
                key_name(&Action::Setting(Change::ToggleEdges))
            ),
            &mut edges,
            &EDGES,
        );
        settings.set_edges(edges);
    }

    fn lod_rows(&mut self, ui: &mut egui::Ui) {
        let settings = &mut self.settings;
        egui::Grid::new("lod").num_columns(2).min_col_width(84.0).show(ui, |ui| {
            if settings.partitioning == Partitioning::Subtriangulation {
                fixed(ui, "LOD", "Uniform", LOD_FIXED);
            } else {
                let hover = format!(
                    "Where factors come from ({}; --lod).",
                    key_name(&Action::Setting(Change::AdaptiveLod))
                );
                value_chooser(ui, "LOD", &hover, &mut settings.lod, &LODS);
            }
            lod_row(ui, settings);
            ui.end_row();
            value_chooser(ui, "Clipping", "Which patches out of view are left out (--clip).", &mut settings.clip, &CLIPS);
            let hover =
                "Which edge each factor is for, and which corner each weight: what hull and domain shader agree on (--convention).";
            value_chooser(ui, "Convention", hover, &mut settings.convention, &CONVENTIONS);
        });
        self.back_face_row(ui);
        let mut frozen = self.viewport.frozen.is_some();
        let hover = "LOD and clipping stay as they are for the camera of now, while you look from elsewhere.";
        let hover = with_key(hover, &Action::FreezeLodCamera);
        if ui.checkbox(&mut frozen, "Freeze LOD camera").on_hover_text(hover).changed() {
            self.toggle_frozen();
        }
    }

    /// Whether backs of the mesh can't be seen, so that patches that face away can be left out.
    pub(in crate::app) fn can_cull_back_faces(&self) -> bool {
        let scene = self.document.as_ref().map(|document| &document.scene);
        let moves = self.settings.displacement != Displacement::Off
            && scene.is_some_and(|scene| scene.tessellator.mesh().heights.is_some());
        scene.is_some_and(|scene| scene.tessellator.is_solid()) && !moves && self.moment().is_none()
    }

    fn back_face_row(&mut self, ui: &mut egui::Ui) {
        let is_solid = self.can_cull_back_faces();
        let check = egui::Checkbox::new(&mut self.settings.cull_back_faces, "Cull back faces");
        ui.add_enabled(is_solid, check)
            .on_hover_text(
                "Leaves out patches whose surface shows its back everywhere, as long as nothing can be seen of it: not in a \
                 clip, not while the near plane cuts the mesh, nor where PN, edges as published or a mistaken convention tear it.",
            )
            .on_disabled_hover_text(BACKS_ARE_SEEN);
    }

    /// The tolerances, each with what it would join; another one loads the mesh again.
    fn weld_row(&mut self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let weld = document.loaded.preparation.weld;
        let label = ui.label("Weld");
        let mut chosen = weld;
        let combo = egui::ComboBox::from_id_salt("Weld").selected_text(tolerance(weld)).show_ui(ui, |ui| {
            ui.selectable_value(&mut chosen, 0.0, "Exact").on_hover_text("Only exactly equal positions are one point.");
            match document.checks.joins() {
                Some(all) => {
                    for joins in all {
                        let text = format!("{}: {joins}", tolerance(joins.tolerance));
                        ui.selectable_value(&mut chosen, joins.tolerance, text).on_hover_text(format!(
                            "As a part of the bounding diagonal: {} units here. Compared with the exact weld.",
                            short(f64::from(joins.tolerance * document.diagonal))
                        ));
                    }
                }
                None if document.checks.is_busy() => drop(ui.weak("trying tolerances…")),
                None => drop(ui.weak("not tried")),
            }
        });
        combo.response.labelled_by(label.id).on_hover_text(
            "Positions within this part of the bounding diagonal become one point, which joins open edges that nearly \
             meet. The list says how many each tolerance would join.",
        );
        ui.end_row();
        if chosen != weld {
            self.prepare(ui.ctx(), |preparation| preparation.weld = chosen);
        }
    }

    fn view_rows(&mut self, ui: &mut egui::Ui) {
        let mut split = self.settings.split.is_some();
        let hover = with_key(
            "Left of the divider the untessellated mesh or another surface, right of it this one, from one camera.",
            &Action::SplitView,
        );
        if ui.checkbox(&mut split, "Split view").on_hover_text(hover).changed() {
            self.toggle_split();
        }
        egui::Grid::new("view").num_columns(2).min_col_width(84.0).show(ui, |ui| {
            left_row(ui, &mut self.settings);
            let mut percent = self.settings.split.unwrap_or(self.viewport.last_split) * 100.0;
            let label = ui.label("Divider");
            let slider = egui::Slider::new(&mut percent, 0.0..=100.0).max_decimals(0).suffix(" %");
            let response = ui.add_enabled(split, slider).labelled_by(label.id);
            if response.on_hover_text("Where the view is split, from the left.").changed() {
                self.viewport.last_split = percent / 100.0;
                self.settings.split = Some(self.viewport.last_split);
            }
            ui.end_row();
            let label = ui.label("Background");
            let response = ui.color_edit_button_srgb(&mut self.settings.background).labelled_by(label.id);
            if response.has_focus() {
                let stroke = ui.visuals().selection.stroke;
                ui.painter().rect_stroke(response.rect.expand(2.0), 3.0, stroke, egui::StrokeKind::Outside);
            }
            response.on_hover_text("sRGB colour behind the mesh.");
            ui.end_row();
        });
    }

    pub(in crate::app) fn toggle_split(&mut self) {
        self.settings.split = if self.settings.split.is_some() { None } else { Some(self.viewport.last_split) };
    }

    pub(in crate::app) fn toggle_frozen(&mut self) {
        self.viewport.frozen = match self.viewport.frozen {
            Some(_) => None,
            None => self.viewport.picture.shown_view(),
        };
    }
}

/// The command that switches an overlay.
fn overlay_action(overlay: Overlay) -> Action {
    Action::Setting(Change::Overlay(overlay))
}

/// The command that gives the surface these colours.
fn colors_action(colors: Colors) -> Action {
    let gives = |overlay: &Overlay| match Overlays::default().control(*overlay) {
        Control::Colors(_, given) => given == colors,
        Control::Switch(_) => false,
    };
    let overlay = Overlay::ALL.into_iter().find(gives);
    overlay.map_or(Action::Setting(Change::MaterialColors), overlay_action)
}

/// What is left of the split.
fn left_row(ui: &mut egui::Ui, settings: &mut Settings) {
    let abouts = SURFACES.map(|(surface, _)| format!("{} All other settings are the same.", explanation(surface)));
    let as_it_came = (None, "As it came", "The mesh itself, untessellated.");
    let surfaces = SURFACES.iter().zip(&abouts).map(|(&(surface, name), about)| (Some(surface), name, about.as_str()));
    let choices: Vec<_> = [as_it_came].into_iter().chain(surfaces).collect();
    if settings.split.is_some() {
        let hover = "What is shown left of the divider: the mesh as it came, or another surface, to hold two methods against \
                     each other (--split-surface).";
        chooser(ui, "Left", hover, &mut settings.split_surface, &choices);
    } else {
        let shown = settings.split_surface.map_or("As it came", surface_name);
        fixed(ui, "Left", shown, "Only a split view has a left half.");
    }
}

/// What the chosen LOD takes.
fn lod_row(ui: &mut egui::Ui, settings: &mut Settings) {
    let lod = settings.used_lod();
    if lod == Lod::Distance {
        distances_row(ui, settings);
        return;
    }
    let (name, hover, value, range, decimals) = if lod == Lod::Error {
        let hover = "How far what is emitted may be from the surface on screen, in px.";
        ("Tolerance", hover, &mut settings.tolerance, TOLERANCE_RANGE, 2)
    } else {
        ("Segment", "Length of a segment on screen, in px.", &mut settings.pixels, PIXELS_RANGE, 1)
    };
    let label = ui.label(name).on_hover_text(hover);
    let slider = egui::Slider::new(value, range)
        .logarithmic(true)
        .max_decimals(decimals)
        .suffix(" px")
        .update_while_editing(false);
    ui.add_enabled(lod != Lod::Uniform, slider)
        .labelled_by(label.id)
        .on_hover_text(hover)
        .on_disabled_hover_text("Only adaptive LOD measures on screen.");
}

/// Near and far, which stay apart.
fn distances_row(ui: &mut egui::Ui, settings: &mut Settings) {
    let (least, most) = (*DISTANCE_RANGE.start(), *DISTANCE_RANGE.end());
    let (near, far) = (settings.near, settings.far);
    let drag = |ui: &mut egui::Ui, label: egui::Response, value: &mut f32, range, hover: &str| {
        let drag = egui::DragValue::new(value).range(range).speed(0.05).max_decimals(2).suffix(" r");
        ui.add(drag.update_while_editing(false)).labelled_by(label.on_hover_text(hover).id).on_hover_text(hover);
    };
    let label = ui.label("Near");
    ui.horizontal(|ui| {
        let hover = "Up to this distance to the eye every edge gets the factor, in bounding radii of the mesh.";
        drag(ui, label, &mut settings.near, least..=far * 0.99, hover);
        let label = ui.label("far");
        let hover = "From this distance to the eye on every edge gets 1, in bounding radii of the mesh.";
        drag(ui, label, &mut settings.far, near * 1.01..=most, hover);
    });
}

fn tolerance(weld: f32) -> String {
    if weld == 0.0 { "Exact".into() } else { format!("{weld:e}") }
}
