//! `pnaen render`: the window's picture, without the window.

use std::path::{Path, PathBuf};

use super::stats::{AnimationStats, Stats};
use super::{CliError, GivenOption, SurfaceOptions, file_error, load, options, to_json, write_picture, write_text};
use crate::engine::{Engine, Loaded};
use crate::gpu::Timing;
use crate::measure::{ScreenView, compare, patch_edges};
use crate::mesh::{LoadError, Progress, Source, t_junctions};
use crate::render::{Target, patch_lines, t_junction_lines};
use crate::settings::{Overlay, Overlays, Settings};
use crate::tessellate::Lod;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A .gltf or .glb file, or a shape made in code such as shape:cube-split
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    /// Picture to write, a PNG file
    #[arg(short, long, value_name = "OUT.png", value_parser = options::picture())]
    pub output: PathBuf,
    #[command(flatten)]
    pub surface: SurfaceOptions,
    #[command(flatten)]
    pub given: GivenOption,
    /// What is drawn over the surface
    #[arg(long, value_enum, value_delimiter = ',', value_name = "OVERLAY,..")]
    pub overlay: Vec<Overlay>,
    /// Left of this fraction of the width, show the mesh untessellated
    #[arg(long, value_name = "FRACTION", value_parser = options::fraction)]
    pub split: Option<f32>,
    /// Outline this triangle (its number in the mesh, from 0), its edges in the colours of factors 0, 1 and 2: red, green,
    /// blue
    #[arg(long, value_name = "TRIANGLE")]
    pub select: Option<u32>,
    /// sRGB colour behind the mesh
    #[arg(long, value_name = "RRGGBB", default_value = "2b2e33", value_parser = options::color)]
    pub background: [u8; 3],
    /// Write what was done, and how long it took, as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Whether stats have the largest distance on screen between what is emitted and its surface, sampled on the CPU
    #[arg(long, value_name = "BOOL", default_value_t = true, action = clap::ArgAction::Set)]
    pub measure_error: bool,
    /// Fail if the picture differs from this one by more than the threshold, and write the difference beside it
    #[arg(long, value_name = "PNG")]
    pub reference: Option<PathBuf>,
    /// Difference that is still the same picture: 0 is none, 1 is all (1 minus structural similarity)
    #[arg(long, value_name = "T", default_value_t = 0.01, value_parser = options::threshold)]
    pub threshold: f64,
}

impl Args {
    /// What the window shows when it opens.
    pub fn preview(file: Source, output: &Path) -> Self {
        let Settings { lod, partitioning, clip, cull_back_faces, background, .. } = Settings::opening();
        Self {
            file,
            output: output.to_owned(),
            surface: SurfaceOptions { lod, partitioning, clip, cull_back_faces, ..SurfaceOptions::default() },
            given: GivenOption::default(),
            overlay: vec![Overlay::Wireframe],
            split: None,
            select: None,
            background,
            stats: None,
            measure_error: true,
            reference: None,
            threshold: 0.01,
        }
    }

    /// # Errors
    /// Two overlays colour the surface.
    fn overlays(&self) -> Result<Overlays, CliError> {
        Overlays::of(&self.overlay).ok_or(CliError::Usage(
            "--overlay takes one of barycentric, factors, triangle-size and low-factors: each colours the whole surface",
        ))
    }
}

pub fn run(args: &Args) -> Result<(), CliError> {
    args.surface.check()?;
    let overlays = args.overlays()?;
    let reference = args.reference.as_deref().map(|path| read_reference(args, path)).transpose()?;
    let loaded = load(&args.file, &args.surface.preparation())?;
    let given = args.given.read(&loaded.mesh, &loaded.topology, args.surface.convention, args.surface.partitioning)?;
    let selected = args.select.map(|triangle| selected_patch(&loaded, triangle)).transpose()?;
    let moment = args.surface.animation.moment(&loaded)?;
    let engine = Engine::headless()?;
    let mut scene = engine.scene(&loaded, args.surface.arena_bytes())?;
    let (given, factors_file) = given.map(|given| (given.factors, given.stats)).unzip();
    scene.tessellator.give(given)?;
    scene.frame_clip(moment.map(|moment| moment.clip));
    scene.set_moment(moment)?;
    let target = Target::new(&engine.gpu, args.surface.size.0)?;
    let camera = args.surface.camera(&loaded.mesh, &scene.bounds);
    let view = camera.lod_view(target.viewport(), &scene.bounds);
    let surface = args.surface.within_budget(|settings| {
        engine.count(&mut scene, &settings.inputs(view), &mut Timing::Off)?;
        Ok(scene.tessellator.totals().1)
    })?;
    let settings = Settings { overlays, split: args.split, background: args.background, ..surface };

    let inputs = settings.inputs(view);
    engine.count(&mut scene, &inputs, &mut Timing::Off)?;
    let (at_rest, loaded) = (&loaded.topology, loaded.posed(moment));
    let measured = if settings.overlays.cracks || selected.is_some() || args.stats.is_some() {
        let measured = engine.measure(&mut scene)?;
        Some(measured)
    } else {
        None
    };
    let mut lines = match &measured {
        Some(measured) if settings.overlays.cracks => measured.crack_lines(&loaded.topology),
        _ => Vec::new(),
    };
    if settings.overlays.t_junctions {
        let junctions = t_junctions(at_rest, &Progress::default()).map_err(LoadError::from)?;
        lines.extend(t_junction_lines(&loaded.topology, &junctions));
    }
    if let Some(patch) = selected {
        let rims = measured.as_ref().map(|measured| &measured.rims);
        lines.extend(patch_lines(&patch_edges(&loaded.topology, patch, rims, settings.convention)));
    }
    scene.set_lines(&engine.gpu, &lines);
    engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off)?;
    let picture = target.read(&engine.gpu)?;
    write_picture(&args.output, &picture.clone().into())?;

    if let (Some(path), Some(measured)) = (&args.stats, measured) {
        let deviation = if args.measure_error { engine.deviation(&mut scene, &inputs)? } else { None };
        let passes = engine.time(&mut scene, &target, &camera, &settings)?;
        let leaks = engine.leaks(&mut scene, &measured, target.size, &camera)?;
        let max_error_px = deviation.map(|worst| worst.px);
        let mut factors_capped = engine.asked_factors(&scene)?.beyond(settings.partitioning);
        if settings.used_lod() == Lod::Error {
            let written = scene.tessellator.hull_factors()?;
            factors_capped += written.iter().filter(|factors| factors.inside > 64.0).count() as u64;
        }
        let viewport = target.viewport();
        let clip_from_object = camera.clip_from_object(viewport, &scene.bounds);
        let view = ScreenView { clip_from_object, viewport };
        let name = args.surface.animation.animation.clone();
        let sizes = engine.sizes(&mut scene, view)?;
        let mut stats = Stats::new(&engine, &loaded, &scene, &measured, &settings, view, &passes);
        stats.triangles_in_view = sizes.in_view;
        stats.triangles_below_3_px = sizes.small;
        stats.leaks = leaks;
        stats.max_error_px = max_error_px;
        stats.factors_capped = factors_capped;
        stats.factors_file = factors_file;
        stats.animation = moment.zip(name).map(|(moment, name)| AnimationStats { name, time: moment.time });
        write_text(path, &to_json(&stats)?)?;
    }
    match args.reference.as_deref().zip(reference) {
        Some((path, reference)) => hold_against(args, &picture, path, &reference),
        None => Ok(()),
    }
}

/// The patch of a triangle of the mesh.
fn selected_patch(loaded: &Loaded, triangle: u32) -> Result<u32, CliError> {
    let (file, count) = (loaded.source.to_string(), loaded.mesh.triangles.len());
    if triangle as usize >= count {
        return Err(CliError::NoTriangle { file, last: count.saturating_sub(1), triangle });
    }
    loaded.topology.patch_of(triangle).ok_or(CliError::NoPatch { file, triangle })
}

/// Reads the reference before anything is drawn or written.
fn read_reference(args: &Args, path: &Path) -> Result<image::RgbaImage, CliError> {
    let reference = image::open(path).map_err(|error| file_error(path, "read", &error))?.to_rgba8();
    // Neither path resolves if there is no such file yet.
    if std::fs::canonicalize(path).ok() == std::fs::canonicalize(&args.output).ok() {
        return Err(file_error(path, "kept", &"the picture would replace it: write the picture elsewhere"));
    }
    Ok(reference)
}

fn hold_against(
    args: &Args,
    picture: &image::RgbaImage,
    path: &Path,
    reference: &image::RgbaImage,
) -> Result<(), CliError> {
    let comparison = compare(picture, reference)
        .map_err(|reason| CliError::Reference { reference: path.display().to_string(), reason })?;
    if comparison.difference <= args.threshold {
        return Ok(());
    }
    let mut name = args.output.file_stem().unwrap_or_default().to_owned();
    name.push("-diff.png");
    let diff = args.output.with_file_name(name);
    // Beside a device or a pipe is no place for a picture.
    let see = if args.output.is_file() {
        write_picture(&diff, &comparison.map.into())?;
        format!(": see {}, where the differences are bright", diff.display())
    } else {
        String::new()
    };
    Err(CliError::Different {
        picture: args.output.display().to_string(),
        reference: path.display().to_string(),
        difference: comparison.difference,
        threshold: args.threshold,
        see,
    })
}
