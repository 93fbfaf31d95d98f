//! Explains the selected patch while the window goes on.

use super::background_job::{BackgroundJob, Stopped};
use geometry::tessellate::{ExplainedPatch, Inputs, PatchFactors, PosedMesh, explain_patch};

/// A patch as it was emitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EmittedPatch {
    pub document: u64,
    /// The tessellation's number, which is another in every pose.
    pub tessellation: u64,
    pub patch: u32,
    pub inputs: Inputs,
    pub factors: PatchFactors,
}

/// The explanation of one patch.
#[derive(Default)]
pub(crate) struct ExplainJob {
    /// What was last asked for.
    of: Option<EmittedPatch>,
    under_way: Option<BackgroundJob<ExplainedPatch>>,
    found: Option<ExplainedPatch>,
}

impl ExplainJob {
    /// Returns the explanation of a patch once it is there, and starts to make it if nobody has.
    pub(crate) fn of(
        &mut self,
        context: &egui::Context,
        posed: &PosedMesh,
        wanted: EmittedPatch,
    ) -> Option<&ExplainedPatch> {
        if self.of != Some(wanted) && self.under_way.is_none() {
            let posed = posed.clone();
            let explain = move || {
                let (mesh, topology) = posed.deformed();
                explain_patch(&mesh, &topology, &wanted.inputs, wanted.patch, wanted.factors)
            };
            (self.of, self.found) = (Some(wanted), None);
            self.under_way = Some(BackgroundJob::start(context, explain));
        }
        self.found.as_ref().filter(|_| self.of == Some(wanted))
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.under_way.is_some()
    }

    /// Takes an explanation that has been made.
    ///
    /// # Errors
    /// Making it panicked. It isn't tried again for the same patch.
    pub(crate) fn take(&mut self) -> Result<(), Stopped> {
        if let Some(result) = self.under_way.as_ref().and_then(BackgroundJob::take) {
            self.under_way = None;
            self.found = Some(result?);
        }
        Ok(())
    }

    /// Lets a job that is under way repaint another window.
    pub(crate) fn go_on_in(&mut self, context: &egui::Context) {
        self.under_way = self.under_way.take().map(|job| job.waking(context));
    }
}
