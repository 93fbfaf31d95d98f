//! The options `--fail-on` and `--evidence`: gates, and pictures of what they found.

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, TypedValueParser};

use super::options::Listed;
use super::{CliError, make_folder, refuse};
use geometry::progress::Progress;
use inspect::gates::{Gate, GateKind, Judgement};
use inspect::settings::Choice;
use inspect::shot::{Shot, write_picture};

#[derive(Clone, Debug, Default, clap::Args)]
pub struct GateOptions {
    #[command(flatten)]
    pub gates: FailOnOption,
    /// Folder for a picture of the worst place of each gate that failed; made if it isn't there. Pictures are named after the
    /// output (of stability: the case) and the gate
    #[arg(long, value_name = "DIR", requires = "fail_on")]
    pub evidence: Option<PathBuf>,
}

#[derive(Clone, Debug, Default, clap::Args)]
pub struct FailOnOption {
    /// Fail (exit code 1) if one of these is found; NAME:N allows up to N of any. A gate that can't be judged fails: leaks of an
    /// open mesh
    #[arg(long, value_name = "GATE,..", value_delimiter = ',', value_parser = gate())]
    pub fail_on: Vec<Gate>,
}

fn gate() -> impl TypedValueParser<Value = Gate> {
    let names = GateKind::ALL.map(|kind| PossibleValue::new(kind.placeholder()).help(kind.label()));
    Listed { parser: str::parse::<Gate>, names: names.into() }
}

impl FailOnOption {
    /// Whether there is a gate of this kind.
    pub(super) fn has(&self, kind: GateKind) -> bool {
        self.fail_on.iter().any(|gate| gate.kind == kind)
    }
}

impl GateOptions {
    /// Refuses what needs the device that draws, where the CPU computes.
    pub(super) fn check(&self, is_on_cpu: bool) -> Result<(), CliError> {
        refuse(
            is_on_cpu && (self.evidence.is_some() || self.gates.has(GateKind::Leaks) || self.gates.has(GateKind::Pops)),
            "--fail-on leaks, --fail-on pops and --evidence need --device gpu, which draws",
        )
    }

    /// Writes pictures of the failed gates' worst places, if they were asked for, into a folder that is made if it isn't there;
    /// none of a gate that is about no place. `stem` begins their names.
    pub(super) fn write_evidence(&self, shot: &mut Shot, judged: &[Judgement], stem: &Path) -> Result<(), CliError> {
        let Some(folder) = self.evidence.as_deref() else { return Ok(()) };
        let stem = stem.file_stem().unwrap_or_default().to_string_lossy();
        for judgement in judged.iter().filter(|judgement| !judgement.passed) {
            let Some(picture) = shot.evidence(judgement, &Progress::new())? else { continue };
            make_folder(folder)?;
            write_picture(&folder.join(format!("{stem}-{}.png", judgement.kind.name())), &picture.into())?;
        }
        Ok(())
    }
}

/// Returns a sentence for each gate that failed on the mesh with this name.
pub(super) fn failures(name: &str, judged: &[Judgement]) -> Vec<String> {
    let failed = judged.iter().filter(|judgement| !judgement.passed);
    failed.map(|judgement| judgement.sentence_of(name)).collect()
}
