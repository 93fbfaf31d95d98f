//! `pnaen shaders`: writes our shaders for other programs.

use std::path::PathBuf;

use super::options::TessellationOptions;
use super::{CliError, make_folder, options, refuse, write_text};
use geometry::tessellate::Lod;
use inspect::settings::Choice;
use inspect::settings::options::LOD;
use inspect::shader_files::{Language, shader_files};

// LOD by error, which is usual elsewhere, can't be exported.
#[derive(Debug, clap::Args)]
#[command(mut_arg(LOD.name, |lod| lod.default_value(Lod::Uniform.name())))]
pub struct Args {
    #[command(flatten)]
    pub tessellation: TessellationOptions,
    /// Language of the shaders
    #[arg(long, display_order = 0, value_parser = options::choice::<Language>())]
    pub language: Language,
    /// Folder to write into; it is made if it isn't there
    #[arg(short, long, value_name = "DIR", display_order = 0)]
    pub output: PathBuf,
    /// Is refused: only the rules of --surface can be exported
    #[arg(long, value_name = "WGSL", hide = true)]
    pub surface_shader: Option<PathBuf>,
}

/// Runs the command, which was given as this line.
pub(super) fn run(args: &Args, line: &str) -> Result<(), CliError> {
    refuse(
        args.surface_shader.is_some(),
        "--surface-shader can't be exported, only the rules of --surface can: write the shaders of one of them, and put your \
             own rule in its place",
    )?;
    let files = shader_files(args.language, &args.tessellation.0.tessellation, line)?;
    make_folder(&args.output)?;
    Ok(files.iter().try_for_each(|file| write_text(&args.output.join(file.name), &file.text))?)
}
