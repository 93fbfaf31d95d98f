//! What runs on threads of its own while the window goes on: loading, checking and measuring.

pub(super) mod background_job;
pub(super) mod chart_job;
pub(super) mod deviation_job;
pub(super) mod document;
pub(super) mod explain_job;
pub(super) mod export_job;
pub(super) mod loading;
pub(super) mod measure_job;
pub(super) mod mesh_checks;
pub(super) mod truth;

use crate::files::Limits;

use background_job::BackgroundJob;
use deviation_job::DeviationJob;
use document::Load;
use explain_job::ExplainJob;
use export_job::ExportJob;
use measure_job::MeasureJob;
use truth::TruthLoad;

/// The jobs that are under way, and the results of measurements.
#[derive(Default)]
pub(super) struct Jobs {
    /// The limits of files that are opened.
    pub limits: Limits,
    pub load: Option<Load>,
    pub truth_load: Option<TruthLoad>,
    pub measure: MeasureJob,
    pub deviation: DeviationJob,
    /// Of the selected patch.
    pub explain: ExplainJob,
    pub export: Option<ExportJob>,
    /// The job that writes a picture. It returns a sentence: what was written, or as an error why nothing was.
    pub picture_file: Option<BackgroundJob<Result<String, String>>>,
}
