//! Compares the outlines of what is shown.

use egui::TextureHandle;
use image::RgbaImage;

use super::background_job::BackgroundJob;
use super::drawn_measurement::DrawnMeasurement;
use super::measure_job::MeasureError;
use crate::app::App;
use geometry::tessellate::Tessellation;
use geometry::view::ScreenView;
use gpu::{GpuError, Readback, Tessellator};
use inspect::engine::silhouette::sibling;
use inspect::engine::{Engine, SilhouetteDrawing, SilhouetteView};
use inspect::measure::{SampleGrid, Silhouette};
use inspect::render::{Scene, outlines_picture};
use inspect::settings::ColorSource;

/// The comparison of outlines, and its last result.
pub(crate) type SilhouetteJob = DrawnMeasurement<OutlineDrawing, MeasuredOutlines>;

/// What draws outlines: a tessellator, which is made once and kept for the next comparison.
#[derive(Default)]
pub(crate) struct OutlineDrawing {
    making: Option<BackgroundJob<Result<Tessellator, GpuError>>>,
    /// None while it is being made, and while it draws.
    tessellator: Option<Tessellator>,
    drawing: Option<Box<SilhouetteDrawing>>,
}

pub(crate) struct MeasuredOutlines {
    pub silhouette: Silhouette,
    pub picture: RgbaImage,
    /// The picture, which lies over that of the view.
    pub texture: TextureHandle,
}

impl OutlineDrawing {
    /// Goes on by a step: makes the tessellator, starts to draw with it, or draws. Returns what was drawn after the last one.
    fn step(
        &mut self,
        context: &egui::Context,
        engine: &Engine,
        scene: &Scene,
        tessellation: &Tessellation,
        view: &SilhouetteView,
    ) -> Result<Option<Readback>, MeasureError> {
        if let Some(drawing) = &mut self.drawing {
            let texels = drawing.step(&engine.gpu)?;
            if texels.is_some() {
                self.tessellator = self.drawing.take().map(|drawing| drawing.tessellator);
            }
            return Ok(texels);
        }
        let tessellator = match self.tessellator.take() {
            Some(tessellator) => tessellator,
            None => {
                let start = || {
                    let (gpu, make) = (engine.gpu.clone(), sibling(scene));
                    BackgroundJob::start(context, move || gpu.attempt(make)?)
                };
                let Some(made) = self.making.get_or_insert_with(start).take() else { return Ok(None) };
                self.making = None;
                made.map_err(MeasureError::Comparing)??
            }
        };
        self.drawing = Some(Box::new(engine.start_silhouette(scene, tessellator, tessellation, view)?));
        Ok(None)
    }
}

impl MeasuredOutlines {
    fn find(context: &egui::Context, grid: SampleGrid, texels: &[u8]) -> Self {
        let silhouette = Silhouette::find(grid, texels);
        let picture = outlines_picture(&silhouette);
        let size = [picture.width(), picture.height()].map(|side| side as usize);
        let image = egui::ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
        let texture = context.load_texture("outlines", image, egui::TextureOptions::NEAREST);
        Self { silhouette, picture, texture }
    }
}

impl App {
    /// Goes on comparing outlines, once all else that is shown was measured. Without the overlay nothing of it is kept.
    pub(in crate::app) fn compare_outlines(
        &mut self,
        context: &egui::Context,
        tessellation: &Tessellation,
        view: &SilhouetteView,
        screen: ScreenView,
    ) -> Result<(), MeasureError> {
        let shows = self.settings.any_half_shows(ColorSource::Outlines);
        let Some(document) = &mut self.document else { return Ok(()) };
        if !shows {
            document.silhouette = SilhouetteJob::default();
            return Ok(());
        }
        if document.right().measure.is_busy() || document.leaks.is_busy() {
            return Ok(());
        }
        let (engine, scene, grid) = (&self.engine, &document.scene, view.grid(&self.engine.gpu));
        let of = (scene.tessellator.generation(), screen);
        let start = |own: &mut OutlineDrawing| {
            own.tessellator = own.drawing.take().map(|drawing| drawing.tessellator).or(own.tessellator.take());
            Ok(())
        };
        let step = |own: &mut OutlineDrawing| own.step(context, engine, scene, tessellation, view);
        let own = context.clone();
        let compare = move |texels: Vec<u8>| MeasuredOutlines::find(&own, grid, &texels);
        document.silhouette.go_on(context, of, start, step, compare, MeasureError::Comparing)
    }

    /// The outlines of what is shown, once they are compared.
    pub(in crate::app) fn found_outlines(&self) -> Option<&MeasuredOutlines> {
        let document = self.document.as_ref().filter(|_| self.settings.any_half_shows(ColorSource::Outlines))?;
        let view = self.viewport.picture.seen_from()?;
        let (of, found) = document.silhouette.found()?;
        (of == (document.scene.tessellator.generation(), view)).then_some(found)
    }
}
