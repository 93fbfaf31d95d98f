//! `pnaen tessellate`: writes the tessellated mesh.

use std::path::PathBuf;

use clap::ValueEnum;

use super::lod_shader_option::report_own_lod;
use super::{
    AdapterOption, CliError, FactorsOption, LodShaderOption, SurfaceOptions, file_of, file_of_heights, keep_apart,
    load_apart, options, warn,
};
use crate::engine::Engine;
use crate::export::Exported;
use crate::gpu::{Given, GpuError, Timing};
use crate::load::Source;
use crate::settings::Settings;
use crate::tessellate::{self, bounds_through};

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// A .gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf file, or a shape made in code such as shape:cube-split, or
    /// shape:torus@2 (finer)
    #[arg(value_parser = super::options::source())]
    pub file: Source,
    /// Mesh to write, a .glb or .obj file
    #[arg(short, long, value_name = "OUT.glb|OUT.obj", value_parser = options::model())]
    pub output: PathBuf,
    #[command(flatten)]
    pub surface: SurfaceOptions,
    #[command(flatten)]
    pub given: FactorsOption,
    #[command(flatten)]
    pub own_lod: LodShaderOption,
    /// Where to tessellate; the CPU needs no graphics driver
    #[arg(long, value_enum, default_value_t = Device::Gpu)]
    pub device: Device,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

/// Where the tessellation is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Device {
    Gpu,
    Cpu,
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    run_with(args, || Engine::chosen(&args.adapter.choice()))
}

/// Like [`run`], with an engine that is made once the arguments have been checked.
///
/// # Errors
/// Those of the command.
pub(crate) fn run_with(args: &Args, engine: impl FnOnce() -> Result<Engine, GpuError>) -> Result<(), CliError> {
    args.surface.check()?;
    args.adapter.check(args.device == Device::Cpu)?;
    args.own_lod.check(args.device == Device::Cpu)?;
    Exported::check_ending(&args.output)?;
    let heights = file_of_heights(args.surface.height.as_ref());
    let (factors, shader) = (args.given.given.as_deref(), args.own_lod.lod_shader.as_deref());
    keep_apart([file_of(&args.file), heights, factors, shader], [Some(&*args.output)])?;
    let own_lod = args.own_lod.read(&args.surface.tessellation())?;
    let loaded = load_apart(&args.file, &args.surface.preparation(), &[Some(&args.output)])?;
    let moment = args.surface.animation.moment(&loaded)?;
    let posed = loaded.posed(moment);
    let (mesh, topology) = (&posed.mesh, &posed.topology);
    let given = args.given.read(mesh, topology, &args.surface.tessellation())?.map(|given| given.factors);
    let bounds = bounds_through(&loaded.mesh, moment.map(|moment| moment.clip));
    let view = args.surface.camera(mesh, moment, &bounds)?.lod_view(args.surface.viewport(), &bounds);
    let tessellated = match args.device {
        Device::Cpu => {
            let count = |settings: &Settings| Ok(tessellate::totals(mesh, topology, &settings.inputs(view)).1);
            let inputs = args.surface.within_budget(count)?.inputs(view);
            let (vertices, triangles) = match &given {
                Some(given) => tessellate::given_totals(given, &inputs),
                None => tessellate::totals(mesh, topology, &inputs),
            };
            Exported::check(&args.output, mesh, vertices, triangles)?;
            match &given {
                Some(given) => tessellate::tessellate_given(mesh, topology, &inputs, given),
                None => tessellate::tessellate(mesh, topology, &inputs, None),
            }
        }
        Device::Gpu => {
            let engine = engine()?;
            let mut scene = engine.scene(&loaded, args.surface.arena_bytes())?;
            scene.tessellator.give(given.map(Given::from).or(own_lod))?;
            scene.set_moment(moment)?;
            let settings = args.surface.within_budget(|settings| {
                engine.count(&mut scene, &settings.inputs(view), &mut Timing::Off)?;
                Ok(scene.tessellator.totals().1)
            })?;
            let inputs = settings.inputs(view);
            engine.count(&mut scene, &inputs, &mut Timing::Off)?;
            report_own_lod(&engine, &scene)?;
            let (vertices, triangles) = scene.tessellator.totals();
            Exported::check(&args.output, mesh, vertices, triangles)?;
            engine.read_tessellated(&mut scene)?
        }
    };
    warn(&Exported::new(mesh, topology, &tessellated).write(&args.output)?);
    Ok(())
}
