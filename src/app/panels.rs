//! Left is what one sets, right what one learns, below what it cost.

use egui::RichText;

use super::App;
use super::text::{grouped, mebibytes, short};
use crate::measure::{Cracks, ulp};
use crate::mesh::EdgeKind;
use crate::render::layout::{CRACK_COLOR, edge_color};
use crate::settings::{FACTOR_RANGE, Overlay, PIXELS_RANGE};
use crate::tessellate::{Clip, Lod, Partitioning, Surface};

/// Name and explanation of each surface, partitioning and overlay.
const SURFACES: [(Surface, &str, &str); 3] = [
    (Surface::Flat, "Flat", "Flat dicing: more triangles, the same shape."),
    (
        Surface::Pn,
        "PN",
        "PN triangles (Vlachos et al. 2001): cubic patches from positions and normals. Cracks where normals are split.",
    ),
    (
        Surface::PnAen,
        "PN-AEN",
        "PN triangles with adjacent edge normals (McDonald and Kilgard 2010): both sides of an edge share the mean of \
         their control points, so nothing cracks.",
    ),
];
const PARTITIONINGS: [(Partitioning, &str, &str); 4] = [
    (Partitioning::Integer, "Integer", "Factors are rounded up: every segment is as long, and the pattern pops."),
    (
        Partitioning::Pow2,
        "Power of two",
        "Factors are rounded up to 1, 2, 4, 8, 16, 32 or 64: the pattern only halves.",
    ),
    (
        Partitioning::FractionalOdd,
        "Fractional odd",
        "An odd number of segments, two of which grow from nothing: no pops.",
    ),
    (
        Partitioning::FractionalEven,
        "Fractional even",
        "An even number of segments, two of which grow from nothing; at least 2.",
    ),
];
const OVERLAYS: [(Overlay, &str, &str); 5] = [
    (Overlay::Wireframe, "Wireframe", "Edges of the tessellated triangles (W)."),
    (Overlay::Patches, "Patch borders", "Borders of the input triangles (P)."),
    (
        Overlay::Barycentric,
        "Barycentric colours",
        "Domain coordinates: u red on corner 0, v green on corner 1, w blue on corner 2 (B).",
    ),
    (Overlay::Adjacency, "Adjacency edges", "Borders of the input triangles, coloured by the kind of edge (A)."),
    (Overlay::Cracks, "Cracks", "Edges whose sides put a point at different positions, through the surface (C)."),
];
/// Name and explanation of each kind of edge.
const EDGE_KINDS: [(EdgeKind, &str, &str); 5] = [
    (EdgeKind::Smooth, "smooth", "Two triangles that share normals and uvs."),
    (EdgeKind::Split, "split normal", "Two triangles whose normals differ at an end: where PN cracks."),
    (EdgeKind::Seam, "uv seam", "Two triangles that share normals but not uvs."),
    (EdgeKind::Boundary, "boundary", "Only one triangle: a hole or a border."),
    (EdgeKind::NonManifold, "non-manifold", "Three or more triangles."),
];

impl App {
    pub(super) fn settings_panel(&mut self, ui: &mut egui::Ui) {
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            heading(ui, "Surface");
            egui::Grid::new("surface").num_columns(2).min_col_width(84.0).show(ui, |ui| self.surface_rows(ui));
            heading(ui, "Level of detail");
            self.lod_rows(ui);
            heading(ui, "Overlays");
            for (overlay, name, hover) in OVERLAYS {
                ui.checkbox(self.settings.overlays.get_mut(overlay), name).on_hover_text(hover);
            }
            heading(ui, "View");
            self.view_rows(ui);
        });
    }

    fn surface_rows(&mut self, ui: &mut egui::Ui) {
        let settings = &mut self.settings;
        chooser(ui, "Surface", "What each triangle becomes.", &mut settings.surface, &SURFACES);
        let label = ui.label("Factor");
        let slider = egui::Slider::new(&mut settings.factor, FACTOR_RANGE)
            .max_decimals(3)
            .logarithmic(true)
            .update_while_editing(false);
        ui.add_enabled(settings.lod == Lod::Uniform, slider)
            .labelled_by(label.id)
            .on_hover_text("Tessellation factor: segments that each edge is cut into, 1 to 64 (+ and -).")
            .on_disabled_hover_text("Adaptive LOD computes a factor for every edge.");
        ui.end_row();
        chooser(ui, "Partitioning", "How factors become segments.", &mut settings.partitioning, &PARTITIONINGS);
    }

    fn lod_rows(&mut self, ui: &mut egui::Ui) {
        let mut adaptive = self.settings.lod == Lod::Paper;
        let hover = "Every edge gets as many segments as its control polygon is long on screen, divided by the px per \
                     segment, at least 1; inside, the largest of the three (McDonald and Kilgard 2010). (L)";
        if ui.checkbox(&mut adaptive, "Adaptive LOD").on_hover_text(hover).changed() {
            self.toggle_lod();
        }
        egui::Grid::new("lod").num_columns(2).min_col_width(84.0).show(ui, |ui| {
            let label = ui.label("Segment");
            let slider = egui::Slider::new(&mut self.settings.pixels, PIXELS_RANGE)
                .logarithmic(true)
                .max_decimals(1)
                .suffix(" px")
                .update_while_editing(false);
            ui.add_enabled(adaptive, slider)
                .labelled_by(label.id)
                .on_hover_text("Length of a segment on screen, in px.")
                .on_disabled_hover_text("Only adaptive LOD measures segments on screen.");
            ui.end_row();
        });
        let mut clip = self.settings.clip == Clip::Paper;
        let hover = "Leaves out patches whose ten control points all lie outside the view, whichever side each is on: \
                     the white paper's test, which can also drop patches that cross the view.";
        if ui.checkbox(&mut clip, "Clip patches out of view").on_hover_text(hover).changed() {
            self.settings.clip = if clip { Clip::Paper } else { Clip::Off };
        }
        let mut frozen = self.frozen.is_some();
        let hover = "LOD and clipping stay as they are for the camera of now, while you look from elsewhere (Z).";
        if ui.checkbox(&mut frozen, "Freeze LOD camera").on_hover_text(hover).changed() {
            self.toggle_frozen();
        }
    }

    fn view_rows(&mut self, ui: &mut egui::Ui) {
        let mut split = self.settings.split.is_some();
        let hover = "Left of the divider the mesh as it came, right of it tessellated, from one camera (S).";
        if ui.checkbox(&mut split, "Split view").on_hover_text(hover).changed() {
            self.toggle_split();
        }
        egui::Grid::new("view").num_columns(2).min_col_width(84.0).show(ui, |ui| {
            let mut percent = self.settings.split.unwrap_or(self.last_split) * 100.0;
            let label = ui.label("Divider");
            let slider = egui::Slider::new(&mut percent, 0.0..=100.0).max_decimals(0).suffix(" %");
            let response = ui.add_enabled(split, slider).labelled_by(label.id);
            if response.on_hover_text("Where the view is split, from the left.").changed() {
                self.last_split = percent / 100.0;
                self.settings.split = Some(self.last_split);
            }
            ui.end_row();
            let label = ui.label("Background");
            ui.color_edit_button_srgb(&mut self.settings.background)
                .labelled_by(label.id)
                .on_hover_text("sRGB colour behind the mesh.");
            ui.end_row();
        });
    }

    pub(super) fn toggle_lod(&mut self) {
        self.settings.lod = if self.settings.lod == Lod::Paper { Lod::Uniform } else { Lod::Paper };
    }

    pub(super) fn toggle_split(&mut self) {
        self.settings.split = if self.settings.split.is_some() { None } else { Some(self.last_split) };
    }

    pub(super) fn toggle_frozen(&mut self) {
        self.frozen = match self.frozen {
            Some(_) => None,
            None => self.viewport.shown_view(),
        };
    }

    pub(super) fn facts_panel(&mut self, ui: &mut egui::Ui) {
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            heading(ui, "Edges");
            self.edge_legend(ui);
            heading(ui, "Cracks");
            self.crack_facts(ui);
            heading(ui, "Mesh");
            self.mesh_facts(ui);
            self.pass_times(ui);
        });
    }

    fn edge_legend(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let edges = &document.edges;
        let counts = [edges.smooth, edges.split, edges.seam, edges.boundary, edges.non_manifold];
        egui::Grid::new("edges").num_columns(3).min_col_width(14.0).show(ui, |ui| {
            for ((kind, name, hover), count) in EDGE_KINDS.into_iter().zip(counts) {
                swatch(ui, edge_color(kind));
                ui.label(name).on_hover_text(hover);
                number(ui, &grouped(count as u64));
                ui.end_row();
            }
        });
    }

    fn crack_facts(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        // Until they are measured the rows keep their places.
        let cracks = self.measuring.cracks();
        let count = |number: fn(&Cracks) -> u64| cracks.map_or_else(|| "…".into(), |cracks| grouped(number(cracks)));
        let gap = |size: &dyn Fn(&Cracks) -> f64, unit: &str| {
            cracks.map_or_else(|| format!("… {unit}"), |cracks| format!("{} {unit}", short(size(cracks))))
        };
        let ulp = ulp(&document.loaded.topology);
        egui::Grid::new("cracks").num_columns(2).min_col_width(104.0).show(ui, |ui| {
            let hover = "Points of edges with several sides, once for each side after the first.";
            fact(ui, "Points compared", &count(|cracks| cracks.edge_points), hover);
            let hover = "Those that differ in at least one bit from the first side's.";
            fact(ui, "Different", &count(|cracks| cracks.different_bits), hover);
            ui.horizontal(|ui| {
                swatch(ui, CRACK_COLOR);
                ui.label("Cracked edges").on_hover_text("Edges with at least one such point; the overlay shows them.");
            });
            number(ui, &count(|cracks| cracks.edges.len() as u64));
            ui.end_row();
            let hover = "Largest distance between two sides' positions of one point, in object units.";
            fact(ui, "Largest gap", &gap(&Cracks::max_gap, "units"), hover);
            let hover = "In units of the last place of the mesh's largest coordinate.";
            fact(ui, "", &gap(&|cracks| cracks.max_gap() / ulp, "ULP"), hover);
            fact(ui, "", &gap(&|cracks| self.viewport.gap_px(cracks), "px"), "On screen.");
        });
    }

    fn mesh_facts(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let (mesh, topology) = (&document.loaded.mesh, &document.loaded.topology);
        let size = document.scene.bounds.max - document.scene.bounds.min;
        egui::Grid::new("mesh").num_columns(2).min_col_width(104.0).show(ui, |ui| {
            fact(ui, "Triangles", &grouped(mesh.triangles.len() as u64), "As loaded.");
            fact(ui, "Patches", &grouped(topology.patches.len() as u64), "Triangles that are tessellated.");
            fact(
                ui,
                "Degenerate",
                &grouped(u64::from(topology.degenerate)),
                "Triangles left out: two corners on one point.",
            );
            fact(
                ui,
                "Points",
                &grouped(topology.points.len() as u64),
                "Positions, welded where they are exactly equal.",
            );
            fact(ui, "Corners", &grouped(mesh.corners.len() as u64), "Distinct position, normal and uv.");
            fact(ui, "Materials", &grouped(mesh.materials.len() as u64), "Base colours and textures.");
            for (axis, length) in [("Size x", size.x), ("Size y", size.y), ("Size z", size.z)] {
                fact(ui, axis, &format!("{} units", short(f64::from(length))), "Extent of the mesh, in object units.");
            }
            fact(ui, "Loading", &format!("{} ms", short(document.loaded.load_ms)), "Reading the file.");
            fact(
                ui,
                "Topology",
                &format!("{} ms", short(document.loaded.topology_ms)),
                "Welding points and finding edges.",
            );
        });
        for warning in &mesh.warnings {
            let text = RichText::new(warning).color(ui.visuals().warn_fg_color);
            ui.add(egui::Label::new(text).truncate()).on_hover_text(warning);
        }
    }

    fn pass_times(&self, ui: &mut egui::Ui) {
        if self.viewport.times.is_empty() {
            return;
        }
        heading(ui, "Passes");
        egui::Grid::new("passes").num_columns(2).min_col_width(104.0).show(ui, |ui| {
            for time in &self.viewport.times {
                fact(ui, time.pass, &format!("{:.3} ms", time.ms), "The GPU's own time for the last run of this pass.");
            }
        });
    }

    pub(super) fn status_line(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            ui.set_min_height(22.0);
            let Some(document) = &self.document else {
                ui.weak("nothing is open");
                return;
            };
            let scene = &document.scene;
            let totals = scene.tessellator.is_counted().then(|| scene.tessellator.totals());
            let (vertices, triangles) = totals.map_or_else(
                || ("…".to_owned(), "…".to_owned()),
                |(vertices, triangles)| (grouped(vertices), grouped(triangles)),
            );
            let patches = document.loaded.topology.patches.len() as u64;
            let drawn = patches - u64::from(self.measuring.found().map_or(0, |found| found.patches_culled));
            let before = (document.loaded.mesh.triangles.len() as u64, document.loaded.mesh.corners.len() as u64);
            status(
                ui,
                120.0,
                format!("{} of {} patches", grouped(drawn), grouped(patches)),
                "Patches drawn, of all; the rest is clipped.",
            );
            status(
                ui,
                170.0,
                format!("{} to {} triangles", grouped(before.0), triangles),
                "Before and after tessellation.",
            );
            status(
                ui,
                160.0,
                format!("{} to {} vertices", grouped(before.1), vertices),
                "Before and after tessellation.",
            );
            self.status_of_cracks(ui);
            let bytes = scene.tessellator.buffers().bytes()
                + scene.tessellator.work_bytes()
                + scene.tessellator.arena_bytes()
                + self.viewport.bytes();
            status(ui, 76.0, mebibytes(bytes), "Memory on the device: topology, output and picture.");
            let (ms, hover) = self.times();
            status(ui, 112.0, ms, &hover);
            ui.weak(&self.engine.gpu.info.name).on_hover_text("Graphics adapter.");
        });
    }

    /// Tessellation and drawing, by the last run of each pass and the GPU's own clock; or else the last whole picture.
    fn times(&self) -> (String, String) {
        let times = &self.viewport.times;
        let Some(draw) = times.iter().find(|time| time.pass == "draw") else {
            let ms = self.viewport.picture_ms.map_or_else(|| "…".into(), |ms| format!("{ms:.1} ms"));
            let why = "From submitting the last picture to its completion; this adapter can't time single passes.";
            return (ms, why.into());
        };
        let all: f64 = times.iter().map(|time| time.ms).sum();
        let passes: Vec<_> = times.iter().map(|time| format!("{}: {:.3} ms", time.pass, time.ms)).collect();
        let hover =
            format!("Tessellation and drawing: each pass's last run, by the GPU's own clock.\n{}", passes.join("\n"));
        (format!("{:.2} + {:.2} ms", all - draw.ms, draw.ms), hover)
    }

    fn status_of_cracks(&self, ui: &mut egui::Ui) {
        let hover = "Edges whose sides put a point at different positions.";
        match self.measuring.cracks() {
            None => status(ui, 86.0, "cracks …", hover),
            Some(cracks) if cracks.edges.is_empty() => status(ui, 86.0, "cracks 0", hover),
            Some(cracks) => {
                let text = RichText::new(format!("cracks {}", grouped(cracks.edges.len() as u64)));
                let [r, g, b] = CRACK_COLOR;
                status(ui, 86.0, text.color(egui::Color32::from_rgb(r, g, b)).strong(), hover);
            }
        }
    }
}

fn heading(ui: &mut egui::Ui, text: &str) {
    ui.add_space(8.0);
    ui.label(RichText::new(text).strong());
    ui.separator();
}

/// A row with a name and a list to choose from.
fn chooser<T: Copy + PartialEq>(
    ui: &mut egui::Ui,
    name: &str,
    hover: &str,
    value: &mut T,
    choices: &[(T, &str, &str)],
) {
    let label = ui.label(name);
    let shown = choices.iter().find(|(choice, ..)| choice == value).map_or("", |(_, text, _)| text);
    let combo = egui::ComboBox::from_id_salt(name).selected_text(shown).show_ui(ui, |ui| {
        for (choice, text, hover) in choices {
            ui.selectable_value(value, *choice, *text).on_hover_text(*hover);
        }
    });
    combo.response.labelled_by(label.id).on_hover_text(hover);
    ui.end_row();
}

/// A row with a name and a right-aligned number.
fn fact(ui: &mut egui::Ui, name: &str, value: &str, hover: &str) {
    ui.label(name).on_hover_text(hover);
    number(ui, value);
    ui.end_row();
}

fn number(ui: &mut egui::Ui, text: &str) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.label(RichText::new(text).monospace()));
}

fn swatch(ui: &mut egui::Ui, [r, g, b]: [u8; 3]) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(14.0, 10.0), egui::Sense::hover());
    ui.painter().rect_filled(rect, 2.0, egui::Color32::from_rgb(r, g, b));
}

/// A field of the status line, of one width whatever it says.
fn status(ui: &mut egui::Ui, width: f32, text: impl Into<egui::WidgetText>, hover: &str) {
    let height = ui.spacing().interact_size.y;
    ui.allocate_ui_with_layout(egui::vec2(width, height), egui::Layout::left_to_right(egui::Align::Center), |ui| {
        ui.set_min_width(width);
        ui.label(text).on_hover_text(hover);
    });
    ui.separator();
}
