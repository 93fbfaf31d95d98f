//! `pnaen tessellate`: writes the tessellated mesh.

use std::path::PathBuf;
use std::sync::Arc;

use clap::ValueEnum;

use super::gate_options::{GateOptions, failures};
use super::options::CamerasOption;
use super::posed::Posed;
use super::view_files::{View, ViewFiles};
use super::{
    AdapterOption, CliError, FactorsOption, LodShaderOption, SurfaceOptions, SurfaceShaderOption, file_of,
    files_of_heights, keep_apart, options, refuse, warn,
};
use geometry::mesh::t_junctions;
use geometry::progress::Progress;
use geometry::tessellate::{HullFactors, Inputs, Tessellated, Tessellation};
use gpu::{Given, GpuError, SurfaceShader, Timing};
use inspect::engine::{Engine, Loaded};
use inspect::export::Exported;
use inspect::gates::{Facts, GateKind, Judgement, judge};
use inspect::measure::{
    CrossingMeasurement, EmittedChunk, Measured, RequestedFactors, ScreenErrorMeasurement, Visitor,
};
use inspect::render::Camera;
use inspect::shot::{Shot, ShotError, ShotView, Subject, report_user_lod, report_user_surface};
use load::Source;

/// The endings of meshes, and what is said of an output with another one.
const ENDINGS: &[&str] = &["glb", "obj"];
const WANTED: &str = "meshes are written as .glb or .obj files: name it one of these";

#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(help = super::options::mesh_help(), value_parser = super::options::source())]
    pub file: Source,
    /// Mesh to write, a .glb or .obj file. With --cameras, a name with {} where each view's name goes
    #[arg(short, long, value_name = "OUT.glb|OUT.obj", value_parser = options::ending_in(ENDINGS, WANTED))]
    pub output: PathBuf,
    #[command(flatten)]
    pub surface: SurfaceOptions,
    #[command(flatten)]
    pub given: FactorsOption,
    #[command(flatten)]
    pub user_lod: LodShaderOption,
    #[command(flatten)]
    pub user_surface: SurfaceShaderOption,
    #[command(flatten)]
    pub cameras: CamerasOption,
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
pub enum Device {
    Gpu,
    Cpu,
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    run_with(args, || Engine::chosen(&args.adapter.choice()))
}

/// Like [`run`], with an engine that is made once the arguments have been checked.
pub fn run_with(args: &Args, engine: impl FnOnce() -> Result<Engine, GpuError>) -> Result<(), CliError> {
    args.check()?;
    let files = ViewFiles::new(&args.output, ENDINGS, &args.cameras);
    let several = "--cameras writes several meshes: put {} into the name of -o where the views' names go";
    let views = files.views(&args.cameras, &args.surface, several)?;
    let written = files.checked(&views);
    let factors = args.given.given.as_deref();
    let shaders = [args.user_lod.lod_shader.as_deref(), args.user_surface.surface_shader.as_deref()];
    let read = [file_of(&args.file), factors, args.cameras.file()].into_iter().chain(shaders);
    keep_apart(read.chain(files_of_heights(&args.surface.height)), written.iter().copied())?;
    let user_lod = args.user_lod.read(&args.surface)?;
    let surface_shader = args.user_surface.read(&args.surface.weld.parts)?;
    let ready = Ready { args, mesh: Posed::load(&args.surface, &args.file, &written)? };
    let Loaded { mesh, topology, .. } = &ready.mesh.posed;
    let given = args.given.read(mesh, topology, &args.surface)?;
    let given = given.map(|(factors, _)| factors);
    let views = views.iter().map(|view| Ok((view, ready.mesh.camera(view)?))).collect::<Result<Vec<_>, CliError>>()?;
    let failed = match args.device {
        Device::Cpu => ready.on_cpu(&views, given.as_deref())?,
        Device::Gpu => ready.on_gpu(&views, engine()?, given.map(Given::from).or(user_lod), surface_shader)?,
    };
    if failed.is_empty() { Ok(()) } else { Err(CliError::Gates(failed)) }
}

impl Args {
    /// Checks the options before anything is read.
    fn check(&self) -> Result<(), CliError> {
        self.surface.check(None)?;
        self.adapter.check(self.device == Device::Cpu)?;
        self.user_lod.check(self.device == Device::Cpu)?;
        self.user_lod.check_alone(&self.given)?;
        self.user_surface.check(self.device == Device::Cpu, &self.gates.gates.fail_on)?;
        self.gates.check(self.device == Device::Cpu)?;
        let compares = self.gates.gates.has(GateKind::Deviation);
        refuse(compares, "--fail-on deviation needs a reference surface, which render and check take")
    }
}

/// A mesh that is ready to be tessellated for each view.
struct Ready<'a> {
    args: &'a Args,
    mesh: Posed<'a>,
}

impl Ready<'_> {
    /// Checks that the view's file can hold so many vertices and triangles, before they are there.
    fn check(&self, view: &View, vertices: u64, triangles: u64) -> Result<(), CliError> {
        Ok(Exported::check(&view.file, &self.mesh.posed.mesh, vertices, triangles).map_err(ShotError::from)?)
    }

    /// Writes what was tessellated for a view. Standard error tells what couldn't be written.
    fn write(&self, view: &View, tessellated: &Tessellated) -> Result<(), CliError> {
        let exported = Exported::new(&self.mesh.posed.mesh, &self.mesh.posed.topology, tessellated);
        warn(&exported.write(&view.file).map_err(ShotError::from)?);
        Ok(())
    }

    /// Tessellates on the CPU. Returns a sentence for each gate that failed.
    fn on_cpu(&self, views: &[(&View, Camera)], given: Option<&[HullFactors]>) -> Result<Vec<String>, CliError> {
        let mut failed = Vec::new();
        for (view, camera) in views {
            let inputs = self.mesh.inputs(self.mesh.lod_view(camera))?;
            let check = |vertices, triangles| self.check(view, vertices, triangles);
            let tessellated = self.mesh.tessellated(&inputs, given, check)?;
            self.write(view, &tessellated)?;
            let judged = self.judged_on_cpu(given, &inputs, &tessellated)?;
            failed.extend(failures(&view.name_of(&self.args.file), &judged));
        }
        Ok(failed)
    }

    /// The same on the device.
    fn on_gpu(
        &self,
        views: &[(&View, Camera)],
        engine: Engine,
        given: Option<Given>,
        surface_shader: Option<Arc<SurfaceShader>>,
    ) -> Result<Vec<String>, CliError> {
        let Args { gates, surface, file, .. } = self.args;
        let mut scene = engine.scene(&self.mesh.loaded, surface.arena_bytes())?;
        let mut subject = Subject {
            moment: self.mesh.moment,
            given,
            surface_shader,
            arena_bytes: surface.arena_bytes(),
            ..Subject::new(self.mesh.loaded.clone(), surface.settings())
        };
        subject.apply_to_scene(&engine, &mut scene)?;
        let mut failed = Vec::new();
        for (index, (view, camera)) in views.iter().enumerate() {
            let lod_view = self.mesh.lod_view(camera);
            let settings = surface.within_budget_on(&engine, &mut scene, lod_view)?;
            engine.count(&mut scene, &settings.inputs(lod_view), &mut Timing::Off)?;
            if index == 0 {
                report_user_surface(&engine, &scene)?;
                report_user_lod(&engine, &scene)?;
            }
            let (vertices, triangles) = scene.tessellator.totals();
            self.check(view, vertices, triangles)?;
            self.write(view, &engine.read_tessellated(&mut scene)?)?;
            if !gates.gates.fail_on.is_empty() {
                let size = surface.size;
                let seen = ShotView { camera: *camera, lod_camera: None, size, transparent: false, legend: false };
                let mut shot = Shot::new(engine.clone(), scene, Subject { settings, ..subject }, seen)?;
                let judged = shot.judge(&gates.gates.fail_on, surface.tessellation().tolerance, &Progress::new())?;
                gates.write_evidence(&mut shot, &judged, &view.file)?;
                failed.extend(failures(&view.name_of(file), &judged));
                (scene, subject) = shot.into_parts();
            }
        }
        Ok(failed)
    }

    /// Judges what the CPU emitted by the gates.
    fn judged_on_cpu(
        &self,
        given: Option<&[HullFactors]>,
        inputs: &Inputs,
        out: &Tessellated,
    ) -> Result<Vec<Judgement>, CliError> {
        let gates = &self.args.gates.gates;
        let (mesh, topology) = (&self.mesh.posed.mesh, &self.mesh.posed.topology);
        let Tessellation { edges, convention, .. } = inputs.tessellation;
        let measured = gates.fail_on.iter().any(|gate| gate.kind.needs_survey()).then(|| {
            let of_lod = || RequestedFactors::new(edges, convention, out.edge_factors.clone());
            let asked = given.map_or_else(of_lod, |given| RequestedFactors::given(convention, given));
            Measured::new(mesh, topology, asked, out)
        });
        let above = gates.has(GateKind::AboveTolerance).then(|| {
            let measurement = ScreenErrorMeasurement::new(mesh, topology, inputs, out.triangles.len() as u64);
            let mut measurement = measurement.counting_above(self.args.surface.tessellation().tolerance);
            measurement.take(&EmittedChunk::whole(&out.vertices, &out.triangles));
            measurement.above()
        });
        let junctions = || t_junctions(&self.mesh.loaded.topology, &Progress::new());
        let junctions = gates.has(GateKind::TJunctions).then(junctions).transpose()?;
        let crossed = gates.has(GateKind::SelfIntersections).then(|| {
            let mut measurement = CrossingMeasurement::default();
            measurement.take(&EmittedChunk::whole(&out.vertices, &out.triangles));
            measurement.finish(topology, &Progress::new())
        });
        let crossed = crossed.transpose()?;
        let facts = Facts {
            warnings: Some(&self.mesh.posed.warnings),
            emitted: Some((out.vertices.len() as u64, out.triangles.len() as u64)),
            measured: measured.as_ref(),
            mesh: Some((&self.mesh.loaded.mesh, &self.mesh.loaded.topology)),
            junctions: junctions.as_deref(),
            above: above.as_ref(),
            crossed: crossed.as_ref().map(Option::as_deref),
            ..Facts::from_mesh(topology)
        };
        Ok(judge(&gates.fail_on, &facts))
    }
}
