//! `pnaen factors`: writes the hull shader's factors of every patch.

use std::path::PathBuf;

use super::options::CamerasOption;
use super::posed::Posed;
use super::tessellate::Device;
use super::view_files::{View, ViewFiles};
use super::{
    AdapterOption, CliError, LodShaderOption, SurfaceOptions, file_of, files_of_heights, keep_apart, write_text,
};
use geometry::tessellate::hull_factors;
use inspect::engine::Engine;
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
        Device::Gpu => {
            // The mesh on the device, in its pose, and what takes the place of LOD there.
            let engine = Engine::chosen(&args.adapter.choice())?;
            let mut scene = engine.scene(&mesh.loaded, args.surface.arena_bytes())?;
            scene.tessellator.give(user_lod)?;
            scene.set_moment(mesh.moment)?;
            Some((engine, scene))
        }
    };
    files.make_folder()?;
    for (index, (view, lod_view)) in views.iter().zip(lod_views).enumerate() {
        let factors = match &mut on_gpu {
            None => hull_factors(&mesh.posed.mesh, topology, &mesh.inputs(lod_view)?),
            Some((engine, scene)) => {
                let settings = args.surface.within_budget_on(engine, scene, lod_view)?;
                let factors = computed(engine, scene, &settings.inputs(lod_view))?;
                // The first view's are reported on, if a shader of the user's own gives them.
                if index == 0 {
                    report_user_lod(engine, scene)?;
                }
                factors
            }
        };
        write_text(&view.file, &to_csv(topology, &factors, args.surface.tessellation().partitioning))?;
    }
    Ok(())
}
