//! The option `--reference`: compares the picture with a reference picture.

use std::path::PathBuf;

use super::options::within;
use super::{CliError, note};
use inspect::shot::ShotError;

/// The reference, and how much a picture may differ from it.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct ReferenceOptions {
    /// Fail if the picture isn't the same as this one, and write a picture of the difference beside it. If the same adapter,
    /// driver and processor drew both, all px must be equal. With --cameras, a folder, or a name with {} where each view's
    /// name goes
    #[arg(long, value_name = "PNG")]
    pub reference: Option<PathBuf>,
    /// Largest mean difference of a square of 8 x 8 px that passes, in steps of 255, whatever drew the reference; without it,
    /// 1.5 if something else drew it
    #[arg(long, value_name = "STEPS", value_parser = within(0.0..=255.0), requires = "reference")]
    pub threshold: Option<f32>,
}

/// Tells on standard error how pictures compare with their references.
pub(super) fn conclude(all: Vec<Result<String, ShotError>>) -> Result<(), CliError> {
    let count = all.len();
    let mut differing = Vec::new();
    for said in all {
        match said {
            Ok(said) => note(&said),
            Err(error) => differing.push(error),
        }
    }
    if count == 1 {
        return differing.pop().map_or(Ok(()), |error| Err(error.into()));
    }
    differing.iter().for_each(|error| note(&error.to_string()));
    match differing.len() {
        0 => Ok(()),
        different => Err(CliError::ManyDifferent { different, all: count }),
    }
}
