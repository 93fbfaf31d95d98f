//! The chart panel below the picture: the controls, the chart, and its front as a list.

use egui::RichText;

use super::chart_diagram::{Diagram, Inks, Spot, line, marker};
use crate::app::App;
use crate::app::jobs::chart_job::Charted;
use crate::app::jobs::job_list::Work;
use crate::app::painting::panel_frame;
use crate::app::text::{grouped, short};
use crate::app::widgets::{dense, list, switch_button, text_width, unclicked};
use crate::commands::{Purpose, Written};
use geometry::near::Interval;
use geometry::tessellate::Surface;
use inspect::settings::Choice;
use lab::chart::{Cost, LodKind, MethodStyle, Plan, Probe, Setting, dash, method_styles};

/// Heights of the panel, and the width of the list in it, in points.
const HEIGHT: f32 = 320.0;
const HEIGHTS: std::ops::RangeInclusive<f32> = 200.0..=700.0;
const LIST_WIDTH: f32 = 372.0;
/// The least width of the diagram beside the list, in points.
const DIAGRAM_WIDTH: f32 = 270.0;
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
        panel.frame(panel_frame(ui)).show(ui, |ui| {
            ui.add_space(2.0);
            ui.horizontal_wrapped(|ui| self.chart_controls(ui));
            self.chart_facts(ui);
            let mut applied = None;
            if let Some(charted) = self.panels.chart.charted.as_ref().filter(|charted| !charted.subject.rows.is_empty())
            {
                let is_stale = self.chart_outdated().is_some();
                let own = Setting::new(&self.settings).filter(|_| !self.uses_surface_shader());
                let diagram = Diagram { charted, cost: self.panels.chart.cost, is_stale, own };
                // While it is measured, the legend has what is still to come, so that it doesn't grow.
                let plan = self.charting().map(|_| &self.panels.chart.plan);
                legend(ui, charted, plan, is_stale);
                let left = (ui.available_width() - LIST_WIDTH).max(DIAGRAM_WIDTH.min(0.5 * ui.available_width()));
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
        for (cost, name, hover) in [
            (Cost::Ms, "Time", "Error against the time to tessellate and draw."),
            (Cost::Triangles, "Triangles", "Error against the number of triangles."),
        ] {
            let is_shown = self.panels.chart.cost == cost;
            if ui.add(switch_button(is_shown, name)).on_hover_text(hover).clicked() {
                self.panels.chart.cost = cost;
            }
        }
        ui.separator();
        self.methods_menu(ui);
        let has_rows = !self.chart_rows().is_empty() && !self.is_writing();
        let save = ui.add_enabled(has_rows, egui::Button::new("Save chart…"));
        if save.on_hover_text("As a picture (.svg, .png) or a table (.csv).").clicked() {
            self.ask_for(ui.ctx(), Purpose::Write(Written::Chart));
        }
    }

    /// What the chart shows, what it leaves out, and whether it is out of date.
    fn chart_facts(&self, ui: &mut egui::Ui) {
        let Some(charted) = self.panels.chart.charted.as_ref() else { return };
        let left_out = left_out(charted);
        let facts = format!("{left_out}{} {}", charted.subject.title, charted.subject.facts());
        let (text, hover) = match self.chart_outdated() {
            Some(why) => (RichText::new(format!("out of date: {why}")).color(ui.visuals().warn_fg_color), "Measured: "),
            None => (RichText::new(&facts).weak(), ""),
        };
        ui.add(egui::Label::new(text).truncate()).on_hover_text(format!("{hover}{facts}"));
    }

    pub(in crate::app) fn can_measure_chart(&self) -> bool {
        let is_idle = self.panels.chart.is_open && self.charting().is_none();
        is_idle && self.document.is_some() && !self.chart_settings().is_empty()
    }

    /// Shows the button that starts or cancels measuring. Returns how many settings are done, and how many there are.
    fn measure_button(&mut self, ui: &mut egui::Ui) -> (usize, usize) {
        let button = |text| egui::Button::new(text).min_size(egui::vec2(BUTTON_WIDTH, 0.0));
        if let Some(progress) = self.charting() {
            if ui.add(button("Cancel")).on_hover_text("Stops measuring; the results so far stay.").clicked() {
                self.jobs.stop(Work::Chart);
            }
            return progress;
        }
        let settings = self.chart_settings();
        let charted = self.panels.chart.charted.as_ref().filter(|_| self.chart_outdated().is_none());
        let known = charted.map_or(0, |charted| settings.iter().filter(|setting| charted.has(setting)).count());
        let (text, hover) = match known {
            0 if self.panels.chart.charted.as_ref().is_none() => {
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
            Surface::ALL.into_iter().for_each(|surface| switch(ui, &mut plan.surfaces, surface, surface.label()));
            ui.weak("Level of detail");
            LodKind::ALL.into_iter().for_each(|lod| switch(ui, &mut plan.lods, lod, lod.label()));
        });
        response.on_hover_text("The surfaces and LODs that are tried, with the normals of the settings panel.");
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
        Spot::Row(row) => format!("{}\n{}", named(&row.setting), facts(diagram.charted, &row.probe)),
        Spot::Current(_, probe) => format!("The window's settings\n{}", facts(diagram.charted, probe)),
    };
    let (layer, id) = (ui.layer_id(), ui.scope_id().with("point"));
    egui::Tooltip::always_open(ui.ctx().clone(), layer, id, egui::PopupAnchor::Pointer).show(|ui| ui.label(text));
    match spot {
        Spot::Row(row) if is_clicked => Some(row.setting),
        _ => None,
    }
}

/// A setting in the words of the settings panel.
fn named(setting: &Setting) -> String {
    format!("{} {setting}", setting.method.surface.label())
}

/// The measurements of a point, as text.
fn facts(charted: &Charted, probe: &Probe) -> String {
    let mut lines = Vec::new();
    if let (Some(errors), Some(diagonal)) = (probe.errors, charted.diagonal) {
        let Interval { at_least, at_most } = errors.largest;
        let [least, most] = [at_least, at_most].map(|part| short(100.0 * part));
        let units = [at_least, at_most].map(|part| short(part * diagonal)).join(" to ");
        lines.push(format!("largest error {least} to {most} % of the diagonal, {units} units"));
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

/// The legend of points and lines, for what is measured and for what a plan adds to it.
fn legend(ui: &mut egui::Ui, charted: &Charted, plan: Option<&Plan>, is_stale: bool) {
    let inks = Inks::new(ui, is_stale);
    let methods = method_styles(&charted.subject).into_iter().map(|(method, _)| (method.surface, method.lod));
    let (mut surfaces, mut lods): (Vec<_>, Vec<_>) = methods.unzip();
    if let Some(plan) = plan {
        surfaces.extend(&plan.surfaces);
        lods.extend(&plan.lods);
    }
    ui.horizontal_wrapped(|ui| {
        for surface in Surface::ALL.into_iter().filter(|surface| surfaces.contains(surface)) {
            let place = legend_entry(ui, 10.0, surface.label(), surface.text());
            marker(ui.painter(), place.center(), &MethodStyle::from_surface(surface), &inks);
        }
        let sample = |ui: &egui::Ui, place: egui::Rect, stroke: egui::Stroke, dash: Option<[f64; 2]>| {
            line(ui.painter(), &[place.left_center(), place.right_center()], stroke, dash);
        };
        for lod in LodKind::ALL.into_iter().filter(|lod| lods.contains(lod)) {
            let place = legend_entry(ui, 30.0, lod.label(), "The dashes of lines between settings with this LOD.");
            sample(ui, place, egui::Stroke::new(1.4, inks.text), dash(lod));
        }
        let place = legend_entry(ui, 26.0, "Front", "Settings that no other setting beats in both error and cost.");
        sample(ui, place, egui::Stroke::new(9.0, inks.front), None);
    });
}

/// Shows a name in a legend, and returns the place for its sample before it. Both stay together where a row ends.
fn legend_entry(ui: &mut egui::Ui, sample: f32, name: &str, hover: &str) -> egui::Rect {
    let gap = ui.spacing().item_spacing.x;
    let size = egui::vec2(sample + gap + text_width(ui, name) + gap, ui.text_style_height(&egui::TextStyle::Body));
    let (place, response) = ui.allocate_exact_size(size, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, name));
    response.on_hover_text(hover);
    let (font, color) = (egui::TextStyle::Body.resolve(ui.style()), ui.visuals().text_color());
    let start = place.left_center() + egui::vec2(sample + gap, 0.0);
    ui.painter().text(start, egui::Align2::LEFT_CENTER, name, font, color);
    place.with_max_x(place.left() + sample)
}

/// Lists the settings of the front as buttons that apply them. Returns the setting whose button was pressed.
fn front_list(ui: &mut egui::Ui, diagram: &Diagram) -> Option<Setting> {
    let subject = &diagram.charted.subject;
    let races = subject.races();
    let front: Vec<_> = races.iter().flat_map(|race| race.front(|row| diagram.cost.of(&row.probe))).collect();
    let unit = if subject.reference_shape.is_some() { "%" } else { "px" };
    // Numbers of triangles are longer than times.
    let (cost_unit, cost_name, width) = match diagram.cost {
        Cost::Ms => ("ms", "ms", 6),
        Cost::Triangles => ("tri", "triangles", 9),
    };
    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Truncate);
    unclicked(ui, dense(format!("{unit:>7} {cost_unit:>width$}  setting")).weak()).on_hover_text(
        "The front: settings that no other setting beats in both error and cost, the cheapest first. A click on one \
         applies it.",
    );
    let mut applied = None;
    list(ui, "Front", front.len(), (front.len(), 0), |ui, index| {
        let (row, error) = front[index];
        let error = subject.shown_error(error);
        let cost = match diagram.cost {
            Cost::Ms => short(row.probe.time.total()),
            Cost::Triangles => grouped(row.probe.triangles),
        };
        let name = named(&row.setting);
        let text = dense(format!("{error:>7} {cost:>width$}  {name}"));
        let response = ui.add(egui::Button::selectable(diagram.own == Some(row.setting), text));
        let said = format!("Apply {name}: {error} {unit}, {cost} {cost_name}");
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &said));
        if response.clicked() {
            applied = Some(row.setting);
        }
        response.on_hover_text(format!("{name}\n{}", facts(diagram.charted, &row.probe)))
    });
    applied
}
