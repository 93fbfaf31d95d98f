//! `pnaen render`: the window's picture, without the window.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use serde::Serialize;

use super::given::FactorsFile;
use super::{CliError, GivenOption, SurfaceOptions, file_error, load, options, to_json, write_picture, write_text};
use crate::engine::{Engine, Loaded};
use crate::gpu::{PassTime, Timing};
use crate::measure::{Measured, ScreenView, compare, patch_edges, ulp};
use crate::mesh::{EdgeCounts, LoadError, Progress, Source, t_junctions};
use crate::render::{Camera, Scene, Target, patch_lines, t_junction_lines};
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
    let camera = args.surface.camera(&scene.bounds);
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
        let name = args.surface.animation.animation.clone();
        let sizes = engine.sizes(&mut scene, ScreenView { clip_from_object, viewport })?;
        let stats = Stats {
            triangles_in_view: sizes.in_view,
            triangles_below_3_px: sizes.small,
            leaks,
            max_error_px,
            factors_capped,
            factors_file,
            animation: moment.zip(name).map(|(moment, name)| AnimationStats { name, time: moment.time }),
            ..Stats::new(&engine, &loaded, &scene, &measured, &settings, &camera, &target, &passes)
        };
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

/// What was done and what it cost. Times are medians in ms.
#[derive(Debug, Serialize)]
struct Stats {
    adapter: String,
    settings: SettingsStats,
    triangles_in: u64,
    points: u64,
    corners: u64,
    edges: EdgeCounts,
    degenerate: u32,
    patches: u64,
    /// For whatever reason.
    patches_culled: u32,
    patches_out_of_view: u32,
    patches_facing_away: u32,
    /// Patches drawn with factors that are all below 2, edges and inside.
    patches_below_factor_2: u32,
    triangles_out: u64,
    /// Emitted triangles that are neither wholly outside one side of the view nor cut by its near plane.
    triangles_in_view: u64,
    /// Those of them that are half of squares with sides of less than 3 px.
    triangles_below_3_px: u64,
    vertices_out: u64,
    bytes: Bytes,
    cracks: CrackStats,
    /// Px through which one looks into the mesh; none if it is open, reaches the near plane, or patches that face away were
    /// left out.
    leaks: Option<u64>,
    /// Triangles that face away from the side that their patch faces.
    folds: u64,
    /// Vertices with a position or uv that is no finite number.
    not_finite: u64,
    /// The largest distance on screen between what was emitted and its surface, in px; none if it wasn't measured, or
    /// nothing is in view.
    max_error_px: Option<f64>,
    /// Edges (as published or from a file, sides), and under LOD by error insides, that asked for more segments than the
    /// partitioning has.
    factors_capped: u64,
    /// What was found about the factors of a file, if they came from one.
    factors_file: Option<FactorsFile>,
    /// None at rest.
    animation: Option<AnimationStats>,
    ms: BTreeMap<&'static str, f64>,
}

/// What was drawn, in the options' names.
#[derive(Debug, Serialize)]
struct SettingsStats {
    surface: String,
    /// Of Phong tessellation alone.
    alpha: Option<f32>,
    normals: String,
    edges: String,
    partitioning: &'static str,
    lod: String,
    clip: String,
    convention: String,
}

impl SettingsStats {
    fn new(settings: &Settings) -> Self {
        Self {
            surface: option_name(settings.surface),
            alpha: settings.surface.is_phong().then_some(settings.alpha),
            normals: option_name(settings.normals),
            edges: option_name(settings.edges),
            partitioning: settings.partitioning.name(),
            lod: option_name(settings.lod),
            clip: option_name(settings.clip),
            convention: option_name(settings.convention),
        }
    }
}

/// What a value is called on the command line.
fn option_name(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

#[derive(Debug, Serialize)]
struct AnimationStats {
    name: String,
    /// s.
    time: f64,
}

/// Memory, in bytes.
#[derive(Debug, Serialize)]
struct Bytes {
    /// Corners and triangles as loaded.
    input: u64,
    /// Points, patches, edges, nets, factors and counts on the device.
    topology: u64,
    /// Output on the device.
    arena: u64,
}

#[derive(Debug, Serialize)]
struct CrackStats {
    edge_points: u64,
    edges_compared: u64,
    different_bits: u64,
    different_factors: u64,
    different_normals: u64,
    /// Object units.
    max_gap: f64,
    /// In units of the last place of the mesh's largest coordinate.
    max_gap_ulp: f64,
    max_gap_px: f64,
    edges: u64,
}

impl Stats {
    fn new(
        engine: &Engine,
        loaded: &Loaded,
        scene: &Scene,
        measured: &Measured,
        settings: &Settings,
        camera: &Camera,
        target: &Target,
        passes: &[PassTime],
    ) -> Self {
        let (mesh, topology) = (&loaded.mesh, &loaded.topology);
        let (vertices_out, triangles_out) = scene.tessellator.totals();
        let cracks = &measured.cracks;
        let viewport = target.viewport();
        let mut ms: BTreeMap<_, _> = passes.iter().map(|time| (time.pass, time.ms)).collect();
        ms.extend([("load", loaded.load_ms), ("topology", loaded.topology_ms)]);
        Self {
            adapter: engine.gpu.info.name.clone(),
            settings: SettingsStats::new(settings),
            triangles_in: mesh.triangles.len() as u64,
            points: topology.points.len() as u64,
            corners: mesh.corners.len() as u64,
            edges: topology.edge_counts(),
            degenerate: topology.degenerate,
            patches: topology.patches.len() as u64,
            patches_culled: measured.culled.total(),
            patches_out_of_view: measured.culled.out_of_view,
            patches_facing_away: measured.culled.facing_away,
            patches_below_factor_2: measured.patches_low,
            triangles_out,
            triangles_in_view: 0,
            triangles_below_3_px: 0,
            vertices_out,
            bytes: Bytes {
                input: (size_of_val(&mesh.corners[..]) + size_of_val(&mesh.triangles[..])) as u64,
                topology: scene.tessellator.buffers().bytes() + scene.tessellator.work_bytes(),
                arena: scene.tessellator.arena_bytes(),
            },
            cracks: CrackStats {
                edge_points: cracks.edge_points,
                edges_compared: cracks.edges_compared,
                different_bits: cracks.different_bits,
                different_factors: cracks.different_factors,
                different_normals: cracks.different_normals,
                max_gap: cracks.max_gap(),
                max_gap_ulp: cracks.max_gap() / ulp(topology),
                max_gap_px: cracks.max_gap_px(camera.clip_from_object(viewport, &scene.bounds), viewport),
                edges: cracks.edges.len() as u64,
            },
            leaks: None,
            folds: measured.folds,
            not_finite: measured.not_finite,
            max_error_px: None,
            factors_capped: 0,
            factors_file: None,
            animation: None,
            ms,
        }
    }
}
