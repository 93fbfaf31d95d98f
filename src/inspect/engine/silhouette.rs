//! Draws what a tessellation, its source mesh and its surface cover on screen, step by step, so that a window goes on meanwhile.

use super::Engine;
use crate::measure::{OutlineOf, SampleGrid, Silhouette};
use crate::render::{Added, Scene, channel, padded_clip};
use geometry::progress::Progress;
use geometry::tessellate::{Clip, Convention, Edges, Inputs, LodView, Partitioning, Tessellation};
use gpu::{Gpu, GpuError, Readback, Tessellator, Timing, submit_untimed};

/// Memory for the output of the tessellator that outlines are drawn with, in bytes.
const ARENA_BYTES: u64 = 32 << 20;

/// How far the surface's stand-in may be from it on screen, in px.
const TOLERANCE_PX: f32 = 0.1;

/// How a picture sees a mesh.
#[derive(Clone, Copy, Debug)]
pub struct SilhouetteView {
    /// Width and height in px.
    pub size: [u32; 2],
    /// What the picture's camera sees.
    pub seen: LodView,
    /// What LOD and clipping are computed for, which may be another camera's view.
    pub lod: LodView,
}

impl SilhouetteView {
    /// The samples of the picture that are compared on this device.
    pub fn grid(&self, gpu: &Gpu) -> SampleGrid {
        SampleGrid::new(self.size, gpu.device.limits().max_texture_dimension_2d)
    }
}

/// A drawing under way. It has a tessellator of its own, so that what is shown stays as it is.
pub struct SilhouetteDrawing {
    /// See [`sibling`].
    pub tessellator: Tessellator,
    pub grid: SampleGrid,
    coverage: Added,
    /// The inputs for each of [`OutlineOf::ALL`] that is still to be drawn, in that order.
    rest: Vec<(OutlineOf, Inputs)>,
    is_set: bool,
    next_chunk: usize,
}

/// Makes a tessellator for [`SilhouetteDrawing`], on any thread.
pub fn sibling(scene: &Scene) -> impl FnOnce() -> Result<Tessellator, GpuError> + Send + use<> {
    scene.tessellator.sibling(ARENA_BYTES)
}

impl SilhouetteDrawing {
    /// Goes on by one step: it requests counts, takes them, or draws a chunk. After the last one it returns all samples, which are
    /// on their way to the host, as [`Silhouette::find`] takes them.
    ///
    /// # Errors
    /// The device was lost, or the mesh's curves are larger than it binds.
    pub fn step(&mut self, gpu: &Gpu) -> Result<Option<Readback>, GpuError> {
        let Some(&(of, inputs)) = self.rest.first() else { return self.read(gpu).map(Some) };
        if !self.is_set {
            if of != OutlineOf::Triangles && self.tessellator.given().is_some() {
                self.tessellator.give(None)?;
            }
            self.tessellator.set(&inputs)?;
            (self.is_set, self.next_chunk) = (true, 0);
        }
        if self.tessellator.count(&mut Timing::Off)? || !self.tessellator.poll_counts()? {
            return Ok(None);
        }
        if self.next_chunk < self.tessellator.chunk_count() {
            submit_untimed(gpu, |recorder| {
                self.tessellator.emit(recorder, self.next_chunk)?;
                self.coverage.draw(recorder, channel(of), Some(&self.tessellator.chunk(self.next_chunk)));
                Ok(())
            })?;
            self.next_chunk += 1;
        }
        if self.next_chunk >= self.tessellator.chunk_count() {
            self.rest.remove(0);
            self.is_set = false;
        }
        Ok(None)
    }

    fn read(&mut self, gpu: &Gpu) -> Result<Readback, GpuError> {
        let mut texels = submit_untimed(gpu, |recorder| {
            // An empty mesh covers nothing, which has to be drawn as well.
            self.coverage.draw(recorder, channel(OutlineOf::Triangles), None);
            Ok(self.coverage.read(gpu, recorder))
        })?;
        texels.request();
        Ok(texels)
    }
}

impl Engine {
    /// Starts to draw the silhouettes of what `scene` shows, with a tessellator that was made as its [`sibling`].
    ///
    /// # Errors
    /// The picture is larger than the adapter draws, the mesh's rig is larger than it binds, or the device was lost.
    pub fn start_silhouette(
        &self,
        scene: &Scene,
        mut tessellator: Tessellator,
        tessellation: &Tessellation,
        view: &SilhouetteView,
    ) -> Result<SilhouetteDrawing, GpuError> {
        let grid = view.grid(&self.gpu);
        let coverage = self.silhouettes.start(&self.gpu, grid, view.seen.clip_from_object)?;
        tessellator.pose_as(scene.tessellator.posed())?;
        if scene.tessellator.given() != tessellator.given() {
            tessellator.give(scene.tessellator.given().cloned())?;
        }
        tessellator.set_surface_shader(scene.tessellator.surface_shader().cloned())?;
        let rest = OutlineOf::ALL.into_iter().zip(inputs(tessellation, view, grid)).collect();
        Ok(SilhouetteDrawing { tessellator, grid, coverage, rest, is_set: false, next_chunk: 0 })
    }

    /// The silhouettes of what `scene` shows. Returns none if `progress` is cancelled.
    ///
    /// # Errors
    /// Those of [`Self::start_silhouette`].
    pub fn silhouette(
        &self,
        scene: &Scene,
        tessellation: &Tessellation,
        view: &SilhouetteView,
        progress: &Progress,
    ) -> Result<Option<Silhouette>, GpuError> {
        let mut drawing = self.start_silhouette(scene, sibling(scene)()?, tessellation, view)?;
        while progress.check().is_ok() {
            if let Some(mut texels) = drawing.step(&self.gpu)? {
                return Ok(Some(Silhouette::find(drawing.grid, &texels.wait(&self.gpu)?)));
            }
            self.gpu.wait();
        }
        Ok(None)
    }
}

/// What [`OutlineOf::ALL`] are tessellated with.
fn inputs(own: &Tessellation, view: &SilhouetteView, grid: SampleGrid) -> [Inputs; 3] {
    let watertight = Tessellation { edges: Edges::PerEdge, convention: Convention::D3d11, ..*own };
    let surface = Tessellation {
        partitioning: Partitioning::Integer,
        clip: Clip::Frustum,
        cull_back_faces: false,
        ..watertight.by_error(TOLERANCE_PX)
    };
    // The surface is drawn in the margin too.
    let half_viewport = grid.padded().map(|side| 0.5 * side as f32).into();
    let clip_from_object = padded_clip(grid, view.seen.clip_from_object);
    let padded = view.seen.seen_through(clip_from_object, half_viewport);
    [Inputs::new(own, view.lod), Inputs::new(&Tessellation::untessellated(), view.seen), Inputs::new(&surface, padded)]
}
