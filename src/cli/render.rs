//! `pnaen render`: draws the window's picture without the window.

use std::path::{Path, PathBuf};

use super::options::{PictureOptions, TessellationOptions};
use super::stats::{AnimationStats, LeftStats, Stats};
use super::truth::{AccuracyStats, DeviationStats, ReferenceSurface};
use super::{
    AdapterOption, CliError, FactorsOption, LimitOption, SurfaceOptions, TruthOption, WeldOption, file_of,
    file_of_heights, keep_apart, load_apart, options, reference, to_json, write_picture, write_text,
};
use crate::engine::{Engine, Loaded, MeasurementResults, Measurements, Runs};
use crate::gpu::{GpuError, Timing};
use crate::load::{LoadError, Source};
use crate::measure::{AccuracyOptions, DeviationField, patch_edges};
use crate::mesh::{Moment, t_junctions};
use crate::progress::Progress;
use crate::render::{
    Camera, LineSegment, Scale, Scene, Target, crack_lines, deviation_scale, patch_lines, t_junction_lines, worst_lines,
};
use crate::settings::{Colors, Settings, SplitSide};
use crate::tessellate::{HullFactors, Inputs};
use crate::view::ScreenView;

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// A .gltf, .glb, .obj, .stl or .ply file, or a shape made in code such as shape:cube-split, or shape:torus@2 (finer)
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    /// Picture to write, a PNG file
    #[arg(short, long, value_name = "OUT.png", value_parser = options::picture())]
    pub output: PathBuf,
    #[command(flatten)]
    pub surface: SurfaceOptions,
    #[command(flatten)]
    pub given: FactorsOption,
    #[command(flatten)]
    pub picture: PictureOptions,
    #[command(flatten)]
    pub truth: TruthOption,
    /// Outline the patch of this triangle (its number in the mesh, from 0); the edges of factors 0, 1 and 2 are red, green
    /// and blue
    #[arg(long, value_name = "TRIANGLE")]
    pub select: Option<u32>,
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
        Self {
            file,
            output: output.to_owned(),
            surface: SurfaceOptions { tessellation, weld, ..SurfaceOptions::default() },
            given: FactorsOption::default(),
            picture: PictureOptions(settings),
            truth: TruthOption::default(),
            select: None,
            stats: None,
            measure_error: true,
            reference: None,
            threshold: 0.01,
            adapter,
        }
    }
}

impl Args {
    /// Checks that no file to be written is one that is read.
    fn keep_apart(&self) -> Result<(), CliError> {
        let truth = self.truth.truth.as_ref().and_then(file_of);
        let heights = file_of_heights(self.surface.height.as_ref());
        let read = [file_of(&self.file), truth, heights, self.given.given.as_deref(), self.reference.as_deref()];
        keep_apart(read, [Some(&*self.output), self.stats.as_deref()])
    }
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    run_with(args, || Engine::chosen(&args.adapter.choice()))
}

/// Like [`run`], with an engine that is made once the arguments have been checked.
///
/// # Errors
/// Those of the command.
pub(crate) fn run_with(args: &Args, engine: impl FnOnce() -> Result<Engine, GpuError>) -> Result<(), CliError> {
    let PictureOptions(Settings { overlays, split_surface, .. }) = args.picture;
    args.surface.check_with(split_surface)?;
    args.keep_apart()?;
    let reference = args.reference.as_deref().map(reference::read).transpose()?;
    let written = [Some(&*args.output), args.stats.as_deref()];
    let loaded = load_apart(&args.file, &args.surface.preparation(), &written)?;
    let given = args.given.read(&loaded.mesh, &loaded.topology, &args.surface.tessellation())?;
    let reference_surface =
        args.truth.reference_surface(&loaded, &args.surface, overlays.colors == Colors::Deviation)?;
    let selected = args.select.map(|triangle| selected_patch(&loaded, triangle)).transpose()?;
    let (given, factors_file) = given.map(|given| (given.factors, given.stats)).unzip();
    let mut shot = Shot::new(args, loaded, given, engine)?;
    shot.measure(args, reference_surface, selected.is_some())?;
    shot.mark(selected)?;
    shot.engine.draw(&mut shot.scene, &shot.target, &shot.camera, &shot.settings, &mut Timing::Off)?;
    let picture = shot.target.read(&shot.engine.gpu)?;
    write_picture(&args.output, &picture.clone().into())?;
    if let Some(path) = args.stats.as_deref()
        && let Some(mut stats) = shot.stats(args)?
    {
        stats.factors_file = factors_file;
        write_text(path, &to_json(&stats)?)?;
    }
    match args.reference.as_deref().zip(reference) {
        Some((path, reference)) => reference::compare_with(&args.output, &picture, path, &reference, args.threshold),
        None => Ok(()),
    }
}

/// Everything that one picture is drawn and measured from.
struct Shot {
    /// The mesh at rest; `loaded` is the mesh in the pose that is drawn.
    at_rest: Loaded,
    loaded: Loaded,
    moment: Option<Moment>,
    engine: Engine,
    scene: Scene,
    target: Target,
    camera: Camera,
    settings: Settings,
    reference_surface: Option<ReferenceSurface>,
    /// What was measured of each half.
    results: ByHalf<MeasurementResults>,
    /// The colour scale of the deviation overlay.
    scale: Scale,
}

/// A value for each half that the picture has.
type ByHalf<T> = [Option<T>; 2];

impl Shot {
    fn new(
        args: &Args,
        at_rest: Loaded,
        given: Option<Vec<HullFactors>>,
        engine: impl FnOnce() -> Result<Engine, GpuError>,
    ) -> Result<Self, CliError> {
        let moment = args.surface.animation.moment(&at_rest)?;
        let engine = engine()?;
        let mut scene = engine.scene(&at_rest, args.surface.arena_bytes())?;
        scene.tessellator.give(given.clone())?;
        scene.frame_clip(moment.map(|moment| moment.clip));
        scene.set_moment(moment)?;
        let target = Target::new(&engine.gpu, args.surface.size.0)?;
        let camera = args.surface.camera(&at_rest.mesh, &scene.bounds);
        let view = camera.lod_view(target.viewport(), &scene.bounds);
        let surface = args.surface.within_budget(|settings| {
            engine.count(&mut scene, &settings.inputs(view), &mut Timing::Off)?;
            Ok(scene.tessellator.totals().1)
        })?;
        let settings = args.picture.0.with(surface.tessellation);
        if settings.half(SplitSide::Left).is_some() {
            engine.split(&mut scene, args.surface.arena_bytes())?;
        }
        for half in SplitSide::BOTH {
            let Some((scene, settings)) = scene.half_mut(half).zip(settings.half(half)) else { continue };
            if half == SplitSide::Left {
                scene.tessellator.give(given.clone())?;
            }
            engine.count(scene, &settings.inputs(view), &mut Timing::Off)?;
        }
        let (loaded, scale) = (at_rest.posed(moment), deviation_scale(0.0, scene.ulp()));
        let (reference_surface, results) = (None, Default::default());
        Ok(Self { at_rest, loaded, moment, engine, scene, target, camera, settings, reference_surface, results, scale })
    }

    /// What a half is tessellated with, if there is one.
    fn inputs(&self, half: SplitSide) -> Option<Inputs> {
        let view = self.camera.lod_view(self.target.viewport(), &self.scene.bounds);
        Some(self.settings.half(half)?.inputs(view))
    }

    fn view(&self) -> ScreenView {
        let viewport = self.target.viewport();
        ScreenView { clip_from_object: self.camera.clip_from_object(viewport, &self.scene.bounds), viewport }
    }

    /// Measures each half with one walk over its output: what the overlays show, and what the stats say.
    fn measure(
        &mut self,
        args: &Args,
        reference_surface: Option<ReferenceSurface>,
        is_selected: bool,
    ) -> Result<(), CliError> {
        self.reference_surface = reference_surface;
        let (view, has_stats) = (self.view(), args.stats.is_some());
        let is_shown = self.settings.overlays.colors == Colors::Deviation;
        let reference_surface = self.reference_surface.as_ref();
        // Both halves are compared with the same surface.
        let target = reference_surface.filter(|_| is_shown).zip(self.inputs(SplitSide::Right));
        let target = target.map(|(reference_surface, inputs)| reference_surface.target(&inputs));
        for half in SplitSide::BOTH {
            let inputs = self.inputs(half);
            let Some((inputs, scene)) = inputs.as_ref().zip(self.scene.half_mut(half)) else { continue };
            let truth = reference_surface.and_then(ReferenceSurface::truth).filter(|_| has_stats);
            let wanted = Measurements {
                survey: self.settings.overlays.cracks || is_selected || has_stats,
                screen_error: (has_stats && args.measure_error).then_some(inputs),
                deviation: target.as_ref(),
                accuracy: truth.map(|(_, truth)| (truth, &inputs.view, AccuracyOptions::default())),
                sizes: (has_stats && half == SplitSide::Right).then_some(view),
            };
            self.results[half as usize] = Some(self.engine.measure_all(scene, &wanted)?);
        }
        self.show_deviation();
        Ok(())
    }

    /// Colours both halves by their deviation, on one scale that covers the larger of the two.
    fn show_deviation(&mut self) {
        let fields = || self.results.iter().flatten().filter_map(|results| results.deviation.as_ref());
        let largest = fields().filter_map(DeviationField::worst).map(|worst| worst.value).fold(0.0, f64::max);
        if fields().next().is_none() {
            return;
        }
        self.scale = deviation_scale(largest, self.scene.ulp());
        for (half, results) in SplitSide::BOTH.into_iter().zip(&self.results) {
            let field = results.as_ref().and_then(|results| results.deviation.as_ref());
            if let Some((scene, field)) = self.scene.half_mut(half).zip(field) {
                scene.set_deviation(&self.engine.gpu, Some((field, self.scale)));
            }
        }
    }

    fn results(&self, half: SplitSide) -> Option<&MeasurementResults> {
        self.results[half as usize].as_ref()
    }

    /// Puts lines over each half: the overlays that are lines, and the outline of the selected patch.
    fn mark(&mut self, selected: Option<u32>) -> Result<(), CliError> {
        for half in SplitSide::BOTH {
            let lines = self.lines(half, selected)?;
            if let Some(scene) = self.scene.half_mut(half) {
                scene.set_lines(&self.engine.gpu, &lines);
            }
        }
        Ok(())
    }

    fn lines(&self, half: SplitSide, selected: Option<u32>) -> Result<Vec<LineSegment>, CliError> {
        let topology = &self.loaded.topology;
        let results = self.results(half);
        let measured = results.and_then(|results| results.survey.as_ref());
        let mut lines = match measured {
            Some(measured) if self.settings.overlays.cracks => crack_lines(measured, topology),
            _ => Vec::new(),
        };
        if self.settings.overlays.t_junctions {
            let junctions = t_junctions(&self.at_rest.topology, &Progress::default()).map_err(LoadError::from)?;
            lines.extend(t_junction_lines(topology, &junctions));
        }
        if let Some(worst) = results.and_then(|results| results.deviation.as_ref()).and_then(DeviationField::worst) {
            lines.extend(worst_lines(worst.emitted.as_vec3(), worst.truth.as_vec3()));
        }
        if let Some(patch) = selected {
            let outlines = measured.map(|measured| &measured.outlines);
            lines.extend(patch_lines(&patch_edges(topology, patch, outlines, self.settings.tessellation.convention)));
        }
        Ok(lines)
    }

    /// The distance of a half from the reference surface, if it was measured.
    fn accuracy(&self, half: SplitSide) -> Option<AccuracyStats> {
        let (name, _) = self.reference_surface.as_ref().and_then(ReferenceSurface::truth)?;
        let results = self.results(half)?;
        let is_whole = results.survey.as_ref()?.culled.total() == 0;
        results.accuracy.as_ref().map(|accuracy| AccuracyStats::new(name, accuracy, is_whole))
    }

    /// The deviation that the overlay shows on a half, if the overlay is on.
    fn deviation(&self, half: SplitSide) -> Option<DeviationStats> {
        self.results(half)?.deviation.as_ref().map(|field| DeviationStats::new(field, self.scale))
    }

    /// The stats of the picture; none if nothing was measured.
    fn stats(&mut self, args: &Args) -> Result<Option<Stats>, CliError> {
        let (view, accuracy) = (self.view(), self.accuracy(SplitSide::Right));
        let Self { engine, scene, target, camera, settings, results, .. } = self;
        let Some(results) = &results[SplitSide::Right as usize] else { return Ok(None) };
        let Some(measured) = &results.survey else { return Ok(None) };
        // Only the right half is timed.
        let alone = Settings { split_surface: None, ..*settings };
        let passes = engine.time(scene, target, camera, &alone, Runs::default())?;
        let leaks = engine.leaks(scene, measured, target.size, camera)?;
        let factors_capped = engine.factors_capped(scene, &settings.tessellation)?;
        let name = args.surface.animation.animation.clone();
        let mut stats = Stats::new(engine, &self.loaded, scene, measured, settings, view, &passes);
        (stats.triangles_in_view, stats.triangles_below_3_px) =
            results.sizes.map_or((0, 0), |sizes| (sizes.in_view, sizes.small));
        stats.leaks = leaks;
        stats.max_error_px = results.screen_error.map(|worst| worst.px);
        stats.patches_flat = results.flat_patches;
        if let Some(tolerance_px) = stats.max_error_px.map(|px| px as f32).filter(|px| *px > 0.0) {
            let inputs = settings.inputs(camera.lod_view(target.viewport(), &scene.bounds));
            let triangles = engine.triangles_by_error(scene, &inputs, tolerance_px)?;
            stats.lod_comparison = triangles.map(|triangles| stats.compared(tolerance_px, triangles));
        }
        stats.factors_capped = factors_capped;
        stats.accuracy = accuracy;
        stats.deviation = self.deviation(SplitSide::Right);
        stats.left = self.left_stats();
        stats.animation = self.moment.zip(name).map(|(moment, name)| AnimationStats { name, time: moment.time });
        Ok(Some(stats))
    }

    /// The stats of another surface left of the split.
    fn left_stats(&self) -> Option<LeftStats> {
        let (scene, settings) = self.scene.half(SplitSide::Left).zip(self.settings.half(SplitSide::Left))?;
        let results = self.results(SplitSide::Left)?;
        let mut stats = LeftStats::new(scene, results.survey.as_ref()?, &settings, self.view());
        stats.max_error_px = results.screen_error.map(|worst| worst.px);
        stats.accuracy = self.accuracy(SplitSide::Left);
        stats.deviation = self.deviation(SplitSide::Left);
        Some(stats)
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
