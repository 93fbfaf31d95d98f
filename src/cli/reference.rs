//! The option `--reference`: compares the picture with a reference picture.

use std::io::Write;
use std::path::PathBuf;

use super::CliError;
use super::options::steps;
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
    #[arg(long, value_name = "STEPS", value_parser = steps, requires = "reference")]
    pub threshold: Option<f32>,
}

/// Tells on standard error how pictures compare with their references.
pub(super) fn conclude(all: Vec<Result<String, ShotError>>) -> Result<(), CliError> {
    let count = all.len();
    let mut differing = Vec::new();
    for said in all {
        match said {
            Ok(said) => {
                let _ = writeln!(std::io::stderr(), "pnaen: {said}");
            }
            Err(error) => differing.push(error),
        }
    }
    if count == 1 {
        return differing.pop().map_or(Ok(()), |error| Err(error.into()));
    }
    for error in &differing {
        let _ = writeln!(std::io::stderr(), "pnaen: {error}");
    }
    match differing.len() {
        0 => Ok(()),
        different => Err(CliError::ManyDifferent { different, all: count }),
    }
}
