//! `pnaen info`: what a file holds.

use super::{CliError, to_json, write_text};
use crate::engine::load;
use crate::mesh::{Info, Progress, Source};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A .gltf or .glb file, or a shape made in code such as shape:cube-split
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    /// As JSON
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &Args) -> Result<(), CliError> {
    // Its warnings are among what is said.
    let loaded = load(&args.file, &Progress::default())?;
    let info = Info::of(&loaded.mesh, &loaded.topology);
    let text = if args.json { to_json(&info)? } else { info.to_string() };
    write_text("-".as_ref(), &text)
}
