//! Measures the distance of what is shown from its reference surface, on a thread of its own, for the deviation overlay.

use std::sync::mpsc::{Receiver, TryRecvError, channel, sync_channel};

use super::background_job::{Stopped, caught, spawn};
use super::measure_job::{Copying, Part, PartKind, Trouble, WAITING, copy_chunk, copy_on, visit};
use crate::gpu::{Gpu, GpuError};
use crate::measure::{DeviationField, DeviationMeasurement, DeviationTarget, WorstPoint};
use crate::progress::Progress;
use crate::render::{DEVIATION_PX_SCALE, Scene, deviation_scale};
use crate::tessellate::{PosedMesh, Surface};

/// The measurement of the distance to the reference surface, and its last result.
#[derive(Default)]
pub(crate) struct DeviationJob {
    /// What the measurement that was started last depends on.
    of: Option<DeviationBasis>,
    /// Declared before `copying`, so that it is dropped first: if `copying` went first, the channel would close, and the
    /// thread would think that it has everything.
    comparing: Option<Comparing>,
    copying: Option<Copying>,
    found: Option<DeviationResult>,
    /// Counts changes of the result.
    pub generation: u64,
}

/// What a result depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DeviationBasis {
    pub document: u64,
    pub tessellation: u64,
    /// Counts reference surfaces.
    pub truth: u64,
    /// The surface whose limit surface is the reference, if none was chosen.
    pub limit: Surface,
}

/// A result. The scene has the samples themselves.
#[derive(Clone, Copy)]
pub(crate) struct DeviationResult {
    of: DeviationBasis,
    /// None if nothing was emitted.
    pub worst: Option<WorstPoint>,
    /// Object units.
    pub rms: f64,
    /// Triangles without a colour, because there were too many.
    pub left_out: u64,
}

impl DeviationResult {
    /// Object units; 0 if nothing was emitted.
    pub(crate) fn largest(&self) -> f64 {
        self.worst.map_or(0.0, |worst| worst.value)
    }
}

/// The thread that measures. It stops when this is dropped.
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
    /// The last result. While a new measurement is under way, it belongs to the previous inputs.
    pub(crate) fn found(&self) -> Option<&DeviationResult> {
        self.found.as_ref()
    }

    /// The result, if it is about this.
    pub(crate) fn found_of(&self, of: DeviationBasis) -> Option<&DeviationResult> {
        self.found.as_ref().filter(|found| found.of == of)
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.comparing.is_some()
    }

    /// The progress of the measurement, 0 to 1; none if none is under way.
    pub(crate) fn fraction(&self) -> Option<f32> {
        self.comparing.as_ref().map(|comparing| comparing.wanted.fraction())
    }

    /// Stops the measurement. The last result stays.
    pub(crate) fn stop(&mut self) {
        if self.comparing.take().is_some() {
            self.copying = None;
            self.of = None;
        }
    }

    /// Stops copying, so that the measurement ends without a result. It isn't started again by itself.
    pub(crate) fn give_up(&mut self) {
        self.copying = None;
    }

    /// Stops the measurement and forgets the last result.
    pub(crate) fn forget(&mut self) {
        *self = Self { generation: self.generation + 1, ..Self::default() };
    }

    /// Goes on with the measurement, or starts another if `of` has changed. The scene, whose counts must be known, gets the
    /// result.
    ///
    /// # Errors
    /// The device was lost, or the measurement's thread panicked.
    pub(crate) fn go_on(
        &mut self,
        gpu: &Gpu,
        scene: &mut Scene,
        of: DeviationBasis,
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
                self.found = Some(DeviationResult { of, worst, rms, left_out });
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

    /// Ends a measurement that failed. The picture, which waits for distances, is drawn without them.
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
        // Without chunks the sender is dropped, which tells the thread that there are none.
        self.copying = if chunks > 0 { Some(copy_chunk(gpu, scene, 0, parts)?) } else { None };
        self.comparing = Some(Comparing { found, wanted });
        Ok(())
    }
}

/// Measures the parts as they come. Returns `None` if the result is no longer wanted, or the device was lost.
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
