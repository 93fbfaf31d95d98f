//! The tessellated mesh as a file.

use std::path::Path;

use geometry::mesh::Moment;
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, Tessellated};
use gpu::{GpuError, Timing};
use inspect::engine::{Engine, Loaded};
use inspect::export::Exported;
use inspect::measure::EmittedChunk;
use inspect::render::Scene;

/// How much of the progress is for reading the mesh back from the device; the rest is for writing the file.
const READING: f32 = 0.8;

/// What is exported: the mesh in a pose, tessellated with these inputs.
pub(crate) struct Export {
    pub engine: Engine,
    pub loaded: Loaded,
    pub moment: Option<Moment>,
    pub inputs: Inputs,
}

impl Export {
    /// Tessellates in a scene of its own, so that the window's isn't changed. Writes nothing if it was cancelled. Returns sentences
    /// about what is drawn but couldn't be written.
    ///
    /// # Errors
    /// The device fails, or the file can't be written; as a sentence.
    pub(crate) fn run(
        &self,
        make: impl FnOnce() -> Result<Scene, GpuError>,
        path: &Path,
        progress: &Progress,
    ) -> Result<Vec<String>, String> {
        let failed = |error: GpuError| error.to_string();
        let mut scene = self.engine.gpu.attempt(make).and_then(|scene| scene).map_err(failed)?;
        scene.set_moment(self.moment).map_err(failed)?;
        self.engine.count(&mut scene, &self.inputs, &mut Timing::Off).map_err(failed)?;
        let (vertices, triangles) = scene.tessellator.totals();
        Exported::check(path, &self.loaded.mesh, vertices, triangles).map_err(|error| error.to_string())?;
        let Some(tessellated) = self.read(&mut scene, progress).map_err(failed)? else { return Ok(Vec::new()) };
        let posed = self.loaded.posed(self.moment);
        let exported = Exported::new(&posed.mesh, &posed.topology, &tessellated);
        if progress.check().is_err() {
            return Ok(Vec::new());
        }
        let said = exported.write(path).map_err(|error| error.to_string())?;
        Ok(left_out(&tessellated, posed.topology.patches.len()).into_iter().chain(said).collect())
    }

    /// Reads back what is emitted, chunk by chunk. Returns none if it was cancelled.
    fn read(&self, scene: &mut Scene, progress: &Progress) -> Result<Option<Tessellated>, GpuError> {
        let mut out = Tessellated::default();
        let mut append = |chunk: &EmittedChunk| out.append(chunk.vertices, chunk.triangles);
        self.engine.visit_watched(scene, &mut [&mut append], &progress.part(0.0, READING))?;
        Ok(progress.check().is_ok().then_some(out))
    }
}

/// A sentence about patches that aren't in the file, if there are any: somebody who didn't set clipping or culling expects all.
fn left_out(tessellated: &Tessellated, patches: usize) -> Option<String> {
    let mut is_written = vec![false; patches];
    tessellated.vertices.iter().for_each(|vertex| is_written[vertex.patch() as usize] = true);
    let left_out = is_written.iter().filter(|is_written| !**is_written).count();
    let said = || {
        format!(
            "{left_out} of {patches} patches aren't drawn in this view, and aren't in the file. To export all of them, switch off \
             Clipping and Cull back faces (under Advanced)."
        )
    };
    (left_out > 0).then(said)
}
