//! The mesh that is open, and the job that loads it.

use std::io::ErrorKind;
use std::sync::Arc;

use super::background_job::BackgroundJob;
use super::mesh_checks::Checks;
use super::stand_in::StandIn;
use geometry::mesh::{EdgeCounts, Moment};
use geometry::progress::{Progress, Stage};
use geometry::tessellate::Deformed;
use gpu::GpuError;
use inspect::engine::{self, Engine, Loaded, Preparation};
use inspect::render::Scene;
use inspect::settings::{ARENA_BYTES, Settings, SplitSide};
use inspect::truth::Truth;
use load::files::FileError;
use load::{LoadError, Source};

/// The mesh that is open.
pub(crate) struct Document {
    pub loaded: Loaded,
    pub scene: Scene,
    pub edges: EdgeCounts,
    /// The moment whose pose the scene has; none at rest.
    pub moment: Option<Moment>,
    /// The number of the factors of a file that the scene has; 0 for those of LOD.
    pub given: u64,
    /// The number of the function that gives the scene's control points; 0 for a surface's own.
    pub surface_shader: u64,
    /// The number of the picture of a lit sphere that the scene has; 0 for those that are made in code.
    pub matcap: u64,
    /// The number of the file whose light the scene has; 0 for none.
    pub environment: u64,
    pub checks: Checks,
    /// What previews draw in place of a large mesh.
    pub stand_in: StandIn,
    /// The bounding diagonal at rest, in object units.
    pub diagonal: f32,
    /// See [`Mesh::has_texture_coordinates`](geometry::mesh::Mesh::has_texture_coordinates).
    pub has_texture_coordinates: bool,
    /// The exact surface, if the mesh is a shape that has one.
    pub exact: Option<Arc<Truth>>,
    /// A number of its own for each document, even if the same file is loaded again.
    pub generation: u64,
}

impl Document {
    /// The mesh and its topology in the pose that is shown; at rest as long as that pose isn't known on the CPU.
    pub(crate) fn shown(&self) -> Deformed {
        self.posed().unwrap_or_else(|| (self.loaded.mesh.clone(), self.loaded.topology.clone()))
    }

    /// The mesh and its topology in the pose that is shown; none as long as that pose isn't known on the CPU.
    pub(crate) fn posed(&self) -> Option<Deformed> {
        self.scene.tessellator.posed().deformed_if_quick()
    }

    /// Bytes on the device: topology and output, of both halves if the split has two surfaces.
    pub(crate) fn bytes(&self) -> u64 {
        let of = |scene: &Scene| {
            let tessellator = &scene.tessellator;
            tessellator.buffers().bytes() + scene.work_bytes() + tessellator.arena_bytes()
        };
        SplitSide::BOTH.into_iter().filter_map(|half| self.scene.half(half)).map(of).sum()
    }
}

/// Memory for a tessellation's output, in bytes. A software adapter gets less, so that each step of a picture is short.
pub(crate) fn arena_bytes(engine: &Engine) -> u64 {
    if engine.gpu.is_software() { ARENA_BYTES / 8 } else { ARENA_BYTES }
}

/// A mesh on the device, unless the device has no room for it.
///
/// # Errors
/// The mesh needs a larger buffer than the adapter can bind, the device is out of memory, or it was lost.
pub(crate) fn scene_of(engine: &Engine, loaded: &Loaded) -> Result<Scene, GpuError> {
    engine.gpu.attempt(|| engine.scene(loaded, arena_bytes(engine)))?
}

/// A load under way; dropping it cancels it.
pub(crate) struct Load {
    pub source: Source,
    /// How the mesh is being prepared.
    pub preparation: Preparation,
    /// Whether the camera stays where it is, because the same mesh is loaded again.
    pub keep_view: bool,
    pub progress: Progress,
    /// A message to show once the mesh is loaded.
    pub remark: Option<String>,
    job: BackgroundJob<Result<Document, Option<NotLoaded>>>,
}

/// Why a mesh could not be loaded.
pub(crate) struct NotLoaded {
    /// The reason, as a sentence.
    pub why: String,
    /// Whether the file doesn't exist.
    pub is_gone: bool,
}

impl NotLoaded {
    fn because(why: String) -> Self {
        Self { why, is_gone: false }
    }
}

impl Load {
    /// Starts a thread that loads the mesh and makes the pipelines that a picture with these settings needs.
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

    /// Returns the result once there is one: a document, why there is none, or no reason if loading was cancelled.
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

/// The part of a load that reading the mesh counts as. Compiling shaders, of which no part is known, is the rest.
const READ: f32 = 0.8;

fn load(
    engine: &Engine,
    context: &egui::Context,
    source: &Source,
    preparation: &Preparation,
    settings: &Settings,
    progress: &Progress,
    generation: u64,
) -> Result<Document, Option<NotLoaded>> {
    let loaded = match engine::load(source, preparation, &progress.part(0.0, READ)) {
        Ok(loaded) => loaded,
        Err(LoadError::Cancelled(_)) => return Err(None),
        Err(error) => {
            let is_gone =
                matches!(&error, LoadError::File(FileError::Io { source, .. }) if source.kind() == ErrorKind::NotFound);
            return Err(Some(NotLoaded { why: error.to_string(), is_gone }));
        }
    };
    let no_room = |error: GpuError| Some(NotLoaded::because(format!("{}: {error}", source.title())));
    progress.enter(Stage::Device);
    progress.set(READ);
    let scene = scene_of(engine, &loaded).map_err(no_room)?;
    // Pipelines are made here, so that the first picture doesn't wait for the driver's compiler.
    engine.prepare(&scene, settings).map_err(no_room)?;
    let edges = loaded.topology.edge_counts();
    let checks = Checks::start(context, &loaded);
    let diagonal = scene.bounds.diagonal();
    let has_texture_coordinates = loaded.mesh.has_texture_coordinates();
    let exact = source.shape().and_then(Truth::of_shape).map(Arc::new);
    Ok(Document {
        loaded,
        scene,
        edges,
        moment: None,
        given: 0,
        surface_shader: 0,
        matcap: 0,
        environment: 0,
        checks,
        stand_in: StandIn::default(),
        diagonal,
        has_texture_coordinates,
        exact,
        generation,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_that_panics_returns_an_error_that_names_the_file() {
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
