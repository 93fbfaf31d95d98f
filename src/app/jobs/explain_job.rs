//! Explains the selected patch while the window goes on.

use super::job_list::Work;
use crate::app::App;
use geometry::tessellate::{ExplainedPatch, Inputs, PatchFactors, explain_patch};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EmittedPatch {
    /// The tessellation's number, which is another in every pose.
    pub tessellation: u64,
    pub patch: u32,
    pub inputs: Inputs,
    pub factors: PatchFactors,
}

/// The patch that an explanation was last asked for, and the explanation once it is made.
pub(crate) type Explanation = Option<(EmittedPatch, Option<ExplainedPatch>)>;

impl App {
    /// Starts to explain a patch, unless that was done already. One that is being explained comes first.
    pub(in crate::app) fn explain(&mut self, context: &egui::Context, wanted: EmittedPatch) {
        let Some(document) = &mut self.document else { return };
        let is_requested = document.explanation.as_ref().is_some_and(|(asked, _)| *asked == wanted);
        if is_requested || self.jobs.has(Work::Explanation) {
            return;
        }
        document.explanation = Some((wanted, None));
        let posed = document.scene.tessellator.posed().clone();
        let explain = move |_: &_| {
            let (mesh, topology) = posed.deformed();
            explain_patch(&mesh, &topology, &wanted.inputs, wanted.patch, wanted.factors)
        };
        self.jobs.start(context, Work::Explanation, String::new(), explain, move |app, _, ended| match ended {
            Ok(found) => {
                if let Some(document) = &mut app.document {
                    document.explanation = Some((wanted, Some(found)));
                }
            }
            Err(stopped) => {
                app.dialogs.error = Some(format!("explaining the patch {stopped}; another patch starts it again"));
            }
        });
    }

    /// The explanation of a patch, once it is made.
    pub(in crate::app) fn explained(&self, wanted: &EmittedPatch) -> Option<&ExplainedPatch> {
        let (asked, found) = self.document.as_ref()?.explanation.as_ref()?;
        found.as_ref().filter(|_| asked == wanted)
    }
}
