//! What is wrong with the picture, in a few lines at the top of the right panel. A click on one shows the place.

use egui::{Color32, RichText};

use crate::app::App;
use crate::app::sections::Section;
use crate::app::text::{counted, grouped, short};
use crate::app::widgets::rgb;
use crate::render::layout::{CRACK_COLOR, FOLD_COLOR, T_JUNCTION_COLOR};
use crate::settings::{Colors, Overlay};

/// Where a click on a line leads.
#[derive(Clone, Copy)]
enum Destination {
    /// The overlay of cracks, and the edge with the widest gap.
    Cracks,
    /// The overlay of cracks, and the edge at the largest leak.
    Leaks,
    /// The overlay of folds, and the patch whose folds have the largest area.
    Folds,
    TJunctions,
    /// The edge whose sides were given the most different factors.
    GivenFactors,
    Sizes,
    Factors,
    Warnings,
}

/// A line of the verdict.
struct Line {
    text: String,
    /// None where all is well: such a line is dim, and leads nowhere.
    color: Option<Color32>,
    hover: &'static str,
    leads: Destination,
}

impl Line {
    fn dim(text: impl Into<String>, hover: &'static str, leads: Destination) -> Self {
        Self { text: text.into(), color: None, hover, leads }
    }

    fn bad(text: String, color: Color32, hover: &'static str, leads: Destination) -> Self {
        Self { text, color: Some(color), hover, leads }
    }
}

impl App {
    pub(in crate::app) fn verdict(&mut self, ui: &mut egui::Ui) {
        if self.document.is_none() {
            return;
        }
        ui.add_space(6.0);
        let lines: Vec<Line> = [
            Some(self.cracks_line()),
            self.leaks_line(),
            Some(self.folds_line()),
            self.junctions_line(),
            self.given_line(ui.visuals().warn_fg_color),
            self.sizes_line(ui.visuals().text_color()),
            self.limit_line(ui.visuals().warn_fg_color),
            self.warnings_line(ui.visuals().warn_fg_color),
        ]
        .into_iter()
        .flatten()
        .collect();
        for line in lines {
            let Some(color) = line.color else {
                ui.weak(line.text).on_hover_text(line.hover);
                continue;
            };
            if ui.button(RichText::new(line.text).color(color)).on_hover_text(line.hover).clicked() {
                self.follow(line.leads);
            }
        }
    }

    fn cracks_line(&self) -> Line {
        let hover =
            "Edges whose sides put a point at different positions. A click shows them and goes to the widest gap.";
        match self.jobs.measure.cracks() {
            None => Line::dim("Cracks \u{2026}", "Cracks are measured while the picture rests.", Destination::Cracks),
            Some(cracks) if cracks.edges.is_empty() => {
                Line::dim("No cracks", "No edge of what is drawn has sides that differ in a bit.", Destination::Cracks)
            }
            Some(cracks) => {
                let px = short(self.viewport.picture.gap_px(cracks));
                let edges = counted(cracks.edges.len() as u64, "cracked edge");
                Line::bad(format!("{edges}, widest {px} px"), rgb(CRACK_COLOR), hover, Destination::Cracks)
            }
        }
    }

    fn leaks_line(&self) -> Option<Line> {
        let hover = "Pixels of this view through which one can see into the closed mesh. A click goes to the cracked edge at the \
                     largest group of them.";
        let leaks = self.may_leak().then(|| self.leaks());
        Some(match leaks? {
            None => Line::dim("Leaks \u{2026}", "Leaks are counted while the picture rests.", Destination::Leaks),
            Some([]) => Line::dim("No leaks in this view", hover, Destination::Leaks),
            Some(leaks) => {
                let pixels: u64 = leaks.iter().map(|leak| u64::from(leak.pixels)).sum();
                let text = format!("{} px leak in this view", grouped(pixels));
                Line::bad(text, rgb(CRACK_COLOR), hover, Destination::Leaks)
            }
        })
    }

    fn folds_line(&self) -> Line {
        let hover = "Triangles that face away from the side that their patch faces. A click shows them and goes to the \
                     largest.";
        match self.jobs.measure.found().map(|found| found.folds) {
            None => Line::dim("Folds \u{2026}", "Folds are counted while the picture rests.", Destination::Folds),
            Some(0) => Line::dim("No folds", hover, Destination::Folds),
            Some(folds) => Line::bad(counted(folds, "fold"), rgb(FOLD_COLOR), hover, Destination::Folds),
        }
    }

    fn junctions_line(&self) -> Option<Line> {
        let junctions = self.document.as_ref()?.checks.t_junctions().filter(|junctions| !junctions.is_empty())?;
        let hover = "Points of the mesh that lie on the open edge of another triangle, which no tessellation closes. A click \
                     shows them and goes to the first.";
        let text = counted(junctions.len() as u64, "T-junction");
        Some(Line::bad(text, rgb(T_JUNCTION_COLOR), hover, Destination::TJunctions))
    }

    fn given_line(&self, color: Color32) -> Option<Line> {
        let compared = self.given.as_ref()?.compared()?;
        let hover = "Edges whose sides have different factors in the file that is open. A click goes to the one where they \
                     differ the most.";
        let edges = compared.agreement.edges.len() as u64;
        let text = format!("{} with different factors", counted(edges, "edge"));
        (edges > 0).then(|| Line::bad(text, color, hover, Destination::GivenFactors))
    }

    fn sizes_line(&self, color: Color32) -> Option<Line> {
        let sizes = self.sizes_shown().filter(|sizes| sizes.small > 0)?;
        let percent = 100.0 * sizes.small as f64 / sizes.in_view.max(1) as f64;
        let hover = "Triangles in view that are smaller than half of a square with sides of 3 px: a GPU shades up to four times \
                     as many px for them as they cover. A click colours triangles by their size.";
        let text = format!("{percent:.0} % of triangles below 3 px");
        (percent >= 0.5).then(|| Line::bad(text, color, hover, Destination::Sizes))
    }

    fn limit_line(&self, color: Color32) -> Option<Line> {
        let patches = self.jobs.measure.found()?.patches_at_limit;
        let hover = "Patches with a factor of 63 or 64, the most there is. LOD by error may miss its tolerance there. A click \
                     colours the surface by factors.";
        let text = format!("{} at the maximum factor", counted(patches.into(), "patch"));
        (patches > 0).then(|| Line::bad(text, color, hover, Destination::Factors))
    }

    fn warnings_line(&self, color: Color32) -> Option<Line> {
        let warnings = self.document.as_ref()?.loaded.warnings.len() as u64;
        let hover = "What was repaired or left out when the file was read. A click lists it.";
        (warnings > 0).then(|| Line::bad(counted(warnings, "warning"), color, hover, Destination::Warnings))
    }

    fn follow(&mut self, leads: Destination) {
        let overlays = &mut self.settings.overlays;
        match leads {
            Destination::Cracks => {
                overlays.cracks = true;
                self.panels.open.set(Section::Cracks, true);
                let widest = self.jobs.measure.cracks().and_then(|cracks| cracks.edges.first()).map(|crack| crack.edge);
                widest.into_iter().for_each(|edge| self.select_edge(edge));
            }
            Destination::Leaks => {
                self.panels.open.set(Section::Cracks, true);
                let largest = self.leaks().and_then(|leaks| leaks.first()).copied();
                largest.into_iter().for_each(|leak| self.show_leak(&leak));
            }
            Destination::Folds => {
                overlays.folds = true;
                self.panels.open.set(Section::Cracks, true);
                let worst = self.jobs.measure.found().and_then(|found| found.folded.first()).copied();
                worst.into_iter().for_each(|folded| self.show_fold(&folded));
            }
            Destination::TJunctions => {
                overlays.t_junctions = true;
                self.panels.open.set(Section::Cracks, true);
                let junctions = self.document.as_ref().and_then(|document| document.checks.t_junctions());
                let first = junctions.and_then(|junctions| junctions.first()).map(|junction| junction.edge);
                first.into_iter().for_each(|edge| self.select_edge(edge));
            }
            Destination::GivenFactors => {
                self.panels.open.set(Section::Factors, true);
                let compared = self.given.as_ref().and_then(|given| given.compared());
                let first = compared.and_then(|compared| compared.agreement.edges.first()).map(|first| first.edge);
                first.into_iter().for_each(|edge| self.select_edge(edge));
            }
            Destination::Sizes if overlays.colors != Colors::TriangleSize => overlays.toggle(Overlay::TriangleSize),
            Destination::Factors if overlays.colors != Colors::Factors => overlays.toggle(Overlay::Factors),
            Destination::Sizes | Destination::Factors => {}
            Destination::Warnings => self.dialogs.shows_warnings = true,
        }
    }
}
