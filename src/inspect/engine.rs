//! The engine that the window and the commands share: a device with its pipelines, and what can be done with a scene
//! without a window: upload it, tessellate it, draw it, read it back and time it.

mod clip_survey;
mod loading;
pub mod measurements;
mod readbacks;
pub mod silhouette;
mod timing;

use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use crate::render::{Camera, LeakCounter, Picker, Renderer, Scene, SilhouetteDrawer, Target};
use crate::settings::{Settings, SplitSide};
use geometry::cores::each;
use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{Inputs, LodView};
use gpu::{AdapterChoice, ComputePipelines, Gpu, GpuError, Recorder, Timing};

pub use clip_survey::{ClipFinding, MomentFound, worst_moment};
pub use loading::{Loaded, Preparation, load, load_reference};
pub use measurements::{MeasurementResults, Measurements};
pub use readbacks::CopiedChunk;
pub use silhouette::{SilhouetteDrawing, SilhouetteView};
pub use timing::Runs;

/// A device and the pipelines on it, each of which is made when it is first needed. Cheap to clone; clones share everything.
#[derive(Clone)]
pub struct Engine {
    pub gpu: Gpu,
    pub pipelines: Arc<ComputePipelines>,
    pub renderer: Arc<Renderer>,
    pub picker: Arc<Picker>,
    pub leak_counter: Arc<LeakCounter>,
    silhouettes: Arc<SilhouetteDrawer>,
    /// See [`Self::chunks_read`].
    chunks_read: Arc<AtomicU64>,
}

impl Engine {
    pub fn new(gpu: Gpu) -> Self {
        Self {
            pipelines: Arc::default(),
            renderer: Arc::new(Renderer::new(&gpu)),
            picker: Arc::default(),
            leak_counter: Arc::new(LeakCounter::new()),
            silhouettes: Arc::new(SilhouetteDrawer::new()),
            chunks_read: Arc::default(),
            gpu,
        }
    }

    /// Makes an engine on the machine's best adapter, without a window.
    ///
    /// # Errors
    /// There is no adapter, or it gives no device.
    pub fn headless() -> Result<Self, GpuError> {
        Gpu::headless().map(Self::new)
    }

    /// Makes an engine on the adapter that `choice` names, without a window.
    ///
    /// # Errors
    /// There is no such adapter, or it gives no device.
    pub fn chosen(choice: &AdapterChoice) -> Result<Self, GpuError> {
        Gpu::chosen(choice).map(Self::new)
    }

    /// Uploads a mesh; its output gets an arena of `arena_bytes`. Any thread may call this.
    ///
    /// # Errors
    /// The mesh needs a larger buffer than the adapter can bind.
    pub fn scene(&self, loaded: &Loaded, arena_bytes: u64) -> Result<Scene, GpuError> {
        self.scene_of(loaded.mesh.clone(), loaded.topology.clone(), arena_bytes)
    }

    /// As [`Self::scene`], for a mesh that was not loaded.
    ///
    /// # Errors
    /// The mesh needs a larger buffer than the adapter can bind.
    pub fn scene_of(&self, mesh: Arc<Mesh>, topology: Arc<Topology>, arena_bytes: u64) -> Result<Scene, GpuError> {
        Scene::new(&self.gpu, &self.renderer.materials, self.pipelines.clone(), mesh, topology, arena_bytes)
    }

    /// Makes the pipelines that a picture of the scene with these settings needs, as far as they are known before the scene is
    /// counted, on all cores. The window's loading thread calls this, so that the window doesn't wait for the driver's compiler.
    /// What isn't made here is made when it is needed, on one core.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare(&self, scene: &Scene, settings: &Settings) -> Result<(), GpuError> {
        for (scene, settings) in SplitSide::BOTH.iter().filter_map(|&half| scene.half(half).zip(settings.half(half))) {
            let works: [&(dyn Fn() -> Result<(), GpuError> + Sync); 2] =
                [&|| scene.tessellator.prepare(&settings.tessellation), &|| self.renderer.prepare(scene, &settings)];
            each(&works, |work| work())?;
        }
        Ok(())
    }

    /// Adds the left half to the scene of a split view, if it has none: a second tessellation, of its mesh or another one.
    ///
    /// # Errors
    /// The mesh needs a larger buffer than the adapter can bind.
    pub fn split(&self, scene: &mut Scene, settings: &Settings, other: Option<&Loaded>) -> Result<(), GpuError> {
        if settings.split.is_none() || scene.half(SplitSide::Left).is_some() {
            return Ok(());
        }
        let arena_bytes = scene.tessellator.arena_bytes();
        let left = other.map_or_else(|| scene.sibling(arena_bytes)(), |other| self.scene(other, arena_bytes))?;
        scene.set_left(Some(left))
    }

    /// Runs the passes that count vertices and triangles, and waits for their results.
    ///
    /// # Errors
    /// The device was lost, or a shader of the user's own took too long.
    pub fn count(&self, scene: &mut Scene, inputs: &Inputs, timing: &mut Timing) -> Result<(), GpuError> {
        scene.tessellator.set(inputs)?;
        scene.tessellator.count(timing)?;
        scene.tessellator.read_counts()?;
        match scene.tessellator.stopped_shader() {
            Some(name) => Err(GpuError::UserShaderTimedOut(name)),
            None => Ok(()),
        }
    }

    /// Tessellates for the camera's view and draws it. Waits for the counts, but not for the picture.
    ///
    /// # Errors
    /// The device was lost.
    pub fn draw(
        &self,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
        timing: &mut Timing,
    ) -> Result<(), GpuError> {
        let view = camera.lod_view(target.viewport(), &scene.bounds);
        self.draw_seen(scene, target, camera, view, settings, timing)
    }

    /// The same, tessellated for a view that may be another camera's.
    ///
    /// # Errors
    /// The device was lost.
    fn draw_seen(
        &self,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        view: LodView,
        settings: &Settings,
        timing: &mut Timing,
    ) -> Result<(), GpuError> {
        self.split(scene, settings, None)?;
        for half in SplitSide::BOTH {
            if let Some((scene, settings)) = scene.half_mut(half).zip(settings.half(half)) {
                self.count(scene, &settings.inputs(view), timing)?;
            }
        }
        let mut recorder = Recorder::new(&self.gpu, timing);
        self.renderer.draw(&mut recorder, scene, target, camera, settings)?;
        recorder.submit();
        Ok(())
    }
}
