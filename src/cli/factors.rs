//! `pnaen factors`: writes the hull shader's factors of every patch.

use std::path::{Path, PathBuf};

use super::lod_shader_option::report_own_lod;
use super::tessellate::Device;
use super::{
    AdapterOption, CliError, LodShaderOption, SurfaceOptions, file_of, file_of_heights, keep_apart, load_apart,
    write_text,
};
use crate::engine::Engine;
use crate::factors_file::to_csv;
use crate::gpu::{GpuError, Timing};
use crate::load::Source;
use crate::progress::Progress;
use crate::render::Scene;
use crate::settings::Settings;
use crate::tessellate::{self, HullFactors, Inputs, bounds_through};

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// A .gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf file, or a shape made in code such as shape:cube-split, or
    /// shape:torus@2 (finer)
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    /// File to write, CSV (- for standard output)
    #[arg(short, long, value_name = "OUT.csv")]
    pub output: PathBuf,
    #[command(flatten)]
    pub surface: SurfaceOptions,
    #[command(flatten)]
    pub own_lod: LodShaderOption,
    /// Where to compute; the CPU needs no graphics driver
    #[arg(long, value_enum, default_value_t = Device::Gpu)]
    pub device: Device,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    args.surface.check()?;
    args.adapter.check(args.device == Device::Cpu)?;
    args.own_lod.check(args.device == Device::Cpu)?;
    let heights = file_of_heights(args.surface.height.as_ref());
    let shader = args.own_lod.lod_shader.as_deref();
    keep_apart([file_of(&args.file), heights, shader], [Some(&*args.output)])?;
    let own_lod = args.own_lod.read(&args.surface.tessellation())?;
    let loaded = load_apart(&args.file, &args.surface.preparation(), &[Some(&args.output)])?;
    let moment = args.surface.animation.moment(&loaded)?;
    let posed = loaded.posed(moment);
    let (mesh, topology) = (&posed.mesh, &posed.topology);
    let bounds = bounds_through(&loaded.mesh, moment.map(|moment| moment.clip));
    let view = args.surface.camera(mesh, moment, &bounds)?.lod_view(args.surface.viewport(), &bounds);
    let written = match args.device {
        Device::Cpu => {
            let count = |settings: &Settings| Ok(tessellate::totals(mesh, topology, &settings.inputs(view)).1);
            tessellate::hull_factors(mesh, topology, &args.surface.within_budget(count)?.inputs(view))
        }
        Device::Gpu => {
            let engine = Engine::chosen(&args.adapter.choice())?;
            let mut scene = engine.scene(&loaded, args.surface.arena_bytes())?;
            scene.tessellator.give(own_lod)?;
            scene.set_moment(moment)?;
            let settings = args.surface.within_budget(|settings| {
                engine.count(&mut scene, &settings.inputs(view), &mut Timing::Off)?;
                Ok(scene.tessellator.totals().1)
            })?;
            let written = computed(&engine, &mut scene, &settings.inputs(view))?;
            report_own_lod(&engine, &scene)?;
            written
        }
    };
    write_text(&args.output, &to_csv(topology, &written, args.surface.tessellation().partitioning))
}

/// The factors that a hull shader would hand to the tessellator with these inputs.
fn computed(engine: &Engine, scene: &mut Scene, inputs: &Inputs) -> Result<Vec<HullFactors>, GpuError> {
    engine.count(scene, inputs, &mut Timing::Off)?;
    scene.tessellator.hull_factors()
}

/// Writes the factors of a scene with these inputs as CSV.
///
/// # Errors
/// The device was lost, or the file can't be written.
pub(crate) fn write_factors(
    engine: &Engine,
    scene: &mut Scene,
    inputs: &Inputs,
    path: &Path,
    progress: &Progress,
) -> Result<(), CliError> {
    let factors = computed(engine, scene, inputs)?;
    progress.check()?;
    write_text(path, &to_csv(scene.tessellator.topology(), &factors, inputs.tessellation.partitioning))
}
