//! The status line below: patches, triangles, cracks, memory and time; or for a while what was written or stopped.

use egui::RichText;

use crate::app::App;
use crate::app::jobs::measure_job::MeasureJob;
use crate::app::text::{counted, grouped, mebibytes, short};
use crate::app::widgets::{legible, rgb, status, text_width};
use crate::commands::{Action, key_name};
use geometry::tessellate::{largest_patch, point_count, triangle_count};
use gpu::ms_of;
use inspect::render::layout::CRACK_COLOR;

impl App {
    pub(in crate::app) fn status_line(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            ui.set_min_height(22.0);
            if let Some(said) = self.said(ui.ctx()) {
                ui.add(egui::Label::new(&said).truncate()).on_hover_text(&said);
                return;
            }
            let Some(document) = &self.document else {
                let text = if self.jobs.load().is_some() { "" } else { "nothing is open" };
                ui.weak(text);
                return;
            };
            let scene = &document.scene;
            // All numbers are of one picture: the last one that was measured, or else the present one.
            let results = self.results();
            let is_known = scene.tessellator.is_counted() || self.is_playing() || self.shows_preview();
            let totals = results.map(|results| results.totals).or(self.totals().filter(|_| is_known));
            let (vertices, triangles) = totals.map_or_else(
                || ("…".to_owned(), "… triangles".to_owned()),
                |(vertices, triangles)| (grouped(vertices), counted(triangles, "triangle")),
            );
            let patches = document.loaded.topology.patches.len() as u64;
            let drawn = results.map(|results| grouped(patches - u64::from(results.found.culled.total())));
            let drawn = drawn.unwrap_or_else(|| "…".to_owned());
            let before = (document.loaded.mesh.triangles.len() as u64, document.loaded.mesh.corners.len() as u64);
            // A field has the width of the largest numbers that this mesh can have.
            let widest = |ui: &egui::Ui, text: String| text_width(ui, &text).max(120.0);
            let most = grouped(patches * u64::from(triangle_count(largest_patch())));
            let width = widest(ui, format!("{} to {most} triangles", grouped(before.0)));
            let hover = "Triangles before and after tessellation.";
            status(ui, width, format!("{} to {triangles}", grouped(before.0)), hover);
            self.status_of_cracks(ui);
            let width = widest(ui, format!("{0} of {0} patches", grouped(patches)));
            let hover =
                "Patches that are drawn, out of all, counted while the picture rests. The others are out of view or face away.";
            status(ui, width, format!("{drawn} of {} patches", grouped(patches)), hover);
            let most = grouped(patches * u64::from(point_count(largest_patch())));
            let width = widest(ui, format!("{} to {most} vertices", grouped(before.1)));
            let hover = "Vertices before and after tessellation.";
            status(ui, width, format!("{} to {vertices} vertices", grouped(before.1)), hover);
            let memory = mebibytes(document.bytes() + self.viewport.picture.bytes());
            status(ui, 76.0, memory, "Memory on the device: topology, output and picture.");
            let (ms, hover) = self.times();
            status(ui, 112.0, ms, &hover);
            self.thaw_button(ui);
            let adapter = &self.engine.gpu.info.name;
            // A few letters of its name would say nothing.
            if ui.available_width() > 0.5 * text_width(ui, adapter) {
                ui.add(egui::Label::new(RichText::new(adapter).weak()).truncate())
                    .on_hover_text(format!("Graphics adapter: {adapter}."));
            }
        });
    }

    /// Says that LOD is frozen, and thaws it.
    fn thaw_button(&mut self, ui: &mut egui::Ui) {
        if self.viewport.frozen.is_some() {
            let text = format!("LOD is frozen: thaw it ({})", key_name(&Action::FreezeLodCamera));
            let hover = "LOD and clipping stay as they are for the camera that froze them, and so do all numbers. Thawed, they \
                         follow the camera again.";
            if ui.small_button(text).on_hover_text(hover).clicked() {
                self.viewport.frozen = None;
            }
        }
    }

    /// The times of tessellation and drawing by the GPU's clock, or of the last whole picture, and their hover text.
    fn times(&self) -> (String, String) {
        let times = &self.viewport.picture.times;
        if !(self.viewport.picture.pass_times_hold && times.iter().any(|time| time.pass == "draw")) {
            let ms = self.viewport.picture.picture_ms.map_or_else(|| "…".into(), |ms| format!("{ms:.1} ms"));
            let why = "The time from submitting the last picture to its completion. Passes aren't timed one by one, because \
                       this adapter can't do that or the picture was drawn in several steps.";
            return (ms, why.into());
        }
        let [tessellation, draw] = [false, true].map(|are_drawing| ms_of(times, are_drawing));
        let passes: Vec<_> = times.iter().map(|time| format!("{}: {:.3} ms", time.pass, time.ms)).collect();
        let hover =
            format!("Tessellation and drawing: each pass's last run, by the GPU's clock.\n{}", passes.join("\n"));
        (format!("{:.2} + {:.2} ms", tessellation, draw), hover)
    }

    fn status_of_cracks(&self, ui: &mut egui::Ui) {
        const WIDTH: f32 = 150.0;
        let hover =
            "The number of edges whose sides differ in a position, and the widest gap as the camera of LOD sees it.";
        match self.results().map(|results| (results.found.cracks.cracked().len(), results.widest_crack)) {
            None => {
                let measure = self.document.as_ref().map(|document| &document.right().measure);
                let text = match measure.and_then(MeasureJob::fraction) {
                    _ if self.is_playing() => "cracks: pause to measure".into(),
                    Some(part) => format!("cracks … {:.0} %", 100.0 * part),
                    _ if self.is_busy() => "cracks …".into(),
                    _ => "cracks not measured".into(),
                };
                status(ui, WIDTH, text, hover);
            }
            Some((_, None)) => status(ui, WIDTH, "cracks 0", hover),
            Some((count, Some((_, px)))) => {
                let text = RichText::new(format!("cracks {}, {} px", grouped(count as u64), short(px)));
                status(ui, WIDTH, text.color(legible(ui, rgb(CRACK_COLOR))).strong(), hover);
            }
        }
    }
}
