//! What is measured of both halves of a split view, side by side.

use egui::{Align, Layout, Role, WidgetInfo};

use crate::app::App;
use crate::app::jobs::measure_job::Results;
use crate::app::sections::Section;
use crate::app::text::{grouped, short};
use crate::app::widgets::dense;
use inspect::settings::SplitSide;

/// The columns after that of the names, with their hover texts.
const COLUMNS: [(&str, &str); 3] = [
    ("Left", "The figures of the left half."),
    ("Right", "The figures of the right half."),
    ("Difference", "By how much the right half's figures are larger than the left one's."),
];
/// The least width of a column in points, and how many characters it has room for.
const WIDTH: f32 = 51.0;
const ROOM: usize = 7;

/// A figure: its name, its hover text, and what it is in the results of a half.
type Figure = (&'static str, &'static str, fn(&Results) -> f64);

const FIGURES: [Figure; 8] = [
    ("Triangles", "Emitted triangles.", |own| own.totals.1 as f64),
    ("Below 3 px, %", "The part of the triangles in view that cover less than 4.5 px.", |own| {
        100.0 * own.sizes.small as f64 / own.sizes.in_view.max(1) as f64
    }),
    ("Culled patches", "Patches that emit no triangles.", |own| own.found.culled.total().into()),
    ("At max factor", "Patches with a factor at the maximum.", |own| own.found.patches_at_limit.into()),
    ("Cracked edges", "Edges with a point that differs.", |own| own.found.cracks.cracked().len() as f64),
    ("Widest gap, px", "The gap that is the widest as the camera of LOD sees it.", |own| {
        own.widest_crack.map_or(0.0, |(_, px)| px)
    }),
    ("Shading seams", "Edges across which shading normals differ, although the mesh's agree.", |own| {
        own.shading_seams as f64
    }),
    ("Folds", "Triangles that face away from the side that their patch faces.", |own| own.found.folds as f64),
];

impl App {
    /// The section with the figures of both halves. Only a split view has it.
    pub(in crate::app) fn halves_section(&mut self, ui: &mut egui::Ui) {
        if self.settings.split.is_none() || !self.panels.open.title(ui, Section::Halves) {
            return;
        }
        egui::Grid::new("halves").num_columns(1 + COLUMNS.len()).min_col_width(WIDTH).show(ui, |ui| {
            ui.label("");
            for (column, hover) in COLUMNS {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.weak(column).on_hover_text(hover));
            }
            ui.end_row();
            for (name, hover, of) in FIGURES {
                row(ui, name, hover, SplitSide::BOTH.map(|half| self.results_of(half).map(of)));
            }
            if !self.lacks_reference() && SplitSide::BOTH.into_iter().all(|half| self.deviates(half)) {
                let known = |half| self.known_deviation(half).map(|found| found.largest.at_least);
                let hover = "The largest distance to the reference surface that was found, in object units.";
                row(ui, "Deviation", hover, SplitSide::BOTH.map(known));
                let hover =
                    "The distance on screen between the worst point and the nearest one of the reference surface.";
                row(ui, "Deviation, px", hover, SplitSide::BOTH.map(|half| self.deviation_px(half)));
            }
        });
    }
}

/// A row with a figure of the left and of the right half, and by how much the right one's is larger. What isn't known is an ellipsis.
fn row(ui: &mut egui::Ui, name: &str, hover: &str, [left, right]: [Option<f64>; 2]) {
    ui.label(name).on_hover_text(hover);
    // Two gaps may be infinite.
    let difference = left.zip(right).map(|(left, right)| if left == right { 0.0 } else { right - left });
    let sign = match difference {
        Some(more) if more > 0.0 => "+",
        Some(less) if less < 0.0 => "-",
        _ => "",
    };
    for ((column, _), (sign, value)) in
        COLUMNS.into_iter().zip([("", left), ("", right), (sign, difference.map(f64::abs))])
    {
        let whole = value.map_or_else(|| "…".to_owned(), written);
        let shown = value.filter(|_| whole.len() > ROOM).map_or_else(|| whole.clone(), short);
        let says = format!("{name}, {}: {sign}{whole}", column.to_lowercase());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let cell = ui.label(dense(sign.to_owned() + &shown)).on_hover_text(format!("{hover}\n{says}"));
            cell.widget_info(|| WidgetInfo::labeled(Role::Label, true, &says));
        });
    }
    ui.end_row();
}

/// A count with all of its digits, or another number shortened.
fn written(value: f64) -> String {
    if value.fract() == 0.0 { grouped(value as u64) } else { short(value) }
}
