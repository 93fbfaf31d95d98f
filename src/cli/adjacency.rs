//! `pnaen adjacency`: PN-AEN's index buffer.

use std::path::PathBuf;

use serde::Serialize;

use super::{CliError, WeldOption, load, write_text};
use crate::mesh::{Source, adjacency};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A .gltf or .glb file, or a shape made in code such as shape:cube-split
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    #[command(flatten)]
    pub weld: WeldOption,
    /// Indices a patch: 9 (corners and the neighbours' corners), or 12 (and dominant corners)
    #[arg(long, default_value_t = 9, value_parser = indices)]
    pub indices: u32,
    /// File to write, JSON (- for standard output)
    #[arg(short, long, value_name = "OUT.json")]
    pub output: PathBuf,
}

fn indices(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| [9, 12].contains(n)).ok_or_else(|| "expected 9 or 12".into())
}

#[derive(Serialize)]
struct Adjacency {
    indices_per_patch: u32,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    patches: Vec<Vec<u32>>,
}

pub fn run(args: &Args) -> Result<(), CliError> {
    let loaded = load(&args.file, args.weld)?;
    let (corners, topology) = (&loaded.mesh.corners, &loaded.topology);
    let flat = if args.indices == 12 { adjacency::twelve_all(topology) } else { adjacency::nine_all(topology) };
    let adjacency = Adjacency {
        indices_per_patch: args.indices,
        positions: corners.iter().map(|c| c.position.to_array()).collect(),
        normals: corners.iter().map(|c| c.normal.to_array()).collect(),
        patches: flat.chunks(args.indices as usize).map(<[u32]>::to_vec).collect(),
    };
    let text = serde_json::to_string(&adjacency).map_err(|error| CliError::Output(error.into()))?;
    write_text(&args.output, &(text + "\n"))
}
