//! What is measured of both halves of a split view, side by side.

use egui::{Align, Layout, Response, RichText, Role, WidgetInfo};

use crate::app::App;
use crate::app::jobs::measure_job::Results;
use crate::app::sections::Section;
use crate::app::text::{grouped, short};
use inspect::settings::SplitSide;

/// How many characters a cell has room for.
const CELL: usize = 8;

const COLUMNS: [&str; 3] = ["Left", "Right", "Change"];

/// A figure's name, its hover text, and what it is of a half.
type Figure = (&'static str, &'static str, fn(&Results) -> f64);

const FIGURES: [Figure; 7] = [
    ("Triangles", "Emitted triangles.", |own| own.totals.1 as f64),
    ("Below 3 px, %", "Triangles in view that cover less than 4.5 px², half of a square of 3 px.", |own| {
        100.0 * own.sizes.small as f64 / own.sizes.in_view.max(1) as f64
    }),
    ("Culled patches", "Patches that emit no triangles.", |own| own.found.culled.total().into()),
    ("At max factor", "Patches with a factor at the maximum.", |own| own.found.patches_at_limit.into()),
    ("Cracked edges", "Edges with a point that differs.", |own| own.found.cracks.cracked().len() as f64),
    ("Widest gap, px", "As the camera of LOD sees it.", |own| own.widest_crack.map_or(0.0, |(_, px)| px)),
    ("Folds", "Triangles that face away from the side that their patch faces.", |own| own.found.folds as f64),
];

impl App {
    /// The section with the figures of both halves, which only a split view has.
    pub(in crate::app) fn halves_section(&mut self, ui: &mut egui::Ui) {
        if self.settings.split.is_none() || !self.panels.open.title(ui, Section::Halves) {
            return;
        }
        egui::Grid::new("halves").num_columns(4).min_col_width(50.0).show(ui, |ui| {
            ui.label("Half").on_hover_text("The change is right minus left.");
            COLUMNS.into_iter().for_each(|column| drop(cell(ui, RichText::new(column))));
            ui.end_row();
            // Each half is measured by a walk of its own.
            let mut halves = self.document.iter().flat_map(|document| &document.halves);
            let are_current = halves.all(|own| own.measure.found().is_some() && !own.measure.is_busy());
            for (name, hover, of) in FIGURES {
                row(ui, [name, hover], SplitSide::BOTH.map(|half| self.results_of(half).map(of)), are_current);
            }
            if SplitSide::BOTH.into_iter().all(|half| self.deviates(half)) {
                let hover = "The largest distance to the reference surface that was found, in object units.";
                let largest = |half| self.known_deviation(half).map(|found| found.largest.at_least);
                row(ui, ["Deviation", hover], SplitSide::BOTH.map(largest), true);
            }
        });
    }
}

/// A row with a figure of both halves and, if both are of what is shown, their difference.
fn row(ui: &mut egui::Ui, [name, hover]: [&str; 2], [left, right]: [Option<f64>; 2], are_current: bool) {
    let difference = left.zip(right).map(|(left, right)| right - left).filter(|_| are_current);
    ui.label(name).on_hover_text(hover);
    for (column, figure) in COLUMNS.into_iter().zip([left, right, difference]) {
        let sign = if column == COLUMNS[2] && figure > Some(0.0) { "+" } else { "" };
        let whole = sign.to_owned() + &written(figure, f64::INFINITY);
        let text = in_cell(sign, figure);
        let says = format!("{name}, {column}: {whole}");
        let cell = cell(ui, RichText::new(text).monospace());
        cell.on_hover_text(&says).widget_info(|| WidgetInfo::labeled(Role::Label, true, &says));
    }
    ui.end_row();
}

fn cell(ui: &mut egui::Ui, text: RichText) -> Response {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.label(text)).inner
}

/// A figure in a cell, with fewer digits if it would take more room.
fn in_cell(sign: &str, figure: Option<f64>) -> String {
    let text = sign.to_owned() + &written(figure, 1e6);
    match figure {
        Some(figure) if text.chars().count() > CELL => format!("{sign}{figure:.1e}"),
        _ => text,
    }
}

/// A count below a limit as a whole, any other number shortened, or an ellipsis until it is known.
fn written(figure: Option<f64>, below: f64) -> String {
    match figure {
        None => "…".to_owned(),
        Some(figure) if figure.fract() != 0.0 || figure.abs() >= below => short(figure),
        Some(figure) => (if figure < 0.0 { "-" } else { "" }).to_owned() + &grouped(figure.abs() as u64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_counts_are_short_in_cells_and_whole_in_what_is_said_of_them() {
        let cell = |figure| in_cell("", Some(figure));
        let said = |figure| written(Some(figure), f64::INFINITY);
        assert_eq!([cell(1_234_567.0), said(1_234_567.0)], ["1.23e6", "1,234,567"]);
        assert_eq!([cell(-138_676.0), said(-138_676.0)], ["-138,676", "-138,676"]);
        assert_eq!([cell(999_999.0), cell(33.0), said(0.25), in_cell("", None)], ["999,999", "33", "0.250", "…"]);
        let small = [("+", 4.08e-12), ("", -4.08e-12), ("", 2.56e-8), ("+", 99_999.0)];
        let cells = small.map(|(sign, figure)| in_cell(sign, Some(figure)));
        assert_eq!(cells, ["+4.1e-12", "-4.1e-12", "2.56e-8", "+99,999"]);
    }
}
