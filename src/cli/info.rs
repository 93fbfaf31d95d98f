//! `pnaen info`: what a file holds.

use super::options::WeldOption;
use super::{CliError, to_json, write_text};
use crate::mesh::{Info, LoadError, Progress, Source, Topology};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A .gltf or .glb file, or a shape made in code such as shape:cube-split
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    #[command(flatten)]
    pub weld: WeldOption,
    /// As JSON
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &Args) -> Result<(), CliError> {
    let info = info(&args.file, args.weld.weld)?;
    let text = if args.json { to_json(&info)? } else { info.to_string() };
    write_text("-".as_ref(), &text)
}

/// Its warnings are among what is said.
fn info(source: &Source, weld: f32) -> Result<Info, LoadError> {
    let progress = Progress::default();
    let mesh = source.load(&progress)?;
    let topology = Topology::build_within(&mesh, weld, &progress)?;
    Ok(Info::of(&mesh, &topology, weld, &progress)?)
}
