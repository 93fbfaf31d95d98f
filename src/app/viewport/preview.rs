//! A cheaper picture while the camera moves, for meshes whose full picture would be late. The full one follows once the camera
//! rests. Nothing is measured in a preview.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use glam::{Mat4, Vec3, vec2};

use super::picture::{Picture, PictureRequest};
use super::preview_pace::PreviewPace;
use crate::app::jobs::job_list::Jobs;
use crate::app::painting::ShownPicture;
use crate::app::{App, Document};
use geometry::tessellate::{Inputs, Tessellation};
use geometry::view::ScreenView;
use gpu::{GpuError, Timing, submit_untimed};
use inspect::engine::Engine;
use inspect::render::{Camera, Scene, Target, WindowPipelines, half_places};
use inspect::settings::{ColorSource, Colors, Settings, SplitSide, SplitView};

/// A full picture that takes longer than this is late: 30 pictures a second leave 33 ms for each, and the window itself takes
/// some of it.
const LATE_MS: f64 = 25.0;
/// A camera that hasn't moved for so long rests.
const REST: Duration = Duration::from_millis(150);
/// About the number of triangles that a preview has, on a software driver and on graphics cards. A software driver shades blocks
/// of 4 x 4 px, of which each triangle costs one at least.
const TRIANGLES_IN_SOFTWARE: f32 = 6_000.0;
const TRIANGLES: f32 = 2_000_000.0;
/// As many triangles that don't depend on the camera are drawn as they are. With others in their place, they would have to be
/// measured again.
const KEPT_IN_SOFTWARE: f32 = 40_000.0;
/// The largest factor of a preview. More can't be seen at its resolution.
const LARGEST_FACTOR: f32 = 8.0;
/// The full picture has at most so many times as many px along each axis as a preview.
const COARSEST: u32 = 4;

/// What a preview draws in place of the full picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    /// The same triangles, since they don't depend on the camera.
    Same,
    /// One factor for all edges, and nothing left out.
    Factor(f32),
    /// A mesh of fewer triangles.
    StandIn,
}

#[derive(Default)]
pub(crate) struct Preview {
    /// Whether there are previews at all. Somebody who judges LOD in motion switches them off.
    pub is_on: bool,
    camera: Option<Camera>,
    moved: Option<Instant>,
    target: Option<(Target, ShownPicture)>,
    /// How many times as many px the full picture has along each axis.
    coarseness: u32,
    /// The same for the first preview of a mesh.
    finest: u32,
    pace: PreviewPace,
    /// The preview that was drawn last, until the full picture follows.
    drawn: Option<(PictureRequest, Shape)>,
    /// The vertices and triangles of the full picture, while previews use its tessellator.
    pub totals: Option<(u64, u64)>,
    /// How many have been drawn.
    pub drawings: u64,
}

impl Preview {
    pub(crate) fn new(engine: &Engine) -> Self {
        let finest = if engine.gpu.is_software() { 2 } else { 1 };
        Self { is_on: true, coarseness: finest, finest, ..Self::default() }
    }

    /// Whether a picture that takes as long as the last full one is replaced by a preview while the camera moves.
    pub(super) fn is_due(&self, full: &Picture) -> bool {
        self.is_on && full.whole_ms.is_some_and(|ms| ms > LATE_MS)
    }

    /// Notes where the camera is. Returns how long it will count as moving, if it has moved a short while ago.
    fn follow(&mut self, camera: Camera) -> Option<Duration> {
        if self.camera.replace(camera).is_some_and(|before| before != camera) {
            self.moved = Some(Instant::now());
        }
        let left = REST.checked_sub(self.moved?.elapsed());
        if left.is_none() {
            self.moved = None;
        }
        left
    }

    /// What the preview was drawn for and its shape, if it is shown: the full picture is of an earlier camera.
    pub(crate) fn shown(&self, picture: &Picture) -> Option<(&PictureRequest, Shape)> {
        let full = picture.drawn.as_ref().map(|drawn| drawn.camera);
        self.drawn.as_ref().filter(|(drawn, _)| Some(drawn.camera) != full).map(|(drawn, shape)| (drawn, *shape))
    }

    pub(crate) fn picture(&self) -> Option<&ShownPicture> {
        self.target.as_ref().map(|(_, shown)| shown)
    }

    /// The mark over a preview, which says what it shows.
    pub(crate) fn mark(&self, shape: Shape) -> String {
        let shape = match shape {
            Shape::Same => "the same triangles".to_owned(),
            Shape::Factor(factor) if factor <= 1.0 => "the mesh as it came".to_owned(),
            Shape::Factor(factor) => format!("factor {factor} everywhere"),
            Shape::StandIn => "a simplified mesh".to_owned(),
        };
        match self.coarseness {
            1 => format!("Preview: {shape}"),
            times => format!("Preview: {shape}, 1/{times} of the resolution"),
        }
    }

    /// Shows the full picture from now on.
    pub(crate) fn end(&mut self) {
        (self.drawn, self.totals) = (None, None);
    }

    /// Forgets the preview of a mesh that is open no more.
    pub(crate) fn forget(&mut self) {
        self.end();
        (self.moved, self.camera) = (None, None);
        self.coarseness = self.finest;
        self.pace.forget();
    }

    /// Notes which previews are finished. If the last ones were late, the next ones are coarser.
    fn land(&mut self) {
        self.pace.land(Instant::now());
        if self.pace.take_is_slow() {
            self.coarseness = (self.coarseness + 1).min(COARSEST);
        }
    }

    /// Makes a target for a full picture of this size.
    fn fit(&mut self, painting: &WindowPipelines, engine: &Engine, full: glam::Vec2) -> Result<(), GpuError> {
        let size = |times: u32| full.to_array().map(|side| (side as u32).div_ceil(times).max(1));
        if self.target.as_ref().is_some_and(|(target, _)| target.size == size(self.coarseness)) {
            return Ok(());
        }
        let make = if engine.gpu.is_software() { Target::draft } else { Target::new };
        let target = make(&engine.gpu, size(self.coarseness))?.coarse(self.coarseness);
        let shown = ShownPicture::new(painting, &engine.gpu, &target, wgpu::FilterMode::Linear);
        self.target = Some((target, shown));
        // The new target is empty.
        self.drawn = None;
        Ok(())
    }

    /// Draws what is wanted into the preview's target, unless it shows that already or the device has enough to do. The
    /// counts come back first.
    fn draw(
        &mut self,
        engine: &Engine,
        scene: &mut Scene,
        wanted: &PictureRequest,
        shape: Shape,
    ) -> Result<(), GpuError> {
        if !count(scene, wanted)? || !self.pace.is_free() || self.drawn == Some((*wanted, shape)) {
            return Ok(());
        }
        let Some((target, _)) = &mut self.target else { return Ok(()) };
        target.keep_only_for(&wanted.settings);
        self.pace.submit(draw(engine, scene, target, wanted)?, Instant::now());
        self.drawn = Some((*wanted, shape));
        self.drawings += 1;
        Ok(())
    }
}

/// Draws what is wanted. What is returned is set once the device has finished it.
pub(super) fn draw(
    engine: &Engine,
    scene: &mut Scene,
    target: &Target,
    wanted: &PictureRequest,
) -> Result<Arc<AtomicBool>, GpuError> {
    submit_untimed(&engine.gpu, |recorder| {
        engine.renderer.draw(recorder, scene, target, &wanted.camera, &wanted.settings)
    })?;
    let done = Arc::new(AtomicBool::new(false));
    let own = done.clone();
    engine.gpu.queue.on_submitted_work_done(move || own.store(true, Ordering::Release));
    Ok(done)
}

/// Lets the device count what each half emits. Returns true once that is known.
pub(super) fn count(scene: &mut Scene, wanted: &PictureRequest) -> Result<bool, GpuError> {
    let mut is_counted = true;
    for half in SplitSide::BOTH {
        let Some(inputs) = wanted.inputs_of(half) else { continue };
        let Some(scene) = scene.half_mut(half) else { return Ok(false) };
        scene.tessellator.set(&inputs)?;
        scene.tessellator.count(&mut Timing::Off)?;
        is_counted &= scene.tessellator.poll_counts()?;
    }
    Ok(is_counted)
}

/// Decides what a preview of the wanted picture draws.
fn shape_of(
    jobs: &mut Jobs,
    context: &egui::Context,
    engine: &Engine,
    document: &Document,
    wanted: &PictureRequest,
    is_frozen: bool,
) -> Shape {
    let is_software = engine.gpu.is_software();
    let (most, kept) = if is_software { (TRIANGLES_IN_SOFTWARE, KEPT_IN_SOFTWARE) } else { (TRIANGLES, TRIANGLES) };
    let Tessellation { lod, factor, .. } = wanted.inputs.tessellation;
    let follows = !is_frozen && wanted.inputs.tessellation.follows_view();
    let (tessellator, patches) = (&document.scene.tessellator, document.loaded.topology.patches.len() as f32);
    let triangles = match lod.follows_view() {
        false => patches * factor * factor,
        true => tessellator.totals().1 as f32,
    };
    // Factors of a file stay as they are, however many triangles they ask for.
    if !follows && (triangles <= kept || wanted.from_files.factors != 0) {
        return Shape::Same;
    }
    // It stands for the mesh alone, not for another one or another pose beside it, and has no parts with surfaces of their own.
    if patches > most
        && !document.loaded.mesh.has_styles()
        && document.moment.is_none()
        && (wanted.settings.split.is_none()
            || (document.scene.half(SplitSide::Left).is_none() || document.scene.shares_pose(SplitSide::Left))
                && wanted.settings.split_view == SplitView::Divider
                && wanted.settings.left_looks.is_none())
        && document.stand_in.is_made(jobs, context, engine, &document.loaded, most as usize)
    {
        return Shape::StandIn;
    }
    let largest = if lod.follows_view() { LARGEST_FACTOR } else { factor.min(LARGEST_FACTOR) };
    Shape::Factor((most / patches.max(1.0)).sqrt().floor().clamp(1.0, largest.max(1.0)))
}

fn settings_of(shape: Shape, settings: &Settings) -> Settings {
    let mut cheap = *settings;
    // Both need data that is computed for what is emitted.
    cheap.change_looks(|own| {
        if matches!(own.overlays.colors.source(), ColorSource::ReferenceSurface | ColorSource::MinimumTriangles) {
            own.overlays.colors = Colors::default();
        }
    });
    let factor = match shape {
        Shape::Same => return cheap,
        Shape::Factor(factor) => factor,
        Shape::StandIn => {
            cheap.split = None;
            1.0
        }
    };
    cheap.tessellation = cheap.tessellation.with_one_factor(factor);
    cheap
}

impl App {
    /// Draws a preview if the camera moves and the full picture would be late. Returns whether it did; if not, the full picture is
    /// due.
    ///
    /// # Errors
    /// The device was lost, or has no room for the preview.
    pub(super) fn preview(&mut self, context: &egui::Context, full: &PictureRequest) -> Result<bool, GpuError> {
        let left = self.viewport.preview.follow(self.viewport.camera);
        // While a clip plays, the picture that is shown is always of an earlier moment.
        let is_seen = |drawn: &PictureRequest| drawn == full || (self.is_playing() && drawn.camera == full.camera);
        if self.viewport.picture.drawn.as_ref().is_some_and(is_seen) {
            self.viewport.preview.end();
        }
        let is_due = self.viewport.preview.is_due(&self.viewport.picture);
        let Some(left) = left.filter(|_| is_due) else { return Ok(false) };
        let Some((wanted, shape)) = self.cheaper_picture(context, full) else { return Ok(false) };
        let Some(document) = &mut self.document else { return Ok(false) };
        let totals = Some(document.scene.tessellator.totals());
        self.viewport.picture.make_way();
        self.viewport.warm_up.give_way();
        let preview = &mut self.viewport.preview;
        preview.land();
        preview.fit(&self.painting, &self.engine, full.view.viewport)?;
        let open = self.environment.as_ref().filter(|_| full.from_files.light > 0);
        let light = open.map(|open| open.content.environment.clone());
        let scene = match (shape, document.stand_in.scene()) {
            (Shape::StandIn, Some(stand_in)) => {
                stand_in.matcap.clone_from(&document.scene.matcap);
                stand_in.environment = light;
                stand_in
            }
            _ => &mut document.scene,
        };
        preview.totals = preview.totals.or(totals);
        preview.draw(&self.engine, scene, &wanted, shape)?;
        self.engine.gpu.check()?;
        // The frame in which the device has finished says how long it took.
        if preview.drawn == Some((wanted, shape)) && preview.pace.is_idle() {
            context.request_repaint_after(left);
        } else {
            context.request_repaint();
        }
        Ok(true)
    }

    /// What a preview of the wanted picture draws; none before a mesh is open.
    pub(super) fn cheaper_picture(
        &mut self,
        context: &egui::Context,
        full: &PictureRequest,
    ) -> Option<(PictureRequest, Shape)> {
        let document = self.document.as_ref()?;
        let shape = shape_of(&mut self.jobs, context, &self.engine, document, full, self.viewport.frozen.is_some());
        let settings = settings_of(shape, &full.settings);
        let inputs = Inputs::new(&settings.tessellation, full.inputs.view);
        Some((PictureRequest { settings, inputs, ..*full }, shape))
    }

    /// The view of what is shown, of a preview or of the full picture, as the right half has it in an area of the window. Its
    /// size is in points.
    pub(super) fn shown_view(&self, area: egui::Rect) -> Option<ScreenView> {
        let picture = &self.viewport.picture;
        let drawn = self.viewport.preview.shown(picture).map(|(drawn, _)| drawn.view);
        let ScreenView { clip_from_object, viewport } = drawn.or(picture.seen_from())?;
        let [_, right] = half_places(viewport.to_array().map(|side| side as u32), &self.settings);
        let shift = Mat4::from_translation(Vec3::X * (2.0 * right.shift as f32 / viewport.x));
        let viewport = vec2(area.width(), area.height());
        Some(ScreenView { clip_from_object: shift * clip_from_object, viewport })
    }
}
