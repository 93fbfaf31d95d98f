//! What the mesh should have been: which truth it is held against, its loading, and how far off the picture is.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use egui::RichText;
use glam::Vec3;

use super::App;
use super::deviating::{Found, Of};
use super::legend::Distances;
use super::text::{grouped, short, shortened};
use super::widgets::{fact, heading, swatch};
use crate::measure::{MOST_TRIANGLES, Yardstick};
use crate::mesh::{LoadError, Progress, Source};
use crate::render::layout::WORST_COLOR;
use crate::render::{DEVIATION_PX_SCALE, LineSegment, project, worst_lines};
use crate::settings::{Colors, DeviationUnit, Settings};
use crate::tessellate::{Clip, Displacement, Inputs, Lod};
use crate::truth::Truth;

/// A truth that was chosen for the mesh.
pub struct Chosen {
    pub source: Source,
    truth: Arc<Truth>,
    /// Tells one from the next; never 0 or 1.
    generation: u64,
}

/// A truth under way; dropping it cancels it.
pub struct TruthLoad {
    pub source: Source,
    pub progress: Progress,
    done: Receiver<Result<Chosen, Option<String>>>,
}

impl TruthLoad {
    /// Loads on a thread of its own.
    fn start(context: &egui::Context, source: Source) -> Self {
        static GENERATION: std::sync::atomic::AtomicU64 = std::sync::atomic::AtomicU64::new(2);
        let generation = GENERATION.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let (sender, done) = channel();
        let progress = Progress::new();
        let (wanted, own_progress, context) = (source.clone(), progress.clone(), context.clone());
        std::thread::spawn(move || {
            let result = match Truth::load(&wanted, &own_progress) {
                Ok(Some(truth)) => Ok(Chosen { source: wanted, truth: Arc::new(truth), generation }),
                Ok(None) => Err(Some(format!("{wanted} can't be a truth: it has no triangles"))),
                Err(LoadError::Cancelled(_)) => Err(None),
                Err(error) => Err(Some(error.to_string())),
            };
            // Nobody is waiting any more if the load was replaced.
            let _ = sender.send(result);
            context.request_repaint();
        });
        Self { source, progress, done }
    }
}

impl Drop for TruthLoad {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

impl App {
    /// Starts to load what the mesh should have been beside the window; what it was held against before stays until then.
    pub fn open_truth(&mut self, context: &egui::Context, source: Source) {
        self.truth_load = Some(TruthLoad::start(context, source));
    }

    /// The truth that was chosen for what is shown.
    pub fn truth(&self) -> Option<&Source> {
        self.truth.as_ref().map(|chosen| &chosen.source)
    }

    /// Goes back to what the mesh is held against by itself.
    pub(super) fn forget_truth(&mut self) {
        self.truth = None;
        self.truth_load = None;
    }

    pub(super) fn take_truth(&mut self) {
        let Some(load) = &self.truth_load else { return };
        let result = match load.done.try_recv() {
            Err(TryRecvError::Empty) => return,
            Ok(result) => result,
            Err(TryRecvError::Disconnected) => {
                let title = load.source.title();
                Err(Some(format!("{title}: loading it stopped unexpectedly; the file may be damaged")))
            }
        };
        self.truth_load = None;
        match result {
            Ok(chosen) => {
                self.truth = Some(chosen);
                self.settings.overlays.colors = Colors::Deviation;
            }
            Err(Some(error)) => self.error = Some(error),
            // Cancelled by the person in front of the window, who knows.
            Err(None) => {}
        }
    }

    /// What is measured from, and what it is called. In a pose and displaced a mesh is none that a truth at rest knows of.
    pub(super) fn yardstick(&self) -> (u64, Option<Arc<Truth>>, String) {
        let limit = || (0, None, "its own limit".to_owned());
        let Some(document) = self.document.as_ref().filter(|_| self.playback.moment().is_none()) else {
            return limit();
        };
        if let Some(chosen) = &self.truth {
            return (chosen.generation, Some(chosen.truth.clone()), chosen.source.title());
        }
        let is_plain = self.settings.displacement == Displacement::Off;
        match (&document.exact, document.loaded.source.shape()) {
            (Some(exact), Some(shape)) if is_plain => {
                (1, Some(exact.clone()), format!("exact {}", shape.title().to_lowercase()))
            }
            _ => limit(),
        }
    }

    fn deviation_of(&self) -> Option<Of> {
        let document = self.document.as_ref()?;
        let tessellation = document.scene.tessellator.generation();
        Some(Of { document: document.generation, tessellation, truth: self.yardstick().0 })
    }

    /// Counts the results that the picture shows; 0 without the overlay.
    pub(super) fn deviation_shown(&self) -> u64 {
        if self.settings.overlays.colors == Colors::Deviation { self.deviating.generation } else { 0 }
    }

    /// How far what is shown is from the truth, once that is known.
    pub fn deviation(&self) -> Option<f64> {
        Some(self.known_deviation()?.worst?.value)
    }

    fn known_deviation(&self) -> Option<&Found> {
        self.deviating.found_of(self.deviation_of()?)
    }

    /// Lets measuring go on, if the overlay is on and nothing is under way that it would disturb.
    pub(super) fn deviate(&mut self, inputs: &Inputs) -> Result<(), crate::gpu::GpuError> {
        let is_wanted = self.settings.overlays.colors == Colors::Deviation;
        if !is_wanted || self.playback.is_playing() {
            self.deviating.stop();
            return Ok(());
        }
        let free = self.viewport.is_free() && self.viewport.cancelled.is_none();
        let (Some(of), (_, truth, _)) = (self.deviation_of().filter(|_| free), self.yardstick()) else { return Ok(()) };
        let Some(document) = self.document.as_mut() else { return Ok(()) };
        if document.moment != self.playback.moment() || !document.scene.tessellator.is_counted() {
            return Ok(());
        }
        let yardstick = || truth.map_or_else(|| Yardstick::Limit(Box::new(*inputs)), Yardstick::Truth);
        self.deviating.go_on(&self.engine.gpu, &mut document.scene, of, yardstick)
    }

    /// The mark on the place that is farthest from the truth.
    pub(super) fn worst_mark(&self) -> Vec<LineSegment> {
        let shown = self.known_deviation().filter(|_| self.settings.overlays.colors == Colors::Deviation);
        let worst = shown.and_then(|found| found.worst);
        worst.map_or_else(Vec::new, |worst| worst_lines(worst.emitted.as_vec3(), worst.truth.as_vec3()))
    }

    /// What the legend says of distances.
    pub(super) fn legend_distances(&self) -> Distances {
        let found = self.deviating.found();
        let unit = self.settings.deviation_in;
        let scale = match unit {
            DeviationUnit::Units => found.map(|found| found.scale),
            DeviationUnit::Px => Some(DEVIATION_PX_SCALE),
        };
        let is_partial = self.known_deviation().is_some_and(|found| found.left_out > 0);
        Distances { unit, scale, is_partial, measured: self.deviating.fraction() }
    }

    /// What the mesh is held against, and how far off the picture is; while that is shown.
    pub(super) fn deviation_section(&mut self, ui: &mut egui::Ui) {
        if self.settings.overlays.colors != Colors::Deviation {
            return;
        }
        heading(ui, "Deviation");
        let name = self.yardstick().2;
        let found = self.known_deviation();
        // Until it is measured the rows keep their places.
        let units = |number: &dyn Fn(&Found) -> f64| {
            found.map_or_else(|| "… units".into(), |found| format!("{} units", short(number(found))))
        };
        let largest = units(&|found| found.worst.map_or(0.0, |worst| worst.value));
        let (rms, px) = (units(&|found| found.rms), found.and_then(|found| self.deviation_px(found)));
        let left_out = found.map_or(0, |found| found.left_out);
        let worst = found.and_then(|found| found.worst);
        let mut clicked = false;
        egui::Grid::new("deviation").num_columns(2).min_col_width(104.0).show(ui, |ui| {
            let hover = "What the mesh should have been: the surface that a shape is sampled from, a file chosen under File, or \
                         else the surface that the tessellation converges to.";
            fact(ui, "Truth", &shortened(&name, 20), hover);
            fact(ui, "Largest", &largest, "The largest distance from what is shown to the truth, in object units.");
            let px = px.map_or_else(|| "… px".into(), |px| format!("{} px", short(px)));
            fact(ui, "", &px, "On screen, between the worst point and the truth's point nearest to it.");
            fact(ui, "RMS", &rms, "Root mean square of the distance over the area that is shown, in object units.");
            ui.horizontal(|ui| {
                swatch(ui, WORST_COLOR);
                ui.label("Worst point").on_hover_text("Where the distance is largest. A click frames it.");
            });
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let text = worst.map_or_else(|| "…".into(), |worst| format!("in patch {}", worst.patch));
                let button = egui::Button::selectable(false, RichText::new(&text).monospace());
                let response = ui.add_enabled(worst.is_some(), button);
                response.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::Button, worst.is_some(), format!("Worst point {text}"))
                });
                clicked = response
                    .on_hover_text("Turns the camera to it. LOD and clipping stay as they are, so that it stays the worst.")
                    .clicked();
            });
            ui.end_row();
        });
        if left_out > 0 {
            let text = format!(
                "Only the first {} triangles are measured; {} have no colour.",
                grouped(MOST_TRIANGLES),
                grouped(left_out)
            );
            ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
        }
        if clicked {
            self.frame_worst();
        }
    }

    /// The largest distance in px, seen as the last picture was.
    fn deviation_px(&self, found: &Found) -> Option<f64> {
        let (worst, view) = (found.worst?, self.viewport.seen_from()?);
        let at = |place: glam::DVec3| project(view.clip_from_object, view.viewport, place.as_vec3());
        Some(f64::from(at(worst.emitted)?.distance(at(worst.truth)?)))
    }

    /// Turns the camera so that the worst point is in the middle, seen from where its patch faces.
    fn frame_worst(&mut self) {
        let Some(worst) = self.known_deviation().and_then(|found| found.worst) else { return };
        let Some(document) = &self.document else { return };
        let (mesh, topology) = document.shown();
        let Some(patch) = topology.patches.get(worst.patch as usize) else { return };
        // Tessellated for the new view it would be another mesh, with another worst point.
        if self.frozen.is_none() && follows_view(&self.settings) {
            self.frozen = self.viewport.shown_view();
        }
        let corners: [Vec3; 3] = patch.corners.map(|corner| mesh.corners[corner as usize].position);
        self.camera.frame_triangle(corners, &document.scene.bounds);
        self.camera.target = worst.emitted.as_vec3();
    }
}

/// Whether what is emitted depends on where one looks from.
fn follows_view(settings: &Settings) -> bool {
    settings.used_lod() != Lod::Uniform || settings.clip != Clip::Off || settings.cull_back_faces
}
