//! The section about the selected patch: its factors, pattern, neighbours, corners and adjacency indices.

use egui::{RichText, Ui};

use super::patch_pattern::{pattern_plot, weights_text};
use crate::app::jobs::explain_job::EmittedPatch;
use crate::app::patch_names::{LETTERS, ends_text, letter, mistake};
use crate::app::text::{factor, short};
use crate::app::widgets::{SWATCH, dense, swatch, title};
use crate::app::{App, Document};
use crate::commands::{Action, with_key};
use geometry::mesh::{Mesh, Topology, adjacency};
use geometry::names;
use geometry::tessellate::factors::{patch_has_rows, patch_is_culled, row_base, row_count, row_flip};
use geometry::tessellate::{
    Convention, ExplainedPatch, FACING_AWAY, FACTOR_VALUE, FIXED_ONE, Lod, OUT_OF_VIEW, PatchFactors, Vertex,
    domain_side, factor_side, inside_cut, point_count, segments, triangle_count, weight_corner,
};
use inspect::measure::EdgeSide;
use inspect::render::layout::FACTOR_COLORS;
use inspect::settings::{Choice, SplitSide};

/// What is to be done once the rows are shown.
type Wish = Box<dyn FnOnce(&mut App)>;

/// The selected triangle, its patch, and what is known about them.
pub(super) struct SelectedPatch<'a> {
    app: &'a App,
    half: SplitSide,
    mesh: &'a Mesh,
    pub topology: &'a Topology,
    triangle: u32,
    patch: u32,
    pub convention: Convention,
    /// What takes the place of LOD: a file of factors, or a shader.
    pub given_by: Option<&'static str>,
    /// Why it has its factors. None until that is found, and if nothing is emitted: the rows then have ellipses, so that they don't
    /// jump.
    pub explained: Option<&'a ExplainedPatch>,
    /// Known once measured. All are 0 if the patch emits nothing.
    pub factors: Option<PatchFactors>,
    sides: Option<[EdgeSide; 3]>,
}

impl App {
    pub(in crate::app) fn patch_section(&mut self, ui: &mut Ui) {
        let shown = |document: &Document| match self.selected_triangle() {
            Some(_) => document.shown(),
            None => (document.loaded.mesh.clone(), document.loaded.topology.clone()),
        };
        // Before a mesh is there, the rows have their places.
        let (mesh, topology) = &self.document.as_ref().map_or_else(Default::default, shown);
        let mut wish = chosen_triangle(ui, mesh, topology, self.selected_triangle());
        match (self.selected_triangle(), self.selected_patch()) {
            (None, _) => drop(ui.weak("Click a triangle, or type its number.")),
            (Some(triangle), None) => drop(ui.label(format!("Triangle {triangle} is degenerate: it has no patch."))),
            (Some(triangle), Some(patch)) => {
                let (question, is_of_shader) = (self.emitted_patch(patch), self.uses_surface_shader());
                let given_by = self.given.as_ref().map(|_| "from the file of factors");
                let given_by = given_by.or(self.uses_lod_shader().then_some("computed by the LOD shader"));
                let half = self.patch_half();
                let results = self.results_of(half);
                let found = results.map(|results| &results.found);
                let convention =
                    results.map_or(self.convention(), |results| results.seen.inputs.tessellation.convention);
                let shown = SelectedPatch {
                    app: self,
                    half,
                    mesh,
                    topology,
                    triangle,
                    patch,
                    convention,
                    given_by,
                    explained: question.and_then(|question| self.explained(&question)),
                    factors: found.map(|found| found.outlines.factors(patch)),
                    sides: found.and_then(|found| found.outlines.patch(topology, patch)),
                };
                if let Some((part, document)) = self.picked_part().zip(self.document.as_ref()) {
                    let name = names::shown(&document.loaded.contents.parts[part].name);
                    ui.add(egui::Label::new(RichText::new(&name).strong()).truncate()).on_hover_text(name);
                }
                if self.settings.split.is_some() {
                    let hover =
                        "Edit left and Edit right choose whose factors these are, if both halves show the same mesh.";
                    let of = if half == SplitSide::Left { "Of the left half" } else { "Of the right half" };
                    ui.weak(of).on_hover_text(hover);
                }
                // The tables have less space between lines than the rest of the panel.
                ui.scope(|ui| {
                    ui.spacing_mut().item_spacing.y = 3.0;
                    ui.spacing_mut().interact_size.y = 16.0;
                    shown.factor_rows(ui);
                    if is_of_shader {
                        ui.add(egui::Label::new(NOT_EXPLAINED).wrap());
                    } else {
                        shown.explanation_rows(ui);
                    }
                    shown.plot(ui);
                    shown.edge_rows(ui, &mut wish);
                    shown.corner_rows(ui);
                    shown.index_rows(ui);
                    shown.hit_rows(ui);
                });
                question.into_iter().for_each(|question| self.explain(ui.ctx(), question));
            }
        }
        wish.into_iter().for_each(|wish| wish(self));
    }

    /// What the selected patch's explanation is about: how the patch was emitted. None until that is measured, and if nothing was emitted.
    fn emitted_patch(&self, patch: u32) -> Option<EmittedPatch> {
        let results = self.results_of(self.patch_half())?;
        let factors = results.found.outlines.factors(patch);
        let emitted = EmittedPatch { tessellation: results.of, patch, inputs: results.seen.inputs, factors };
        // What explains a patch computes its surface on the CPU, which doesn't know a shader's.
        let is_known = !self.uses_surface_shader();
        (is_known && !patch_is_culled(factors)).then_some(emitted)
    }
}

/// What is said in place of what a patch's factors are explained by.
const NOT_EXPLAINED: &str =
    "How far its triangles are from the surface isn't measured: the CPU doesn't know the surface of a shader.";

/// The number of the selected triangle, which can be dragged and typed, and the buttons beside it.
fn chosen_triangle(ui: &mut Ui, mesh: &Mesh, topology: &Topology, selected: Option<u32>) -> Option<Wish> {
    let mut wish: Option<Wish> = None;
    ui.horizontal(|ui| {
        let hover = "Number in the mesh, from 0. A file's triangles are grouped by material.";
        let label = ui.label("Triangle").on_hover_text(hover);
        let mut number = selected.map_or(-1, i64::from);
        let drag = egui::DragValue::new(&mut number)
            .range(-1..=mesh.triangles.len() as i64 - 1)
            .speed(0.1)
            .update_while_editing(false)
            .custom_formatter(|number, _| if number < 0.0 { "none".into() } else { format!("{number}") })
            .custom_parser(|text| {
                if text.trim() == "none" { Some(-1.0) } else { text.trim().parse::<u32>().ok().map(f64::from) }
            });
        let response = ui.add_sized([64.0, ui.spacing().interact_size.y], drag).labelled_by(label.id);
        if response.on_hover_text(hover).changed() {
            wish = Some(Box::new(move |app| app.select_triangle(u32::try_from(number).ok())));
        }
        let patch = selected.and_then(|triangle| topology.patch_of(triangle));
        let frame = ui.add_enabled(patch.is_some(), egui::Button::new("Frame").small());
        if frame.on_hover_text("Puts the patch in the middle of the view, seen from its front (Shift+F).").clicked() {
            wish = Some(Box::new(App::frame_patch));
        }
        let deselect = ui.add_enabled(selected.is_some(), egui::Button::new("Deselect").small());
        deselect.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, selected.is_some(), "Deselect patch"));
        if deselect.on_hover_text(with_key("Clears the selection.", &Action::Cancel)).clicked() {
            wish = Some(Box::new(App::deselect));
        }
    });
    wish
}

impl SelectedPatch<'_> {
    /// A row for each factor: its edge, the factor that LOD gave, the factor that the tessellator uses, and the segments.
    fn factor_rows(&self, ui: &mut Ui) {
        title(ui, "Factors", "TessFactor[i] belongs to the edge on which weight i (u, v, w) is 0.");
        let header = format!("{:<4}{:<4}{:>8}{:>8}{:>6}", "", "edge", "LOD", "used", "cut");
        factor_row(ui, None, &header, true).on_hover_text(
            "LOD: the factor that LOD gave. Used: the factor after the tessellator clamped and rounded it. Cut: the \
             number of segments.",
        );
        for i in 0..3 {
            let (word, side) = (self.factors.map(|f| f.outside[i as usize]), factor_side(self.convention, i));
            let numbers = self.factor_numbers(self.asked(i), word, word.map(segments));
            let text = format!("{:<4}{:<4}{numbers}", format!("[{i}]"), ends_text(side));
            factor_row(ui, Some(FACTOR_COLORS[i as usize]), &text, false).on_hover_text(format!("TessFactor[{i}]"));
        }
        let asked = match self.lod().is_by_error() {
            // LOD by error asks for a whole number and doesn't keep it, so the used factor is shown.
            true => self.factors.map(|factors| used(factors.inside) as f32),
            _ if self.factors.is_some_and(patch_has_rows) => self.factors.and_then(|f| self.asked(row_base(f))),
            _ => (0..3).map(|i| self.asked(i)).reduce(|a, b| Some(a?.max(b?))).flatten(),
        };
        let numbers = self.factor_numbers(asked, self.factors.map(|f| f.inside), self.factors.map(inside_cut));
        let (name, hover) = match self.factors.filter(|factors| patch_has_rows(*factors)) {
            Some(factors) => {
                let base = row_base(factors);
                let flipped = if row_flip(factors) == 1 { " Their diagonals run the other way." } else { "" };
                let rows = row_count(factors);
                ("width", format!("{rows} rows lie along edge [{base}]. The widest has so many segments.{flipped}"))
            }
            None => ("inside", "InsideTessFactor".to_owned()),
        };
        factor_row(ui, None, &format!("{name:<8}{numbers}"), false).on_hover_text(hover);
        for text in (0..3).filter_map(|i| mistake(self.convention, i)) {
            ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
        }
    }

    pub(super) fn lod(&self) -> Lod {
        let own = self.app.settings.half(self.half).unwrap_or(self.app.settings);
        own.tessellation.used_lod()
    }

    /// The factor that LOD gave the edge whose factor the hull shader writes as factor `i`.
    fn asked(&self, i: u32) -> Option<f32> {
        self.sides.as_ref().map(|sides| sides[factor_side(self.convention, i) as usize].factor)
    }

    /// The three columns of numbers, or ellipses until they are known.
    fn factor_numbers(&self, asked: Option<f32>, word: Option<u32>, cut: Option<u32>) -> String {
        match (asked, word, cut) {
            _ if self.factors.is_some_and(patch_is_culled) => format!("{:>22}", "culled"),
            (Some(asked), Some(word), Some(cut)) => {
                format!("{:>8}{:>8}{cut:>6}", factor(f64::from(asked), 3), factor(used(word), 3))
            }
            _ => format!("{:>8}{:>8}{:>6}", "…", "…", "…"),
        }
    }

    fn plot(&self, ui: &mut Ui) {
        let pattern = match self.factors {
            None => "… points, … triangles".to_owned(),
            Some(factors) => format!("{} points, {} triangles", point_count(factors), triangle_count(factors)),
        };
        let hover = "The domain points and triangles that the tessellator makes from these factors.";
        title(ui, &format!("Pattern: {pattern}"), hover);
        let letters = [0, 1, 2].map(|i| format!("{} {}", weight_corner(self.convention, i), LETTERS[i as usize]));
        let empty = match self.factors {
            None if self.app.is_playing() => "measured when paused",
            None => "measuring…",
            Some(PatchFactors { inside: OUT_OF_VIEW, .. }) => "out of view, so nothing is emitted",
            Some(PatchFactors { inside: FACING_AWAY, .. }) => "facing away, so nothing is emitted",
            Some(_) => "a factor is 0 or less, so nothing is emitted",
        };
        pattern_plot(ui, self.factors, self.app.hit().map(|hit| hit.number), letters, empty);
    }

    /// A row for each edge: its kind, and the triangles across it.
    fn edge_rows(&self, ui: &mut Ui, wish: &mut Option<Wish>) {
        title(ui, "Edges of the patch", "Edges are named by their two corners. A click selects one.");
        let grid =
            egui::Grid::new("patch edges").num_columns(4).min_col_width(14.0).min_row_height(0.0).spacing([8.0, 3.0]);
        grid.show(ui, |ui| {
            for text in ["", "edge", "kind", "neighbour"] {
                ui.weak(text);
            }
            ui.end_row();
            for i in 0..3 {
                let k = domain_side(self.convention, i);
                let side = &self.topology.sides[self.topology.patches[self.patch as usize].sides[k as usize] as usize];
                let (number, edge) = (side.edge, &self.topology.edges[side.edge as usize]);
                swatch(ui, FACTOR_COLORS[i as usize]);
                let text = dense(ends_text(k));
                let response = ui.selectable_label(self.app.selected_edge() == Some(number), text);
                let named = format!("Edge {} of the patch", ends_text(k));
                response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &named));
                if response.on_hover_text(format!("Selects the edge, number {number}.")).clicked() {
                    *wish = Some(Box::new(move |app| app.select_only_edge(Some(number))));
                }
                ui.label(edge.kind.label()).on_hover_text(edge.kind.text());
                let others = self.topology.edge_sides(edge).iter().map(|side| side.patch());
                let others: Vec<_> = others.filter(|&patch| patch != self.patch).collect();
                if let Some(triangle) = neighbours(ui, self.topology, &others) {
                    *wish = Some(Box::new(move |app| app.select_triangle(Some(triangle))));
                }
                ui.end_row();
            }
        });
    }

    /// Position, normal and uv of every corner.
    fn corner_rows(&self, ui: &mut Ui) {
        let hover = "Position in object units, unit normal and texture coordinates, as loaded. Hover texts have the exact \
                     numbers.";
        title(ui, "Corners", hover);
        for (k, corner) in (0..).zip(self.topology.patch_corners(self.patch)) {
            let point = self.topology.corner_points[corner as usize];
            let (at, letter) = (&self.mesh.corners[corner as usize], letter(self.convention, k));
            ui.label(dense(format!("{k} {letter}  corner {corner}, point {point}")));
            let rows =
                [("at", &at.position.to_array()[..]), ("normal", &at.normal.to_array()), ("uv", &at.uv.to_array())];
            for (name, numbers) in rows {
                let text = |number: &f32| format!("{:>9}", short(f64::from(*number)));
                let exact: Vec<_> = numbers.iter().map(|number| format!("{number:e}")).collect();
                ui.label(dense(format!("{name:>6}{}", numbers.iter().map(text).collect::<String>())))
                    .on_hover_text(exact.join(" "));
            }
        }
        let material = self.mesh.materials.iter().find(|material| material.triangles.contains(&self.triangle));
        let material =
            material.map_or("none", |material| if material.name.is_empty() { "unnamed" } else { &material.name });
        ui.add(egui::Label::new(format!("Material: {material}")).truncate());
    }

    /// The nine indices of PN-AEN, and the three of dominant corners.
    fn index_rows(&self, ui: &mut Ui) {
        let hover = "Indices of corners as `pnaen adjacency` writes them: nine, or twelve with the dominant corners.";
        title(ui, "Adjacency indices", hover);
        let indices = adjacency::eighteen(self.topology, self.patch);
        let row = |name: &str, indices: &[u32]| {
            format!("{name:<10}{}", indices.iter().map(|index| format!("{index:>8}")).collect::<String>())
        };
        ui.label(dense(row("corners", &indices[..3]))).on_hover_text("The triangle's own corners 0, 1, 2.");
        for k in 0..3_usize {
            let pair = &indices[3 + 2 * k..5 + 2 * k];
            let hover = "The neighbour's corners along this edge, in the patch's direction. Without exactly one neighbour \
                         they are the patch's own.";
            ui.label(dense(row(&format!("edge {}", ends_text(k as u32)), pair))).on_hover_text(hover);
        }
        ui.label(dense(row("dominant", &indices[9..12])))
            .on_hover_text("The lowest corner on each of the three points.");
    }

    /// The domain points of the emitted triangle that was clicked on.
    fn hit_rows(&self, ui: &mut Ui) {
        let Some(hit) = self.app.hit() else { return };
        let hover = "The triangle's number in the patch, and its domain points in 16.16 fixed point and as decimals.";
        title(ui, &format!("Emitted triangle {}", hit.number), hover);
        ui.label(dense(format!("{:<5}{:>9}{:>9}{:>9}", "point", "u", "v", "w")).weak());
        // The points' numbers are known once the tessellation is measured.
        let points = self.factors.and_then(|factors| factors.triangles().get(hit.number as usize).copied());
        for (k, vertex) in hit.vertices.iter().enumerate() {
            let point = points.map_or_else(|| "…".into(), |points| points[k].to_string());
            let [fixed, decimals] = weights_text(self.convention.domain_weights(Vertex::domain(vertex)));
            ui.label(dense(format!("{point:<5}{fixed}")));
            ui.label(dense(format!("{:<5}{decimals}", "")).weak());
        }
    }
}

/// Buttons that select the triangles of patches. Returns the triangle whose button was clicked.
fn neighbours(ui: &mut Ui, topology: &Topology, patches: &[u32]) -> Option<u32> {
    let button = |ui: &mut Ui, patch: &u32| {
        let triangle = topology.patches[*patch as usize].triangle;
        let response = ui.small_button(dense(triangle.to_string()));
        let named = format!("Neighbour, triangle {triangle}");
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &named));
        response.on_hover_text("Selects this triangle.").clicked().then_some(triangle)
    };
    match patches {
        [] => {
            ui.weak("none");
            None
        }
        [patch] => button(ui, patch),
        several => {
            let listed = |ui: &mut Ui| {
                let shown = several.iter().take(LISTED_NEIGHBOURS);
                let clicked = shown.fold(None, |clicked, patch| button(ui, patch).or(clicked));
                if several.len() > LISTED_NEIGHBOURS {
                    ui.weak(format!("{} more", several.len() - LISTED_NEIGHBOURS));
                }
                clicked
            };
            ui.vertical(listed).inner
        }
    }
}

/// How many triangles across one edge are listed.
const LISTED_NEIGHBOURS: usize = 16;

/// The factor in a word: see [`PatchFactors`].
fn used(word: u32) -> f64 {
    f64::from(word & FACTOR_VALUE) / f64::from(FIXED_ONE)
}

/// A line of the factors' table, and the colour of the edge.
fn factor_row(ui: &mut Ui, color: Option<[u8; 3]>, text: &str, is_weak: bool) -> egui::Response {
    let row = ui.horizontal(|ui| {
        match color {
            Some(color) => swatch(ui, color),
            None => drop(ui.allocate_exact_size(SWATCH, egui::Sense::hover())),
        }
        ui.label(if is_weak { dense(text).weak() } else { dense(text) })
    });
    row.inner
}
