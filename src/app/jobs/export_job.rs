//! Writes the tessellated mesh on a thread of its own.

use std::path::{Path, PathBuf};

use super::background_job::{BackgroundJob, Stopped};
use super::document::{Document, arena_bytes};
use crate::engine::{Engine, Loaded};
use crate::export::Exported;
use crate::gpu::{GpuError, Timing};
use crate::measure::EmittedChunk;
use crate::mesh::Moment;
use crate::names::shown_path;
use crate::progress::Progress;
use crate::render::Scene;
use crate::tessellate::{Inputs, Tessellated};

/// How much of the progress is for reading the mesh back from the device; the rest is for writing the file.
const READING: f32 = 0.8;

/// An export under way; dropping it cancels it.
pub(crate) struct ExportJob {
    pub progress: Progress,
    path: PathBuf,
    /// None only for a moment, inside [`Self::wake`].
    job: Option<BackgroundJob<Result<(), String>>>,
}

impl ExportJob {
    /// Starts to tessellate the document with these inputs, in the pose that is shown, and to write a .glb or .obj file.
    pub(crate) fn start(
        context: &egui::Context,
        engine: &Engine,
        document: &Document,
        inputs: Inputs,
        path: PathBuf,
    ) -> Self {
        let progress = Progress::new();
        let export = Export {
            engine: engine.clone(),
            loaded: document.loaded.clone(),
            moment: document.moment,
            inputs,
            path: path.clone(),
            progress: progress.clone(),
        };
        let make = document.scene.beside(arena_bytes(engine));
        Self { job: Some(BackgroundJob::start(context, move || export.run(make))), path, progress }
    }

    /// The file's name.
    pub(crate) fn name(&self) -> String {
        shown_path(Path::new(self.path.file_name().unwrap_or_default()))
    }

    /// Returns a sentence once the export has ended: what was written, or as an error why nothing was.
    pub(crate) fn take(&self) -> Option<Result<String, String>> {
        let stopped = |stopped: Stopped| Err(format!("exporting the mesh {stopped}"));
        let ended = self.job.as_ref()?.take()?.unwrap_or_else(stopped);
        Some(ended.map(|()| format!("{} is written.", shown_path(&self.path))))
    }

    /// Lets the job repaint another window when it ends.
    pub(crate) fn wake(&mut self, context: &egui::Context) {
        self.job = self.job.take().map(|job| job.waking(context));
    }
}

impl Drop for ExportJob {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

/// What the thread needs.
struct Export {
    engine: Engine,
    loaded: Loaded,
    moment: Option<Moment>,
    inputs: Inputs,
    path: PathBuf,
    progress: Progress,
}

impl Export {
    /// Tessellates in a scene of its own, so that the window's isn't changed. Writes nothing if it was cancelled.
    fn run(&self, make: impl FnOnce() -> Result<Scene, GpuError>) -> Result<(), String> {
        let failed = |error: GpuError| error.to_string();
        let mut scene = self.engine.gpu.attempt(make).and_then(|scene| scene).map_err(failed)?;
        scene.set_moment(self.moment).map_err(failed)?;
        self.engine.count(&mut scene, &self.inputs, &mut Timing::Off).map_err(failed)?;
        let (vertices, triangles) = scene.tessellator.totals();
        Exported::check(&self.path, vertices, triangles).map_err(|error| error.to_string())?;
        let Some(tessellated) = self.read(&mut scene).map_err(failed)? else { return Ok(()) };
        let posed = self.loaded.posed(self.moment);
        let exported = Exported::new(&posed.mesh, &posed.topology, &tessellated);
        if self.progress.check().is_err() {
            return Ok(());
        }
        exported.write(&self.path).map_err(|error| error.to_string())
    }

    /// Reads back what is emitted, chunk by chunk. Returns none if it was cancelled.
    fn read(&self, scene: &mut Scene) -> Result<Option<Tessellated>, GpuError> {
        let mut out = Tessellated::default();
        let chunks = scene.tessellator.chunk_count();
        for index in 0..chunks {
            if self.progress.check().is_err() {
                return Ok(None);
            }
            let mut append = |chunk: &EmittedChunk| out.append(chunk.vertices, chunk.triangles);
            self.engine.visit_chunk(scene, index, &mut [&mut append])?;
            self.progress.set(READING * (index + 1) as f32 / chunks as f32);
        }
        Ok(Some(out))
    }
}
