//! What is measured of both halves of a split view, side by side.

use egui::{Align, Layout, RichText, Role, WidgetInfo};

use crate::app::App;
use crate::app::jobs::measure_job::Results;
use crate::app::sections::Section;
use crate::app::text::{grouped, short};
use inspect::settings::SplitSide;

const COLUMNS: [&str; 3] = ["Left", "Right", "Difference"];

/// The figures of a half: each with its name and hover text.
const FIGURES: [(&str, &str, fn(&Results) -> f64); 7] = [
    ("Triangles", "Emitted triangles.", |own| own.totals.1 as f64),
    ("Below 3 px, %", "The part of the triangles in view that cover less than 4.5 px.", |own| {
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
            cells(ui, ["Half", "The difference is right minus left."], COLUMNS.map(RichText::new));
            for (name, hover, of) in FIGURES {
                row(ui, [name, hover], SplitSide::BOTH.map(|half| self.results_of(half).map(of)));
            }
            if SplitSide::BOTH.into_iter().all(|half| self.deviates(half)) {
                let hover = "The largest distance to the reference surface that was found, in object units.";
                let largest = |half| self.known_deviation(half).map(|found| found.largest.at_least);
                row(ui, ["Deviation", hover], SplitSide::BOTH.map(largest));
            }
        });
    }
}

/// A row with a figure of both halves and their difference.
fn row(ui: &mut egui::Ui, name: [&str; 2], [left, right]: [Option<f64>; 2]) {
    let difference = left.zip(right).map(|(left, right)| right - left);
    let sign = if difference > Some(0.0) { "+" } else { "" };
    let texts = [written(left), written(right), sign.to_owned() + &written(difference)];
    cells(ui, name, texts.map(|text| RichText::new(text).monospace()));
}

/// A row of texts under the columns, after its name with a hover text.
fn cells(ui: &mut egui::Ui, [name, hover]: [&str; 2], texts: [RichText; 3]) {
    ui.label(name).on_hover_text(hover);
    for (column, text) in COLUMNS.into_iter().zip(texts) {
        let says = format!("{name}, {column}: {}", text.text());
        let cell = ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.label(text)).inner;
        cell.on_hover_text(&says).widget_info(|| WidgetInfo::labeled(Role::Label, true, &says));
    }
    ui.end_row();
}

/// A small count as a whole, any other number shortened, or an ellipsis until it is known.
fn written(figure: Option<f64>) -> String {
    match figure {
        None => "…".to_owned(),
        Some(figure) if figure.fract() != 0.0 || figure.abs() >= 1e5 => short(figure),
        Some(figure) => (if figure < 0.0 { "-" } else { "" }).to_owned() + &grouped(figure.abs() as u64),
    }
}
