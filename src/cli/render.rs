//! `pnaen render`: the window's picture, without the window.

use std::path::{Path, PathBuf};

use super::split::LeftStats;
use super::stats::{AnimationStats, Stats};
use super::truth::{AccuracyStats, DeviationStats, Held};
use super::{
    AdapterOption, CliError, GivenOption, LimitOption, SplitOption, SurfaceOptions, TruthOption, WeldOption, file_of,
    file_of_heights, keep_apart, load_apart, options, reference, to_json, write_picture, write_text,
};
use crate::engine::{Engine, Loaded, Runs};
use crate::gpu::Timing;
use crate::load::{LoadError, Source};
use crate::measure::{AccuracyOptions, Field, Measured, ScreenView, patch_edges};
use crate::mesh::{Moment, t_junctions};
use crate::progress::Progress;
use crate::render::{
    Camera, LineSegment, Scale, Scene, Target, deviation_scale, patch_lines, t_junction_lines, worst_lines,
};
use crate::settings::{Colors, Half, Overlay, Overlays, Settings};
use crate::tessellate::{HullFactors, Inputs, Lod};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A .gltf, .glb, .obj, .stl or .ply file, or a shape made in code such as shape:cube-split, or shape:torus@2 (finer)
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
    #[command(flatten)]
    pub truth: TruthOption,
    #[command(flatten)]
    pub split: SplitOption,
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
    #[command(flatten)]
    pub adapter: AdapterOption,
}

impl Args {
    /// What the window shows when it opens.
    pub fn preview(file: Source, limit: LimitOption, adapter: AdapterOption, output: &Path) -> Self {
        let Settings { lod, partitioning, clip, cull_back_faces, background, .. } = Settings::opening();
        let weld = WeldOption { limit, ..WeldOption::default() };
        Self {
            file,
            output: output.to_owned(),
            surface: SurfaceOptions { lod, partitioning, clip, cull_back_faces, weld, ..SurfaceOptions::default() },
            given: GivenOption::default(),
            overlay: vec![Overlay::Wireframe],
            truth: TruthOption::default(),
            split: SplitOption::default(),
            select: None,
            background,
            stats: None,
            measure_error: true,
            reference: None,
            threshold: 0.01,
            adapter,
        }
    }

    /// # Errors
    /// Two overlays colour the surface.
    fn overlays(&self) -> Result<Overlays, CliError> {
        Overlays::of(&self.overlay).ok_or(CliError::Usage(
            "--overlay takes one of barycentric, factors, triangle-size, low-factors and deviation: each colours the whole surface",
        ))
    }
}

impl Args {
    /// What is written replaces nothing that is read.
    fn keep_apart(&self) -> Result<(), CliError> {
        let truth = self.truth.truth.as_ref().and_then(file_of);
        let heights = file_of_heights(self.surface.height.as_ref());
        let read = [file_of(&self.file), truth, heights, self.given.given.as_deref(), self.reference.as_deref()];
        keep_apart(read, [Some(&*self.output), self.stats.as_deref()])
    }
}

pub fn run(args: &Args) -> Result<(), CliError> {
    args.surface.check_with(args.split.split_surface)?;
    let overlays = args.overlays()?;
    args.keep_apart()?;
    let reference = args.reference.as_deref().map(reference::read).transpose()?;
    let written = [Some(&*args.output), args.stats.as_deref()];
    let loaded = load_apart(&args.file, &args.surface.preparation(), &written)?;
    let given = args.given.read(&loaded.mesh, &loaded.topology, args.surface.convention, args.surface.partitioning)?;
    let held = args.truth.held(&loaded, &args.surface, overlays.colors == Colors::Deviation)?;
    let selected = args.select.map(|triangle| selected_patch(&loaded, triangle)).transpose()?;
    let (given, factors_file) = given.map(|given| (given.factors, given.stats)).unzip();
    let mut shot = Shot::new(args, loaded, overlays, given)?;
    let is_measured = overlays.cracks || selected.is_some() || args.stats.is_some();
    let measured = if is_measured { shot.measure()? } else { Default::default() };
    shot.hold(held)?;
    shot.mark(&measured, selected)?;
    shot.engine.draw(&mut shot.scene, &shot.target, &shot.camera, &shot.settings, &mut Timing::Off)?;
    let picture = shot.target.read(&shot.engine.gpu)?;
    write_picture(&args.output, &picture.clone().into())?;
    let [left, right] = &measured;
    if let Some((path, right)) = args.stats.as_deref().zip(right.as_ref()) {
        let mut stats = shot.stats(args, right)?;
        if let Some(left) = left {
            stats.left = shot.left_stats(args, left)?;
        }
        stats.factors_file = factors_file;
        write_text(path, &to_json(&stats)?)?;
    }
    match args.reference.as_deref().zip(reference) {
        Some((path, reference)) => reference::hold_against(&args.output, &picture, path, &reference, args.threshold),
        None => Ok(()),
    }
}

/// What is drawn, tessellated on its device.
struct Shot {
    /// At rest, and as it is drawn.
    at_rest: Loaded,
    loaded: Loaded,
    moment: Option<Moment>,
    engine: Engine,
    scene: Scene,
    target: Target,
    camera: Camera,
    settings: Settings,
    held: Option<Held>,
    /// How far each half is from that, where the overlay shows it.
    fields: ByHalf<Field>,
    /// What those are read against.
    scale: Scale,
}

/// Of each half, if there is one.
type ByHalf<T> = [Option<T>; 2];

impl Shot {
    fn new(
        args: &Args,
        at_rest: Loaded,
        overlays: Overlays,
        given: Option<Vec<HullFactors>>,
    ) -> Result<Self, CliError> {
        let moment = args.surface.animation.moment(&at_rest)?;
        let engine = Engine::chosen(&args.adapter.choice())?;
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
        let (SplitOption { split, split_surface }, background) = (args.split, args.background);
        let deviation_in = args.truth.deviation_in;
        let settings = Settings { overlays, split, split_surface, background, deviation_in, ..surface };
        if settings.half(Half::Left).is_some() {
            engine.split(&mut scene, args.surface.arena_bytes())?;
        }
        for half in Half::BOTH {
            let Some((scene, settings)) = scene.half_mut(half).zip(settings.half(half)) else { continue };
            if half == Half::Left {
                scene.tessellator.give(given.clone())?;
            }
            engine.count(scene, &settings.inputs(view), &mut Timing::Off)?;
        }
        let (loaded, scale) = (at_rest.posed(moment), deviation_scale(0.0, scene.ulp()));
        let (held, fields) = (None, Default::default());
        Ok(Self { at_rest, loaded, moment, engine, scene, target, camera, settings, held, fields, scale })
    }

    /// What a half is tessellated with, if there is one.
    fn inputs(&self, half: Half) -> Option<Inputs> {
        let view = self.camera.lod_view(self.target.viewport(), &self.scene.bounds);
        Some(self.settings.half(half)?.inputs(view))
    }

    fn view(&self) -> ScreenView {
        let viewport = self.target.viewport();
        ScreenView { clip_from_object: self.camera.clip_from_object(viewport, &self.scene.bounds), viewport }
    }

    fn measure(&mut self) -> Result<ByHalf<Measured>, CliError> {
        let mut measured = ByHalf::default();
        for half in Half::BOTH {
            if let Some(scene) = self.scene.half_mut(half) {
                measured[half as usize] = Some(self.engine.measure(scene)?);
            }
        }
        Ok(measured)
    }

    /// Measures what the overlay shows: both halves against one thing, and on the scale of the one that is farther off.
    fn hold(&mut self, held: Option<Held>) -> Result<(), CliError> {
        self.held = held;
        let held = self.held.as_ref().filter(|_| self.settings.overlays.colors == Colors::Deviation);
        let Some((held, inputs)) = held.zip(self.inputs(Half::Right)) else { return Ok(()) };
        let yardstick = held.yardstick(&inputs);
        for half in Half::BOTH {
            let Some(scene) = self.scene.half_mut(half) else { continue };
            self.fields[half as usize] = Some(self.engine.field(scene, &yardstick)?);
        }
        let worst = self.fields.iter().flatten().filter_map(Field::worst);
        let largest = worst.map(|worst| worst.value).fold(0.0, f64::max);
        self.scale = deviation_scale(largest, self.scene.ulp());
        for (half, field) in Half::BOTH.into_iter().zip(&self.fields) {
            if let Some((scene, field)) = self.scene.half_mut(half).zip(field.as_ref()) {
                scene.set_deviation(&self.engine.gpu, Some((field, self.scale)));
            }
        }
        Ok(())
    }

    /// Puts lines over each half: the overlays that are lines, and the outline of the selected patch.
    fn mark(&mut self, measured: &ByHalf<Measured>, selected: Option<u32>) -> Result<(), CliError> {
        for (half, measured) in Half::BOTH.into_iter().zip(measured) {
            let lines = self.lines(half, measured.as_ref(), selected)?;
            if let Some(scene) = self.scene.half_mut(half) {
                scene.set_lines(&self.engine.gpu, &lines);
            }
        }
        Ok(())
    }

    fn lines(
        &self,
        half: Half,
        measured: Option<&Measured>,
        selected: Option<u32>,
    ) -> Result<Vec<LineSegment>, CliError> {
        let topology = &self.loaded.topology;
        let mut lines = match measured {
            Some(measured) if self.settings.overlays.cracks => measured.crack_lines(topology),
            _ => Vec::new(),
        };
        if self.settings.overlays.t_junctions {
            let junctions = t_junctions(&self.at_rest.topology, &Progress::default()).map_err(LoadError::from)?;
            lines.extend(t_junction_lines(topology, &junctions));
        }
        if let Some(worst) = self.fields[half as usize].as_ref().and_then(Field::worst) {
            lines.extend(worst_lines(worst.emitted.as_vec3(), worst.truth.as_vec3()));
        }
        if let Some(patch) = selected {
            let rims = measured.map(|measured| &measured.rims);
            lines.extend(patch_lines(&patch_edges(topology, patch, rims, self.settings.convention)));
        }
        Ok(lines)
    }

    /// How far a half is from its own surface on screen, in px, and from the truth.
    fn errors(
        &mut self,
        args: &Args,
        half: Half,
        measured: &Measured,
    ) -> Result<(Option<f64>, Option<AccuracyStats>), CliError> {
        let Some((inputs, scene)) = self.inputs(half).zip(self.scene.half_mut(half)) else { return Ok((None, None)) };
        let error = if args.measure_error { self.engine.deviation(scene, &inputs)? } else { None };
        let accuracy = match self.held.as_ref().and_then(Held::truth) {
            Some((name, truth)) => {
                let accuracy = self.engine.accuracy(scene, truth, &inputs.view, AccuracyOptions::default())?;
                accuracy.map(|accuracy| AccuracyStats::new(name, &accuracy, measured.culled.total() == 0))
            }
            None => None,
        };
        Ok((error.map(|worst| worst.px), accuracy))
    }

    /// What the overlay shows of a half, if it is on.
    fn deviation(&self, half: Half) -> Option<DeviationStats> {
        self.fields[half as usize].as_ref().map(|field| DeviationStats::new(field, self.scale))
    }

    fn stats(&mut self, args: &Args, measured: &Measured) -> Result<Stats, CliError> {
        let (max_error_px, accuracy) = self.errors(args, Half::Right, measured)?;
        let view = self.view();
        let Self { engine, scene, target, camera, settings, .. } = self;
        // What is left of the split isn't what is timed.
        let alone = Settings { split_surface: None, ..*settings };
        let passes = engine.time(scene, target, camera, &alone, Runs::default())?;
        let leaks = engine.leaks(scene, measured, target.size, camera)?;
        let mut factors_capped = engine.asked_factors(scene)?.beyond(settings.partitioning);
        if settings.used_lod() == Lod::Error {
            let written = scene.tessellator.hull_factors()?;
            factors_capped += written.iter().filter(|factors| factors.inside > 64.0).count() as u64;
        }
        let name = args.surface.animation.animation.clone();
        let sizes = engine.sizes(scene, view)?;
        let mut stats = Stats::new(engine, &self.loaded, scene, measured, settings, view, &passes);
        stats.triangles_in_view = sizes.in_view;
        stats.triangles_below_3_px = sizes.small;
        stats.leaks = leaks;
        stats.max_error_px = max_error_px;
        stats.factors_capped = factors_capped;
        stats.accuracy = accuracy;
        stats.deviation = self.deviation(Half::Right);
        stats.animation = self.moment.zip(name).map(|(moment, name)| AnimationStats { name, time: moment.time });
        Ok(stats)
    }

    /// What is known of another surface left of the split.
    fn left_stats(&mut self, args: &Args, measured: &Measured) -> Result<Option<LeftStats>, CliError> {
        let (max_error_px, accuracy) = self.errors(args, Half::Left, measured)?;
        let Some((scene, settings)) = self.scene.half(Half::Left).zip(self.settings.half(Half::Left)) else {
            return Ok(None);
        };
        let mut stats = LeftStats::new(scene, measured, &settings, self.view());
        stats.max_error_px = max_error_px;
        stats.accuracy = accuracy;
        stats.deviation = self.deviation(Half::Left);
        Ok(Some(stats))
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
