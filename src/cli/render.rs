//! `pnaen render`: draws the window's picture without the window.

use std::path::{Path, PathBuf};

use super::gate_options::{GateOptions, failures};
use super::options::{CamerasOption, NamedView, PictureOptions, TessellationOptions};
use super::picture_file::{Stamp, write_stamped};
use super::reference::{self, Reference, ReferenceOptions};
use super::shot::{Shot, StatsWanted};
use super::shot_options::ShotOptions;
use super::stats::Stats;
use super::{
    AdapterOption, CliError, LimitOption, SurfaceOptions, WeldOption, file_error, options, to_json, write_text,
};
use crate::engine::Engine;
use crate::export::ending;
use crate::files::file_reason;
use crate::gpu::GpuError;
use crate::load::Source;
use crate::names::shown;
use crate::progress::Progress;
use crate::settings::Settings;

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// A .gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf file, or a shape made in code such as shape:cube-split, or
    /// shape:torus@2 (finer)
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    /// Picture to write, a PNG file. With --cameras, a folder, or a name with {} where each view's name goes
    #[arg(short, long, value_name = "OUT.png", value_parser = options::picture())]
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
    #[command(flatten)]
    pub reference: ReferenceOptions,
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
            cameras: CamerasOption::default(),
            reference: ReferenceOptions::default(),
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
    if args.cameras.cameras.is_some() && names_one_picture(&args.output) {
        return Err(CliError::Usage(
            "--cameras draws several pictures: name a folder with -o, or put {} where the views' names go",
        ));
    }
    let views = args.pictures()?;
    let mut written: Vec<_> =
        views.iter().map(|view| view.output.as_path()).filter(|path| is_checked(path, args)).collect();
    written.extend(args.stats.as_deref());
    let written: Vec<_> = written.into_iter().map(Some).collect();
    let read: Vec<_> = views.iter().map(|view| view.reference.as_deref()).chain([args.cameras.file()]).collect();
    args.shot.check(&args.file, &read, &written)?;
    args.shot.own_surface.check(false, &args.gates.gates.fail_on)?;
    let read = |path: &Path| Reference::read(path, &args.reference);
    let references = views.iter().map(|view| view.reference.as_deref().map(read).transpose());
    let references = references.collect::<Result<Vec<_>, _>>()?;
    let (subject, factors_file) = args.shot.subject(&args.file, &written)?;
    let mut shot = args.shot.shot(engine()?, subject)?;
    make_folder(args)?;
    let mut stats = Vec::new();
    let (mut judgements, mut failed) = (Vec::new(), Vec::new());
    for (view, reference) in views.iter().zip(references) {
        let drawn = draw(args, line, &mut shot, view, reference.as_ref())?;
        judgements.extend(drawn.judgement);
        failed.extend(drawn.failed);
        if let Some(mut own) = drawn.stats {
            own.factors_file = factors_file.clone();
            stats.push(own);
        }
    }
    if let Some(path) = args.stats.as_deref() {
        let text = match &stats[..] {
            [own] if args.cameras.cameras.is_none() => to_json(own)?,
            all => to_json(&all)?,
        };
        write_text(path, &text)?;
    }
    let compared = reference::conclude(judgements);
    if failed.is_empty() {
        return compared;
    }
    failed.extend(compared.err().map(|different| different.to_string()));
    Err(CliError::Gates(failed))
}

/// A picture that the command draws.
struct Picture {
    /// The view, if it isn't that of the command's own camera options.
    view: Option<NamedView>,
    output: PathBuf,
    reference: Option<PathBuf>,
}

impl Picture {
    /// The mesh's name, with the view's if there are several.
    fn name_of(&self, mesh: &Source) -> String {
        let mesh = shown(&mesh.to_string());
        match &self.view {
            Some(NamedView { name, .. }) => format!("{mesh} from {name}"),
            None => mesh,
        }
    }
}

/// What came of a picture.
struct Drawn {
    stats: Option<Stats>,
    judgement: Option<Result<String, CliError>>,
    /// A sentence for each gate that failed.
    failed: Vec<String>,
}

impl Args {
    /// The pictures that are drawn: one, or one for each of several views.
    fn pictures(&self) -> Result<Vec<Picture>, CliError> {
        let reference = self.reference.reference.as_deref();
        let Some(views) = self.cameras.views(&self.shot.surface.view)? else {
            return Ok(vec![Picture {
                view: None,
                output: self.output.clone(),
                reference: reference.map(Path::to_owned),
            }]);
        };
        let picture = |view: NamedView| Picture {
            output: of_view(&self.output, &view.name),
            reference: reference.map(|place| of_view(place, &view.name)),
            view: Some(view),
        };
        Ok(views.into_iter().map(picture).collect())
    }
}

/// What stands for a view's name in names of files.
const NAME: &str = "{}";

/// The file of a view: in a folder, or where a name has {} in it.
fn of_view(place: &Path, name: &str) -> PathBuf {
    match place.file_name().and_then(|own| own.to_str()).filter(|own| own.contains(NAME)) {
        Some(pattern) => place.with_file_name(pattern.replace(NAME, name)),
        None => place.join(format!("{name}.png")),
    }
}

/// Whether a path has the name of a single picture.
fn names_one_picture(path: &Path) -> bool {
    ending(path) == "png" && !is_pattern(path)
}

fn is_pattern(path: &Path) -> bool {
    path.file_name().and_then(|own| own.to_str()).is_some_and(|own| own.contains(NAME))
}

/// Whether the folder of a picture must be there before the command begins. A folder for views is made if it isn't.
fn is_checked(picture: &Path, args: &Args) -> bool {
    args.cameras.cameras.is_none() || is_pattern(&args.output) || picture.parent().is_some_and(Path::is_dir)
}

/// Makes the folder for views, if it isn't there.
fn make_folder(args: &Args) -> Result<(), CliError> {
    if args.cameras.cameras.is_none() || is_pattern(&args.output) {
        return Ok(());
    }
    std::fs::create_dir_all(&args.output).map_err(|error| file_error(&args.output, "made", &file_reason(&error)))
}

/// Draws a picture, writes it, measures it and compares it with its reference.
fn draw(
    args: &Args,
    line: &str,
    shot: &mut Shot,
    picture: &Picture,
    reference: Option<&Reference>,
) -> Result<Drawn, CliError> {
    if let Some(own) = &picture.view {
        let (mesh, moment, bounds) = shot.place();
        let camera = own.view.camera(&args.shot.surface, mesh, moment, bounds)?;
        args.shot.check_camera(&camera)?;
        shot.look_from(camera)?;
    }
    let wanted = args.stats.as_ref().map(|_| StatsWanted { error: args.measure_error });
    let drawn = shot.picture(wanted, &Progress::new())?;
    write_stamped(&picture.output, &drawn, &Stamp { command: line, settings: shot.settings() })?;
    let tolerance_px = args.shot.surface.tessellation().tolerance;
    let gates = shot.judge(&args.gates.gates.fail_on, tolerance_px, &Progress::new())?;
    let mut stats = wanted.is_some().then(|| shot.stats()).transpose()?.flatten();
    let judged = reference.map(|reference| reference.judge(&picture.output, &drawn)).transpose()?;
    let (compared, judgement) = judged.map(|judged| (judged.stats, judged.said)).unzip();
    if let Some(stats) = &mut stats {
        stats.view = picture.view.as_ref().map(|own| own.name.clone());
        stats.reference = compared;
    }
    args.gates.write_evidence(shot, &gates, &picture.output)?;
    Ok(Drawn { stats, judgement, failed: failures(&picture.name_of(&args.file), &gates) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_have_files_of_their_own_names() {
        for (place, expected) in
            [("views", "views/top.png"), ("out-{}.png", "out-top.png"), ("a/{}-x.png", "a/top-x.png")]
        {
            assert_eq!(of_view(Path::new(place), "top"), Path::new(expected));
        }
        assert!(names_one_picture(Path::new("a/b.png")) && !names_one_picture(Path::new("a/{}.png")));
    }
}
