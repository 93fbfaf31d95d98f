//! What runs on threads of its own while the window goes on: loading, checking, measuring and writing files.

pub(super) mod background_job;
pub(super) mod chart_job;
pub(super) mod deviation_job;
pub(super) mod document;
pub(super) mod environment_job;
pub(super) mod explain_job;
pub(super) mod export_job;
pub(super) mod given_factors;
pub(super) mod leak_job;
pub(super) mod loading;
pub(super) mod matcap;
pub(super) mod measure_job;
pub(super) mod mesh_checks;
pub(super) mod own_shader_job;
pub(super) mod picture_job;
pub(super) mod silhouette_job;
pub(super) mod stand_in;
pub(super) mod truth;
pub(super) mod walk;
pub(super) mod writing_job;

use load::files::Limits;

use deviation_job::DeviationJob;
use document::Load;
use environment_job::EnvironmentLoad;
use explain_job::ExplainJob;
use given_factors::FactorsJob;
use leak_job::LeakJob;
use matcap::MatcapJob;
use measure_job::MeasureJob;
use silhouette_job::SilhouetteJob;
use truth::TruthLoad;
use writing_job::WritingJob;

/// The jobs that are under way, and the results of measurements.
#[derive(Default)]
pub(super) struct Jobs {
    /// The limits of files that are opened.
    pub limits: Limits,
    pub load: Option<Load>,
    pub truth_load: Option<TruthLoad>,
    pub environment: Option<EnvironmentLoad>,
    pub factors: Option<FactorsJob>,
    pub matcap: Option<MatcapJob>,
    pub measure: MeasureJob,
    pub leaks: LeakJob,
    pub silhouette: SilhouetteJob,
    pub deviation: DeviationJob,
    /// Of the selected patch.
    pub explain: ExplainJob,
    /// The file that is being written, of all but the chart.
    pub writing: Option<WritingJob>,
}
