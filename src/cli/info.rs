//! `pnaen info`: prints what a file holds.

use super::mesh_report::Info;
use super::options::WeldOption;
use super::{CliError, to_json, write_text};
use geometry::progress::Progress;
use inspect::engine;
use load::Source;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A .gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf file, or a shape made in code such as shape:cube-split, or
    /// shape:torus@2 (finer)
    #[arg(value_parser = super::options::source())]
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
