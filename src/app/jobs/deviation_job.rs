//! How far what is shown is from what it should have been, measured beside the window for the overlay.

use std::sync::mpsc::{Receiver, TryRecvError, channel, sync_channel};

use super::background_job::{Stopped, caught, spawn};
use super::measure_job::{Copying, Part, PartKind, Trouble, WAITING, copy_chunk, copy_on, visit};
use crate::gpu::{Gpu, GpuError};
use crate::measure::{DeviationField, DeviationMeasurement, DeviationTarget, WorstPoint};
use crate::progress::Progress;
use crate::render::{DEVIATION_PX_SCALE, Scene, deviation_scale};
use crate::tessellate::{PosedMesh, Surface};

/// What is known about the distance to the truth.
#[derive(Default)]
pub(crate) struct DeviationJob {
    /// What was last asked for.
    of: Option<Of>,
    /// Before the copying: dropped first, so that its thread doesn't take an end of parts for all of them.
    comparing: Option<Comparing>,
    copying: Option<Copying>,
    found: Option<Found>,
    /// Counts results.
    pub generation: u64,
}

/// What a result is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Of {
    pub document: u64,
    pub tessellation: u64,
    /// Tells one truth from the next.
    pub truth: u64,
    /// Whose limit it is held against without one.
    pub limit: Surface,
}

/// A result; the samples themselves are the scene's.
#[derive(Clone, Copy)]
pub(crate) struct Found {
    of: Of,
    /// None if nothing was emitted.
    pub worst: Option<WorstPoint>,
    /// Object units.
    pub rms: f64,
    /// Triangles without a colour, because there were too many.
    pub left_out: u64,
}

impl Found {
    /// Object units; 0 if nothing was emitted.
    pub(crate) fn largest(&self) -> f64 {
        self.worst.map_or(0.0, |worst| worst.value)
    }
}

/// The thread that compares; it gives up when this is dropped.
struct Comparing {
    found: Receiver<Result<DeviationField, Stopped>>,
    wanted: Progress,
}

impl Drop for Comparing {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}

impl DeviationJob {
    /// The last result; of something else while that is measured which is wanted by now.
    pub(crate) fn found(&self) -> Option<&Found> {
        self.found.as_ref()
    }

    /// The result, if it is about this.
    pub(crate) fn found_of(&self, of: Of) -> Option<&Found> {
        self.found.as_ref().filter(|found| found.of == of)
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.comparing.is_some()
    }

    /// The part of all triangles that is measured, 0 to 1, while they are.
    pub(crate) fn fraction(&self) -> Option<f32> {
        self.comparing.as_ref().map(|comparing| comparing.wanted.fraction())
    }

    /// Stops what is under way; what is known stays known.
    pub(crate) fn stop(&mut self) {
        if self.comparing.take().is_some() {
            self.copying = None;
            self.of = None;
        }
    }

    /// Copies no more of what is under way, which then ends without a result, and isn't tried again by itself.
    pub(crate) fn give_up(&mut self) {
        self.copying = None;
    }

    /// Forgets everything, and stops what is under way.
    pub(crate) fn forget(&mut self) {
        *self = Self { generation: self.generation + 1, ..Self::default() };
    }

    /// Goes on measuring, or starts over if that isn't what was asked for last; the scene, whose counts are known, gets
    /// what comes of it.
    ///
    /// # Errors
    /// The device was lost, or measuring this stopped.
    pub(crate) fn go_on(
        &mut self,
        gpu: &Gpu,
        scene: &mut Scene,
        of: Of,
        target: impl FnOnce() -> DeviationTarget,
    ) -> Result<(), Trouble> {
        if self.of != Some(of) {
            self.of = Some(of);
            self.start(gpu, scene, target())?;
            return Ok(());
        }
        copy_on(&mut self.copying, gpu, scene)?;
        match self.comparing.as_ref().map(|comparing| comparing.found.try_recv()) {
            Some(Ok(Ok(field))) => {
                self.comparing = None;
                let scale = deviation_scale(field.worst().map_or(0.0, |worst| worst.value), scene.ulp());
                scene.set_deviation(gpu, Some((&field, scale)));
                self.generation += 1;
                let (worst, rms, left_out) = (field.worst(), field.rms(), field.left_out);
                self.found = Some(Found { of, worst, rms, left_out });
            }
            Some(Ok(Err(stopped))) => {
                self.do_without(gpu, scene);
                return Err(Trouble::Deviating(stopped));
            }
            Some(Err(TryRecvError::Disconnected)) => self.do_without(gpu, scene),
            Some(Err(TryRecvError::Empty)) | None => {}
        }
        Ok(())
    }

    /// It failed: what waits for distances is drawn without.
    fn do_without(&mut self, gpu: &Gpu, scene: &mut Scene) {
        self.comparing = None;
        scene.set_deviation(gpu, Some((&DeviationField::empty(), DEVIATION_PX_SCALE)));
        self.generation += 1;
    }

    fn start(&mut self, gpu: &Gpu, scene: &mut Scene, target: DeviationTarget) -> Result<(), GpuError> {
        self.comparing = None;
        let (parts, received) = sync_channel(WAITING);
        let (sender, found) = channel();
        let wanted = Progress::default();
        let (posed, still_wanted) = (scene.tessellator.posed().clone(), wanted.clone());
        let (triangles, chunks) = (scene.tessellator.totals().1, scene.tessellator.chunk_count());
        spawn(move || {
            let measure = || field(&received, &posed, &target, triangles, &still_wanted);
            let whole = |field: &DeviationField| field.chunks.len() == chunks;
            if let Some(result) = caught(|| measure().filter(whole)).transpose() {
                let _ = sender.send(result);
            }
        });
        // Without a sender the thread knows of the end.
        self.copying = if chunks > 0 { Some(copy_chunk(gpu, scene, 0, parts)?) } else { None };
        self.comparing = Some(Comparing { found, wanted });
        Ok(())
    }
}

/// Measures the parts as they come. `None` if no longer wanted, or the device was lost.
fn field(
    parts: &Receiver<Part>,
    posed: &PosedMesh,
    target: &DeviationTarget,
    triangles: u64,
    wanted: &Progress,
) -> Option<DeviationField> {
    let (mesh, topology) = posed.deformed();
    let mut measurement = DeviationMeasurement::new(target, &mesh, &topology, triangles, wanted);
    for Part(part, readback) in parts {
        let PartKind::Chunk { first_patch, vertex_bytes } = part else { continue };
        visit(first_patch, vertex_bytes, &readback, &mut [&mut measurement])?;
        wanted.check().ok()?;
    }
    wanted.check().ok()?;
    measurement.finish().ok()
}
