//! The lists of cracked edges and of T-junctions, and the details of the selected edge.

use egui::RichText;

use crate::app::App;
use crate::app::text::{grouped, short};
use crate::app::widgets::{FoundRow, columns, fact, found_list, list, list_title, marked, number};
use crate::commands::{Action, with_key};
use geometry::mesh::{TJunction, Topology};
use geometry::view::ulp;
use glam::Vec3;
use inspect::gates::{EdgeSpot, Spot};
use inspect::measure::{CrackedEdge, EdgeSide, Measured};
use inspect::render::LineSegment;
use inspect::render::layout::{CRACK_COLOR, OUTLINE_COLOR, SIDE_COLORS, T_JUNCTION_COLOR};
use inspect::settings::{Choice, SplitSide};

/// Half the widths of the selected edge's outline, of its first side, and of the others, in px.
const ALONE: [f32; 3] = [2.5, 1.75, 0.75];
/// The same for an edge of the selected patch, whose outline lies over it: what is seen is a halo.
const HALO: [f32; 3] = [6.25, 5.5, 4.0];
/// The same for a cracked edge, whose gap is to be seen between its sides; and of the dots at the gap's ends.
const CRACKED: [f32; 3] = [0.0, 0.75, 0.75];
const GAP_DOT: f32 = 1.5;

impl App {
    /// The list of cracked edges, the widest gap first. A click frames one.
    pub(in crate::app) fn worst_edges(&mut self, ui: &mut egui::Ui) {
        let (Some(document), Some(results)) = (&self.document, self.results()) else { return };
        let cracked = results.found.cracks.cracked();
        if cracked.is_empty() {
            return;
        }
        let topology = &document.loaded.topology;
        let hover = "Edges whose sides put a point at different positions, the widest gap first; a click frames one.";
        list_title(ui, None, "Worst edges", hover);
        columns(ui, &format!("{:<7}{:<13}{:>9}", "edge", "kind", "gap, units"), true);
        let which = document.generation as u32 ^ results.seen.inputs.tessellation.surface as u32;
        let clicked = found_list(ui, "worst edges", cracked, which, |crack| {
            let kind = topology.edges[crack.edge as usize].kind.label();
            FoundRow {
                columns: format!("{:<7}{kind:<13}{:>9}", crack.edge, short(crack.gap)),
                is_selected: self.selected_edge() == Some(crack.edge),
                hover: format!(
                    "The gap is {} px wide as the camera of LOD sees it, {} ULP. {} points and {} normals differ; the factors {}. A click \
                     frames the edge.",
                    short(results.gap_px(crack)),
                    short(crack.gap / ulp(topology)),
                    crack.different_bits,
                    crack.different_normals,
                    if crack.different_factors { "differ" } else { "agree" },
                ),
            }
        });
        if let Some(edge) = clicked.map(|crack| crack.edge) {
            self.select_edge(edge);
        }
    }

    /// The selected edge: its kind, its gap, and the points of each side.
    pub(in crate::app) fn edge_details(&mut self, ui: &mut egui::Ui) {
        let (Some(edge), Some(document)) = (self.selected_edge(), &self.document) else { return };
        let topology = &document.loaded.topology;
        let kind = topology.edges[edge as usize].kind.label();
        let mut closed = false;
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            ui.label(RichText::new(format!("Edge {edge}")).strong());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let hover = with_key("Closes this section.", &Action::Cancel);
                closed = ui.small_button("Deselect").on_hover_text(hover).clicked();
            });
        });
        ui.separator();
        let results = self.results();
        let sides = results.map(|results| results.found.outlines.edge(topology, edge)).unwrap_or_default();
        egui::Grid::new("edge").num_columns(2).min_col_width(104.0).show(ui, |ui| {
            fact(ui, "Kind", kind, "How the normals and uvs of the edge's sides agree.");
            if let Some((results, crack)) = results.and_then(|own| Some((own, crack_in(&own.found, edge)?))) {
                let (px, ulps) = (results.gap_px(crack), crack.gap / ulp(topology));
                fact(ui, "Gap", &format!("{} units", short(crack.gap)), "Largest distance between two sides.");
                let hover = "In units of the last place of the mesh's largest coordinate.";
                fact(ui, "", &format!("{} ULP", short(ulps)), hover);
                fact(ui, "", &format!("{} px", short(px)), "The gap as the camera of LOD sees it.");
                let hover = "Points whose normals differ although the mesh's normals agree.";
                fact(ui, "Normals differ", &grouped(crack.different_normals.into()), hover);
                if let Some(patch) = crack.discarded {
                    let triangle = topology.patches[patch as usize].triangle;
                    let hover =
                        "One of its factors isn't above 0, so that it isn't drawn. The gap is as wide as this hole.";
                    fact(ui, "Left out", &format!("triangle {triangle}"), hover);
                }
            }
        });
        side_rows(ui, &sides);
        if sides.len() > 1 {
            point_rows(ui, &sides);
        }
        if closed {
            self.select_only_edge(None);
        }
    }

    pub(in crate::app) fn t_junction_list(&mut self, ui: &mut egui::Ui) {
        let Some(junctions) = self.document.as_ref().and_then(|document| document.checks.t_junctions()) else { return };
        if junctions.is_empty() {
            return;
        }
        ui.add_space(4.0);
        let hover = "Points that lie on the open edge of another triangle, or close beside it. No tessellation closes these \
                     gaps, because the edge's segments don't depend on the point.";
        ui.horizontal(|ui| {
            marked(ui, Some(T_JUNCTION_COLOR), "T-junctions", hover);
            number(ui, &grouped(junctions.len() as u64));
        });
        columns(ui, &format!("{:<9}{:<9}{:>11}", "point", "edge", "at, 0 to 1"), true);
        let clicked = found_list(ui, "t-junctions", junctions, junctions[0].point, |own| FoundRow {
            columns: format!("{:<9}{:<9}{:>11.3}", own.point, own.edge, own.t),
            is_selected: self.selected_edge() == Some(own.edge),
            hover: "Where the point lies along the edge, from 0 to 1. A click frames the edge.".to_owned(),
        });
        if let Some(junction) = clicked.copied() {
            self.show_junction(&junction);
        }
    }

    pub(super) fn show_junction(&mut self, junction: &TJunction) {
        self.settings.overlays.t_junctions = true;
        let Some(document) = &self.document else { return };
        let at = document.shown().1.points[junction.point as usize];
        self.select_edge_at(junction.edge, Some(at));
    }

    /// Selects an edge and shows it: where its sides are the farthest apart, or else its middle.
    pub fn select_edge(&mut self, edge: u32) {
        self.select_edge_at(edge, None);
    }

    fn select_edge_at(&mut self, edge: u32, at: Option<Vec3>) {
        let Some(document) = &self.document else { return };
        let topology = &document.shown().1;
        if edge as usize >= topology.edges.len() {
            return;
        }
        let spot = self.edge_spot(topology, edge, at);
        // The selected triangle stays if it is one of its edges.
        if !self.patch_has(edge) {
            self.deselect();
        }
        self.select_only_edge(Some(edge));
        self.show_place(SplitSide::Right, &Spot::Edge(spot), None);
    }

    fn edge_spot(&self, topology: &Topology, edge: u32, at: Option<Vec3>) -> EdgeSpot {
        let found = self.results().map(|results| &results.found);
        if let Some(crack) = found.and_then(|found| crack_in(found, edge)).filter(|crack| crack.gap > 0.0) {
            return EdgeSpot::new(topology, edge, None).at_gap(crack.widest);
        }
        // What was emitted may bulge above the middle of the straight line, and hide it.
        let sides = found.map(|found| found.outlines.edge(topology, edge)).unwrap_or_default();
        let middle = sides.first().and_then(|side| side.positions().nth(side.points.len() / 2));
        EdgeSpot::new(topology, edge, at.or(middle))
    }

    pub(in crate::app) fn selected_gap(&self, half: SplitSide) -> Option<&CrackedEdge> {
        let found = self.found(half)?;
        crack_in(found, self.selected_edge()?).filter(|crack| crack.gap > 0.0)
    }

    /// The lines that mark the selected edge: each side in a colour of its own, the later ones thinner so that sides that
    /// coincide both show, and a dot where they are farthest apart. If its patches emit nothing, it is the straight line. An edge of
    /// the selected patch has wider ones, of which a halo is seen around the colour of the edge's factor.
    pub(in crate::app) fn selection_lines(&self, topology: &Topology, half: SplitSide) -> Vec<LineSegment> {
        let Some(edge) = self.selected_edge() else { return Vec::new() };
        let sides = self.found(half).map(|found| found.outlines.edge(topology, edge)).unwrap_or_default();
        let mut polylines: Vec<Vec<Vec3>> = sides.iter().map(|side| side.positions().collect()).collect();
        if polylines.iter().all(|points| points.len() < 2) {
            let ends = topology.edge_points(&topology.edges[edge as usize]);
            polylines = vec![ends.map(|point| topology.points[point as usize]).to_vec()];
        }
        let strip = |points: &[Vec3], color, half_width| {
            let ends = points.windows(2).map(move |ends| [ends[0], ends[1]]);
            ends.map(|[a, b]| LineSegment { half_width, ..LineSegment::new(a, b, color) }).collect::<Vec<_>>()
        };
        let gap = self.selected_gap(half);
        let [around, first, later] = match gap {
            Some(_) => CRACKED,
            None if self.patch_has(edge) => HALO,
            None => ALONE,
        };
        let outline = polylines.iter().flat_map(|points| strip(points, OUTLINE_COLOR, around));
        let colored = polylines.iter().enumerate().flat_map(|(k, points)| {
            strip(points, SIDE_COLORS[k % SIDE_COLORS.len()], if k == 0 { first } else { later })
        });
        let dots = gap.into_iter().flat_map(|crack| crack.widest);
        let dots = dots.map(|place| LineSegment { half_width: GAP_DOT, ..LineSegment::new(place, place, CRACK_COLOR) });
        outline.chain(colored).chain(dots).collect()
    }
}

/// The differences between an edge's sides, if there are any.
fn crack_in(found: &Measured, edge: u32) -> Option<&CrackedEdge> {
    found.cracks.edges.iter().find(|crack| crack.edge == edge)
}

/// A row for each side: its triangle with the colour that the side has over the mesh, its factor and its segments.
fn side_rows(ui: &mut egui::Ui, sides: &[EdgeSide]) {
    egui::Grid::new("sides").num_columns(3).min_col_width(60.0).show(ui, |ui| {
        ui.weak("side");
        for (text, hover) in [
            ("factor", "The factor that LOD gave, before it was clamped and rounded."),
            ("segments", "The number of segments that the side was cut into."),
        ] {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.weak(text).on_hover_text(hover));
        }
        ui.end_row();
        for (k, side) in sides.iter().enumerate() {
            let (color, name) = (SIDE_COLORS[k % SIDE_COLORS.len()], format!("Triangle {}", side.triangle));
            marked(ui, Some(color), &name, "The triangle's number in the mesh, from 0.");
            number(ui, &format!("{:.5}", side.factor));
            number(ui, &side.segments().to_string());
            ui.end_row();
        }
    });
}

/// A row for each point of an edge with the distance between its sides. The hover text has the positions.
fn point_rows(ui: &mut egui::Ui, sides: &[EdgeSide]) {
    let Some((first, others)) = sides.split_first() else { return };
    let count = sides.iter().map(|side| side.points.len()).max().unwrap_or(0);
    columns(ui, &format!("{:<6}{:>23}", "point", "gap, units"), true);
    list(ui, "points", count, (count, first.triangle), |ui, index| {
        let place = |side: &EdgeSide| side.positions().nth(index);
        let gaps = others.iter().map(|other| Some(f64::from(place(first)?.distance(place(other)?))));
        let gap =
            gaps.map(|gap| gap.unwrap_or(f64::NAN)).fold(0.0, |a: f64, b| if b.is_nan() || b > a { b } else { a });
        let text = if gap.is_nan() { "not on all sides".to_owned() } else { short(gap) };
        columns(ui, &format!("{index:<6}{text:>23}"), false).on_hover_ui(|ui| {
            for side in sides {
                let text = match place(side) {
                    Some(p) => format!("triangle {}: {:e} {:e} {:e}", side.triangle, p.x, p.y, p.z),
                    None => format!("triangle {} has no such point", side.triangle),
                };
                ui.label(RichText::new(text).monospace());
            }
        })
    });
}
