//! The commands, which need neither window nor display. Each has a file of its own; this one has the command line and the errors.

mod adapters;
mod adjacency;
mod camera_and_light_report;
mod chart;
mod check;
pub mod compare;
#[cfg(test)]
mod copied_command_tests;
mod domain;
mod factors;
mod gallery;
mod gate_options;
mod info;
mod material_report;
mod options;
mod output_guard;
mod own_factors_and_surface;
#[cfg(test)]
mod page_tests;
mod posed;
mod render;
mod shaders;
mod shot_options;
mod stability;
mod tessellate;
mod turntable;
mod view_files;

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::{Parser, Subcommand};
use thiserror::Error;

pub(crate) use adapters::AdapterOption;
use output_guard::{file_of, files_of_heights, keep_apart};

pub(crate) use options::{LimitOption, OpeningOptions, SurfaceOptions, WeldOption};
pub(crate) use own_factors_and_surface::{FactorsOption, LodShaderOption, SurfaceShaderOption};
pub use render::{preview, run_with as render_with};
pub use tessellate::run_with as tessellate_with;

use geometry::names::{on_one_line, shown};
use geometry::progress::{Cancelled, Progress};
use gpu::GpuError;
use inspect::engine::{Loaded, Preparation};
use inspect::shader_files::ShaderError;
use inspect::shot::files::{file_error, read_bytes, read_text, to_json, write_bytes, write_text};
use inspect::shot::{ShotError, given};
use inspect::user_shader::UserShaderError;
use load::environment_file::EnvironmentError;
use load::files::file_reason;
use load::selection::choice;
use load::{LoadError, MatcapError, Source};

/// Shows what tessellation does to a mesh in a window; commands write pictures, meshes and numbers instead
#[derive(Debug, Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Mesh that the window opens: a mesh file, or a shape made in code such
    /// as shape:cube-split, or shape:torus@2 (finer)
    #[arg(value_parser = options::source())]
    pub file: Option<Source>,
    #[command(flatten)]
    pub opening: OpeningOptions,
    #[command(flatten)]
    pub limit: LimitOption,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw the picture that the window shows, into a PNG file
    Render(render::Args),
    /// Draw pictures from all around, as numbered PNG files or an animated GIF
    ///
    /// The camera turns once around the vertical axis through the point that it looks at. LOD follows the camera unless
    /// --lod-camera is given.
    Turntable(turntable::Args),
    /// Write the tessellated mesh
    Tessellate(tessellate::Args),
    /// Print the tessellator's domain points and triangles for given factors
    Domain(domain::Args),
    /// Write the factors that the hull shader gives every patch, before the tessellator clamps and rounds them
    Factors(factors::Args),
    /// Write the index buffer of PN-AEN patches, or compare one with the mesh
    ///
    /// Indices refer to the mesh's distinct corners, which the JSON lists: one for each combination of position, normal and
    /// uv. Patches are the mesh's triangles in order, without degenerate ones; the JSON gives each patch's triangle.
    Adjacency(adjacency::Args),
    /// Write the shaders of a tessellation for other programs, in HLSL, GLSL or WGSL, with a page on how to run them
    ///
    /// Without --lod they have uniform LOD, since LOD by error can't be exported.
    Shaders(shaders::Args),
    /// Compare another program's tessellated mesh with ours
    ///
    /// Nothing but positions and triangles is looked at, in any order. The exit code is 0 if they are the same, and 1 if not.
    Compare(compare::Args),
    /// Run cases that break tessellators, and report which methods pass and which fail
    ///
    /// Failures of the published methods are printed, but don't make the command fail: the exit code is 1 only if something
    /// fails that this program promises.
    Stability(stability::Args),
    /// Draw every technique side by side, and write a page that explains each and names its source
    Gallery(gallery::Args),
    /// Time every method at many settings, measure its error, and chart error against time and triangles
    ///
    /// Errors are measured against a reference surface: a shape's exact surface, or the mesh of --reference-surface. Without either, errors
    /// are distances in px on screen between the triangles and the surface that they approximate, and different surfaces are
    /// not compared with each other. Ctrl-C ends the command after the current setting: the CSV and the picture have what was
    /// done, and the exit code is 130. A second Ctrl-C ends it at once.
    Chart(chart::Args),
    /// Check a folder of assets against quality gates
    ///
    /// The exit code is 1 if an asset fails a gate or can't be checked. Ctrl-C ends the command after the assets that are being
    /// checked: the report has what was done, and the exit code is 130. A second Ctrl-C ends it at once.
    Check(check::Args),
    /// Print what a file holds, and which parts of it are left out
    Info(info::Args),
    /// List the graphics adapters
    Adapters,
}

/// Why a command failed, in one sentence.
#[derive(Debug, Error)]
pub enum CliError {
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Shot(#[from] ShotError),
    #[error(transparent)]
    Environment(#[from] EnvironmentError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Csv(#[from] load::csv_vertices::CsvError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error(transparent)]
    Matcap(#[from] MatcapError),
    #[error(transparent)]
    UserShader(#[from] UserShaderError),
    #[error("{path}: there is no folder {folder} to write it in; make it first")]
    NoFolder { path: String, folder: String },
    #[error("{path} is {by} by the same command, so it isn't overwritten; choose another name")]
    Taken { path: String, by: &'static str },
    #[error("{0}")]
    Usage(&'static str),
    #[error(
        "even at a tolerance of {largest} px there are {least} triangles, more than {most}: allow more, or use a mesh with \
         fewer"
    )]
    Budget { most: u64, least: u64, largest: f32 },
    #[error("{file} has triangles 0 to {last}, and no triangle {triangle}")]
    NoTriangle { file: String, last: usize, triangle: u32 },
    #[error(
        "{} has no camera {}; {}",
        shown(mesh),
        shown(wanted),
        choice(known, "it has no cameras, so omit --file-camera")
    )]
    NoCamera { mesh: String, wanted: String, known: Vec<String> },
    #[error("{view}: {error}")]
    View { view: String, error: Box<CliError> },
    #[error(transparent)]
    ViewProjection(#[from] inspect::render::view_projection::ViewProjectionError),
    #[error("{different} of {all} pictures differ from their references")]
    ManyDifferent { different: usize, all: usize },
    #[error("triangle {triangle} of {file} is degenerate: it has no patch")]
    NoPatch { file: String, triangle: u32 },
    #[error("{path}: {fault}")]
    Indices { path: String, fault: inspect::adjacency_file::IndicesFault },
    #[error("{path}: {different} of {patches} patches {}: {meanings}", if *different == 1 { "differs" } else { "differ" })]
    OtherIndices { path: String, different: usize, patches: usize, meanings: String },
    #[error(
        "{file}: --corners needs one height image over all triangles, which its materials don't have: name one with --height"
    )]
    NotOneImage { file: String },
    #[error("{file} has no triangles to compare; choose another file")]
    NothingToCompare { file: String },
    #[error(
        "{file}: our tessellation would have {triangles} triangles, more than the {most} that are compared: lower the factor"
    )]
    TooFine { file: String, triangles: u64, most: u64 },
    #[error("{theirs} isn't our tessellation: {count} {} above", if *count == 1 { "difference is" } else { "differences are" })]
    NotTheSame { theirs: String, count: usize },
    #[error("no picture is drawn, since coordinates are too large: omit -o, or scale the other program's output")]
    NothingToDraw,
    #[error("{file} has no animation \"{name}\": it has {has}")]
    NoAnimation { file: String, name: String, has: String },
    #[error("interrupted after {done} of {all} {what}: what was done is written")]
    Interrupted { done: usize, all: usize, what: &'static str },
    #[error(transparent)]
    Shaders(#[from] ShaderError),
    #[error("{}", .0.join("; "))]
    Gates(Vec<String>),
    #[error("{0}")]
    Check(String),
    #[error("there is nothing to check: no meshes found in these folders; name others")]
    NoAssets,
    #[error("the output could not be written: {0}")]
    Output(std::io::Error),
}

/// Runs a command. A closed pipe is no failure: the reader wants no more.
pub fn run(command: Command) -> ExitCode {
    let line = given(std::env::args_os());
    let result = match command {
        Command::Render(args) => render::run(&args, &line),
        Command::Turntable(args) => turntable::run(&args, &line),
        Command::Tessellate(args) => tessellate::run(&args),
        Command::Domain(args) => domain::run(&args),
        Command::Factors(args) => factors::run(&args),
        Command::Adjacency(args) => adjacency::run(&args),
        Command::Shaders(args) => shaders::run(&args, &line),
        Command::Compare(args) => compare::run(&args),
        Command::Stability(args) => stability::run(&args),
        Command::Gallery(args) => gallery::run(&args),
        Command::Chart(args) => chart::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Adapters => adapters::run(),
    };
    let Err(error) = result else { return ExitCode::SUCCESS };
    let code = match &error {
        CliError::Output(error) | CliError::Shot(ShotError::Output(error))
            if error.kind() == std::io::ErrorKind::BrokenPipe =>
        {
            return ExitCode::SUCCESS;
        }
        CliError::Usage(_) | CliError::Shaders(ShaderError::Unexportable { .. }) => 2,
        CliError::Interrupted { .. } => INTERRUPTED,
        _ => 1,
    };
    match &error {
        CliError::Gates(sentences) => sentences.iter().for_each(|sentence| note(sentence)),
        error => note(&error.to_string()),
    }
    ExitCode::from(code)
}

/// Prints an error on standard error, and returns the exit code of a failure.
pub fn fail(error: &dyn std::fmt::Display) -> ExitCode {
    note(&error.to_string());
    ExitCode::FAILURE
}

/// Refuses options that can't be together, or that need others.
fn refuse(is_wrong: bool, why: &'static str) -> Result<(), CliError> {
    if is_wrong { Err(CliError::Usage(why)) } else { Ok(()) }
}

/// Makes a folder, unless it is there.
fn make_folder(folder: &Path) -> Result<(), CliError> {
    Ok(std::fs::create_dir_all(folder).map_err(|error| file_error(folder, "made", &file_reason(&error)))?)
}

/// Loads a mesh for a command. Standard error tells what was left out or repaired.
fn load(source: &Source, preparation: &Preparation) -> Result<Loaded, CliError> {
    let loaded = inspect::engine::load(source, preparation, &Progress::default())?;
    warn(&loaded.warnings);
    if preparation.heights.is_none() && loaded.mesh.heights.is_some() {
        note("the file has height images; --displacement on displaces by them");
    }
    Ok(loaded)
}

/// Like [`load()`], but fails if a file to be written is one that the mesh's file refers to.
fn load_apart(source: &Source, preparation: &Preparation, written: &[Option<&Path>]) -> Result<Loaded, CliError> {
    let loaded = load(source, preparation)?;
    keep_apart(loaded.files.iter().map(|path| Some(path.as_path())), written.iter().copied())?;
    Ok(loaded)
}

/// The exit code after Ctrl-C: 128 + SIGINT, as shells return it.
const INTERRUPTED: u8 = 130;

/// Returns a flag that Ctrl-C sets. A second Ctrl-C ends the program. `piece` is what the command ends after, such as "setting".
fn stop_on_interrupt(piece: &'static str) -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = stop.clone();
    // Without a handler, Ctrl-C ends the program at once, and what was written until then stays.
    let _ = ctrlc::set_handler(move || {
        if set.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        note(&format!("ending after this {piece}; Ctrl-C again ends at once"));
    });
    stop
}

/// Reports the progress of a long command on standard error, at most once a second.
struct ProgressPrinter(Instant);

impl ProgressPrinter {
    const EVERY: Duration = Duration::from_secs(1);

    fn new() -> Self {
        Self(Instant::now())
    }

    fn print(&mut self, text: impl FnOnce() -> String) {
        if self.0.elapsed() >= Self::EVERY {
            self.0 = Instant::now();
            note(&text());
        }
    }
}

/// Says something on standard error, which may be closed; then nobody reads it.
fn note(text: &str) {
    let _ = writeln!(std::io::stderr(), "pnaen: {}", on_one_line(text));
}

fn warn(warnings: &[String]) {
    warnings.iter().for_each(|warning| note(&format!("warning: {warning}")));
}
