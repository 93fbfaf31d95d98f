//! Measures the distance of what is shown from its reference surface, on a thread of its own, for the deviation overlay.

use super::measure_job::MeasureError;
use super::walk::Walk;
use geometry::near::Interval;
use geometry::tessellate::Surface;
use gpu::Gpu;
use inspect::measure::{DeviationField, DeviationMeasurement, DeviationTarget, WorstPoint};
use inspect::render::{DEVIATION_PX_SCALE, Scene, deviation_scale};

/// The measurement of the distance to the reference surface, and its last result.
#[derive(Default)]
pub(crate) struct DeviationJob {
    /// What the measurement that was started last depends on.
    of: Option<DeviationBasis>,
    walk: Option<Walk<DeviationField>>,
    /// The last result. While a new measurement is under way, it belongs to the previous inputs.
    pub found: Option<DeviationResult>,
    /// Counts changes of the result.
    pub generation: u64,
}

/// What a result depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DeviationBasis {
    pub tessellation: u64,
    /// Counts reference surfaces.
    pub reference_shape: u64,
    /// The surface whose limit surface is the reference, if none was chosen.
    pub limit: Surface,
}

/// A result. The scene has the samples themselves.
#[derive(Clone, Copy)]
pub(crate) struct DeviationResult {
    pub of: DeviationBasis,
    /// The largest distance, in object units; 0 if nothing was emitted.
    pub largest: Interval,
    /// Where its lower end is; none if nothing was emitted.
    pub worst: Option<WorstPoint>,
    /// Object units.
    pub rms: f64,
    /// Triangles without a colour, because there were too many.
    pub left_out: u64,
}

impl DeviationJob {
    pub(crate) fn is_busy(&self) -> bool {
        self.walk.is_some()
    }

    /// The progress of the measurement, 0 to 1; none if none is under way.
    pub(crate) fn fraction(&self) -> Option<f32> {
        self.walk.as_ref().map(Walk::fraction)
    }

    /// Stops the measurement. The last result stays.
    pub(crate) fn stop(&mut self) {
        if self.walk.take().is_some() {
            self.of = None;
        }
    }

    /// Stops copying, so that the measurement ends without a result. It isn't started again by itself.
    pub(crate) fn give_up(&mut self) {
        self.walk.iter_mut().for_each(Walk::stop_copying);
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
    ) -> Result<(), MeasureError> {
        if self.of != Some(of) {
            self.of = Some(of);
            self.walk = None;
            let (posed, triangles) = (scene.tessellator.posed().clone(), scene.tessellator.totals().1);
            let target = target();
            self.walk = Some(Walk::start(gpu, scene, None, move |parts| {
                let (mesh, topology) = posed.deformed();
                let mut measurement = DeviationMeasurement::new(&target, &mesh, &topology, triangles, parts.wanted);
                parts.visit(&mut [&mut measurement])?;
                measurement.finish().ok()
            })?);
            return Ok(());
        }
        let Some(walk) = &mut self.walk else { return Ok(()) };
        match walk.go_on(gpu, scene)? {
            Some(Ok(Some(field))) => {
                self.walk = None;
                let largest = field.largest();
                let scale = deviation_scale(largest.at_least, scene.ulp);
                scene.set_deviation(gpu, Some((&field, scale)));
                self.generation += 1;
                let (worst, rms, left_out) = (field.worst(), field.rms(), field.left_out);
                self.found = Some(DeviationResult { of, largest, worst, rms, left_out });
            }
            Some(Ok(None)) => self.do_without(gpu, scene),
            Some(Err(stopped)) => {
                self.do_without(gpu, scene);
                return Err(MeasureError::Deviating(stopped));
            }
            None => {}
        }
        Ok(())
    }

    /// Ends a measurement that failed. The picture, which waits for distances, is drawn without them.
    fn do_without(&mut self, gpu: &Gpu, scene: &mut Scene) {
        self.walk = None;
        scene.set_deviation(gpu, Some((&DeviationField::empty(), DEVIATION_PX_SCALE)));
        self.generation += 1;
    }
}
