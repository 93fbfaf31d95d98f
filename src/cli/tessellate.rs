//! `pnaen tessellate`: writes the tessellated mesh.

use std::path::PathBuf;

use clap::ValueEnum;

use super::gate_options::{GateOptions, pass};
use super::lod_shader_option::report_own_lod;
use super::shot::{Shot, ShotView, Subject};
use super::surface_shader_option::report_own_surface;
use super::{
    AdapterOption, CliError, FactorsOption, LodShaderOption, SurfaceOptions, SurfaceShaderOption, file_of,
    file_of_heights, keep_apart, load_apart, options, warn,
};
use crate::engine::{Engine, Loaded};
use crate::export::Exported;
use crate::gates::{Facts, GateKind, judge};
use crate::gpu::{Given, GpuError, Timing};
use crate::load::Source;
use crate::measure::{AskedFactors, EmittedChunk, Measured, ScreenErrorMeasurement, Visitor};
use crate::mesh::{Moment, t_junctions};
use crate::progress::Progress;
use crate::render::{Camera, Scene};
use crate::settings::Settings;
use crate::tessellate::{self, HullFactors, Inputs, LodView, Tessellated, Tessellation, bounds_through};

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
    #[command(flatten)]
    pub own_surface: SurfaceShaderOption,
    /// Where to tessellate; the CPU needs no graphics driver
    #[arg(long, value_enum, default_value_t = Device::Gpu)]
    pub device: Device,
    #[command(flatten)]
    pub gates: GateOptions,
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
    args.check()?;
    let heights = file_of_heights(args.surface.height.as_ref());
    let factors = args.given.given.as_deref();
    let shaders = [args.own_lod.lod_shader.as_deref(), args.own_surface.surface_shader.as_deref()];
    keep_apart([file_of(&args.file), heights, factors].into_iter().chain(shaders), [Some(&*args.output)])?;
    let own_lod = args.own_lod.read(&args.surface.tessellation())?;
    let surface_shader = args.own_surface.read()?;
    let loaded = load_apart(&args.file, &args.surface.preparation(), &[Some(&args.output)])?;
    let moment = args.surface.animation.moment(&loaded)?;
    let posed = loaded.posed(moment);
    let (mesh, topology) = (&posed.mesh, &posed.topology);
    let given = args.given.read(mesh, topology, &args.surface.tessellation())?.map(|given| given.factors);
    let bounds = bounds_through(&loaded.mesh, moment.map(|moment| moment.clip));
    let camera = args.surface.camera(mesh, moment, &bounds)?;
    let view = camera.lod_view(args.surface.viewport(), &bounds);
    match args.device {
        Device::Cpu => {
            let (inputs, tessellated) = args.on_cpu(&posed, given.as_deref(), view)?;
            warn(&Exported::new(mesh, topology, &tessellated).write(&args.output)?);
            args.judge_on_cpu([&loaded, &posed], given.as_deref(), &inputs, &tessellated)
        }
        Device::Gpu => {
            let engine = engine()?;
            let mut scene = engine.scene(&loaded, args.surface.arena_bytes())?;
            let given = given.map(Given::from).or(own_lod);
            let subject = Subject { surface_shader, ..args.subject(loaded, moment, given) };
            subject.dress(&engine, &mut scene)?;
            let (settings, tessellated) = args.on_gpu(&engine, &mut scene, &posed, view)?;
            warn(&Exported::new(mesh, topology, &tessellated).write(&args.output)?);
            args.judge_on_gpu(engine, scene, Subject { settings, ..subject }, camera)
        }
    }
}

impl Args {
    /// Checks the options before anything is read.
    fn check(&self) -> Result<(), CliError> {
        self.surface.check()?;
        self.adapter.check(self.device == Device::Cpu)?;
        self.own_lod.check(self.device == Device::Cpu)?;
        self.own_lod.check_alone(&self.given)?;
        self.own_surface.check(self.device == Device::Cpu, &self.gates.gates.fail_on)?;
        let draws = self.gates.evidence.is_some() || self.gates.gates.has(GateKind::Leaks);
        if draws && self.device == Device::Cpu {
            return Err(CliError::Usage("--fail-on leaks and --evidence need --device gpu, which draws"));
        }
        Exported::check_ending(&self.output)?;
        Ok(())
    }

    /// Tessellates on the CPU, within the budget of triangles. Returns what was tessellated with, too.
    fn on_cpu(
        &self,
        posed: &Loaded,
        given: Option<&[HullFactors]>,
        view: LodView,
    ) -> Result<(Inputs, Tessellated), CliError> {
        let (mesh, topology) = (&posed.mesh, &posed.topology);
        let count = |settings: &Settings| Ok(tessellate::totals(mesh, topology, &settings.inputs(view)).1);
        let inputs = self.surface.within_budget(count)?.inputs(view);
        let (vertices, triangles) = match given {
            Some(given) => tessellate::given_totals(given, &inputs),
            None => tessellate::totals(mesh, topology, &inputs),
        };
        Exported::check(&self.output, mesh, vertices, triangles)?;
        let tessellated = match given {
            Some(given) => tessellate::tessellate_given(mesh, topology, &inputs, given),
            None => tessellate::tessellate(mesh, topology, &inputs, None),
        };
        Ok((inputs, tessellated))
    }

    /// The same on the device, where the scene has its pose and its factors. Returns the settings, too.
    fn on_gpu(
        &self,
        engine: &Engine,
        scene: &mut Scene,
        posed: &Loaded,
        view: LodView,
    ) -> Result<(Settings, Tessellated), CliError> {
        let settings = self.surface.within_budget(|settings| {
            engine.count(scene, &settings.inputs(view), &mut Timing::Off)?;
            Ok(scene.tessellator.totals().1)
        })?;
        engine.count(scene, &settings.inputs(view), &mut Timing::Off)?;
        report_own_surface(engine, scene)?;
        report_own_lod(engine, scene)?;
        let (vertices, triangles) = scene.tessellator.totals();
        Exported::check(&self.output, &posed.mesh, vertices, triangles)?;
        Ok((settings, engine.read_tessellated(scene)?))
    }

    /// What a picture of the mesh would be drawn from.
    fn subject(&self, loaded: Loaded, moment: Option<Moment>, given: Option<Given>) -> Subject {
        Subject {
            loaded,
            moment,
            given,
            surface_shader: None,
            matcap: None,
            environment: None,
            settings: self.surface.settings(),
            reference_surface: None,
            selected: None,
            more_lines: Default::default(),
            arena_bytes: self.surface.arena_bytes(),
        }
    }

    /// Judges what the device emitted by the gates, seen from `camera`, and draws what they found.
    fn judge_on_gpu(&self, engine: Engine, scene: Scene, subject: Subject, camera: Camera) -> Result<(), CliError> {
        if self.gates.gates.fail_on.is_empty() {
            return Ok(());
        }
        let size = self.surface.size.0;
        let view = ShotView { camera, lod_camera: None, size, transparent: false, legend: false };
        let mut shot = Shot::new(engine, scene, subject, view)?;
        let tolerance_px = self.surface.tessellation().tolerance;
        let judged = shot.judge(&self.gates.gates.fail_on, tolerance_px, &Progress::new())?;
        self.gates.write_evidence(&mut shot, &judged, &self.output)?;
        pass(&self.file, &judged)
    }

    /// Judges what the CPU emitted by the gates. The mesh is given at rest, and in the pose that was tessellated.
    fn judge_on_cpu(
        &self,
        [at_rest, posed]: [&Loaded; 2],
        given: Option<&[HullFactors]>,
        inputs: &Inputs,
        out: &Tessellated,
    ) -> Result<(), CliError> {
        let gates = &self.gates.gates;
        let (mesh, topology) = (&posed.mesh, &posed.topology);
        let Tessellation { edges, convention, .. } = inputs.tessellation;
        let measured = gates.fail_on.iter().any(|gate| gate.kind.needs_survey()).then(|| {
            let of_lod = || AskedFactors::new(edges, convention, out.edge_factors.clone());
            let asked = given.map_or_else(of_lod, |given| AskedFactors::given(convention, given));
            Measured::of(mesh, topology, asked, out)
        });
        let above = gates.has(GateKind::AboveTolerance).then(|| {
            let measurement = ScreenErrorMeasurement::new(mesh, topology, inputs, out.triangles.len() as u64);
            let mut measurement = measurement.counting_above(self.surface.tessellation().tolerance);
            measurement.take(&EmittedChunk::whole(&out.vertices, &out.triangles));
            measurement.above()
        });
        let junctions = || t_junctions(&at_rest.topology, &Progress::new());
        let junctions = gates.has(GateKind::TJunctions).then(junctions).transpose()?;
        let facts = Facts {
            topology,
            warnings: &posed.warnings,
            vertices: out.vertices.len() as u64,
            triangles: out.triangles.len() as u64,
            measured: measured.as_ref(),
            junctions: junctions.as_deref(),
            leaks: None,
            above: above.as_ref(),
        };
        pass(&self.file, &judge(&gates.fail_on, &facts))
    }
}
