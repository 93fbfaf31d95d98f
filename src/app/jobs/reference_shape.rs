//! The reference surface that the mesh is compared with, and the job that loads it.

use std::sync::Arc;

use super::companion_files::new_generation;
use super::job_list::Work;
use crate::app::App;
use geometry::progress::Progress;
use inspect::reference_shape::ReferenceShape;
use inspect::settings::Colors;
use load::import::Subdivide;
use load::{Import, Source};

/// A reference surface that was chosen for the mesh.
pub(crate) struct ChosenReferenceShape {
    pub source: Source,
    reference_shape: Arc<ReferenceShape>,
    /// A number of its own for each one, from 2 on: see [`App::yardstick`].
    generation: u64,
}

impl App {
    /// Starts to load a reference surface. Until it is loaded, the one before it stays.
    pub fn open_reference_shape(&mut self, context: &egui::Context, source: Source) {
        let (wanted, limits) = (source.clone(), self.jobs.limits);
        let import = Import { subdivide: Subdivide::File, ..self.preparation().import };
        let load = move |progress: &Progress| match ReferenceShape::load(&wanted, import, &limits, progress) {
            Ok(Some(reference_shape)) => Ok(Arc::new(reference_shape)),
            Ok(None) => Err(format!("{wanted} can't be a reference surface: it has no triangles")),
            Err(error) => Err(error.to_string()),
        };
        let title = format!("Loading the reference surface {}", source.title());
        self.read_companion(context, Work::ReferenceShape, title, source.title(), load, |app, reference_shape| {
            app.reference_shape = Some(ChosenReferenceShape { source, reference_shape, generation: new_generation() });
            app.settings.overlays.colors = Colors::Deviation;
        });
    }

    /// Loads a reference surface of a file again, which is turned and scaled as the mesh is.
    pub(in crate::app) fn follow_reference_shape(&mut self, context: &egui::Context) {
        let chosen = self.reference_shape.as_ref().map(|chosen| chosen.source.clone());
        if let Some(source @ (Source::File(_) | Source::Vase)) = chosen {
            self.open_reference_shape(context, source);
        }
    }

    /// The reference surface that was chosen for the mesh.
    pub fn reference_shape(&self) -> Option<&Source> {
        self.reference_shape.as_ref().map(|chosen| &chosen.source)
    }

    /// Goes back to the default reference surface: the exact surface of a shape, or the limit surface.
    pub(in crate::app) fn forget_reference_shape(&mut self) {
        self.reference_shape = None;
        self.jobs.stop(Work::ReferenceShape);
    }

    /// The reference surface that distances are measured from: its number, the surface (none for the limit surface), and
    /// its name. The number is 0 for the limit surface, 1 for the exact surface, and from 2 on for a chosen one. In a pose it
    /// is always the limit surface, and an exact surface isn't used for a displaced mesh.
    pub(in crate::app) fn yardstick(&self) -> (u64, Option<Arc<ReferenceShape>>, String) {
        let limit = || (0, None, "limit surface".to_owned());
        let Some(document) = self.document.as_ref().filter(|_| self.viewport.playback.moment().is_none()) else {
            return limit();
        };
        if let Some(chosen) = &self.reference_shape {
            return (chosen.generation, Some(chosen.reference_shape.clone()), chosen.source.title());
        }
        let is_plain = !self.settings.tessellation.displacement.is_on();
        match (&document.exact, document.loaded.source.shape()) {
            (Some(exact), Some(shape)) if is_plain => {
                (1, Some(exact.clone()), format!("exact {}", shape.title().to_lowercase()))
            }
            _ => limit(),
        }
    }
}
