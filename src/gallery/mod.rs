//! Every technique side by side, on one mesh: pictures, numbers, and a page that says what each is and whose.

mod exhibits;
mod page;

use image::{DynamicImage, RgbImage};
use thiserror::Error;

pub use exhibits::{Exhibit, Tile, exhibits};
pub use page::{PAGE, page};

use crate::engine::{Engine, Loaded, Preparation, load};
use crate::gpu::{GpuError, Timing};
use crate::measure::{ChartError, sheet};
use crate::mesh::{LoadError, Progress, Source};
use crate::render::{Camera, Scene, Target};
use crate::settings::{ARENA_BYTES, Overlays, Settings};
use crate::tessellate::Displacement;

/// Why there is no gallery.
#[derive(Debug, Error)]
pub enum GalleryError {
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Chart(#[from] ChartError),
}

/// Width and height of one tile, in px.
const TILE: [u32; 2] = [300, 240];

/// How much farther away than what shows the mesh: surfaces and heights stand out.
const AWAY: f32 = 1.15;

/// What is looked at, and how.
#[derive(Clone, Debug)]
pub struct Look {
    /// The mesh; none for a shape made in code that suits each exhibit.
    pub source: Option<Source>,
    pub preparation: Preparation,
    /// Tessellation factor.
    pub factor: f32,
    /// How far white is above black, in bounding radii, and the height that stays.
    pub height_scale: f32,
    pub midlevel: f32,
    /// From the front to the right and upwards, in degrees.
    pub azimuth: f32,
    pub elevation: f32,
}

/// What one tile showed.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    pub triangles: u64,
    /// Edge points whose positions differ in at least one bit, and the widest gap in object units.
    pub different_bits: u64,
    pub max_gap: f64,
    /// Edge points whose normals differ though the mesh's agree.
    pub different_normals: u64,
    pub folds: u64,
}

/// Draws an exhibit: its tiles in rows, and what each showed, in their order.
///
/// # Errors
/// [`GalleryError`].
pub fn draw(exhibit: &Exhibit, look: &Look, engine: &Engine) -> Result<(RgbImage, Vec<Shown>), GalleryError> {
    let target = Target::new(&engine.gpu, TILE)?;
    let (mut parts, mut all) = (Vec::new(), Vec::new());
    let mut known: Option<(f32, Loaded, Scene)> = None;
    for tile in &exhibit.tiles {
        if known.as_ref().is_none_or(|(rim, ..)| *rim != tile.rim) {
            let loaded = prepared(exhibit, look, tile.rim)?;
            let scene = engine.scene(&loaded, ARENA_BYTES)?;
            known = Some((tile.rim, loaded, scene));
        }
        let Some((_, loaded, scene)) = &mut known else { continue };
        let (picture, shown) = draw_tile(tile, exhibit.overlays, look, engine, &target, loaded, scene)?;
        parts.push((tile.name.clone(), picture));
        all.push(shown);
    }
    let columns = if parts.len() % 4 == 0 { 4 } else { 3 };
    Ok((sheet(&parts, columns)?, all))
}

/// The exhibit's mesh; with the heights that suit a shape made in code where it is to be displaced and nobody named others.
fn prepared(exhibit: &Exhibit, look: &Look, rim: f32) -> Result<Loaded, LoadError> {
    let source = look.source.clone().unwrap_or(Source::Shape(exhibit.shape));
    let preparation = Preparation { rim, ..look.preparation.clone() };
    let mut loaded = load(&source, &preparation, &Progress::new())?;
    let displaced = exhibit.tiles.iter().any(|tile| tile.settings.displacement != Displacement::Off);
    if displaced && loaded.mesh.heights.is_none() {
        let mut mesh = (*loaded.mesh).clone();
        mesh.heights = Some(std::sync::Arc::new(exhibits::waves(&mesh)));
        loaded.mesh = std::sync::Arc::new(mesh);
    }
    Ok(loaded)
}

fn draw_tile(
    tile: &Tile,
    overlays: Overlays,
    look: &Look,
    engine: &Engine,
    target: &Target,
    loaded: &Loaded,
    scene: &mut Scene,
) -> Result<(RgbImage, Shown), GpuError> {
    let framing = Camera::framing(&scene.bounds, target.viewport());
    let distance = AWAY * framing.distance;
    let camera = Camera { azimuth: look.azimuth, elevation: look.elevation, distance, ..framing };
    let Look { height_scale, midlevel, factor, .. } = *look;
    let factor = tile.factor.unwrap_or(factor);
    let settings = Settings { overlays, factor, height_scale, midlevel, ..tile.settings };
    let inputs = settings.inputs(camera.lod_view(target.viewport(), &scene.bounds));
    engine.count(scene, &inputs, &mut Timing::Off)?;
    let measured = engine.measure(scene)?;
    let lines = if overlays.cracks { measured.crack_lines(&loaded.topology) } else { Vec::new() };
    scene.set_lines(&engine.gpu, &lines);
    engine.draw(scene, target, &camera, &settings, &mut Timing::Off)?;
    let shown = Shown {
        triangles: scene.tessellator.totals().1,
        different_bits: measured.cracks.different_bits,
        max_gap: measured.cracks.max_gap(),
        different_normals: measured.cracks.different_normals,
        folds: measured.folds,
    };
    Ok((DynamicImage::from(target.read(&engine.gpu)?).to_rgb8(), shown))
}
