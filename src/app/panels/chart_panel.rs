//! The chart panel below the picture: the controls, the chart, and its front as a list.

use egui::RichText;

use super::chart_diagram::{Diagram, Inks, Spot, line, marker};
use crate::app::App;
use crate::app::jobs::chart_job::Charted;
use crate::app::text::{grouped, short};
use crate::app::widgets::{columns, list};
use crate::chart::{Cost, LodKind, MethodStyle, Probe, Row, Setting, dash, method_styles};
use crate::settings::Choice;
use crate::tessellate::Surface;

/// Heights of the panel, and the width of the list in it, in points.
const HEIGHT: f32 = 320.0;
const HEIGHTS: std::ops::RangeInclusive<f32> = 200.0..=700.0;
const LIST_WIDTH: f32 = 360.0;
/// The width of the button's longest text, in points, so that nothing beside it moves.
const BUTTON_WIDTH: f32 = 96.0;
/// Says how many settings aren't in the chart because they have too many triangles.
fn left_out(charted: &Charted) -> String {
    let own = charted.current.is_some_and(|(_, probe)| probe.is_none());
    match (charted.left_out.len(), own) {
        (0, false) => String::new(),
        (0, true) => "current settings left out (too many triangles); ".into(),
        (count, false) => format!("{count} left out (too many triangles); "),
        (count, true) => format!("{count} and current settings left out (too many triangles); "),
    }
}

const NOTHING_YET: &str = "Measure tries surfaces and LODs at many settings on this mesh, in this view, and shows the error \
                           and the time of each. A click on a point applies its setting.";

impl App {
    pub(in crate::app) fn chart_panel(&mut self, ui: &mut egui::Ui) {
        if !self.panels.chart.is_open {
            return;
        }
        let panel = egui::Panel::bottom("chart").resizable(true).default_size(HEIGHT).size_range(HEIGHTS);
        panel.show(ui, |ui| {
            ui.add_space(2.0);
            ui.horizontal_wrapped(|ui| self.chart_controls(ui));
            self.chart_facts(ui);
            let mut applied = None;
            if let Some(charted) = self.panels.chart.charted().filter(|charted| !charted.subject.rows.is_empty()) {
                let is_stale = self.chart_outdated().is_some();
                let own = Setting::of(&self.settings);
                let diagram = Diagram { charted, cost: self.panels.chart.cost, is_stale, own };
                legend(ui, charted, is_stale);
                let left = ui.available_width() - LIST_WIDTH.min(0.45 * ui.available_width());
                ui.horizontal_top(|ui| {
                    let size = egui::vec2(left, ui.available_height());
                    applied = ui.allocate_ui(size, |ui| picked(ui, &diagram)).inner;
                    ui.vertical(|ui| applied = applied.or(front_list(ui, &diagram)));
                });
            } else {
                ui.add_space(8.0);
                let text = if self.charting().is_some() { "Preparing…" } else { NOTHING_YET };
                ui.add(egui::Label::new(RichText::new(text).weak()).wrap());
                ui.allocate_space(ui.available_size());
            }
            if let Some(setting) = applied {
                self.settings = setting.applied(&self.settings);
            }
        });
    }

    fn chart_controls(&mut self, ui: &mut egui::Ui) {
        ui.label(RichText::new("Chart").strong());
        let (done, all) = self.measure_button(ui);
        let part = done as f32 / all.max(1) as f32;
        let bar = egui::ProgressBar::new(part).desired_width(120.0).text(format!("{done} of {all}"));
        // An empty bar would paint a round end.
        let bar = if done == 0 { bar.fill(egui::Color32::TRANSPARENT) } else { bar };
        let most = grouped(self.panels.chart.effort.most_triangles);
        ui.add(bar).on_hover_text(format!(
            "How many of all settings are measured. Measuring waits while a picture is drawn. Settings with more than \
             {most} triangles are left out."
        ));
        ui.separator();
        let cost = &mut self.panels.chart.cost;
        ui.selectable_value(cost, Cost::Ms, "Time").on_hover_text("Error against the time to tessellate and draw.");
        let hover = "Error against the number of triangles.";
        ui.selectable_value(cost, Cost::Triangles, "Triangles").on_hover_text(hover);
        ui.separator();
        self.methods_menu(ui);
        let has_rows = !self.chart_rows().is_empty() && self.panels.chart.saving.is_none();
        let save = ui.add_enabled(has_rows, egui::Button::new("Save chart…"));
        if save.on_hover_text("As a picture (.svg, .png) or a table (.csv).").clicked() {
            self.save_dialog(ui.ctx());
        }
    }

    /// What the chart shows, what it leaves out, and whether it is out of date.
    fn chart_facts(&self, ui: &mut egui::Ui) {
        let Some(charted) = self.panels.chart.charted() else { return };
        let left_out = left_out(charted);
        let facts = format!("{left_out}{} {}", charted.subject.title, charted.subject.facts());
        let (text, hover) = match self.chart_outdated() {
            Some(why) => (RichText::new(format!("out of date: {why}")).color(ui.visuals().warn_fg_color), "Measured: "),
            None => (RichText::new(&facts).weak(), ""),
        };
        ui.add(egui::Label::new(text).truncate()).on_hover_text(format!("{hover}{facts}"));
    }

    /// Whether there is something to measure.
    pub(in crate::app) fn can_measure_chart(&self) -> bool {
        let is_idle = self.panels.chart.is_open && self.panels.chart.charting.progress().is_none();
        is_idle && self.document.is_some() && !self.chart_settings().is_empty()
    }

    /// Shows the button that starts or cancels measuring. Returns how many settings are done, and how many there are.
    fn measure_button(&mut self, ui: &mut egui::Ui) -> (usize, usize) {
        let button = |text| egui::Button::new(text).min_size(egui::vec2(BUTTON_WIDTH, 0.0));
        if let Some(progress) = self.panels.chart.charting.progress() {
            if ui.add(button("Cancel")).on_hover_text("Stops measuring; the results so far stay.").clicked() {
                self.panels.chart.stop();
            }
            return progress;
        }
        let settings = self.chart_settings();
        let charted = self.panels.chart.charted().filter(|_| self.chart_outdated().is_none());
        let known = charted.map_or(0, |charted| settings.iter().filter(|setting| charted.has(setting)).count());
        let (text, hover) = match known {
            0 if self.panels.chart.charted().is_none() => {
                ("Measure", "Tries every method at many settings and times each. The window stays usable.")
            }
            0 => ("Measure again", "Measures all settings on what is shown now."),
            known if known < settings.len() => ("Measure rest", "Measures the settings that are missing."),
            _ => ("Measure again", "Measures all settings anew."),
        };
        let enabled = self.document.is_some() && !settings.is_empty();
        let response = ui.add_enabled(enabled, button(text)).on_hover_text(hover);
        if response.on_disabled_hover_text("Choose a surface and an LOD under Methods.").clicked() {
            self.measure_chart(ui.ctx());
        }
        (known, settings.len())
    }

    fn methods_menu(&mut self, ui: &mut egui::Ui) {
        let config =
            egui::containers::menu::MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
        let button = egui::containers::menu::MenuButton::new("Methods").config(config);
        let plan = &mut self.panels.chart.plan;
        let (response, _) = button.ui(ui, |ui| {
            ui.weak("Surfaces");
            Surface::ALL.into_iter().for_each(|surface| switch(ui, &mut plan.surfaces, surface, surface.name()));
            ui.weak("Level of detail");
            LodKind::ALL.into_iter().for_each(|lod| switch(ui, &mut plan.lods, lod, lod_name(lod)));
        });
        response.on_hover_text("The surfaces and LODs that are tried, with the normals of the settings panel.");
    }
}

fn lod_name(lod: LodKind) -> &'static str {
    match lod {
        LodKind::Uniform => "uniform factor",
        LodKind::Paper => "white paper's LOD",
        LodKind::Error => "LOD by error",
        LodKind::ErrorRows => "LOD by error, rows",
    }
}

/// A checkbox that adds `one` to a list or removes it.
fn switch<T: PartialEq>(ui: &mut egui::Ui, all: &mut Vec<T>, one: T, name: &str) {
    let mut has = all.contains(&one);
    if ui.checkbox(&mut has, name).changed() {
        if has {
            all.push(one);
        } else {
            all.retain(|other| *other != one);
        }
    }
}

/// Shows the diagram and a tooltip for the point under the pointer. Returns the setting that was clicked on.
fn picked(ui: &mut egui::Ui, diagram: &Diagram) -> Option<Setting> {
    let (spot, is_clicked) = diagram.show(ui)?;
    let text = match spot {
        Spot::Row(row) => format!("{}\n{}", diagram.charted.subject.named(row), facts(diagram.charted, &probe(row))),
        Spot::Current => {
            let measured = diagram.charted.current.and_then(|(_, probe)| probe)?;
            format!("The window's settings\n{}", facts(diagram.charted, &measured))
        }
    };
    egui::Tooltip::always_open(
        ui.ctx().clone(),
        ui.layer_id(),
        ui.scope_id().with("point"),
        egui::PopupAnchor::Pointer,
    )
    .show(|ui| ui.label(text));
    match spot {
        Spot::Row(row) if is_clicked => Some(row.setting),
        _ => None,
    }
}

fn probe(row: &Row) -> Probe {
    let Row { triangles, vertices, time, errors, max_error_px, triangles_by_error, .. } = *row;
    Probe { triangles, vertices, time, errors, max_error_px, triangles_by_error }
}

/// The measurements of a point, as text.
fn facts(charted: &Charted, probe: &Probe) -> String {
    let mut lines = Vec::new();
    if let (Some(errors), Some(diagonal)) = (probe.errors, charted.diagonal) {
        let (part, units) = (short(100.0 * errors.largest), short(errors.largest * diagonal));
        lines.push(format!("largest error {part} % of the diagonal, {units} units"));
    }
    if let Some(px) = probe.max_error_px {
        lines.push(format!("{} px on screen", short(px)));
    }
    let time = probe.time;
    let (all, tessellate, draw) = (short(time.total()), short(time.tessellate), short(time.draw));
    lines.push(format!("{all} ms: {tessellate} tessellation, {draw} drawing"));
    lines.push(format!("{} triangles", grouped(probe.triangles)));
    if let Some(least) = probe.triangles_by_error.filter(|least| *least < probe.triangles) {
        let times = short(probe.triangles as f64 / least as f64);
        lines.push(format!("{times} times the {} that LOD by error needs", grouped(least)));
    }
    lines.join("\n")
}

/// The legend of points and lines.
fn legend(ui: &mut egui::Ui, charted: &Charted, is_stale: bool) {
    let inks = Inks::new(ui, is_stale);
    let styles = method_styles(&charted.subject);
    let (mut surfaces, mut lods): (Vec<Surface>, Vec<LodKind>) = Default::default();
    for (method, _) in &styles {
        surfaces.extend((!surfaces.contains(&method.surface)).then_some(method.surface));
        lods.extend((!lods.contains(&method.lod)).then_some(method.lod));
    }
    ui.horizontal_wrapped(|ui| {
        let sample =
            |ui: &mut egui::Ui, width: f32| ui.allocate_exact_size(egui::vec2(width, 14.0), egui::Sense::hover()).0;
        for surface in surfaces {
            let rect = sample(ui, 10.0);
            marker(ui.painter(), rect.center(), &MethodStyle::of_surface(surface), &inks);
            ui.label(surface.name());
        }
        for lod in lods {
            let rect = sample(ui, 30.0);
            let ends = [rect.left_center(), rect.right_center()];
            line(ui.painter(), &ends, egui::Stroke::new(1.4, inks.text()), dash(lod));
            ui.label(lod_name(lod));
        }
        let rect = sample(ui, 26.0);
        let ends = [rect.left_center(), rect.right_center()];
        line(ui.painter(), &ends, egui::Stroke::new(9.0, inks.front()), None);
        ui.label("front").on_hover_text("Settings that no other setting beats in both error and cost.");
    });
}

/// Lists the settings of the front as buttons that apply them. Returns the setting whose button was pressed.
fn front_list(ui: &mut egui::Ui, diagram: &Diagram) -> Option<Setting> {
    let subject = &diagram.charted.subject;
    let races = subject.races();
    let front: Vec<_> = races.iter().flat_map(|race| race.front(|row| diagram.cost.of(row))).collect();
    let unit = if subject.truth.is_some() { "%" } else { "px" };
    let cost = if diagram.cost == Cost::Ms { "ms" } else { "tri" };
    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Truncate);
    columns(ui, &format!("{unit:>8} {cost:>8}  setting"), true).on_hover_text(
        "The front: settings that no other setting beats in both error and cost, the cheapest first. A click on one \
         applies it.",
    );
    let mut applied = None;
    list(ui, "Front", front.len(), |ui, index| {
        let (row, error) = front[index];
        let error = short(error * subject.unit());
        let (cost, cost_unit) = match diagram.cost {
            Cost::Ms => (short(row.time.total()), "ms"),
            Cost::Triangles => (grouped(row.triangles), "triangles"),
        };
        let name = format!("{} {}", row.setting.method.surface.name(), row.setting);
        let text = RichText::new(format!("{error:>8} {cost:>8}  {name}")).monospace();
        let response = ui.add(egui::Button::selectable(diagram.own == Some(row.setting), text));
        let said = format!("Apply {}: {error} {unit}, {cost} {cost_unit}", subject.named(row));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &said));
        if response.clicked() {
            applied = Some(row.setting);
        }
        response.on_hover_text(format!("{}\n{}", subject.named(row), facts(diagram.charted, &probe(row))))
    });
    applied
}
