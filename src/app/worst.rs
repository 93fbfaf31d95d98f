//! Edges whose sides disagree, the worst first; one of them in detail; and T-junctions.

use egui::RichText;

use super::App;
use super::facts::EDGE_KINDS;
use super::text::{grouped, short};
use super::widgets::{fact, heading};
use crate::measure::EdgeSide;
use crate::mesh::{EdgeKind, TJunction, Topology};
use crate::render::LineSegment;
use crate::render::layout::SELECTION_COLOR;

/// Rows that a list shows at once.
const ROWS: f32 = 6.0;

impl App {
    /// A list of edges; a click frames one.
    pub(super) fn worst_edges(&mut self, ui: &mut egui::Ui) {
        let (Some(document), Some(cracks)) = (&self.document, self.measuring.cracks()) else { return };
        if cracks.edges.is_empty() {
            return;
        }
        ui.add_space(4.0);
        let header = format!("{:<6}{:<13}{:>8}", "edge", "kind", "gap");
        ui.label(RichText::new(header).monospace().weak()).on_hover_text(
            "Edges whose sides disagree in a position, factor or normal, the widest gap (object units) first.",
        );
        let topology = &document.loaded.topology;
        let mut clicked = None;
        let text = |row: usize| {
            let crack = &cracks.edges[row];
            let kind = kind_name(topology.edges[crack.edge as usize].kind);
            (crack.edge, format!("{:<6}{kind:<13}{:>8}", crack.edge, short(crack.gap)))
        };
        rows(ui, "worst edges", cracks.edges.len(), |ui, row| {
            let (edge, text) = text(row);
            let crack = &cracks.edges[row];
            let response = ui.selectable_label(self.selected_edge == Some(edge), RichText::new(text).monospace());
            let response = response.on_hover_ui(|ui| {
                ui.label(format!(
                    "{} px on screen; {} points and {} normals differ; factors {}. A click frames the edge.",
                    short(self.viewport.gap_of_edge_px(crack)),
                    crack.different_bits,
                    crack.different_normals,
                    if crack.different_factors { "differ" } else { "agree" },
                ));
            });
            if response.clicked() {
                clicked = Some(edge);
            }
        });
        if let Some(edge) = clicked {
            self.select_edge(edge);
        }
    }

    /// The selected edge: its kind, its triangles, and what each side made of it.
    pub(super) fn edge_details(&mut self, ui: &mut egui::Ui) {
        let (Some(edge), Some(document)) = (self.selected_edge, &self.document) else { return };
        let topology = &document.loaded.topology;
        let kind = kind_name(topology.edges[edge as usize].kind);
        let mut closed = false;
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            ui.label(RichText::new(format!("Edge {edge}")).strong());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                closed = ui.small_button("Deselect").on_hover_text("Closes this section (Esc).").clicked();
            });
        });
        ui.separator();
        let sides = self.measuring.found().map(|found| found.rims.edge(topology, edge)).unwrap_or_default();
        egui::Grid::new("edge").num_columns(2).min_col_width(104.0).show(ui, |ui| {
            fact(ui, "Kind", kind, "What the edge's sides have in common.");
            if let Some(crack) = self.measuring.cracks().and_then(|cracks| cracks.edges.iter().find(|c| c.edge == edge))
            {
                let px = self.viewport.gap_of_edge_px(crack);
                fact(ui, "Gap", &format!("{} units", short(crack.gap)), "Largest distance between two sides.");
                fact(ui, "", &format!("{} px", short(px)), "On screen.");
            }
            for side in &sides {
                let name = format!("Triangle {}", side.triangle);
                let value = format!("{:.5} / {}", side.factor, side.segments());
                fact(ui, &name, &value, "The factor it was given, and the segments that makes.");
            }
        });
        point_rows(ui, &sides);
        if closed {
            self.selected_edge = None;
        }
    }

    /// A list of T-junctions; a click frames one.
    pub(super) fn t_junction_list(&mut self, ui: &mut egui::Ui) {
        let Some(junctions) = self.document.as_ref().and_then(|document| document.checks.t_junctions()) else { return };
        if junctions.is_empty() {
            return;
        }
        heading(ui, "T-junctions");
        ui.label(format!("{} points on open edges", grouped(junctions.len() as u64)))
            .on_hover_text("No tessellation closes these: the edge is cut without knowing of the point.");
        ui.label(RichText::new(format!("{:<9}{:<9}{:>9}", "point", "edge", "at")).monospace().weak());
        let mut clicked: Option<TJunction> = None;
        rows(ui, "t-junctions", junctions.len(), |ui, row| {
            let TJunction { edge, point, t, .. } = junctions[row];
            let text = RichText::new(format!("{point:<9}{edge:<9}{t:>9.3}")).monospace();
            let response = ui.selectable_label(self.selected_edge == Some(edge), text);
            if response.on_hover_text("Where along the edge the point lies. A click frames the edge.").clicked() {
                clicked = Some(junctions[row]);
            }
        });
        if let Some(junction) = clicked {
            self.settings.overlays.t_junctions = true;
            self.select_edge(junction.edge);
        }
    }

    /// Selects an edge and turns the camera so that it is in the middle, seen from the side its triangles face.
    pub fn select_edge(&mut self, edge: u32) {
        let Some(document) = &self.document else { return };
        let topology = &document.loaded.topology;
        let Some(chosen) = topology.edges.get(edge as usize) else { return };
        let ends = chosen.points.map(|point| topology.points[point as usize]);
        self.camera.frame_edge(ends, topology.edge_facing(chosen), &document.scene.bounds);
        self.selected_edge = Some(edge);
    }

    /// What marks the selected edge: all its sides, or if its patches emit nothing the straight line.
    pub(super) fn selection_lines(&self, topology: &Topology) -> Vec<LineSegment> {
        let Some(edge) = self.selected_edge else { return Vec::new() };
        let wide = |a, b| LineSegment { half_width: 4.0, ..LineSegment::new(a, b, SELECTION_COLOR) };
        let sides = self.measuring.found().map(|found| found.rims.edge(topology, edge)).unwrap_or_default();
        let lines = sides.iter().flat_map(|side| {
            let points: Vec<_> = side.positions().collect();
            points.windows(2).map(|ends| wide(ends[0], ends[1])).collect::<Vec<_>>()
        });
        let lines: Vec<_> = lines.collect();
        if lines.is_empty() {
            let [a, b] = topology.edges[edge as usize].points.map(|point| topology.points[point as usize]);
            return vec![wide(a, b)];
        }
        lines
    }
}

fn kind_name(kind: EdgeKind) -> &'static str {
    EDGE_KINDS.iter().find(|(known, ..)| *known == kind).map_or("", |(_, name, _)| name)
}

/// A list of many rows, of which only those in sight are made.
fn rows(ui: &mut egui::Ui, name: &str, count: usize, mut row: impl FnMut(&mut egui::Ui, usize)) {
    let height = ui.text_style_height(&egui::TextStyle::Monospace).max(ui.spacing().interact_size.y);
    let shown = ROWS.min(count as f32) * (height + ui.spacing().item_spacing.y);
    let area = egui::ScrollArea::vertical().id_salt(name).max_height(shown).auto_shrink([false, true]);
    area.show_rows(ui, height, count, |ui, range| range.for_each(|index| row(ui, index)));
}

/// Every point of an edge, and how far its sides are apart there; the positions themselves on hover.
fn point_rows(ui: &mut egui::Ui, sides: &[EdgeSide]) {
    let Some((first, others)) = sides.split_first() else { return };
    let count = sides.iter().map(|side| side.points.len()).max().unwrap_or(0);
    ui.label(RichText::new(format!("{:<6}{:>21}", "point", "apart, units")).monospace().weak());
    rows(ui, "points", count, |ui, index| {
        let place = |side: &EdgeSide| side.positions().nth(index);
        let gaps = others.iter().map(|other| Some(f64::from(place(first)?.distance(place(other)?))));
        let gap = gaps
            .map(|gap| gap.map_or(f64::NAN, |gap| gap))
            .fold(0.0, |a: f64, b| if b.is_nan() || b > a { b } else { a });
        let text = if gap.is_nan() { "not on all sides".to_owned() } else { short(gap) };
        ui.label(RichText::new(format!("{index:<6}{text:>21}")).monospace()).on_hover_ui(|ui| {
            for side in sides {
                let text = match place(side) {
                    Some(p) => format!("triangle {}: {:e} {:e} {:e}", side.triangle, p.x, p.y, p.z),
                    None => format!("triangle {} has no such point", side.triangle),
                };
                ui.label(RichText::new(text).monospace());
            }
        });
    });
}
