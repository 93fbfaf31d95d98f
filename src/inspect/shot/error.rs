//! Why a picture could not be drawn, measured or written.

use geometry::progress::Cancelled;
use gpu::GpuError;
use load::LoadError;
use thiserror::Error;

use super::picture_comparison::CompareError;
use crate::export::ExportError;
use crate::plot::ChartError;

/// Why a picture could not be drawn, measured, compared or written, in one sentence.
#[derive(Debug, Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum ShotError {
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error(transparent)]
    Chart(#[from] ChartError),
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error("{path}: could not be {doing} ({reason})")]
    File { path: String, doing: &'static str, reason: String },
    #[error("{reference}: {reason}")]
    Reference { reference: String, reason: CompareError },
    #[error("{picture} differs from {reference}: {how}{see}; if this is meant, draw the reference again")]
    Different { picture: String, reference: String, how: String, see: String },
    #[error("{path}, line {line}: {reason}")]
    Line { path: String, line: usize, reason: String },
    #[error("{path}: {reason}")]
    Clash { path: String, reason: String },
    #[error(
        "{path}: the factors of patch {triangle} are not all equal, as subtriangulation needs them: choose another \
         --partitioning"
    )]
    Uneven { path: String, triangle: u32 },
    #[error("the output could not be written: {0}")]
    Output(std::io::Error),
}
