//! `pnaen render`: draws the window's picture without the window.

use std::path::{Path, PathBuf};

use super::gate_options::{GateOptions, failures};
use super::options::{CamerasOption, Declared};
use super::shot_options::ShotOptions;
use super::view_files::{View, ViewFiles};
use super::{AdapterOption, CliError, LimitOption, OpeningOptions, SurfaceOptions, note, options, to_json, write_text};
use geometry::progress::Progress;
use gpu::GpuError;
use inspect::engine::Engine;
use inspect::export::ending;
use inspect::render::Camera;
use inspect::settings::Settings;
use inspect::shot::{Reference, Shot, ShotError, Stats, StatsWanted, given};
use load::Source;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(help = super::options::mesh_help(), value_parser = super::options::source())]
    pub file: Source,
    /// Picture to write, a PNG file, or a report on it, an .html file. With --cameras, a folder, or a name with {} where each view's name goes
    #[arg(short, long, value_name = "OUT.png", value_parser = options::picture_or_page())]
    pub output: PathBuf,
    #[command(flatten)]
    pub shot: ShotOptions,
    #[command(flatten)]
    pub cameras: CamerasOption,
    /// Write statistics and timings as JSON (- for standard output). With --cameras, an array with one object for each view
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Whether stats include the largest distance on screen between the triangles and the surface, sampled on the CPU
    #[arg(long, value_name = "BOOL", default_value_t = true, action = clap::ArgAction::Set)]
    pub measure_error: bool,
    /// Fail if the picture isn't the same as this one, and write a picture of the difference beside it. If the same adapter,
    /// driver and processor drew both, all px must be equal. With --cameras, a folder, or a name with {} where each view's
    /// name goes
    #[arg(long, value_name = "PNG")]
    pub reference: Option<PathBuf>,
    /// Largest mean difference of a square of 8 x 8 px that passes, in steps of 255, whatever drew the reference; without it,
    /// 1.5 if something else drew it
    #[arg(long, value_name = "STEPS", value_parser = options::within(0.0..=255.0), requires = "reference")]
    pub threshold: Option<f32>,
    #[command(flatten)]
    pub gates: GateOptions,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

/// The ending of pictures.
const ENDINGS: &[&str] = &["png", "html"];

/// Writes the picture that the window would have shown, for machines without a display.
pub fn preview(
    source: Option<Source>,
    opening: &OpeningOptions,
    limit: LimitOption,
    adapter: AdapterOption,
    output: &Path,
) -> Result<(), CliError> {
    let settings = if source.is_some() { Settings::opening() } else { Settings::greeting() };
    let mut surface = SurfaceOptions::default();
    surface.tessellation.0.tessellation = settings.tessellation;
    surface.weld.limit = limit;
    surface.weld.import.0 = opening.import(surface.weld.import.0);
    surface.weld.parts = opening.parts.clone();
    let args = Args {
        file: source.unwrap_or_default(),
        output: output.to_owned(),
        shot: ShotOptions { surface, picture: Declared(settings), ..ShotOptions::default() },
        stats: None,
        measure_error: true,
        cameras: CamerasOption::default(),
        reference: None,
        threshold: None,
        gates: GateOptions::default(),
        adapter,
    };
    run(&args, &given(std::env::args_os()))
}

/// Runs the command, which was given as this line.
pub(super) fn run(args: &Args, line: &str) -> Result<(), CliError> {
    run_with(args, line, || Engine::chosen(&args.adapter.choice()))
}

/// Like [`run`], with an engine that is made once the arguments have been checked.
pub fn run_with(args: &Args, line: &str, engine: impl FnOnce() -> Result<Engine, GpuError>) -> Result<(), CliError> {
    let files = ViewFiles::new(&args.output, ENDINGS, &args.cameras);
    let several = "--cameras draws several pictures: name a folder with -o, or put {} where the views' names go";
    let views = files.views(&args.cameras, &args.shot.surface, several)?;
    let mut written = files.checked(&views);
    written.push(args.stats.as_deref());
    let places: Vec<Option<PathBuf>> = views.iter().map(|view| args.reference_of(view)).collect();
    let read: Vec<_> = places.iter().map(Option::as_deref).chain([args.cameras.file()]).collect();
    args.shot.check(&args.file, &read, &written)?;
    args.shot.check_gates(&args.gates.gates.fail_on)?;
    let reference = |path: &Path| Reference::read(path, args.threshold);
    let references = places.iter().map(|place| place.as_deref().map(reference).transpose());
    let references: Vec<_> = references.collect::<Result<_, _>>()?;
    let (subject, factors_file) = args.shot.subject(&args.file, &written)?;
    let mut shot = args.shot.shot(engine()?, subject)?;
    let cameras = views.iter().map(|view| args.camera(view, &shot)).collect::<Result<Vec<_>, _>>()?;
    files.make_folder()?;
    let mut found = Found::default();
    for (((index, view), camera), reference) in views.iter().enumerate().zip(cameras).zip(references) {
        if let Some(camera) = camera {
            shot.look_from(camera)?;
        }
        if index == 0 {
            shot.report_user_shaders()?;
        }
        draw(args, line, &mut shot, view, reference.as_ref(), &mut found)?;
    }
    found.stats.iter_mut().for_each(|own| own.factors_file.clone_from(&factors_file));
    conclude(args, found)
}

/// Writes the stats of all pictures, and says which gates failed and which pictures differ from their references.
fn conclude(args: &Args, Found { stats, judgements, mut failed }: Found) -> Result<(), CliError> {
    if let Some(path) = args.stats.as_deref() {
        let text = match &stats[..] {
            [own] if args.cameras.cameras.is_none() => to_json(own)?,
            all => to_json(&all)?,
        };
        write_text(path, &text)?;
    }
    let compared = compared(judgements);
    if failed.is_empty() {
        return compared;
    }
    failed.extend(compared.err().map(|different| different.to_string()));
    Err(CliError::Gates(failed))
}

/// Tells on standard error how pictures compare with their references.
fn compared(all: Vec<Result<String, ShotError>>) -> Result<(), CliError> {
    let count = all.len();
    let mut differing = Vec::new();
    for said in all {
        match said {
            Ok(said) => note(&said),
            Err(error) => differing.push(error),
        }
    }
    if count == 1 {
        return differing.pop().map_or(Ok(()), |error| Err(error.into()));
    }
    differing.iter().for_each(|error| note(&error.to_string()));
    match differing.len() {
        0 => Ok(()),
        different => Err(CliError::ManyDifferent { different, all: count }),
    }
}

/// What came of the pictures.
#[derive(Default)]
struct Found {
    stats: Vec<Stats>,
    judgements: Vec<Result<String, ShotError>>,
    /// A sentence for each gate that failed.
    failed: Vec<String>,
}

impl Args {
    /// The camera of one of several views; none for the only one, whose camera the shot has.
    fn camera(&self, view: &View, shot: &Shot) -> Result<Option<Camera>, CliError> {
        if view.named.is_none() {
            return Ok(None);
        }
        let camera = view.camera(&self.shot.surface, shot.place(), self.shot.framed_size())?;
        self.shot.check_camera(&camera)?;
        Ok(Some(camera))
    }

    /// The reference picture of a view, if there are references.
    fn reference_of(&self, view: &View) -> Option<PathBuf> {
        let place = self.reference.as_deref()?;
        let name = view.named.as_ref().map(|named| named.name.as_str());
        Some(ViewFiles::new(place, ENDINGS, &self.cameras).of(name))
    }
}

/// Draws a picture, writes it, measures it and compares it with its reference.
fn draw(
    args: &Args,
    line: &str,
    shot: &mut Shot,
    view: &View,
    reference: Option<&Reference>,
    found: &mut Found,
) -> Result<(), CliError> {
    let wanted = args.stats.as_ref().map(|_| StatsWanted { error: args.measure_error });
    let drawn = shot.picture(wanted, &Progress::new())?;
    match ending(&view.file).as_str() {
        "html" => shot.write_report(&view.file, line, &Progress::new())?,
        _ => shot.write(&view.file, &drawn, line)?,
    }
    let tolerance_px = args.shot.surface.tessellation().tolerance;
    let gates = shot.judge(&args.gates.gates.fail_on, tolerance_px, &Progress::new())?;
    let mut stats = wanted.is_some().then(|| shot.stats()).transpose()?.flatten();
    let judged = reference.map(|reference| reference.judge(&view.file, &drawn, shot.adapter())).transpose()?;
    let (compared, said) = judged.map(|judged| (judged.stats, judged.said)).unzip();
    if let Some(stats) = &mut stats {
        stats.view = view.named.as_ref().map(|named| named.name.clone());
        stats.reference = compared;
    }
    args.gates.write_evidence(shot, &gates, &view.file)?;
    found.stats.extend(stats);
    found.judgements.extend(said);
    found.failed.extend(failures(&view.name_of(&args.file), &gates));
    Ok(())
}
