//! Every technique side by side, on one mesh: pictures, numbers, and a page that says what each is and whose.

mod exhibits;
mod page;
mod tile;

use std::sync::Arc;

use glam::Vec3;
use image::RgbImage;
use thiserror::Error;

pub(crate) use exhibits::{Exhibit, Tile, exhibits};
pub(crate) use page::{PAGE, page};
pub(crate) use tile::Shown;

use crate::engine::{Engine, Loaded, Preparation, load};
use crate::gpu::{GpuError, Timing};
use crate::load::{LoadError, Source};
use crate::measure::EmittedChunk;
use crate::plot::{ChartError, contact_sheet};
use crate::progress::Progress;
use crate::render::{Camera, Scene, Target};
use crate::settings::{ARENA_BYTES, Settings};
use crate::tessellate::{Displacement, Surface, Tessellation, displacement_reach};
use tile::{Wall, draw_tile};

/// Why there is no gallery.
#[derive(Debug, Error)]
pub(crate) enum GalleryError {
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Chart(#[from] ChartError),
}

/// Width and height of one tile, in px.
const TILE: [u32; 2] = [300, 240];

/// Px that captions are high: pages show four tiles in a row at two thirds of their size.
const TEXT: u32 = 24;

/// The factor at which it is looked where a surface goes, before anything is drawn.
const LOOK_FACTOR: f32 = 4.0;

/// A surface that goes farther from the mesh's middle, in bounding radii, isn't stepped back for: patches that fly away
/// leave the picture, and what everybody came to see stays.
const FARTHEST: f32 = 1.1;

/// What is looked at, and how.
#[derive(Clone, Debug)]
pub(crate) struct Look {
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

/// The room in which exhibits are hung.
pub(crate) struct Gallery<'a> {
    look: Look,
    engine: &'a Engine,
    /// What was loaded already: a mesh of one's own is in every exhibit.
    loaded: Vec<Loaded>,
}

impl<'a> Gallery<'a> {
    pub(crate) fn new(look: Look, engine: &'a Engine) -> Self {
        Self { look, engine, loaded: Vec::new() }
    }

    /// Draws an exhibit: its tiles in rows, and what each showed, in their order. `starting` is told each tile's number before
    /// it is drawn.
    ///
    /// # Errors
    /// [`GalleryError`].
    pub(crate) fn draw(
        &mut self,
        exhibit: &Exhibit,
        mut starting: impl FnMut(usize),
    ) -> Result<(RgbImage, Vec<Shown>), GalleryError> {
        let engine = self.engine;
        let target = Target::new(&engine.gpu, TILE)?;
        let camera = self.camera(exhibit, &target)?;
        let (mut parts, mut all) = (Vec::new(), Vec::new());
        let mut hung: Option<(f32, Loaded, Scene)> = None;
        for (index, tile) in exhibit.tiles.iter().enumerate() {
            starting(index);
            if hung.as_ref().is_none_or(|(crease_band, ..)| *crease_band != tile.crease_band) {
                let loaded = self.prepared(exhibit, tile.crease_band)?;
                let scene = engine.scene(&loaded, ARENA_BYTES)?;
                hung = Some((tile.crease_band, loaded, scene));
            }
            let Some((_, loaded, scene)) = &mut hung else { continue };
            let settings = self.settings(tile);
            let wall = Wall { engine, target: &target, camera: &camera, overlays: exhibit.overlays };
            let (picture, shown) = draw_tile(&wall, settings, loaded, scene)?;
            parts.push((tile.name.clone(), picture));
            all.push(shown);
        }
        let columns = if parts.len() % 4 == 0 { 4 } else { 3 };
        Ok((contact_sheet(&parts, columns, TEXT)?, all))
    }

    /// What a mesh of one's own has to be said of: see [`crate::load::LoadedMesh::warnings`].
    ///
    /// # Errors
    /// It can't be loaded.
    pub(crate) fn warnings(&mut self) -> Result<Vec<String>, GalleryError> {
        match self.look.source.clone() {
            Some(source) => Ok(self.load(source, 0.0)?.warnings.clone()),
            None => Ok(Vec::new()),
        }
    }

    /// One camera for all tiles of an exhibit, so that they can be compared: filled by the mesh under all of its surfaces, and
    /// by as far as anything is displaced.
    fn camera(&mut self, exhibit: &Exhibit, target: &Target) -> Result<Camera, GalleryError> {
        let loaded = self.prepared(exhibit, 0.0)?;
        let mut scene = self.engine.scene(&loaded, ARENA_BYTES)?;
        let framing = Camera::framing(&scene.bounds, target.viewport());
        let mut camera = Camera { azimuth: self.look.azimuth, elevation: self.look.elevation, ..framing };
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
            let plain = settings.with(Tessellation {
                displacement: Displacement::Off,
                factor: LOOK_FACTOR,
                ..settings.tessellation
            });
            places.extend(self.places(&mut scene, plain, &camera, target)?);
        }
        camera.fit(places.into_iter(), farthest, target.viewport());
        Ok(camera)
    }

    /// Where a surface goes; nowhere, if it flies away.
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
        // Divided first: squares of very small or large lengths leave f32.
        let near = |place: &Vec3| place.is_finite() && ((*place - center) / most).length() <= 1.0;
        Ok(if places.iter().all(near) { places } else { Vec::new() })
    }

    /// What a tile is drawn with.
    fn settings(&self, tile: &Tile) -> Settings {
        let Look { height_scale, midlevel, factor, .. } = self.look;
        tile.settings.with(Tessellation {
            factor: tile.factor.unwrap_or(factor),
            height_scale,
            midlevel,
            ..tile.settings.tessellation
        })
    }

    /// The exhibit's mesh; with the heights that suit a shape made in code where it is to be displaced and nobody named
    /// others.
    fn prepared(&mut self, exhibit: &Exhibit, crease_band: f32) -> Result<Loaded, LoadError> {
        let source = self.look.source.clone().unwrap_or(Source::Shape(exhibit.shape));
        let mut loaded = self.load(source, crease_band)?.clone();
        let displaced = exhibit.tiles.iter().any(|tile| tile.settings.tessellation.displacement != Displacement::Off);
        if displaced && loaded.mesh.heights.is_none() {
            let mut mesh = (*loaded.mesh).clone();
            mesh.heights = Some(Arc::new(exhibits::waves(&mesh)));
            loaded.mesh = Arc::new(mesh);
        }
        Ok(loaded)
    }

    fn load(&mut self, source: Source, crease_band: f32) -> Result<&Loaded, LoadError> {
        let preparation = Preparation { crease_band, ..self.look.preparation.clone() };
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
