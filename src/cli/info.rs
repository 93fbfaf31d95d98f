//! `pnaen info`: prints what a file holds.

use std::mem::take;

use super::mesh_report::{Info, PartInfo};
use super::options::WeldOption;
use super::{CliError, to_json, write_text};
use geometry::mesh::weld_previews;
use geometry::progress::Progress;
use inspect::engine;
use load::{LoadError, Source};

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
    let info = info(&args.file, &args.weld)?;
    let text = if args.json { to_json(&info)? } else { info.to_string() };
    write_text("-".as_ref(), &text)
}

/// Gathers the numbers of a mesh, and the warnings of loading it.
fn info(source: &Source, options: &WeldOption) -> Result<Info, LoadError> {
    let progress = Progress::default();
    let mut loaded = engine::load(source, &options.preparation(), &progress)?;
    let mut info = Info::of(&loaded.mesh, &loaded.topology, options.weld, &loaded.warnings, &progress)?;
    info.parts = loaded.parts.iter().map(PartInfo::of).collect();
    (info.variants, info.scenes, info.scene) = (take(&mut loaded.variants), take(&mut loaded.scenes), loaded.scene);
    if loaded.crease_band.width != 0.0 {
        // A weld tolerance applies to the mesh as it was read, before it got its crease band.
        (info.crease_band, info.joins) = (loaded.crease_band, weld_previews(&loaded.read, None, &progress)?);
    }
    Ok(info)
}
