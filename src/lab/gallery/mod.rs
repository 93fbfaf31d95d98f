//! Every technique side by side on one mesh: pictures, numbers, and a page that says what each technique is and where it was
//! published.

mod exhibits;
mod page;
mod tile;

use std::sync::Arc;

use glam::{Vec2, Vec3};
use image::RgbImage;

pub use exhibits::Exhibit;
pub(crate) use exhibits::Tile;
use exhibits::{OwnMesh, exhibits};
pub use page::{PAGE, page};
pub(crate) use tile::TileResults;

use crate::chart::distinct;
use geometry::mesh::{Heights, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, Tessellation, displacement_reach};
use gpu::{GpuError, Timing};
use inspect::engine::{Engine, Loaded, Preparation, load};
use inspect::measure::EmittedChunk;
use inspect::plot::contact_sheet;
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{ARENA_BYTES, Settings};
use inspect::shot::ShotError;
use load::import::Subdivide;
use load::mesh_file::read;
use load::selection::Selection;
use load::{Format, Import, Limits, LoadError, Source};
use tile::draw_tile;

/// Width and height of one tile, in px.
const TILE: [u32; 2] = [300, 240];

/// The height of captions in px. It is large because pages show four tiles in a row at two thirds of their size.
const TEXT: u32 = 24;

/// The factor for the tessellation that the camera is fitted to, before anything is drawn.
const FRAMING_FACTOR: f32 = 4.0;

/// A surface that reaches farther than this from the mesh's middle, in bounding radii, doesn't count for the camera. Patches
/// that fly away leave the picture, so that the rest stays large.
const FARTHEST: f32 = 1.5;

/// The cage that is shown if no mesh is named: a cube, in OBJ.
const CAGE: &[u8] = b"v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
                      f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

/// What the gallery shows, and how.
#[derive(Clone, Debug)]
pub struct GalleryOptions {
    /// The mesh; `None` for the shape or the cage that suits each exhibit.
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
    /// The current exhibit's meshes that were loaded already. A mesh that the user names is in every exhibit.
    loaded: Vec<Loaded>,
}

/// The mesh of a tile, also on the device.
type OnDevice = (OwnMesh, Loaded, Scene);

impl<'a> Gallery<'a> {
    pub fn new(options: GalleryOptions, engine: &'a Engine) -> Self {
        Self { options, engine, loaded: Vec::new() }
    }

    /// The exhibits that can be shown, and warnings about the mesh that the user named, at all levels of tiles; not about crease
    /// bands, which nobody asked for. Such a mesh is a cage if its polygons are refined. Tiles for which it can't be are left out.
    pub fn exhibits(&mut self) -> Result<(Vec<Exhibit>, Vec<String>), ShotError> {
        let Some(source) = self.options.source.clone() else { return Ok((exhibits().into(), Vec::new())) };
        let (mut all, mut warnings, import) = (Vec::new(), Vec::new(), self.options.preparation.import);
        for exhibit in exhibits().into_iter().filter(|exhibit| exhibit.shape.is_some() || import.refines_all()) {
            let mut tiles = Vec::new();
            for tile in exhibit.tiles {
                let loaded = self.load(source.clone(), OwnMesh { crease_band: 0.0, ..tile.own_mesh })?;
                warnings.extend(loaded.warnings.iter().cloned());
                let is_shown = exhibit.shape.is_some() || loaded.is_refined;
                let said = || format!("\"{}\" is left out: not all of the mesh can be refined so often.", tile.name);
                warnings.extend((!is_shown).then(said));
                tiles.extend(is_shown.then_some(tile));
            }
            all.extend((!tiles.is_empty()).then_some(Exhibit { tiles, ..exhibit }));
        }
        Ok((all, distinct(warnings)))
    }

    /// Draws an exhibit's tiles in rows. Returns the picture, and the results of each tile in order. `starting` is called with
    /// the index of each tile before it is drawn.
    pub fn draw(
        &mut self,
        exhibit: &Exhibit,
        mut starting: impl FnMut(usize),
    ) -> Result<(RgbImage, Vec<TileResults>), ShotError> {
        // Those that only other exhibits have are forgotten.
        self.loaded.retain(|loaded| loaded.preparation == self.options.preparation);
        let engine = self.engine;
        let target = Target::new(&engine.gpu, TILE)?;
        let camera = self.camera(exhibit, target.viewport())?;
        let (mut parts, mut all, mut current) = (Vec::new(), Vec::new(), None);
        for (index, tile) in exhibit.tiles.iter().enumerate() {
            starting(index);
            let entered = self.entered(current.take(), exhibit, tile)?;
            let (_, loaded, scene) = current.insert(entered);
            let drawn_as = (self.settings(tile), exhibit.overlays);
            let (picture, results) = draw_tile(engine, &target, &camera, drawn_as, loaded, scene)?;
            parts.push((tile.name.clone(), picture));
            all.push(results);
        }
        let columns = if parts.len() % 4 == 0 { 4 } else { 3 };
        Ok((contact_sheet(&parts, columns, TEXT)?, all))
    }

    /// The mesh of a tile, which may be the current one.
    fn entered(&mut self, current: Option<OnDevice>, exhibit: &Exhibit, tile: &Tile) -> Result<OnDevice, ShotError> {
        if let Some(current) = current.filter(|(own_mesh, ..)| *own_mesh == tile.own_mesh) {
            return Ok(current);
        }
        let loaded = self.prepared(exhibit, tile.own_mesh)?;
        let scene = self.engine.scene(&loaded, ARENA_BYTES)?;
        Ok((tile.own_mesh, loaded, scene))
    }

    /// The camera for all tiles of an exhibit, so that they can be compared. All meshes of the exhibit with all surfaces fit into
    /// its picture, with room for displacement.
    fn camera(&mut self, exhibit: &Exhibit, viewport: Vec2) -> Result<Camera, ShotError> {
        let GalleryOptions { azimuth, elevation, .. } = self.options;
        let mut camera = Camera { azimuth, elevation, ..Camera::default() };
        let (mut places, mut seen, mut farthest, mut current) = (Vec::<Vec3>::new(), Vec::new(), 0.0_f32, None);
        for tile in &exhibit.tiles {
            let entered = self.entered(current.take(), exhibit, tile)?;
            let (_, loaded, scene) = current.insert(entered);
            camera.frame(&scene.bounds, viewport);
            let view = camera.lod_view(viewport, &scene.bounds);
            let settings = self.settings(tile);
            farthest = farthest.max(displacement_reach(&loaded.mesh, &settings.inputs(view)));
            let drawn = (settings.tessellation.surface, tile.own_mesh);
            if seen.contains(&drawn) {
                continue;
            }
            seen.push(drawn);
            places.extend(loaded.mesh.corners.iter().map(|corner| corner.position));
            let plain = settings.with(Tessellation { factor: FRAMING_FACTOR, ..settings.tessellation.undisplaced() });
            places.extend(self.places(scene, &plain.inputs(view))?);
        }
        camera.fit(places.into_iter(), farthest, viewport);
        Ok(camera)
    }

    /// The positions of a surface's vertices; none if it reaches beyond [`FARTHEST`].
    fn places(&self, scene: &mut Scene, inputs: &Inputs) -> Result<Vec<Vec3>, GpuError> {
        self.engine.count(scene, &tile::affordable(inputs, scene), &mut Timing::Off)?;
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
    fn prepared(&mut self, exhibit: &Exhibit, own_mesh: OwnMesh) -> Result<Loaded, LoadError> {
        let mut loaded = match self.options.source.clone().or(exhibit.shape.map(Source::Shape)) {
            Some(source) => self.load(source, own_mesh)?.clone(),
            None => refined_cage(own_mesh.levels)?,
        };
        let displaced = exhibit.tiles.iter().any(|tile| tile.settings.tessellation.displacement.is_on());
        if displaced && loaded.mesh.heights.is_none() {
            let mesh = Arc::make_mut(&mut loaded.mesh);
            mesh.heights = Some(Arc::new(Heights::waves(mesh, 128, [3.0, 2.0])));
        }
        Ok(loaded)
    }

    fn load(&mut self, source: Source, OwnMesh { crease_band, levels }: OwnMesh) -> Result<&Loaded, LoadError> {
        let usual = &self.options.preparation;
        let import = Import { levels: levels.or(usual.import.levels), ..usual.import };
        let preparation = Preparation { crease_band, import, ..usual.clone() };
        let known = |loaded: &Loaded| loaded.source == source && loaded.preparation == preparation;
        let index = self.loaded.iter().position(known).unwrap_or(self.loaded.len());
        if index == self.loaded.len() {
            self.loaded.push(load(&source, &preparation, &Progress::new())?);
        }
        Ok(&self.loaded[index])
    }
}

/// The cage, refined so often.
fn refined_cage(levels: Option<f32>) -> Result<Loaded, LoadError> {
    let import = Import { subdivide: Subdivide::CatmullClark, levels, ..Import::default() };
    let (selected, progress) = (Selection { import, ..Selection::default() }, Progress::new());
    let read = read(Format::Obj, CAGE.to_vec(), "cube.obj".as_ref(), selected, &Limits::default(), &progress)?;
    let topology = Topology::build(&read.mesh, &progress)?;
    Ok(Loaded::from_mesh(read.mesh.into(), topology.into()))
}
