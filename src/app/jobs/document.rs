//! A mesh in the window, and its loading beside the window.

use std::io::ErrorKind;
use std::sync::Arc;

use super::background_job::BackgroundJob;
use super::mesh_checks::Checks;
use crate::engine::{self, Engine, Loaded, Preparation};
use crate::files::FileError;
use crate::gpu::GpuError;
use crate::load::{LoadError, Source};
use crate::mesh::{EdgeCounts, Moment};
use crate::progress::Progress;
use crate::render::Scene;
use crate::settings::{ARENA_BYTES, Settings, SplitSide};
use crate::tessellate::Deformed;
use crate::truth::Truth;

/// What is open.
pub(crate) struct Document {
    pub loaded: Loaded,
    pub scene: Scene,
    pub edges: EdgeCounts,
    /// What the scene was posed for; none at rest.
    pub moment: Option<Moment>,
    pub checks: Checks,
    /// Of the mesh's bounds at rest, in object units.
    pub diagonal: f32,
    /// What its shape is sampled from, if it is such a shape.
    pub exact: Option<Arc<Truth>>,
    /// Tells one loaded document from the next, also of one file.
    pub generation: u64,
}

impl Document {
    /// The mesh and its topology as they are shown, or as loaded while nobody knows them in the pose shown.
    pub(crate) fn shown(&self) -> Deformed {
        self.posed().unwrap_or_else(|| (self.loaded.mesh.clone(), self.loaded.topology.clone()))
    }

    /// The same; none while nobody knows.
    pub(crate) fn posed(&self) -> Option<Deformed> {
        self.scene.tessellator.posed().deformed_if_quick()
    }

    /// Bytes on the device: topology and output, of both halves if there are two surfaces.
    pub(crate) fn bytes(&self) -> u64 {
        let of = |scene: &Scene| {
            let tessellator = &scene.tessellator;
            tessellator.buffers().bytes() + scene.work_bytes() + tessellator.arena_bytes()
        };
        SplitSide::BOTH.into_iter().filter_map(|half| self.scene.half(half)).map(of).sum()
    }
}

/// Memory for a tessellation's output: steps that a software adapter takes no longer for than a person notices.
pub(crate) fn arena_bytes(engine: &Engine) -> u64 {
    if engine.gpu.is_software() { ARENA_BYTES / 8 } else { ARENA_BYTES }
}

/// A mesh on the device, unless the device has no room for it.
///
/// # Errors
/// The mesh is larger than the adapter binds, the device is out of memory, or it was lost.
pub(crate) fn scene_of(engine: &Engine, loaded: &Loaded) -> Result<Scene, GpuError> {
    engine.gpu.attempt(|| engine.scene(loaded, arena_bytes(engine)))?
}

/// A load under way; dropping it cancels it.
pub(crate) struct Load {
    pub source: Source,
    /// What the mesh will have become.
    pub preparation: Preparation,
    /// Whether the camera stays where it is: the same mesh is loaded again.
    pub keep_view: bool,
    pub progress: Progress,
    /// What is said once the mesh is there.
    pub remark: Option<String>,
    job: BackgroundJob<Result<Document, Option<NotLoaded>>>,
}

/// What went wrong.
pub(crate) struct NotLoaded {
    /// In a sentence.
    pub why: String,
    /// Whether the file isn't there.
    pub is_gone: bool,
}

impl NotLoaded {
    fn because(why: String) -> Self {
        Self { why, is_gone: false }
    }
}

impl Load {
    /// Loads on a thread of its own, and makes the pipelines there that a picture with these settings needs.
    pub(crate) fn start(
        engine: &Engine,
        context: &egui::Context,
        source: Source,
        preparation: Preparation,
        settings: Settings,
        keep_view: bool,
    ) -> Self {
        static GENERATION: std::sync::atomic::AtomicU64 = std::sync::atomic::AtomicU64::new(0);
        let generation = GENERATION.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let progress = Progress::default();
        let (engine, own_context) = (engine.clone(), context.clone());
        let (wanted, prepared, own_progress) = (source.clone(), preparation.clone(), progress.clone());
        let load = move || load(&engine, &own_context, &wanted, &prepared, &settings, &own_progress, generation);
        Self { job: BackgroundJob::start(context, load), source, preparation, keep_view, progress, remark: None }
    }

    /// The outcome, once there is one: a document, what went wrong, or nothing if it was cancelled.
    pub(crate) fn take(&mut self) -> Option<Result<Document, Option<NotLoaded>>> {
        let stopped = |stopped| format!("{}: loading it {stopped}; the file may be damaged", self.source.title());
        Some(self.job.take()?.unwrap_or_else(|error| Err(Some(NotLoaded::because(stopped(error))))))
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

fn load(
    engine: &Engine,
    context: &egui::Context,
    source: &Source,
    preparation: &Preparation,
    settings: &Settings,
    progress: &Progress,
    generation: u64,
) -> Result<Document, Option<NotLoaded>> {
    let loaded = match engine::load(source, preparation, progress) {
        Ok(loaded) => loaded,
        Err(LoadError::Cancelled(_)) => return Err(None),
        Err(error) => {
            let is_gone =
                matches!(&error, LoadError::File(FileError::Io { source, .. }) if source.kind() == ErrorKind::NotFound);
            return Err(Some(NotLoaded { why: error.to_string(), is_gone }));
        }
    };
    let no_room = |error: GpuError| Some(NotLoaded::because(format!("{}: {error}", source.title())));
    let scene = scene_of(engine, &loaded).map_err(no_room)?;
    // What is compiled here, beside the window, the first picture doesn't wait for.
    engine.prepare(&scene, settings).map_err(no_room)?;
    let edges = loaded.topology.edge_counts();
    let checks = Checks::start(context, &loaded);
    let diagonal = scene.bounds.diagonal();
    let exact = source.shape().and_then(Truth::of_shape).map(Arc::new);
    Ok(Document { loaded, scene, edges, moment: None, checks, diagonal, exact, generation })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_that_panics_is_a_sentence_about_the_file() {
        let indices: &[u32] = std::hint::black_box(&[]);
        let mut load = Load {
            job: BackgroundJob::start(&egui::Context::default(), move || panic!("index {} of {}", 7, indices.len())),
            source: Source::File("models/odd.glb".into()),
            preparation: Preparation::default(),
            keep_view: false,
            progress: Progress::default(),
            remark: None,
        };
        let start = std::time::Instant::now();
        let result = loop {
            assert!(start.elapsed() < std::time::Duration::from_secs(30), "it hasn't ended");
            match load.take() {
                Some(result) => break result,
                None => std::thread::sleep(std::time::Duration::from_millis(1)),
            }
        };
        let said = result.map(|_| ()).expect_err("it panicked").expect("nobody cancelled it").why;
        assert_eq!(said, "odd.glb: loading it stopped unexpectedly (index 7 of 0); the file may be damaged");
    }
}
