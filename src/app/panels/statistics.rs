//! The panel on the right: statistics of the tessellation and the mesh.

use crate::app::App;
use crate::app::sections::{Section, scrolling_column};
use crate::app::text::{grouped, part, short};
use crate::app::widgets::{fact, marked, number};
use geometry::mesh::EdgeKind;
use geometry::view::ulp;
use inspect::measure::{Measured, SeamTurns};
use inspect::render::layout::{CRACK_COLOR, FOLD_COLOR, WASTE_COLOR, edge_color};
use inspect::settings::Choice;

/// The least width of the rows, in points: less than a panel of the usual width has.
const LEAST_WIDTH: f32 = 276.0;

impl App {
    pub(in crate::app) fn facts_panel(&mut self, ui: &mut egui::Ui) {
        self.legend_panel(ui);
        scrolling_column(ui, LEAST_WIDTH, |ui| {
            // Each in a scope of its own, so that rows that come and go don't take the focus from those below.
            ui.push_id("verdict", |ui| self.verdict(ui));
            let top = ui.cursor().top();
            if self.panels.open.title(ui, Section::Patch) {
                ui.push_id("patch", |ui| self.patch_section(ui));
            }
            let pushed = self.pushed_down(ui, top);
            ui.push_id("halves", |ui| self.halves_section(ui));
            ui.push_id("given", |ui| self.given_section(ui));
            self.deviation_section(ui);
            self.section(ui, Section::Cracks, |app, ui| app.crack_facts(ui));
            if self.panels.open.has(Section::Cracks) {
                self.worst_edges(ui);
                self.leak_list(ui);
                self.fold_list(ui);
                self.t_junction_list(ui);
            }
            self.edge_details(ui);
            self.section(ui, Section::Patches, |app, ui| app.patch_facts(ui));
            self.section(ui, Section::Waste, |app, ui| app.waste_facts(ui));
            self.section(ui, Section::Edges, |app, ui| app.edge_facts(ui));
            self.section(ui, Section::Mesh, |app, ui| app.mesh_facts(ui));
            if !self.viewport.picture.times.is_empty() {
                self.section(ui, Section::Passes, |app, ui| app.pass_times(ui));
            }
            // Only now, since lists would take it for theirs.
            if pushed != 0.0 {
                ui.scroll_with_delta_animation(egui::vec2(0.0, -pushed), egui::style::ScrollAnimation::none());
            }
        });
    }

    fn edge_facts(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let edges = &document.edges;
        let counts = [edges.smooth, edges.split, edges.seam, edges.boundary, edges.non_manifold];
        for (kind, count) in EdgeKind::ALL.into_iter().zip(counts) {
            marked_fact(ui, edge_color(kind), kind.label(), &grouped(count as u64), kind.text());
        }
        self.seam_facts(ui);
    }

    /// How far shading normals turn at seams. Until that is measured, the rows show ellipses.
    fn seam_facts(&self, ui: &mut egui::Ui) {
        let seams = self.results().map(|results| results.found.seams.shading);
        let angle = |of: fn(&SeamTurns) -> f64| match seams {
            None => "…".to_owned(),
            Some(seams) if seams.edges > 0 => format!("{:.2}°", of(&seams)),
            Some(_) => "-".to_owned(),
        };
        let hover = "The largest angle between the shading normals of the two sides of an edge with split normals or a uv seam.";
        fact(ui, "Angle at seams", &angle(|seams| seams.emitted.most), hover);
        let hover = "The largest such angle between the mesh's own normals.";
        fact(ui, "of the mesh", &angle(|seams| seams.source.most), hover);
        let hover = "The most by which tessellation makes the angle at a point larger than the mesh has it there, right to \
                     about 0.01°.";
        fact(ui, "added", &angle(|seams| seams.most_added), hover);
    }

    fn crack_facts(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        // Until they are measured, the rows show ellipses.
        let results = self.results();
        let found = results.map(|results| &results.found);
        let count = |number: fn(&Measured) -> u64| found.map_or_else(|| "…".into(), |found| grouped(number(found)));
        let gap = |size: Option<f64>, unit: &str| format!("{} {unit}", size.map_or_else(|| "…".into(), short));
        let widest = found.map(|found| found.cracks.max_gap());
        let ulp = ulp(&document.loaded.topology);
        let hover = "Points of edges with several sides, counted once for each side after the first.";
        fact(ui, "Points compared", &count(|found| found.cracks.edge_points), hover);
        let hover = "Points that differ in at least one bit from the first side's.";
        fact(ui, "Different", &count(|found| found.cracks.different_bits), hover);
        let hover = "Edges whose sides were given factors that differ in at least one bit.";
        fact(ui, "Factors differ", &count(|found| found.cracks.different_factors), hover);
        let hover = "Points whose normals differ in at least one bit although the normals in the file agree.";
        fact(ui, "Normals differ", &count(|found| found.cracks.different_normals), hover);
        let hover = "Edges with a point that differs. The overlay Cracks shows them.";
        let cracked = count(|found| found.cracks.cracked().len() as u64);
        marked_fact(ui, CRACK_COLOR, "Cracked edges", &cracked, hover);
        let hover = "The largest distance between two sides' positions of one point, in object units.";
        fact(ui, "Largest gap", &gap(widest, "units"), hover);
        let hover = "The same in ULP of the mesh's largest coordinate.";
        fact(ui, "", &gap(widest.map(|gap| gap / ulp), "ULP"), hover);
        let hover = "The gap that is the widest as the camera of LOD sees it.";
        fact(ui, "", &gap(results.map(|results| results.widest_crack.map_or(0.0, |(_, px)| px)), "px"), hover);
        let hover = "Triangles that face away from the side that their patch faces.";
        marked_fact(ui, FOLD_COLOR, "Folds", &count(|found| found.folds), hover);
    }

    /// By how much the section of the patch, which begins at `top`, pushes down what the pointer is over, in points: the panel is
    /// scrolled as far, so that it stays there. 0 if the pointer is elsewhere.
    fn pushed_down(&mut self, ui: &egui::Ui, top: f32) -> f32 {
        let height = ui.cursor().top() - top;
        let before = std::mem::replace(&mut self.panels.patch_height, height);
        let pointer = ui.ctx().pointer_latest_pos();
        let is_below = pointer.is_some_and(|at| ui.clip_rect().contains(at) && at.y > top + before);
        if is_below { height - before } else { 0.0 }
    }

    fn patch_facts(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let all = document.loaded.topology.patches.len() as u64;
        let found = self.results().map(|results| &results.found);
        let count =
            |number: &dyn Fn(&Measured) -> u64| found.map_or_else(|| "…".into(), |found| grouped(number(found)));
        let drawn = count(&|found| all - u64::from(found.culled.total()));
        fact(ui, "Drawn", &drawn, "Patches that emit triangles.");
        let hover = "Patches that clipping leaves out, because the LOD camera can't see them.";
        fact(ui, "Out of view", &count(&|found| found.culled.out_of_view.into()), hover);
        let hover = "Patches that are left out because the LOD camera sees only their backs.";
        fact(ui, "Facing away", &count(&|found| found.culled.facing_away.into()), hover);
        let hover = "Patches with a factor at the tessellator's maximum: 127 under rows, else 63 or 64. They may need more \
                     segments, so LOD by error may miss its tolerance there.";
        fact(ui, "At maximum factor", &count(&|found| found.patches_at_limit.into()), hover);
    }

    /// What is tessellated too finely or needlessly.
    fn waste_facts(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let patches = document.loaded.topology.patches.len() as u64;
        let (results, unknown) = (self.results(), || "…".to_owned());
        let small = results.map_or_else(unknown, |results| part(results.sizes.small, results.sizes.in_view));
        let low = results.map_or_else(unknown, |results| part(results.found.patches_low.into(), patches));
        let hover = "Triangles in view with an area below 4.5 px², half of a square with sides of 3 px, and their share of all \
                     triangles in view.";
        marked_fact(ui, WASTE_COLOR, "Below 3 px", &small, hover);
        let hover = "Patches whose factors are all below 2, and their share of all patches. They could be drawn without \
                     tessellation.";
        marked_fact(ui, WASTE_COLOR, "Below factor 2", &low, hover);
    }

    fn mesh_facts(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let (mesh, topology) = (&document.loaded.mesh, &document.loaded.topology);
        let size = document.scene.bounds.max - document.scene.bounds.min;
        fact(ui, "Triangles", &grouped(mesh.triangles.len() as u64), "Triangles as loaded.");
        fact(ui, "Patches", &grouped(topology.patches.len() as u64), "Triangles that are tessellated.");
        let hover = "Triangles that are left out because two of their corners lie on one point.";
        fact(ui, "Degenerate", &grouped(u64::from(topology.degenerate)), hover);
        fact(ui, "Points", &grouped(topology.points.len() as u64), "Distinct positions, after welding.");
        let hover = "Distinct combinations of position, normal and uv.";
        fact(ui, "Corners", &grouped(mesh.corners.len() as u64), hover);
        self.normal_facts(ui);
        fact(ui, "Materials", &grouped(mesh.materials.len() as u64), "Base colours and textures.");
        let styles: Vec<String> = document.loaded.preparation.parts.style_texts().collect();
        if !styles.is_empty() {
            let hover = format!("What parts have in place of what is set for all (--part): {}.", styles.join("; "));
            fact(ui, "Styles of parts", &grouped(styles.len() as u64), &hover);
        }
        let hover = "Extent of the mesh in object units; over the whole clip, if one is chosen.";
        for (axis, length) in [("Size x", size.x), ("Size y", size.y), ("Size z", size.z)] {
            fact(ui, axis, &format!("{} units", short(f64::from(length))), hover);
        }
    }

    fn pass_times(&self, ui: &mut egui::Ui) {
        let hover = "The time of this pass's last run, by the GPU's clock.";
        for time in &self.viewport.picture.times {
            fact(ui, time.pass, &format!("{:.3} ms", time.ms), hover);
        }
    }

    /// Normals that are legal but suspicious.
    fn normal_facts(&self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let faults = document.checks.normal_faults.get();
        let count = |number: Option<u32>| number.map_or_else(|| "…".into(), |count| grouped(count.into()));
        let hover = "Corners whose normal points to the back of their triangle.";
        fact(ui, "Normals inward", &count(faults.map(|faults| faults.against_face)), hover);
        let hover = "Edges where the normals of two sides point in opposite directions.";
        fact(ui, "Normals opposite", &count(faults.map(|faults| faults.opposite)), hover);
        let hover = "Corners whose normal runs along one of their edges.";
        fact(ui, "Normals along edges", &count(faults.map(|faults| faults.along_edge)), hover);
    }
}

/// A row with the colour that marks it on the mesh.
fn marked_fact(ui: &mut egui::Ui, color: [u8; 3], name: &str, value: &str, hover: &str) {
    marked(ui, Some(color), name, hover);
    number(ui, value);
    ui.end_row();
}
