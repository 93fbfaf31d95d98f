//! Every technique side by side on one mesh: pictures, numbers, and a page that says what each technique is and where it was
//! published.

mod exhibits;
mod page;
mod tile;

use std::sync::Arc;

use glam::Vec3;
use image::RgbImage;

pub(crate) use exhibits::Tile;
pub use exhibits::{Exhibit, exhibits};
pub use page::{PAGE, page};
pub(crate) use tile::TileResults;

use geometry::mesh::Heights;
use geometry::progress::Progress;
use geometry::tessellate::{Surface, Tessellation, displacement_reach};
use gpu::{GpuError, Timing};
use inspect::engine::{Engine, Loaded, Preparation, load};
use inspect::measure::EmittedChunk;
use inspect::plot::contact_sheet;
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{ARENA_BYTES, Settings};
use inspect::shot::ShotError;
use load::{LoadError, Source};
use tile::draw_tile;

/// Width and height of one tile, in px.
const TILE: [u32; 2] = [300, 240];

/// The height of captions in px. It is large because pages show four tiles in a row at two thirds of their size.
const TEXT: u32 = 24;

/// The factor for the tessellation that the camera is fitted to, before anything is drawn.
const FRAMING_FACTOR: f32 = 4.0;

/// A surface that reaches farther than this from the mesh's middle, in bounding radii, doesn't count for the camera. Patches
/// that fly away leave the picture, so that the rest stays large.
const FARTHEST: f32 = 1.1;

/// What the gallery shows, and how.
#[derive(Clone, Debug)]
pub struct GalleryOptions {
    /// The mesh; `None` for the shape that suits each exhibit.
    pub source: Option<Source>,
    pub preparation: Preparation,
    /// Tessellation factor.
    pub factor: f32,
    /// How far white is above black, in bounding radii, and the height that stays where it is, from 0 to 1.
    pub height_scale: f32,
    pub midlevel: f32,
    /// The direction of the camera, in degrees from the front to the right, and upwards.
    pub azimuth: f32,
    pub elevation: f32,
}

/// Draws exhibits on one device.
pub struct Gallery<'a> {
    options: GalleryOptions,
    engine: &'a Engine,
    /// The meshes that were loaded already. A mesh that the user names is in every exhibit.
    loaded: Vec<Loaded>,
}

impl<'a> Gallery<'a> {
    pub fn new(options: GalleryOptions, engine: &'a Engine) -> Self {
        Self { options, engine, loaded: Vec::new() }
    }

    /// Draws an exhibit's tiles in rows. Returns the picture, and the results of each tile in order. `starting` is called with
    /// the index of each tile before it is drawn.
    pub fn draw(
        &mut self,
        exhibit: &Exhibit,
        mut starting: impl FnMut(usize),
    ) -> Result<(RgbImage, Vec<TileResults>), ShotError> {
        let engine = self.engine;
        let target = Target::new(&engine.gpu, TILE)?;
        let camera = self.camera(exhibit, &target)?;
        let (mut parts, mut all) = (Vec::new(), Vec::new());
        let mut current: Option<(f32, Loaded, Scene)> = None;
        for (index, tile) in exhibit.tiles.iter().enumerate() {
            starting(index);
            if current.as_ref().is_none_or(|(crease_band, ..)| *crease_band != tile.crease_band) {
                let loaded = self.prepared(exhibit, tile.crease_band)?;
                let scene = engine.scene(&loaded, ARENA_BYTES)?;
                current = Some((tile.crease_band, loaded, scene));
            }
            let Some((_, loaded, scene)) = &mut current else { continue };
            let drawn_as = (self.settings(tile), exhibit.overlays);
            let (picture, results) = draw_tile(engine, &target, &camera, drawn_as, loaded, scene)?;
            parts.push((tile.name.clone(), picture));
            all.push(results);
        }
        let columns = if parts.len() % 4 == 0 { 4 } else { 3 };
        Ok((contact_sheet(&parts, columns, TEXT)?, all))
    }

    /// The warnings about the mesh that the user named: see [`load::LoadedMesh::warnings`].
    pub fn warnings(&mut self) -> Result<Vec<String>, ShotError> {
        match self.options.source.clone() {
            Some(source) => Ok(self.load(source, 0.0)?.warnings.clone()),
            None => Ok(Vec::new()),
        }
    }

    /// The camera for all tiles of an exhibit, so that they can be compared. The mesh with all surfaces of the exhibit fits
    /// into its picture, with room for displacement.
    fn camera(&mut self, exhibit: &Exhibit, target: &Target) -> Result<Camera, ShotError> {
        let loaded = self.prepared(exhibit, 0.0)?;
        let mut scene = self.engine.scene(&loaded, ARENA_BYTES)?;
        let framing = Camera::framing(&scene.bounds, target.viewport());
        let mut camera = Camera { azimuth: self.options.azimuth, elevation: self.options.elevation, ..framing };
        let view = camera.lod_view(target.viewport(), &scene.bounds);
        let mut places: Vec<Vec3> = loaded.mesh.corners.iter().map(|corner| corner.position).collect();
        let (mut seen, mut farthest): (Vec<Surface>, f32) = (Vec::new(), 0.0);
        for tile in &exhibit.tiles {
            let settings = self.settings(tile);
            farthest = farthest.max(displacement_reach(&loaded.mesh, &settings.inputs(view)));
            if seen.contains(&settings.tessellation.surface) {
                continue;
            }
            seen.push(settings.tessellation.surface);
            let plain = settings.with(Tessellation { factor: FRAMING_FACTOR, ..settings.tessellation.undisplaced() });
            places.extend(self.places(&mut scene, plain, &camera, target)?);
        }
        camera.fit(places.into_iter(), farthest, target.viewport());
        Ok(camera)
    }

    /// The positions of a surface's vertices; none if it reaches beyond [`FARTHEST`].
    fn places(
        &self,
        scene: &mut Scene,
        settings: Settings,
        camera: &Camera,
        target: &Target,
    ) -> Result<Vec<Vec3>, GpuError> {
        let inputs = settings.inputs(camera.lod_view(target.viewport(), &scene.bounds));
        self.engine.count(scene, &tile::affordable(&inputs, scene), &mut Timing::Off)?;
        let mut places: Vec<Vec3> = Vec::new();
        let mut take = |chunk: &EmittedChunk| {
            places.extend(chunk.vertices.iter().map(|vertex| Vec3::from(vertex.position)));
        };
        self.engine.visit(scene, &mut [&mut take])?;
        let (center, most) = (scene.bounds.center(), FARTHEST * scene.bounds.radius());
        // Dividing first keeps the squares of very small or large lengths within the range of f32.
        let near = |place: &Vec3| place.is_finite() && ((*place - center) / most).length() <= 1.0;
        Ok(if places.iter().all(near) { places } else { Vec::new() })
    }

    /// The settings that a tile is drawn with.
    fn settings(&self, tile: &Tile) -> Settings {
        let GalleryOptions { height_scale, midlevel, factor, .. } = self.options;
        tile.settings.with(Tessellation {
            factor: tile.factor.unwrap_or(factor),
            height_scale,
            midlevel,
            ..tile.settings.tessellation
        })
    }

    /// The exhibit's mesh. If the exhibit displaces it and the user named no height image, it has the waves made in code.
    fn prepared(&mut self, exhibit: &Exhibit, crease_band: f32) -> Result<Loaded, LoadError> {
        let source = self.options.source.clone().unwrap_or(Source::Shape(exhibit.shape));
        let mut loaded = self.load(source, crease_band)?.clone();
        let displaced = exhibit.tiles.iter().any(|tile| tile.settings.tessellation.displacement.is_on());
        if displaced && loaded.mesh.heights.is_none() {
            let mut mesh = (*loaded.mesh).clone();
            mesh.heights = Some(Arc::new(Heights::waves(&mesh, 128, [3.0, 2.0])));
            loaded.mesh = Arc::new(mesh);
        }
        Ok(loaded)
    }

    fn load(&mut self, source: Source, crease_band: f32) -> Result<&Loaded, LoadError> {
        let preparation = Preparation { crease_band, ..self.options.preparation.clone() };
        let known = |loaded: &Loaded| loaded.source == source && loaded.preparation == preparation;
        let index = match self.loaded.iter().position(known) {
            Some(index) => index,
            None => {
                self.loaded.push(load(&source, &preparation, &Progress::new())?);
                self.loaded.len() - 1
            }
        };
        Ok(&self.loaded[index])
    }
}
