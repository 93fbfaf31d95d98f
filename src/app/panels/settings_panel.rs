//! The settings in the left panel.

use super::option_rows::{option_hover, option_row, shown_option_row};
use crate::app::App;
use crate::app::jobs::job_list::{LeftChoice, Work};
use crate::app::sections::{Section, scrolling_column};
use crate::app::text::short;
use crate::app::widgets::{LABEL_WIDTH, button_row, chooser, file_row, fixed, list_row};
use crate::commands::{
    Action, BACKS_ARE_SEEN, Change, CompanionFile, LEFT_MESH, Purpose, all, key_name, with_key, with_note,
};
use geometry::tessellate::{Lod, Surface, Tessellation};
use inspect::settings::{
    Choice, Colors, Declaration, Kind, Overlay, Overlays, Range, Settings, SplitSide, Value, options,
};
use load::MorphWeights;

/// Rows with a label and a control or a number each.
fn grid(name: &str) -> egui::Grid {
    egui::Grid::new(name).num_columns(2).min_col_width(LABEL_WIDTH)
}

impl App {
    pub(in crate::app) fn settings_panel(&mut self, ui: &mut egui::Ui) {
        scrolling_column(ui, 0.0, |ui| {
            // Lists, and sliders with their numbers, end where the lines under the titles do.
            let (gap, room) = (ui.spacing().item_spacing.x, ui.available_width());
            let controls = room - LABEL_WIDTH - gap;
            ui.spacing_mut().combo_width = controls;
            ui.spacing_mut().slider_width = controls - gap - ui.spacing().interact_size.x;
            self.halves_row(ui);
            self.of_half(|app, is_left| {
                app.section(ui, Section::Surface, Self::surface_rows);
                app.section(ui, Section::LevelOfDetail, Self::lod_rows);
                if app.section(ui, Section::Displacement, Self::height_map_row) {
                    app.part_heights(ui);
                    grid("displacement").show(ui, |ui| app.displacement_rows(ui));
                }
                // Those of another file on the left aren't listed.
                let own = app.other_left().filter(|_| is_left).map(|left| &left.content.source);
                if own.is_none_or(|own| Some(own) == app.source()) {
                    app.parts_section(ui);
                }
                app.morphs_section(ui, is_left);
                app.section(ui, Section::Look, Self::look_rows);
                app.section(ui, Section::Import, Self::import_rows);
                app.section(ui, Section::Advanced, Self::advanced_rows);
            });
        });
    }

    /// Which half of a split view is edited, and buttons that exchange both halves and that keep the right one. While a file stands
    /// for settings of the right half, these come back there when it is closed, so that half alone is edited.
    fn halves_row(&mut self, ui: &mut egui::Ui) {
        let has_files = self.given.is_some() || self.lod_shader.is_some() || self.surface_shader.is_some();
        let has_left = self.settings.split.is_some() && !has_files;
        if !has_left {
            self.panels.edited = SplitSide::Right;
        }
        if self.settings.split.is_none() {
            return;
        }
        let row = |ui: &mut egui::Ui| {
            for (half, name) in [(SplitSide::Left, "Edit left (A)"), (SplitSide::Right, "Edit right (B)")] {
                let hover = "The settings of surface, level of detail, displacement and below Advanced are those of this half; so are \
                             its looks and overlays, if Left looks gives the left half its own.";
                let button = egui::Button::selectable(self.panels.edited == half, name);
                if ui.add_enabled(has_left, button).on_hover_text(hover).clicked() {
                    self.panels.edited = half;
                }
            }
            let now = self.availability();
            let commands = all(&now);
            self.command_button(ui, &commands, &now, &Change::SwapHalves.into(), ["Swap"; 2]);
            self.command_button(ui, &commands, &now, &Action::KeepOnLeft, ["Keep the right half on the left"; 2]);
        };
        ui.horizontal_wrapped(row);
    }

    /// Shows rows whose settings are those of the half that is edited. They get whether that is the left one.
    pub(super) fn of_half(&mut self, show: impl FnOnce(&mut Self, bool)) {
        let is_left = self.panels.edited == SplitSide::Left && self.settings.split.is_some();
        if is_left {
            self.settings.swap_halves();
        }
        show(self, is_left);
        if is_left {
            self.settings.swap_halves();
        }
    }

    /// Which mesh the left half shows.
    fn left_mesh_row(&mut self, ui: &mut egui::Ui) {
        let (open, left) = (self.document.as_ref(), self.other_left());
        let from = left.map(|left| left.from.clone());
        let shown = match &from {
            None => "The same".to_owned(),
            Some(LeftChoice::Read(None, _)) => "The same, own weights".to_owned(),
            Some(LeftChoice::Read(Some(source), _)) => source.title(),
            Some(LeftChoice::Kept(kept)) if Some(&kept.loaded.source) != self.source() => kept.loaded.source.title(),
            Some(LeftChoice::Kept(kept)) if open.is_some_and(|open| kept.version < open.version) => {
                "Before the change on disk".to_owned()
            }
            Some(LeftChoice::Kept(_)) => "As kept".to_owned(),
        };
        let before = open.and_then(|open| open.before.clone().map(LeftChoice::Kept));
        let file = self.reference_shape().filter(|source| source.shape().is_none()).cloned();
        let is_reference = matches!(&from, Some(LeftChoice::Read(Some(left), _)) if Some(left) == file.as_ref());
        list_row(ui, "Left mesh", &with_note(LEFT_MESH, "--split-with"), &shown, |ui| {
            if ui.selectable_label(from.is_none(), "The same").clicked() {
                self.close_companion(CompanionFile::LeftMesh);
            }
            if from.is_some() && !is_reference {
                let _ = ui.selectable_label(true, &shown);
            }
            if before.is_some() && before != from && ui.selectable_label(false, "Before the change on disk").clicked() {
                self.compare_with_before();
            }
            if let Some(file) = file
                && ui.selectable_label(is_reference, format!("Reference surface: {}", file.title())).clicked()
                && !is_reference
            {
                self.read_left(ui.ctx(), Some(file), MorphWeights::new());
            }
            if ui.selectable_label(false, "Another file…").clicked() {
                self.ask_for(ui.ctx(), Purpose::CompanionFile(CompanionFile::LeftMesh));
            }
        });
    }

    /// What the left half shows.
    fn left_row(&mut self, ui: &mut egui::Ui) {
        let option = &options::SPLIT_LEFT;
        let unset = option.unset.iter().map(|unset| (None, unset.label, unset.text));
        let surfaces = Surface::ALL.iter().map(|surface| (Some(*surface), surface.label(), surface.text()));
        let (shown, choices) = (self.settings.left_surface(), unset.chain(surfaces).collect::<Vec<_>>());
        if let Some(surface) = chooser(ui, option.label, &option_hover(option, ""), shown, &choices) {
            self.settings.set_left_surface(surface);
        }
    }

    /// Whether the left half looks otherwise than the right one.
    fn left_looks_row(&mut self, ui: &mut egui::Ui) {
        let option = &options::SPLIT_LOOKS;
        let same = option.unset.iter().map(|unset| (false, unset.label, unset.text));
        let own = (true, "Its own", "Edit left then has the overlays, colours and light of the left half.");
        let (has_own, choices) = (self.settings.left_looks.is_some(), same.chain([own]).collect::<Vec<_>>());
        if let Some(has_own) = chooser(ui, option.label, &option_hover(option, ""), has_own, &choices) {
            // Nothing differs yet.
            option.set(&mut self.settings, if has_own { Value::Options(Vec::new()) } else { Value::Unset });
        }
    }

    /// A section of rows with a label and a control or a number each. Returns whether it is open.
    pub(super) fn section(
        &mut self,
        ui: &mut egui::Ui,
        section: Section,
        rows: impl FnOnce(&mut Self, &mut egui::Ui),
    ) -> bool {
        let is_open = self.panels.open.title(ui, section);
        if is_open {
            grid(section.title()).show(ui, |ui| rows(self, ui));
        }
        is_open
    }

    fn surface_rows(&mut self, ui: &mut egui::Ui) {
        self.scene_row(ui);
        self.variant_row(ui);
        if !self.surface_shader_rows(ui) {
            option_row(ui, &options::SURFACE, &mut self.settings, "");
        }
        let mut shown = self.settings;
        if self.preparation().parts.has_phong() {
            // The strength is that of parts, whatever the surface of the others is.
            shown.tessellation.surface = Surface::Phong;
        }
        shown_option_row(ui, &options::ALPHA, &mut shown);
        self.settings.tessellation.alpha = shown.tessellation.alpha;
        if self.settings.split.is_some() && self.panels.edited == SplitSide::Right {
            self.left_mesh_row(ui);
            self.left_row(ui);
            self.left_looks_row(ui);
            option_row(ui, &options::SPLIT_VIEW, &mut self.settings, "");
        }
        self.normals_rows(ui);
        let settings = &mut self.settings;
        option_row(ui, &options::NORMALS, settings, "");
        option_row(ui, &options::PARTITIONING, settings, "");
    }

    /// What specialists set.
    fn advanced_rows(&mut self, ui: &mut egui::Ui) {
        let settings = &mut self.settings;
        option_row(ui, &options::EDGES, settings, key_name(&Action::Setting(Change::ToggleEdges)));
        option_row(ui, &options::CONVENTION, settings, "");
        option_row(ui, &options::CLIP, settings, "");
        shown_option_row(ui, &options::NORMALS_AT, settings);
        self.weld_row(ui);
        self.crease_band_row(ui);
        self.back_face_row(ui);
    }

    fn lod_rows(&mut self, ui: &mut egui::Ui) {
        if let Some(given) = &self.given {
            file_row(ui, "Factors", "These factors take the place of those of LOD.", &given.from);
            if button_row(ui, "Close the file", "Closes the file of factors. LOD computes factors again.") {
                self.forget_factors();
            }
            return;
        }
        if self.lod_shader_rows(ui) {
            return;
        }
        let settings = &mut self.settings;
        match (options::LOD.no_effect)(settings) {
            Some(why) => fixed(ui, options::LOD.label, settings.tessellation.used_lod().label(), why),
            None => option_row(ui, &options::LOD, settings, key_name(&Action::Setting(Change::AdaptiveLod))),
        }
        if (options::FACTOR.no_effect)(settings).is_none() {
            let [up, down] = [Change::FactorUp, Change::FactorDown].map(|change| key_name(&change.into()));
            option_row(ui, &options::FACTOR, settings, &format!("{up} and {down}"));
        }
        let own: Vec<_> = options_of_lods().filter(|option| (option.no_effect)(settings).is_none()).collect();
        for option in own {
            match option.kind {
                Kind::Pair(_) => distances_row(ui, settings),
                _ => option_row(ui, option, settings, ""),
            }
        }
    }

    /// Whether no back of the mesh can be seen, so that patches that face away can be left out.
    pub(in crate::app) fn can_cull_back_faces(&self) -> bool {
        let scene = self.document.as_ref().map(|document| &document.scene);
        let moves = self.settings.tessellation.displacement.is_on()
            && scene.is_some_and(|scene| scene.tessellator.mesh().heights.is_some());
        scene.is_some_and(|scene| scene.tessellator.is_solid()) && !moves && self.moment().is_none()
    }

    fn back_face_row(&mut self, ui: &mut egui::Ui) {
        let is_solid = self.can_cull_back_faces();
        let check =
            egui::Checkbox::new(&mut self.settings.tessellation.cull_back_faces, options::CULL_BACK_FACES.label);
        ui.label("");
        ui.add_enabled(is_solid, check)
            .on_hover_text(format!(
                "{} They are drawn anyway where backs can be seen: in an animation, while the near plane cuts the \
                 mesh, and where PN, edges computed by each patch, or a wrong convention tear the surface.",
                option_hover(&options::CULL_BACK_FACES, "")
            ))
            .on_disabled_hover_text(BACKS_ARE_SEEN);
        ui.end_row();
    }

    /// A choice of material variants, which is there only if the file has some. Another variant loads the mesh again.
    fn variant_row(&mut self, ui: &mut egui::Ui) {
        let (contents, own) = (self.contents(), self.preparation().variant);
        if contents.variants.is_empty() {
            return;
        }
        let hover = "Primitives have the materials of this variant.";
        let named = contents.variants.iter().map(|name| (Some(name.as_str()), name.as_str(), hover));
        let of_file = (None, "File's own", "Each primitive has its own material.");
        let choices: Vec<_> = std::iter::once(of_file).chain(named).collect();
        let hover = "Material variant to show (--variant).";
        if let Some(chosen) = chooser(ui, "Variant", hover, own.as_deref(), &choices) {
            self.prepare(ui.ctx(), |preparation| preparation.variant = chosen.map(str::to_owned));
        }
    }

    /// A choice of scenes, which is there only if the file has several. Another scene loads the mesh again.
    fn scene_row(&mut self, ui: &mut egui::Ui) {
        let contents = self.contents();
        let scenes = &contents.scenes;
        if scenes.len() <= 1 {
            return;
        }
        let names = scenes.iter().enumerate();
        let choices: Vec<_> =
            names.map(|(i, name)| (Some(i), name.as_str(), "What is shown of the file is this scene.")).collect();
        let hover = "Which of the file's scenes is shown (--scene).";
        if let Some(scene) = chooser(ui, "Scene", hover, contents.scene, &choices).flatten() {
            // By name if that is unique, so that it stays right when the file changes.
            let name = &scenes[scene];
            let is_first = scenes.iter().position(|other| other == name) == Some(scene);
            let name = if is_first { name.clone() } else { scene.to_string() };
            self.prepare(ui.ctx(), |preparation| preparation.scene = Some(name));
        }
    }

    /// The row for the weld tolerance. Its list says what each tolerance would join. A new one loads the mesh again.
    fn weld_row(&mut self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let weld = self.preparation().weld;
        let mut chosen = weld;
        let hover = "Positions closer together than this become one point, which joins open edges that nearly meet. Tolerances \
                     are relative to the bounding diagonal. The list says how many edges each would join.";
        list_row(ui, "Weld", hover, &tolerance(weld), |ui| {
            ui.selectable_value(&mut chosen, 0.0, "Exact").on_hover_text("Only exactly equal positions are one point.");
            match document.checks.joins.get() {
                Some(all) => {
                    for joins in all {
                        let text = format!("{}: {joins}", tolerance(joins.tolerance));
                        ui.selectable_value(&mut chosen, joins.tolerance, text).on_hover_text(format!(
                            "The tolerance is relative to the bounding diagonal; here it is {} object units. The \
                             counts are compared with the exact weld.",
                            short(f64::from(joins.tolerance * document.diagonal))
                        ));
                    }
                }
                None if self.jobs.has(Work::Checks) => drop(ui.weak("trying tolerances…")),
                None => drop(ui.weak("not tried")),
            }
        });
        self.prepare(ui.ctx(), |preparation| preparation.weld = chosen);
    }

    pub(in crate::app) fn toggle_split(&mut self) {
        // A half that blinks shows alone: then the divider comes back.
        let shows_both = self.settings.split.is_some_and(|split| split > 0.0 && split < 1.0);
        self.settings.split = if shows_both { None } else { Some(self.viewport.last_split) };
    }
}

/// The options that have an effect under some LODs only, without the factor, which has a row beside the surface.
fn options_of_lods() -> impl Iterator<Item = &'static Declaration> {
    let depends_on_lod = |option: &&Declaration| {
        let under = |&lod: &Lod| Settings::from(Tessellation { lod, ..Tessellation::default() });
        let idle = Lod::ALL.iter().filter(|lod| (option.no_effect)(&under(lod)).is_some()).count();
        (1..Lod::ALL.len()).contains(&idle)
    };
    options::TESSELLATION.into_iter().filter(depends_on_lod).filter(|option| option.name != options::FACTOR.name)
}

/// The hover text of an overlay: what it shows, and its key.
pub(super) fn overlay_hover(overlay: Overlay) -> String {
    with_key(overlay.text(), &Action::Setting(Change::Overlay(overlay)))
}

/// The overlay that gives the surface these colours; none for the mesh's own.
pub(super) fn overlay_of(colors: Colors) -> Option<Overlay> {
    Overlays { colors, ..Overlays::default() }.on().next()
}

/// The hover text of a choice of colours: their meaning, and the overlay's key.
pub(super) fn colors_hover(colors: Colors) -> String {
    overlay_of(colors).map_or_else(|| colors.text().to_owned(), overlay_hover)
}

/// Near and far distance, with far always the larger one.
fn distances_row(ui: &mut egui::Ui, settings: &mut Settings) {
    let Range { least, most, .. } = options::DISTANCE_RANGE;
    let own = &mut settings.tessellation;
    let (near, far) = (own.near, own.far);
    let drag = |ui: &mut egui::Ui, label: egui::Response, value: &mut f32, range, hover: &str| {
        let drag = egui::DragValue::new(value).range(range).speed(0.05).max_decimals(2).suffix(" r");
        ui.add(drag.update_while_editing(false)).labelled_by(label.on_hover_text(hover).id).on_hover_text(hover);
    };
    let label = ui.label("Near");
    ui.horizontal(|ui| {
        let hover =
            "Edges up to this distance to the eye, in bounding radii of the mesh, have the full factor (--distances).";
        drag(ui, label, &mut own.near, least..=far * 0.99, hover);
        let label = ui.label("far");
        let hover =
            "Edges from this distance to the eye on, in bounding radii of the mesh, have factor 1 (--distances).";
        drag(ui, label, &mut own.far, near * 1.01..=most, hover);
    });
    ui.end_row();
}

fn tolerance(weld: f32) -> String {
    if weld == 0.0 { "Exact".into() } else { format!("{weld:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_a_lod_has_a_row() {
        let names: Vec<_> = options_of_lods().map(|option| option.name).collect();
        assert_eq!(names, ["pixels", "tolerance", "distances"]);
    }
}
