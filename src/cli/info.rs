//! `pnaen info`: prints what a file holds.

use super::mesh_report::Info;
use super::options::WeldOption;
use super::{CliError, to_json, write_text};
use geometry::progress::Progress;
use inspect::engine;
use load::Source;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(help = super::options::mesh_help(), value_parser = super::options::source())]
    pub file: Source,
    #[command(flatten)]
    pub weld: WeldOption,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    let progress = Progress::default();
    let loaded = engine::load(&args.file, &args.weld.preparation(), &progress)?;
    let info = Info::new(&loaded, &progress)?;
    let text = if args.json { to_json(&info)? } else { info.to_string() };
    Ok(write_text("-".as_ref(), &text)?)
}
