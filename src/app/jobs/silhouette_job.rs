//! Compares the outlines of what is shown while the window goes on: a chunk is drawn at a time, and a thread of its own compares
//! them.

use egui::TextureHandle;
use image::RgbaImage;

use super::background_job::BackgroundJob;
use super::measure_job::MeasureError;
use crate::app::App;
use geometry::tessellate::Tessellation;
use geometry::view::ScreenView;
use gpu::{GpuError, Readback, Tessellator};
use inspect::engine::silhouette::sibling;
use inspect::engine::{Engine, SilhouetteDrawing, SilhouetteView};
use inspect::measure::{SampleGrid, Silhouette};
use inspect::render::{Scene, lay_over, outlines_picture};
use inspect::settings::ColorSource;

/// The comparison of outlines, and its last result.
#[derive(Default)]
pub(crate) struct SilhouetteJob {
    /// The tessellation and the view that outlines are compared for.
    of: Option<(u64, ScreenView)>,
    under_way: Option<OutlineComparison>,
    found: Option<MeasuredOutlines>,
    /// A tessellator that is kept for the next comparison.
    kept: Option<Tessellator>,
}

enum OutlineComparison {
    Making(BackgroundJob<Result<Tessellator, GpuError>>),
    Drawing(Box<SilhouetteDrawing>),
    PendingReadback(Readback, SampleGrid),
    Finding(BackgroundJob<Option<(Silhouette, RgbaImage)>>),
}

pub(crate) struct MeasuredOutlines {
    pub silhouette: Silhouette,
    picture: RgbaImage,
    /// The picture, which lies over that of the view.
    pub texture: TextureHandle,
}

impl SilhouetteJob {
    pub(crate) fn is_busy(&self) -> bool {
        self.under_way.is_some()
    }

    /// Stops comparing. It isn't started again by itself.
    pub(crate) fn give_up(&mut self) {
        self.under_way = None;
    }

    fn found(&self, of: (u64, ScreenView)) -> Option<&MeasuredOutlines> {
        self.found.as_ref().filter(|_| self.of == Some(of))
    }

    /// Goes on comparing what a scene shows, whose counts must be known, or starts over if its tessellation or the view has changed.
    ///
    /// # Errors
    /// The device was lost or has no memory left, or a thread panicked.
    fn go_on(
        &mut self,
        context: &egui::Context,
        engine: &Engine,
        scene: &Scene,
        tessellation: &Tessellation,
        view: &SilhouetteView,
        screen: ScreenView,
    ) -> Result<(), MeasureError> {
        let of = Some((scene.tessellator.generation(), screen));
        if self.of != of {
            if let Some(OutlineComparison::Drawing(drawing)) = self.under_way.take() {
                self.kept = Some(drawing.tessellator);
            }
            (self.of, self.found) = (of, None);
            self.under_way = Some(match self.kept.take() {
                Some(tessellator) => draw(engine, scene, tessellator, tessellation, view)?,
                None => {
                    let (gpu, make) = (engine.gpu.clone(), sibling(scene));
                    OutlineComparison::Making(BackgroundJob::start(context, move || gpu.attempt(make)?))
                }
            });
            return Ok(());
        }
        self.under_way = match self.under_way.take() {
            None => None,
            Some(OutlineComparison::Making(job)) => Some(match job.take() {
                None => OutlineComparison::Making(job),
                Some(made) => draw(engine, scene, made.map_err(MeasureError::Comparing)??, tessellation, view)?,
            }),
            Some(OutlineComparison::Drawing(mut drawing)) => Some(match drawing.step(&engine.gpu)? {
                None => OutlineComparison::Drawing(drawing),
                Some(texels) => {
                    self.kept = Some(drawing.tessellator);
                    OutlineComparison::PendingReadback(texels, drawing.grid)
                }
            }),
            Some(OutlineComparison::PendingReadback(mut texels, grid)) => Some(match texels.poll()? {
                false => OutlineComparison::PendingReadback(texels, grid),
                true => OutlineComparison::Finding(BackgroundJob::start(context, move || {
                    // No bytes come from a lost device, which is reported elsewhere.
                    let silhouette = Silhouette::find(grid, &texels.bytes().ok()?);
                    let picture = outlines_picture(&silhouette);
                    Some((silhouette, picture))
                })),
            }),
            Some(OutlineComparison::Finding(job)) => match job.take() {
                None => Some(OutlineComparison::Finding(job)),
                Some(found) => {
                    self.found = found.map_err(MeasureError::Comparing)?.map(|found| uploaded(context, found));
                    None
                }
            },
        };
        Ok(())
    }
}

fn draw(
    engine: &Engine,
    scene: &Scene,
    tessellator: Tessellator,
    tessellation: &Tessellation,
    view: &SilhouetteView,
) -> Result<OutlineComparison, GpuError> {
    Ok(OutlineComparison::Drawing(Box::new(engine.start_silhouette(scene, tessellator, tessellation, view)?)))
}

fn uploaded(context: &egui::Context, (silhouette, picture): (Silhouette, RgbaImage)) -> MeasuredOutlines {
    let size = [picture.width(), picture.height()].map(|side| side as usize);
    let image = egui::ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
    let texture = context.load_texture("outlines", image, egui::TextureOptions::NEAREST);
    MeasuredOutlines { silhouette, picture, texture }
}

impl App {
    fn shows_silhouette(&self) -> bool {
        self.settings.overlays.colors.source() == ColorSource::Outlines
    }

    /// Goes on comparing outlines, once all else that is shown was measured. Without the overlay nothing of it is kept.
    pub(in crate::app) fn compare_outlines(
        &mut self,
        context: &egui::Context,
        tessellation: &Tessellation,
        view: &SilhouetteView,
        screen: ScreenView,
    ) -> Result<(), MeasureError> {
        let shows = self.shows_silhouette();
        let Some(document) = &mut self.document else { return Ok(()) };
        if !shows {
            document.silhouette = SilhouetteJob::default();
            return Ok(());
        }
        if document.right().measure.is_busy() || document.leaks.is_busy() {
            return Ok(());
        }
        document.silhouette.go_on(context, &self.engine, &document.scene, tessellation, view, screen)
    }

    /// The outlines of what is shown, once they are compared.
    pub(in crate::app) fn found_outlines(&self) -> Option<&MeasuredOutlines> {
        let document = self.document.as_ref().filter(|_| self.shows_silhouette())?;
        let view = self.viewport.picture.seen_from()?;
        document.silhouette.found((document.scene.tessellator.generation(), view))
    }

    /// Lays the outlines over a copy of the picture that is shown.
    pub(in crate::app) fn lay_outlines_over(&self, picture: &mut RgbaImage) {
        if let Some(found) = self.found_outlines() {
            lay_over(picture, &found.picture, &self.settings);
        }
    }
}
