//! `pnaen gallery`: every technique side by side.

use std::path::PathBuf;

use super::{AdapterOption, CliError, ProgressPrinter, WeldOption, make_folder, options, refuse, warn, write_text};
use inspect::engine::{Engine, Preparation};
use inspect::settings::options::{FACTOR, HEIGHT_SCALE, MIDLEVEL};
use inspect::shot::write_picture;
use lab::gallery::{Exhibit, Gallery, GalleryOptions, PAGE, page};
use load::{HeightSource, Source};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A mesh file, or a shape made in code; without one, each exhibit has
    /// the shape that suits it
    #[arg(value_parser = super::options::source())]
    pub file: Option<Source>,
    /// Folder for a picture of each exhibit, and a page that explains them, gallery.md; made if it isn't there
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    #[command(flatten)]
    pub weld: WeldOption,
    /// Height map of the displacement exhibit: an image, or `material`; by default waves made in code
    #[arg(long, value_name = "IMAGE|material", value_parser = options::heights())]
    pub height: Option<HeightSource>,
    /// How far white lies above black in that exhibit, in bounding radii, -1 to 1
    #[arg(long, value_name = "S", default_value_t = 0.15, value_parser = options::number_of(&HEIGHT_SCALE), allow_hyphen_values = true)]
    pub height_scale: f32,
    /// Height at which that exhibit's displacement moves nothing, 0 to 1
    #[arg(long, value_name = "H", default_value_t = 0.5, value_parser = options::number_of(&MIDLEVEL))]
    pub midlevel: f32,
    /// Tessellation factor, 1 to 64; the exhibits of patterns and displacement have their own. It is lower where a tile would
    /// have more than about 2,000,000 triangles
    #[arg(long, value_name = "F", default_value_t = 12.0, value_parser = options::number_of(&FACTOR))]
    pub factor: f32,
    /// Degrees from the front to the right, and degrees upwards
    #[arg(long, value_name = "AZIMUTH,ELEVATION", default_value = "30,20", allow_hyphen_values = true)]
    pub camera: options::CameraOption,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    let is_far = args.camera.distance.is_some();
    refuse(is_far, "--camera takes AZIMUTH,ELEVATION here: the distance is chosen so that each tile is filled")?;
    let options = GalleryOptions {
        source: args.file.clone(),
        preparation: Preparation { heights: args.height.clone(), ..args.weld.preparation() },
        factor: args.factor,
        height_scale: args.height_scale,
        midlevel: args.midlevel,
        azimuth: args.camera.azimuth,
        elevation: args.camera.elevation.clamp(-89.9, 89.9),
    };
    let engine = Engine::chosen(&args.adapter.choice())?;
    make_folder(&args.output)?;
    let mut gallery = Gallery::new(options, &engine);
    let (exhibits, warnings) = gallery.exhibits()?;
    warn(&warnings);
    let (mut all, mut progress_printer) = (Vec::new(), ProgressPrinter::new());
    for exhibit in exhibits {
        let Exhibit { name, tiles, .. } = &exhibit;
        let said = |tile: usize| format!("{name}, {} of {}: {}", tile + 1, tiles.len(), tiles[tile].name);
        let (picture, shown) = gallery.draw(&exhibit, |tile| progress_printer.print(|| said(tile)))?;
        write_picture(&args.output.join(format!("{name}.png")), &picture.into())?;
        all.push((exhibit, shown));
    }
    let subject = args.file.as_ref().map(Source::title);
    Ok(write_text(&args.output.join(PAGE), &page(subject.as_deref(), &engine.gpu.info.name, &all))?)
}
