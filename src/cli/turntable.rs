//! `pnaen turntable`: pictures from all around, as numbered PNG files or as one animated GIF.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser};

use super::options::whole;
use super::shot_options::ShotOptions;
use super::{AdapterOption, CliError, ProgressPrinter, refuse};
use geometry::progress::Progress;
use inspect::engine::Engine;
use inspect::export::ending;
use inspect::shot::{FPS, FRAMES, Turn};
use load::Source;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(help = super::options::mesh_help(), value_parser = super::options::source())]
    pub file: Source,
    /// Folder for numbered PNG files, which is made if it isn't there; or a .gif file
    #[arg(short, long, value_name = "DIR|OUT.gif", value_parser = PathBufValueParser::new().try_map(place))]
    pub output: PathBuf,
    /// Number of pictures in one turn, 2 to 3600
    #[arg(long, value_name = "N", default_value_t = Turn::default().frames, value_parser = whole(FRAMES))]
    pub frames: u32,
    /// Pictures a second in a GIF, 1 to 50
    #[arg(long, value_name = "FPS", default_value_t = Turn::default().fps, value_parser = whole(FPS))]
    pub fps: u32,
    #[command(flatten)]
    pub shot: ShotOptions,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

pub(super) fn run(args: &Args, line: &str) -> Result<(), CliError> {
    let turn = Turn { frames: args.frames, fps: args.fps };
    let written = turn.files(&args.output);
    let written: Vec<_> = written.iter().map(|path| Some(path.as_path())).collect();
    args.shot.check(&args.file, &[], &written)?;
    let stays = args.shot.surface.view.view_projection.is_some();
    refuse(stays, "--view-projection is one view, and a turntable turns its camera: use --camera")?;
    let (subject, _) = args.shot.subject(&args.file, &written)?;
    let mut shot = args.shot.shot(Engine::chosen(&args.adapter.choice())?, subject)?;
    shot.report_user_shaders()?;
    let mut progress_printer = ProgressPrinter::new();
    let mut say = |frame| progress_printer.print(|| format!("picture {} of {}", frame + 1, turn.frames));
    Ok(turn.write(&mut shot, |_| line.to_owned(), &args.output, &Progress::new(), &mut say)?)
}

/// Parses the path of a folder or a GIF file.
fn place(path: PathBuf) -> Result<PathBuf, String> {
    match ending(&path).as_str() {
        other @ ("png" | "apng" | "jpg" | "jpeg" | "webp" | "mp4" | "webm" | "avi" | "mov") => {
            Err(format!("a turntable is a .gif file or a folder of PNG files, not .{other}"))
        }
        _ => Ok(path),
    }
}
