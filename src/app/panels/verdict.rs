//! What is wrong with the picture, in a few lines at the top of the right panel. A click on one shows the place. A line where all
//! is well is dim, but there, so that nothing below moves while numbers change.

use egui::{Color32, RichText};

use super::destinations::{Destination, ShownFinding, Step};
use crate::app::App;
use crate::app::text::{counted, grouped, short};
use crate::app::widgets::{legible, rgb};
use crate::commands::{Action, with_key};
use inspect::gates::Judgement;
use inspect::render::layout::{CRACK_COLOR, FOLD_COLOR, T_JUNCTION_COLOR};
use inspect::settings::Choice;
use load::{Import, NormalSource, is_of_lacking_normals};

struct Line {
    text: String,
    /// None where all is well: such a line is dim, and leads nowhere.
    color: Option<Color32>,
    hover: &'static str,
    leads: Destination,
}

impl Line {
    /// Whether many sound meshes have what it says.
    fn is_often_meant(&self) -> bool {
        matches!(self.leads, Destination::Mesh(gate) if gate.is_often_meant())
    }

    fn dim(text: impl Into<String>, hover: &'static str, leads: Destination) -> Self {
        Self { text: text.into(), color: None, hover, leads }
    }

    fn bad(text: String, color: Color32, hover: &'static str, leads: Destination) -> Self {
        Self { text, color: Some(color), hover, leads }
    }
}

impl App {
    pub(in crate::app) fn verdict(&mut self, ui: &mut egui::Ui) {
        ui.add_space(6.0);
        let shown = self.document.as_ref().and_then(|document| document.shown_finding);
        for line in self.verdict_lines(ui.visuals()) {
            let shown = shown.filter(|shown| shown.leads == line.leads && shown.count > 1);
            if let Some(step) = row(ui, &line, shown) {
                self.follow(line.leads, step);
            }
        }
        self.mesh_findings(ui);
    }

    /// What gates find in the mesh, behind one line that is always there, so that nothing below moves once they are judged.
    fn mesh_findings(&mut self, ui: &mut egui::Ui) {
        let lines: Vec<Line> = self.mesh_lines(ui.visuals()).collect();
        let Some(first) = lines.first() else {
            let hover = "What gates of the mesh find, such as edges of three triangles.";
            row(ui, &Line::dim("In the mesh: nothing", hover, Destination::Warnings), None);
            return;
        };
        let color = lines.iter().find(|line| !line.is_often_meant()).map_or(first.color, |line| line.color);
        let text = format!("In the mesh: {}", counted(lines.len() as u64, "finding"));
        let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y + 2.0);
        ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.set_min_height(size.y);
            let color = color.map_or(ui.visuals().text_color(), |color| legible(ui, color));
            ui.menu_button(RichText::new(text).color(color), |ui| {
                for line in lines {
                    if let Some(step) = row(ui, &line, None) {
                        self.follow(line.leads, step);
                        ui.close();
                    }
                }
            });
        });
    }

    /// The colour of the first line that says what is wrong, rather than what could be better.
    pub(in crate::app) fn worst(&self, ui: &egui::Ui) -> Option<Color32> {
        let lines = self.verdict_lines(ui.visuals()).into_iter().chain(self.mesh_lines(ui.visuals()));
        let is_wrong = |line: &Line| match line.leads {
            Destination::Sizes | Destination::CreaseAngle(_) | Destination::MadeNormals | Destination::Patches => false,
            _ => !line.is_often_meant(),
        };
        lines.filter(is_wrong).find_map(|line| line.color)
    }

    /// Where the findings lead, in their order.
    pub(super) fn destinations(&self) -> Vec<Destination> {
        let lines = self.verdict_lines(&egui::Visuals::default());
        lines.into_iter().filter(|line| line.color.is_some()).map(|line| line.leads).collect()
    }

    fn verdict_lines(&self, visuals: &egui::Visuals) -> Vec<Line> {
        let lines = [
            Some(self.checked_line(visuals.text_color())),
            Some(self.cracks_line()),
            Some(self.leaks_line()),
            Some(self.folds_line()),
            Some(self.junctions_line()),
            self.seams_line(visuals.warn_fg_color),
            self.given_line(visuals.warn_fg_color),
            Some(self.sizes_line(visuals.text_color())),
            Some(self.limit_line(visuals.warn_fg_color)),
            self.normals_line(visuals),
            self.split_edges_line(visuals.warn_fg_color),
            Some(self.warnings_line(visuals.warn_fg_color)),
        ];
        lines.into_iter().flatten().collect()
    }

    /// The line of what isn't measured yet, or can't be, since its picture isn't drawn.
    fn unknown(&self, what: &str, hover: &'static str, leads: Destination) -> Line {
        if self.viewport.picture.cancelled.is_some() {
            let why = "The picture isn't drawn, so nothing is measured in it.";
            return Line::dim(format!("{what}: not measured"), why, leads);
        }
        Line::dim(format!("{what} \u{2026}"), hover, leads)
    }

    /// How much of the mesh the findings are about.
    fn checked_line(&self, color: Color32) -> Line {
        let hover = "Cracks, leaks, folds and sizes are found in the patches that are drawn. The others are out of the camera's view or \
                     face away. A click opens the section that counts them.";
        let (Some(document), Some(results)) = (&self.document, self.results()) else {
            return self.unknown("Checked", hover, Destination::Patches);
        };
        let patches = document.loaded.topology.patches.len() as u64;
        let whole = "All patches are drawn, and checked for cracks, leaks and folds.";
        match u64::from(results.found.culled.total()) {
            0 => Line::dim(format!("Checked: {}", counted(patches, "patch")), whole, Destination::Patches),
            left_out => {
                let text = format!("Checked: {} of {}", grouped(patches - left_out), counted(patches, "patch"));
                Line::bad(text, color, hover, Destination::Patches)
            }
        }
    }

    fn cracks_line(&self) -> Line {
        let hover = "Edges whose sides put a point at different positions, and the widest gap in px as the camera of LOD sees it. A \
                     click shows it and freezes LOD.";
        let Some(results) = self.results() else {
            return self.unknown("Cracks", "Cracks are measured while the picture rests.", Destination::Cracks);
        };
        let Some((_, px)) = results.widest_crack else {
            let why = "Every shared edge of what is drawn matches bit for bit.";
            return Line::dim("No cracks", why, Destination::Cracks);
        };
        let edges = counted(results.found.cracks.cracked().len() as u64, "cracked edge");
        let text = format!("{edges}, widest {} px", short(px));
        Line::bad(text, rgb(CRACK_COLOR), hover, Destination::Cracks)
    }

    fn leaks_line(&self) -> Line {
        let hover = "Pixels of the view through which one can see into the closed mesh. A click goes to the cracked edge at the largest \
                     group of them, and freezes the view that they are counted in.";
        let view = if self.viewport.frozen.is_some() { "the frozen view" } else { "this view" };
        let none = || format!("No leaks in {view}");
        let waits = self.results().is_none();
        let junctions = self.document.as_ref().and_then(|document| document.checks.t_junctions());
        let has_cracks = self.results().is_none_or(|results| !results.found.cracks.cracked().is_empty());
        let is_whole = !has_cracks && junctions.is_some_and(|junctions| junctions.is_empty());
        if !waits && !self.may_leak() && is_whole {
            return Line::dim(none(), "No edge is cracked.", Destination::Leaks);
        }
        if !waits && !self.may_leak() {
            let why = "Leaks can be counted only if the mesh is closed, all of its triangles are wound the same way, all of it lies before \
                       the camera, and no patch is left out because it faces away.";
            return Line::dim("Leaks aren't counted", why, Destination::Leaks);
        }
        match self.leaks().filter(|_| !waits) {
            None => self.unknown("Leaks", "Leaks are counted while the picture rests.", Destination::Leaks),
            Some([]) => Line::dim(none(), hover, Destination::Leaks),
            Some(leaks) => {
                let pixels: u64 = leaks.iter().map(|leak| u64::from(leak.pixels)).sum();
                let text = format!("{} px leak in {view}", grouped(pixels));
                Line::bad(text, rgb(CRACK_COLOR), hover, Destination::Leaks)
            }
        }
    }

    fn folds_line(&self) -> Line {
        let hover =
            "Triangles that face away from the side that their patch faces. A click shows the largest and freezes LOD.";
        match self.results().map(|results| results.found.folds) {
            None => self.unknown("Folds", "Folds are counted while the picture rests.", Destination::Folds),
            Some(0) => Line::dim("No folds", hover, Destination::Folds),
            Some(folds) => Line::bad(counted(folds, "fold"), rgb(FOLD_COLOR), hover, Destination::Folds),
        }
    }

    fn junctions_line(&self) -> Line {
        let leads = Destination::TJunctions;
        let junctions = self.document.as_ref().and_then(|document| document.checks.t_junctions());
        let hover = "Points of the mesh that lie on the open edge of another triangle, which no tessellation closes. A click \
                     shows them and goes to the first.";
        match junctions {
            None => Line::dim("T-junctions \u{2026}", hover, leads),
            Some([]) => Line::dim("No T-junctions", hover, leads),
            Some(all) => Line::bad(counted(all.len() as u64, "T-junction"), rgb(T_JUNCTION_COLOR), hover, leads),
        }
    }

    /// A line for each gate of the mesh that found something. What many sound meshes have is no warning.
    fn mesh_lines(&self, visuals: &egui::Visuals) -> impl Iterator<Item = Line> {
        let found = self.document.iter().flat_map(|document| document.checks.found());
        found.map(|Judgement { kind, text, .. }| {
            let color = if kind.is_often_meant() { visuals.text_color() } else { visuals.warn_fg_color };
            Line::bad(text.clone(), color, kind.text(), Destination::Mesh(*kind))
        })
    }

    fn seams_line(&self, color: Color32) -> Option<Line> {
        let seams = self.results()?.shading_seams;
        let hover = "Edges across which shading normals differ, although positions agree and so do the mesh's normals: light breaks \
                     there, but nothing is open. A click goes to the one with the most such points.";
        (seams > 0).then(|| Line::bad(counted(seams, "shading seam"), color, hover, Destination::ShadingSeams))
    }

    fn given_line(&self, color: Color32) -> Option<Line> {
        let agreement = self.agreement()?;
        let hover = "Edges whose sides have different factors in the file or from the shader that is open. A click goes to the one where they \
                     differ the most.";
        let edges = agreement.edges.len() as u64;
        let text = format!("{} with different factors", counted(edges, "edge"));
        (edges > 0).then(|| Line::bad(text, color, hover, Destination::GivenFactors))
    }

    fn sizes_line(&self, color: Color32) -> Line {
        let hover = "The part of the triangles in view that cover less than 4.5 px², half of a square of 3 x 3 px. For each of \
                     them a GPU shades up to four times as many px as it covers. A click colours triangles by their size.";
        let Some(sizes) = self.results().map(|results| &results.sizes) else {
            return self.unknown("Triangles below 3 px", hover, Destination::Sizes);
        };
        let percent = 100.0 * sizes.small as f64 / sizes.in_view.max(1) as f64;
        let wires = if self.settings.overlays.wireframe && percent >= 50.0 { "Wires too dense: " } else { "" };
        let text = format!("{wires}{percent:.0} % of triangles below 3 px");
        Line { text, color: (percent >= 0.5).then_some(color), hover, leads: Destination::Sizes }
    }

    fn limit_line(&self, color: Color32) -> Line {
        let hover = "Patches with the largest factor that there is: 127 under rows, else 63 or 64. LOD by error may miss its \
                     tolerance there. A click colours the surface by factors.";
        match self.results().map(|results| results.found.patches_at_limit) {
            None => self.unknown("Patches at the maximum factor", hover, Destination::Factors),
            Some(0) => Line::dim("No patch at the maximum factor", hover, Destination::Factors),
            Some(patches) => {
                let text = format!("{} at the maximum factor", counted(patches.into(), "patch"));
                Line::bad(text, color, hover, Destination::Factors)
            }
        }
    }

    /// There only where normals differ along all inner edges, so that no surface can be smooth.
    fn split_edges_line(&self, color: Color32) -> Option<Line> {
        let document = self.document.as_ref().filter(|document| {
            let is_of_file = document.loaded.preparation.import.normals == NormalSource::File;
            is_of_file
                && !self.lacks_normals()
                && document.edges.split > 0
                && document.edges.smooth + document.edges.seam == 0
        })?;
        let hover = "Every edge between triangles has different normals on its two sides, so that each triangle is flat and nothing can \
                     curve. A click makes normals anew, smooth below the crease angle: the mesh is loaded again.";
        let text = format!("All {} are split", counted(document.edges.split.into(), "edge"));
        Some(Line::bad(text, color, hover, Destination::MadeNormals))
    }

    /// There only where the file lacks normals.
    fn normals_line(&self, visuals: &egui::Visuals) -> Option<Line> {
        let Import { crease_angle, .. } = self.document.as_ref()?.loaded.preparation.import;
        self.lacks_normals().then(|| match crease_angle {
            0.0 => {
                let hover = "The file has no normals for some triangles, and these are flat. A click smooths them again: it sets the \
                             crease angle back, and the mesh is loaded again.";
                let smooth = Destination::CreaseAngle(Import::default().crease_angle);
                Line::bad("Missing normals: flat".to_owned(), visuals.text_color(), hover, smooth)
            }
            angle => {
                let hover = "The file has no normals for some triangles. Where two of them meet at less than this angle they are shaded and \
                             curved as one smooth surface. A glTF file means them to be flat. A click makes them flat: it sets the crease \
                             angle to 0\u{b0}, and the mesh is loaded again.";
                let text = format!("Missing normals: smoothed below {angle}\u{b0}");
                Line::bad(text, visuals.warn_fg_color, hover, Destination::CreaseAngle(0.0))
            }
        })
    }

    /// Whether the file has no normals for some triangles, and none are made anew for all or for a part. A warning tells it too.
    fn lacks_normals(&self) -> bool {
        self.document.as_ref().is_some_and(|document| {
            let loaded = &document.loaded;
            loaded.preparation.import.normals == NormalSource::File
                && loaded.read.repairs.normals_made > 0
                && loaded.preparation.parts.styles.iter().all(|(_, own)| own.normals != Some(NormalSource::Made))
        })
    }

    fn warnings_line(&self, color: Color32) -> Line {
        let has_line = self.lacks_normals();
        let warnings = self.warnings().filter(|warning| !(has_line && is_of_lacking_normals(warning))).count() as u64;
        let hover = "What was repaired or left out when the file was read. A click lists it.";
        let what = if has_line { "other warning" } else { "warning" };
        match warnings {
            _ if self.document.is_none() => Line::dim("Warnings \u{2026}", hover, Destination::Warnings),
            0 => Line::dim(format!("No {what}s"), hover, Destination::Warnings),
            _ => Line::bad(counted(warnings, what), color, hover, Destination::Warnings),
        }
    }
}

/// Shows a hover text on the left, where it covers none of the other lines.
fn hover_beside<'a>(response: &'a egui::Response, text: &str) -> &'a egui::Response {
    let mut tooltip = egui::Tooltip::for_enabled(response);
    tooltip.popup = tooltip.popup.align(egui::RectAlign::LEFT);
    tooltip.show(|ui| ui.label(text));
    response
}

/// Shows a line: a button in a colour, or where there is none, weak text at the same place and as high. The finding that is shown has
/// buttons for its other places. Returns what was clicked.
fn row(ui: &mut egui::Ui, line: &Line, shown: Option<ShownFinding>) -> Option<Step> {
    let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y + 2.0);
    let [from_left, from_right] =
        [egui::Layout::left_to_right, egui::Layout::right_to_left].map(|to| to(egui::Align::Center));
    ui.allocate_ui_with_layout(size, from_right, |ui| {
        ui.set_min_height(size.y);
        let mut step = shown.and_then(|shown| steps(ui, &shown));
        ui.with_layout(from_left, |ui| match line.color {
            Some(color) => {
                let text = RichText::new(&line.text).color(legible(ui, color));
                let is_clicked = hover_beside(&ui.add(egui::Button::new(text).truncate()), line.hover).clicked();
                step = step.or(is_clicked.then_some(Step::Worst));
            }
            None => {
                ui.add_space(ui.spacing().button_padding.x);
                hover_beside(&ui.weak(&line.text), line.hover);
            }
        });
        step
    })
    .inner
}

/// Which of its places the finding shows, and buttons that step to the others.
fn steps(ui: &mut egui::Ui, shown: &ShownFinding) -> Option<Step> {
    let mut button = |text: &str, action: Action, name: &str, step: Step| {
        let button = ui.small_button(text).on_hover_text(with_key(name, &action));
        button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
        button.clicked().then_some(step)
    };
    let next = button(">", Action::NextPlace, "Next place", Step::Next);
    let previous = button("<", Action::PreviousPlace, "Previous place", Step::Previous);
    ui.label(format!("{}/{}", grouped(shown.place as u64 + 1), grouped(shown.count as u64)));
    next.or(previous)
}
