//! The deviation of what is shown: its measurement, its section in the panel, its marks and its colour scale.

use egui::RichText;

use crate::app::App;
use crate::app::jobs::deviation_job::{DeviationBasis, DeviationJob, DeviationResult};
use crate::app::jobs::measure_job::MeasureError;
use crate::app::panels::option_rows::option_row;
use crate::app::sections::Section;
use crate::app::text::{grouped, short, shortened};
use crate::app::widgets::{fact, marked, number};
use geometry::tessellate::Inputs;
use geometry::view::project;
use inspect::gates::{PatchSpot, Spot};
use inspect::measure::{DeviationTarget, MOST_TRIANGLES, WorstPoint};
use inspect::render::layout::WORST_COLOR;
use inspect::render::{Distances, Scale, deviation_scale};
use inspect::settings::{Choice, ColorSource, SplitSide, SurfaceUnit, options};

impl App {
    fn deviating(&self, half: SplitSide) -> Option<&DeviationJob> {
        Some(&self.document.as_ref()?.halves[half as usize].deviation)
    }

    fn deviation_of(&self, half: SplitSide) -> Option<DeviationBasis> {
        let document = self.document.as_ref().filter(|_| !self.lacks_reference())?;
        let tessellation = document.scene.half(half)?.tessellator.generation();
        let (reference_shape, limit) = (self.yardstick().0, self.settings.tessellation.surface);
        Some(DeviationBasis { tessellation, reference_shape, limit })
    }

    /// Whether there is nothing to compare with: the CPU doesn't know the limit surface of a shader.
    fn lacks_reference(&self) -> bool {
        self.uses_surface_shader() && self.yardstick().1.is_none()
    }

    /// Whether a half shows its deviation.
    pub(super) fn deviates(&self, half: SplitSide) -> bool {
        self.settings.half(half).is_some_and(|own| own.overlays.colors.source() == ColorSource::ReferenceSurface)
    }

    /// Counts changes of the deviation that the picture shows; 0 without the overlay.
    pub(in crate::app) fn deviation_shown(&self) -> u64 {
        let is_shown = self.settings.any_half_shows(ColorSource::ReferenceSurface);
        let jobs = SplitSide::BOTH.into_iter().filter_map(|half| self.deviating(half).filter(|_| is_shown));
        jobs.map(|job| job.generation).sum()
    }

    pub(in crate::app) fn known_deviation(&self, half: SplitSide) -> Option<&DeviationResult> {
        self.settings.half(half)?;
        let of = self.deviation_of(half)?;
        self.deviating(half)?.found.as_ref().filter(|found| found.of == of)
    }

    /// Goes on measuring if the overlay is on, no clip plays and no picture is under way. Without a reference surface both
    /// halves are compared with the limit surface of the right one, which has these inputs. The limit surface of a flat left
    /// half would be that half itself.
    pub(in crate::app) fn deviate(&mut self, inputs: &Inputs) -> Result<(), MeasureError> {
        if !self.settings.any_half_shows(ColorSource::ReferenceSurface) || self.viewport.playback.is_playing() {
            let halves = self.document.iter_mut().flat_map(|document| &mut document.halves);
            halves.for_each(|half| half.deviation.stop());
            return Ok(());
        }
        if !self.viewport.picture.is_free() || self.viewport.picture.cancelled.is_some() {
            return Ok(());
        }
        for half in SplitSide::BOTH {
            let (of, reference_shape) = (self.deviation_of(half).filter(|_| self.deviates(half)), self.yardstick().1);
            let Some(document) = self.document.as_mut() else { continue };
            let Some(of) = of else {
                document.halves[half as usize].deviation.stop();
                continue;
            };
            let is_posed = document.moment == self.viewport.playback.moment();
            let scene = document.scene.half_mut(half).filter(|scene| is_posed && scene.tessellator.is_counted());
            let Some(scene) = scene else { continue };
            let limit = || DeviationTarget::Limit(Box::new(*inputs));
            let target = || reference_shape.map_or_else(limit, DeviationTarget::ReferenceShape);
            document.halves[half as usize].deviation.go_on(&self.engine.gpu, scene, of, target)?;
        }
        let (Some(scale), Some(document)) = (self.deviation_scale(), self.document.as_mut()) else { return Ok(()) };
        for half in SplitSide::BOTH {
            if let Some(scene) = document.scene.half_mut(half) {
                scene.scale_deviation(scale);
            }
        }
        Ok(())
    }

    /// The colour scale in object units, for the larger of the halves' last known deviations.
    fn deviation_scale(&self) -> Option<Scale> {
        let scene = &self.document.as_ref()?.scene;
        let shown = SplitSide::BOTH.into_iter().filter(|half| self.deviates(*half));
        let largest = shown.filter_map(|half| Some(self.deviating(half)?.found.as_ref()?.largest.at_least));
        Some(deviation_scale(largest.reduce(f64::max)?, scene.ulp))
    }

    /// The point of a half that is farthest from the reference surface, if it is marked.
    pub(in crate::app) fn marked_worst(&self, half: SplitSide) -> Option<WorstPoint> {
        self.known_deviation(half).filter(|_| self.deviates(half))?.worst
    }

    /// The number of the result that each half's mark shows; 0 for no mark.
    pub(in crate::app) fn worst_marked(&self) -> [u64; 2] {
        let marked = |half| self.marked_worst(half).and(self.deviating(half));
        SplitSide::BOTH.map(|half| marked(half).map_or(0, |job| job.generation))
    }

    pub(in crate::app) fn legend_distances(&self) -> Distances {
        let mut known = SplitSide::BOTH.into_iter().filter_map(|half| self.known_deviation(half));
        let is_partial = known.any(|found| found.left_out > 0);
        let measured = SplitSide::BOTH.into_iter().filter_map(|half| self.deviating(half)?.fraction()).reduce(f32::min);
        let outlines = self.found_outlines().map(|found| found.silhouette.distances);
        Distances { scale: self.deviation_scale(), is_partial, measured, outlines }
    }

    /// The largest distance of a half, in the overlay's unit; none without the overlay. Until it is known, it is an ellipsis.
    pub(in crate::app) fn largest_text(&self, half: SplitSide) -> Option<String> {
        let settings = self.settings.half(half).filter(|_| self.deviates(half))?;
        let (number, unit) = match settings.deviation_in {
            SurfaceUnit::Units => (self.known_deviation(half).map(|found| found.largest.at_least), "units"),
            SurfaceUnit::Px => (self.deviation_px(half), "px"),
        };
        Some(format!("{} {unit}", number.map_or_else(|| "…".into(), short)))
    }

    /// The section about deviation: the reference surface and the distances. It is shown with the overlay.
    pub(in crate::app) fn deviation_section(&mut self, ui: &mut egui::Ui) {
        if !self.settings.any_half_shows(ColorSource::ReferenceSurface)
            || !self.panels.open.title(ui, Section::Deviation)
        {
            return;
        }
        if self.lacks_reference() {
            let text = "Nothing is measured: the CPU doesn't know the surface of a shader. Choose a reference surface under File.";
            return drop(ui.add(egui::Label::new(text).wrap()));
        }
        let (reference_shape, mut name) = (self.yardstick().1, self.yardstick().2);
        let is_split = self.settings.half(SplitSide::Left).is_some();
        if is_split && reference_shape.is_none() {
            name = format!("limit of {}", self.settings.tessellation.surface.label());
        }
        let mut clicked = None;
        egui::Grid::new("deviation").num_columns(2).min_col_width(104.0).show(ui, |ui| {
            let hover = "The surface that distances are measured to: the exact surface of a shape made in code, a file or the \
                         limit of the mesh's own cage, chosen under File, or else the surface that the tessellation \
                         converges to.";
            fact(ui, "Reference", &shortened(&name, 20), hover);
            if let Some(step) = reference_shape.as_ref().and_then(|own| own.step) {
                let hover = "How far the last refinement of the reference surface's cage moved it at most, in object units. \
                             About a third of that is missing to the limit surface.";
                fact(ui, "Last refinement", &format!("{} units", short(step)), hover);
            }
            option_row(ui, &options::DEVIATION_IN, &mut self.settings, "");
            for half in SplitSide::BOTH.into_iter().filter(|half| self.deviates(*half)) {
                let surface = self.surface_title(half);
                let place = if half == SplitSide::Left { "Left" } else { "Right" };
                if is_split {
                    let hover = "The surface in this half of the split view.";
                    ui.label(RichText::new(place).strong()).on_hover_text(hover);
                    number(ui, &surface);
                    ui.end_row();
                }
                if self.deviation_rows(ui, half, if is_split { place } else { "" }) {
                    clicked = Some(half);
                }
            }
        });
        let known = SplitSide::BOTH.into_iter().filter_map(|half| self.known_deviation(half));
        let left_out: u64 = known.map(|found| found.left_out).sum();
        if left_out > 0 {
            let most = grouped(MOST_TRIANGLES);
            let text = format!("Only the first {most} triangles are measured; {} have no colour.", grouped(left_out));
            ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
        }
        let worst = clicked.and_then(|half| Some((half, self.known_deviation(half)?.worst?)));
        if let Some(((half, worst), document)) = worst.zip(self.document.as_ref()) {
            let corners = document.patch_positions(half, worst.patch);
            self.show_place(half, &Spot::Patch(PatchSpot::new(corners, worst.emitted.as_vec3())), None);
        }
    }

    /// Rows with a half's distances, or ellipses until they are measured. Returns true if the worst point was clicked.
    fn deviation_rows(&self, ui: &mut egui::Ui, half: SplitSide, place: &str) -> bool {
        let found = self.known_deviation(half);
        let text = |number: Option<f64>, unit| format!("{} {unit}", number.map_or_else(|| "…".into(), short));
        let hover = "The largest distance that was found between the emitted triangles and the reference surface, in object units.";
        fact(ui, "Largest", &text(found.map(|found| found.largest.at_least), "units"), hover);
        let hover = "No emitted point is farther from the reference surface, for certain. Distances to a limit surface are \
                     sampled, so that none is known.";
        match found.map(|found| found.largest.at_most) {
            Some(unknown) if unknown.is_infinite() => fact(ui, "At most", "unknown", hover),
            at_most => fact(ui, "At most", &text(at_most, "units"), hover),
        }
        let hover =
            "The distance on screen between the worst point and the nearest point of the reference surface, in px.";
        fact(ui, "", &text(self.deviation_px(half), "px"), hover);
        let hover = "Root mean square of the distance over the area that is shown, in object units.";
        fact(ui, "RMS", &text(found.map(|found| found.rms), "units"), hover);
        marked(ui, Some(WORST_COLOR), "Worst point", "The point where the distance is largest. A click frames it.");
        let worst = found.and_then(|found| found.worst);
        let column = ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let text = worst.map_or_else(|| "…".into(), |worst| format!("in patch {}", worst.patch));
            let button = egui::Button::selectable(false, RichText::new(&text).monospace());
            let response = ui.add_enabled(worst.is_some(), button);
            let name = format!("{place} Worst point {text}");
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, worst.is_some(), name.trim_start()));
            let hover =
                "Turns the camera to this point. LOD and clipping stay frozen, so that it remains the worst point.";
            response.on_hover_text(hover).clicked()
        });
        ui.end_row();
        column.inner
    }

    /// The largest distance of a half in px, in the view of the last picture.
    fn deviation_px(&self, half: SplitSide) -> Option<f64> {
        let (worst, view) = (self.known_deviation(half)?.worst?, self.viewport.picture.seen_from()?);
        let at = |place: glam::DVec3| project(view.clip_from_object, view.viewport, place.as_vec3());
        Some(f64::from(at(worst.emitted)?.distance(at(worst.reference_shape)?)))
    }
}
