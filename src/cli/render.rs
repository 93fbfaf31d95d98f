//! `pnaen render`: draws the window's picture without the window.

use std::path::{Path, PathBuf};

use super::gate_options::{GateOptions, pass};
use super::options::{PictureOptions, TessellationOptions};
use super::picture_file::{Stamp, write_stamped};
use super::shot::StatsWanted;
use super::shot_options::ShotOptions;
use super::{AdapterOption, CliError, LimitOption, SurfaceOptions, WeldOption, options, reference};
use crate::engine::Engine;
use crate::gpu::GpuError;
use crate::load::Source;
use crate::progress::Progress;
use crate::settings::Settings;

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// A .gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf file, or a shape made in code such as shape:cube-split, or
    /// shape:torus@2 (finer)
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    /// Picture to write, a PNG file
    #[arg(short, long, value_name = "OUT.png", value_parser = options::picture())]
    pub output: PathBuf,
    #[command(flatten)]
    pub shot: ShotOptions,
    /// Write statistics and timings as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Whether stats include the largest distance on screen between the triangles and the surface, sampled on the CPU
    #[arg(long, value_name = "BOOL", default_value_t = true, action = clap::ArgAction::Set)]
    pub measure_error: bool,
    /// Fail if the picture differs from this one by more than the threshold, and write a picture of the difference beside it
    #[arg(long, value_name = "PNG")]
    pub reference: Option<PathBuf>,
    /// Largest difference that passes: 0 for equal pictures, 1 for nothing in common (1 minus structural similarity)
    #[arg(long, value_name = "T", default_value_t = 0.01, value_parser = options::threshold)]
    pub threshold: f64,
    #[command(flatten)]
    pub gates: GateOptions,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

impl Args {
    /// The arguments that draw what the window shows when it opens with these settings.
    pub(crate) fn preview(
        file: Source,
        settings: Settings,
        limit: LimitOption,
        adapter: AdapterOption,
        output: &Path,
    ) -> Self {
        let tessellation = TessellationOptions { tessellation: settings.tessellation, displacement: None };
        let weld = WeldOption { limit, ..WeldOption::default() };
        let surface = SurfaceOptions { tessellation, weld, ..SurfaceOptions::default() };
        Self {
            file,
            output: output.to_owned(),
            shot: ShotOptions { surface, picture: PictureOptions(settings), ..ShotOptions::default() },
            stats: None,
            measure_error: true,
            reference: None,
            threshold: 0.01,
            gates: GateOptions::default(),
            adapter,
        }
    }
}

/// Runs the command, which was given as this line.
pub(super) fn run(args: &Args, line: &str) -> Result<(), CliError> {
    run_with(args, line, || Engine::chosen(&args.adapter.choice()))
}

/// Like [`run`], with an engine that is made once the arguments have been checked.
///
/// # Errors
/// Those of the command.
pub(crate) fn run_with(
    args: &Args,
    line: &str,
    engine: impl FnOnce() -> Result<Engine, GpuError>,
) -> Result<(), CliError> {
    let written = [Some(&*args.output), args.stats.as_deref()];
    args.shot.check(&args.file, args.reference.as_deref(), &written)?;
    let reference = args.reference.as_deref().map(reference::read).transpose()?;
    let (subject, factors_file) = args.shot.subject(&args.file, &written)?;
    let mut shot = args.shot.shot(engine()?, subject)?;
    let stats = args.stats.as_ref().map(|_| StatsWanted { error: args.measure_error });
    let picture = shot.picture(stats, &Progress::new())?;
    write_stamped(&args.output, &picture, &Stamp { command: line, settings: shot.settings() })?;
    let tolerance_px = args.shot.surface.tessellation().tolerance;
    let judged = shot.judge(&args.gates.gates.fail_on, tolerance_px, &Progress::new())?;
    if let Some(path) = args.stats.as_deref() {
        shot.write_stats(factors_file, path)?;
    }
    args.gates.write_evidence(&mut shot, &judged, &args.output)?;
    let passed = pass(&args.file, &judged);
    match args.reference.as_deref().zip(reference) {
        Some((path, reference)) => {
            let compared = reference::compare_with(&args.output, &picture, path, &reference, args.threshold);
            both(passed, compared)
        }
        None => passed,
    }
}

/// Fails if either does, with the sentences of both.
fn both(gates: Result<(), CliError>, compared: Result<(), CliError>) -> Result<(), CliError> {
    match (gates, compared) {
        (Err(CliError::Gates(mut sentences)), Err(different)) => {
            sentences.push(different.to_string());
            Err(CliError::Gates(sentences))
        }
        (gates, compared) => gates.and(compared),
    }
}
