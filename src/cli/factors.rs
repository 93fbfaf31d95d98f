//! `pnaen factors`: writes the hull shader's factors of every patch.

use std::path::PathBuf;

use super::options::CamerasOption;
use super::posed::Posed;
use super::tessellate::Device;
use super::view_files::{View, ViewFiles};
use super::{
    AdapterOption, CliError, LodShaderOption, SurfaceOptions, file_of, files_of_heights, keep_apart, write_text,
};
use geometry::tessellate::{HullFactors, LodView, hull_factors};
use gpu::Given;
use inspect::engine::Engine;
use inspect::render::Scene;
use inspect::shot::files::computed;
use inspect::shot::report_user_lod;
use load::Source;
use load::factors_file::to_csv;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(help = super::options::mesh_help(), value_parser = super::options::source())]
    pub file: Source,
    /// File to write, CSV (- for standard output). With --cameras, a folder, or a name with {} where each view's name goes
    #[arg(short, long, value_name = "OUT.csv")]
    pub output: PathBuf,
    #[command(flatten)]
    pub surface: SurfaceOptions,
    #[command(flatten)]
    pub user_lod: LodShaderOption,
    #[command(flatten)]
    pub cameras: CamerasOption,
    /// Where to compute; the CPU needs no graphics driver
    #[arg(long, value_enum, default_value_t = Device::Gpu)]
    pub device: Device,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    args.surface.check(None)?;
    args.adapter.check(args.device == Device::Cpu)?;
    args.user_lod.check(args.device == Device::Cpu)?;
    let files = ViewFiles::new(&args.output, &["csv"], &args.cameras);
    let several = "--cameras writes several files: name a folder with -o, or put {} where the views' names go";
    let views = files.views(&args.cameras, &args.surface, several)?;
    let written = files.checked(&views);
    let shader = args.user_lod.lod_shader.as_deref();
    let read = [file_of(&args.file), shader, args.cameras.file()].into_iter();
    keep_apart(read.chain(files_of_heights(&args.surface.height)), written.iter().copied())?;
    let user_lod = args.user_lod.read(&args.surface)?;
    let mesh = Posed::load(&args.surface, &args.file, &written)?;
    let topology = &mesh.posed.topology;
    let lod_view = |view: &View| Ok(mesh.lod_view(&mesh.camera(view)?));
    let lod_views = views.iter().map(lod_view).collect::<Result<Vec<_>, CliError>>()?;
    let mut on_gpu = match args.device {
        Device::Cpu => None,
        Device::Gpu => Some(args.uploaded(&mesh, user_lod)?),
    };
    files.make_folder()?;
    for (index, (view, lod_view)) in views.iter().zip(lod_views).enumerate() {
        let factors = match &mut on_gpu {
            None => hull_factors(&mesh.posed.mesh, topology, &mesh.inputs(lod_view)?),
            Some((engine, scene)) => args.factors_on_gpu(engine, scene, lod_view, index == 0)?,
        };
        write_text(&view.file, &to_csv(topology, &factors, args.surface.tessellation().partitioning))?;
    }
    Ok(())
}

impl Args {
    /// A mesh on the device, in its pose, and what takes the place of LOD there.
    fn uploaded(&self, mesh: &Posed, user_lod: Option<Given>) -> Result<(Engine, Scene), CliError> {
        let engine = Engine::chosen(&self.adapter.choice())?;
        let mut scene = engine.scene(&mesh.loaded, self.surface.arena_bytes())?;
        scene.tessellator.give(user_lod)?;
        scene.set_moment(mesh.moment)?;
        Ok((engine, scene))
    }

    /// The factors of a view, computed on the device. The first view's are reported on, if a shader of the user's own gives them.
    fn factors_on_gpu(
        &self,
        engine: &Engine,
        scene: &mut Scene,
        lod_view: LodView,
        is_first: bool,
    ) -> Result<Vec<HullFactors>, CliError> {
        let settings = self.surface.within_budget_on(engine, scene, lod_view)?;
        let factors = computed(engine, scene, &settings.inputs(lod_view))?;
        if is_first {
            report_user_lod(engine, scene)?;
        }
        Ok(factors)
    }
}
