//! One picture, and all that is measured for it: what `render` and `turntable` draw, and what the window saves.

mod copied_command;
mod error;
mod factors_report;
pub mod files;
mod judging;
pub mod legend;
mod picture_comparison;
mod picture_file;
mod reference;
mod reference_surface;
mod report_page;
mod split_titles;
mod stats;
mod turn;
mod user_shader_report;

use std::path::Path;
use std::sync::Arc;

use glam::Vec2;
use image::RgbaImage;

pub use copied_command::{AT_REST, CopiedCommand, given};
pub use error::ShotError;
pub use factors_report::{FactorsFile, agreement_lines, read_factors, said};
pub use judging::Numbers;
#[cfg(test)]
pub(crate) use picture_comparison::DIFFERENCE_FLOOR;
pub use picture_comparison::{CompareError, Comparison, compare};
pub use picture_file::{png_bytes, write_drawn, write_picture};
pub use reference::{BETWEEN_DRIVERS, Judged, Reference};
pub use split_titles::{HalfFacts, half_title, mesh_title, surface_title};
pub use stats::Stats;
pub use turn::{FPS, FRAMES, Turn, frame_name};
pub use user_shader_report::{not_numbers_said, report_user_lod, report_user_surface, straight_sides_said};

use legend::draw_legend;
use picture_file::write_stamped;
use reference_surface::{AccuracyStats, DeviationStats};
use split_titles::draw_titles;

use crate::engine::{Engine, Loaded, MeasurementResults, Measurements, SilhouetteView};
use crate::gates::Judgement;
use crate::measure::{
    AccuracyOptions, DeviationField, DeviationTarget, Silhouette, WorstPoint, patch_edges, patch_width,
};
use crate::reference_shape::ReferenceShape;
use crate::render::{
    Camera, Distances, LeftPose, LineSegment, Renderer, Scale, Scene, Target, axis_lines, bone_lines, crack_lines,
    deviation_scale, lay_over, lod_camera_lines, outlines_picture, patch_lines, t_junction_lines, worst_lines,
};
use crate::settings::{ARENA_BYTES, ColorSource, Settings, SplitSide, SplitView};
use geometry::mesh::{Bounds, Mesh, Moment, Texture, t_junctions};
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, LodView};
use geometry::view::ScreenView;
use gpu::{Given, GpuError, SurfaceShader, Timing, submit_untimed};
use load::panorama::Panorama;

/// What is drawn.
#[derive(Default)]
pub struct Subject {
    /// The mesh at rest.
    pub loaded: Loaded,
    /// The mesh left of a split, if it is another one.
    pub left: Option<Loaded>,
    pub moment: Option<Moment>,
    pub left_pose: LeftPose,
    /// What takes the place of LOD: factors of a file, or a shader.
    pub given: Option<Given>,
    /// What takes the place of the surface, except left of a split.
    pub surface_shader: Option<Arc<SurfaceShader>>,
    /// A picture of a lit sphere in place of that of the settings, for the matcap overlay.
    pub matcap: Option<Arc<Texture>>,
    /// The light of a file that is still to be uploaded, if the scene doesn't have it already.
    pub environment: Option<Panorama>,
    pub settings: Settings,
    /// The surface that it is compared with, and its name. Without one, the deviation overlay takes the tessellation's limit surface.
    pub reference_surface: Option<(String, Arc<ReferenceShape>)>,
    /// The patch that is outlined.
    pub selected: Option<u32>,
    /// Lines over each half besides those of the overlays. The outline of the patch is over them.
    pub more_lines: [Vec<LineSegment>; 2],
    /// Memory for output on the device, of each half.
    pub arena_bytes: u64,
}

/// From where it is seen, and how large and on what it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct ShotView {
    pub camera: Camera,
    /// The camera that LOD and clipping are computed for and its view's size in px, if it isn't the picture's.
    pub lod_camera: Option<(Camera, Vec2)>,
    /// Width and height in px.
    pub size: [u32; 2],
    /// Whether nothing is behind the mesh, rather than the background's colour.
    pub transparent: bool,
    /// Whether the legend of the surface's colours is drawn into the picture.
    pub legend: bool,
}

/// Which numbers are measured for stats.
#[derive(Clone, Copy, Debug)]
pub struct StatsWanted {
    /// Whether they include the largest error on screen.
    pub error: bool,
}

/// How much of a picture's progress is for measuring; the rest is for drawing.
const MEASURING: f32 = 0.5;

/// A value for each half that the picture has.
type ByHalf<T> = [Option<T>; 2];

/// Everything that one picture is drawn and measured from.
pub struct Shot {
    subject: Subject,
    /// The mesh in the pose that is drawn.
    posed: Loaded,
    engine: Engine,
    scene: Scene,
    target: Target,
    view: ShotView,
    /// What LOD and clipping are computed for.
    lod_view: LodView,
    /// What was measured of each half.
    results: ByHalf<MeasurementResults>,
    /// The colour scale of the deviation overlay.
    scale: Scale,
    /// The outlines, if they are shown.
    silhouette: Option<Silhouette>,
    /// How gates judged it, if they did.
    judged: Vec<Judgement>,
    /// The worst place of the gate that compares the error with the tolerance.
    error_place: Option<WorstPoint>,
}

impl Subject {
    /// The mesh at rest with these settings, and nothing else.
    pub fn new(loaded: Loaded, settings: Settings) -> Self {
        Self { loaded, settings, arena_bytes: ARENA_BYTES, ..Self::default() }
    }

    /// Gives a scene of the mesh its factors, its control points, its matcap and its poses.
    ///
    /// # Errors
    /// The mesh's rig needs larger buffers than the adapter can bind.
    pub fn apply_to_scene(&self, engine: &Engine, scene: &mut Scene) -> Result<(), GpuError> {
        scene.matcap = self.matcap.as_ref().map(|picture| engine.renderer.matcap(picture)).transpose()?;
        scene.tessellator.give(self.given.clone())?;
        scene.tessellator.set_surface_shader(self.surface_shader.clone())?;
        scene.frame_clip(self.moment.map(|moment| moment.clip));
        scene.set_left_pose(self.left_pose)?;
        scene.set_moment(self.moment)
    }
}

impl ShotView {
    /// What LOD and clipping are computed for.
    pub fn lod_view(&self, scene: &Scene) -> LodView {
        let own = (self.camera, Vec2::from(self.size.map(|side| side as f32)));
        let (camera, viewport) = self.lod_camera.unwrap_or(own);
        camera.lod_view(viewport, &scene.bounds)
    }
}

impl Shot {
    /// Tessellates the subject in its scene, which is [prepared](Subject::apply_to_scene) already.
    ///
    /// # Errors
    /// The adapter has no textures of that size, the left half needs larger buffers than it can bind, or the device was lost.
    pub fn new(engine: Engine, mut scene: Scene, subject: Subject, view: ShotView) -> Result<Self, GpuError> {
        let make = if view.transparent { Target::transparent } else { Target::new };
        let target = make(&engine.gpu, view.size)?;
        engine.split(&mut scene, &subject.settings, subject.left.as_ref())?;
        if let Some(left) = scene.half_mut(SplitSide::Left) {
            let is_shader = matches!(subject.given, Some(Given::Shader(_)));
            let takes_given = subject.settings.has_left_tessellation() && (subject.left.is_none() || is_shader);
            left.tessellator.give(subject.given.clone().filter(|_| takes_given))?;
            left.tessellator.set_surface_shader(None)?;
        }
        let mut shot = Self {
            posed: subject.loaded.posed(subject.moment),
            lod_view: view.lod_view(&scene),
            scale: deviation_scale(0.0, scene.ulp),
            results: Default::default(),
            silhouette: None,
            judged: Vec::new(),
            error_place: None,
            subject,
            engine,
            scene,
            target,
            view,
        };
        shot.engine.prepare(&shot.scene, &shot.subject.settings)?;
        shot.count()?;
        Ok(shot)
    }

    /// Reports on standard error where what shaders of the user's own gave disagrees, if there are any.
    ///
    /// # Errors
    /// The device was lost.
    pub fn report_user_shaders(&self) -> Result<(), GpuError> {
        report_user_surface(&self.engine, &self.scene)?;
        report_user_lod(&self.engine, &self.scene)
    }

    /// Moves the picture's camera. LOD follows it, unless that has a camera of its own.
    ///
    /// # Errors
    /// The device was lost.
    pub fn look_from(&mut self, camera: Camera) -> Result<(), GpuError> {
        self.view.camera = camera;
        self.lod_view = self.view.lod_view(&self.scene);
        (self.results, self.judged, self.error_place) = Default::default();
        self.count()
    }

    /// The scene and what is drawn, for another shot of them.
    pub fn into_parts(self) -> (Scene, Subject) {
        (self.scene, self.subject)
    }

    /// The picture's camera.
    pub fn camera(&self) -> &Camera {
        &self.view.camera
    }

    /// Where it is seen from: the mesh in its pose, its moment, and the bounds that cameras are made for.
    pub fn place(&self) -> (&Mesh, Option<Moment>, &Bounds) {
        (&self.subject.loaded.mesh, self.subject.moment, &self.scene.bounds)
    }

    /// What it is drawn with.
    pub fn settings(&self) -> &Settings {
        &self.subject.settings
    }

    pub fn adapter(&self) -> &wgpu::AdapterInfo {
        &self.engine.gpu.info
    }

    /// Writes a picture of it as a PNG file, with texts that say what drew it and with which command.
    ///
    /// # Errors
    /// The file can't be written.
    pub fn write(&self, path: &Path, picture: &RgbaImage, command: &str) -> Result<(), ShotError> {
        write_stamped(path, picture, self.adapter(), command, self.settings())
    }

    /// Counts what each half will emit.
    fn count(&mut self) -> Result<(), GpuError> {
        for half in SplitSide::BOTH {
            let inputs = self.inputs(half);
            if let Some((inputs, scene)) = inputs.zip(self.scene.half_mut(half)) {
                self.engine.count(scene, &inputs, &mut Timing::Off)?;
            }
        }
        Ok(())
    }

    /// Measures what the overlays and stats need, and draws the picture.
    ///
    /// # Errors
    /// The device was lost, or `progress` was cancelled.
    pub fn picture(&mut self, stats: Option<StatsWanted>, progress: &Progress) -> Result<RgbaImage, ShotError> {
        self.measure(stats, &progress.part(0.0, MEASURING))?;
        self.mark(progress)?;
        self.draw(&progress.part(MEASURING, 1.0))?;
        let mut picture = self.target.read(&self.engine.gpu)?;
        if let Some(silhouette) = &self.silhouette {
            lay_over(&mut picture, &outlines_picture(silhouette), &self.subject.settings);
        }
        if self.view.camera.is_mirrored() {
            image::imageops::flip_horizontal_in_place(&mut picture);
        }
        if self.view.legend {
            if let Some(split) = self.subject.settings.split {
                let divider = (self.subject.settings.split_view != SplitView::Difference).then_some(split);
                draw_titles(&mut picture, divider, &SplitSide::BOTH.map(|half| self.half_title(half)))?;
            }
            draw_legend(&mut picture, &self.scene, &self.view.camera, &self.subject.settings, &self.distances())?;
        }
        Ok(picture)
    }

    /// What a half shows.
    fn half_title(&self, half: SplitSide) -> String {
        let meshes = self.subject.left.as_ref().map(|left| [left, &self.subject.loaded]);
        let measured = self.results(half).and_then(|results| results.survey.as_ref());
        let facts = HalfFacts {
            mesh: meshes.map_or_else(Vec::new, |own| mesh_title(half, own, own.map(|own| own.source.title()))),
            pose: self.scene.pose_title(half),
            triangles: self.scene.half(half).map(|own| own.tessellator.totals().1),
            cracked_edges: measured.map(|measured| measured.cracks.cracked().len() as u64),
            ..HalfFacts::default()
        };
        half_title(&self.subject.settings, half, facts)
    }

    /// Draws step by step, so that a long drawing can be cancelled, and a device that is shared has time for others.
    fn draw(&mut self, progress: &Progress) -> Result<(), ShotError> {
        let Self { subject: Subject { settings, .. }, engine, scene, target, view, .. } = self;
        let steps = Renderer::step_count(scene, settings);
        for step in 0..steps {
            progress.check()?;
            submit_untimed(&engine.gpu, |recorder| {
                engine.renderer.draw_steps(recorder, scene, target, &view.camera, settings, step..step + 1)
            })?;
            engine.gpu.wait();
            progress.set((step + 1) as f32 / steps as f32);
        }
        Ok(())
    }

    /// What the legend says about distances.
    fn distances(&self) -> Distances {
        let mut fields = self.results.iter().flatten().filter_map(|results| results.deviation.as_ref());
        let is_partial = fields.any(|field| field.left_out > 0);
        let outlines = self.silhouette.as_ref().map(|silhouette| silhouette.distances);
        Distances { scale: Some(self.scale), is_partial, measured: None, outlines }
    }

    /// What a half is tessellated with, if there is one.
    fn inputs(&self, half: SplitSide) -> Option<Inputs> {
        Some(self.subject.settings.half(half)?.inputs(self.lod_view))
    }

    fn view(&self) -> ScreenView {
        let viewport = self.target.viewport();
        ScreenView { clip_from_object: self.view.camera.clip_from_object(viewport, &self.scene.bounds), viewport }
    }

    /// Measures each half with one walk over its output: what the overlays show, and what the stats say.
    fn measure(&mut self, stats: Option<StatsWanted>, progress: &Progress) -> Result<(), ShotError> {
        let view = self.view();
        let reference_surface = self.subject.reference_surface.as_ref().map(|(_, own)| own);
        // Both halves are compared with the same surface. The CPU doesn't know the limit surface of a shader.
        let limit = self.inputs(SplitSide::Right).filter(|_| self.subject.surface_shader.is_none());
        let limit = limit.map(|inputs| DeviationTarget::Limit(Box::new(inputs)));
        let target = reference_surface.cloned().map(DeviationTarget::ReferenceShape).or(limit);
        for half in SplitSide::BOTH {
            let own = self.inputs(half).zip(self.subject.settings.half(half));
            let Some(((inputs, settings), scene)) = own.as_ref().zip(self.scene.half_mut(half)) else { continue };
            let is_shown = settings.overlays.colors.source() == ColorSource::ReferenceSurface;
            // The CPU doesn't know the surface of a shader.
            let has_error = scene.tessellator.surface_shader().is_none() && stats.is_some_and(|stats| stats.error);
            let compared = reference_surface.filter(|_| stats.is_some());
            let wanted = Measurements {
                survey: settings.overlays.cracks || self.subject.selected.is_some() || stats.is_some(),
                screen_error: has_error.then_some(inputs),
                deviation: target.as_ref().filter(|_| is_shown),
                accuracy: compared.map(|own| (&**own, &inputs.view, AccuracyOptions::default())),
                sizes: stats.is_some().then_some(view),
            };
            self.results[half as usize] = Some(self.engine.measure_watched(scene, &wanted, progress)?);
            progress.check()?;
        }
        self.show_deviation();
        self.compare_outlines(progress)
    }

    /// Compares outlines, if they are shown: those of the right half, in all of the picture.
    fn compare_outlines(&mut self, progress: &Progress) -> Result<(), ShotError> {
        if self.subject.settings.any_half_shows(ColorSource::Outlines) {
            let seen = self.view.camera.lod_view(self.target.viewport(), &self.scene.bounds);
            let view = SilhouetteView { size: self.target.size, seen, lod: self.lod_view };
            let tessellation = &self.subject.settings.tessellation;
            self.silhouette = self.engine.silhouette(&self.scene, tessellation, &view, progress)?;
            progress.check()?;
        }
        Ok(())
    }

    /// Colours both halves by their deviation, on one scale that covers the larger of the two.
    fn show_deviation(&mut self) {
        let fields = self.results.iter().flatten().filter_map(|results| results.deviation.as_ref());
        let largest = fields.filter_map(DeviationField::worst).map(|worst| worst.value).fold(0.0, f64::max);
        self.scale = deviation_scale(largest, self.scene.ulp);
        for (half, results) in SplitSide::BOTH.into_iter().zip(&self.results) {
            let field = results.as_ref().and_then(|results| results.deviation.as_ref());
            if let Some((scene, field)) = self.scene.half_mut(half).zip(field) {
                scene.set_deviation(&self.engine.gpu, Some((field, self.scale)));
            }
        }
    }

    fn results(&self, half: SplitSide) -> Option<&MeasurementResults> {
        self.results[half as usize].as_ref()
    }

    /// Puts lines over each half: the overlays that are lines, and the outline of the selected patch.
    fn mark(&mut self, progress: &Progress) -> Result<(), ShotError> {
        for half in SplitSide::BOTH {
            let lines = self.lines(half, progress)?;
            if let Some(scene) = self.scene.half_mut(half) {
                scene.set_lines(&self.engine.gpu, &lines);
            }
        }
        Ok(())
    }

    fn lines(&self, half: SplitSide, progress: &Progress) -> Result<Vec<LineSegment>, ShotError> {
        let settings = self.subject.settings.half(half).unwrap_or(self.subject.settings);
        let is_same = self.scene.shares_pose(half);
        let other = self.scene.half(half).filter(|_| !is_same).map(|own| own.tessellator.topology());
        let topology = other.unwrap_or(&self.posed.topology);
        let results = self.results(half);
        let measured = results.and_then(|results| results.survey.as_ref());
        let cracked = measured.filter(|_| settings.overlays.cracks);
        let mut lines = cracked.map_or_else(Vec::new, |measured| crack_lines(measured, topology));
        if settings.overlays.t_junctions && is_same {
            let junctions = t_junctions(&self.subject.loaded.topology, progress)?;
            lines.extend(t_junction_lines(topology, &junctions));
        }
        if let Some(own) = self.scene.half(half).filter(|_| settings.overlays.bones) {
            lines.extend(bone_lines(own));
        }
        if let Some(worst) = results.and_then(|results| results.deviation.as_ref()).and_then(DeviationField::worst) {
            lines.extend(worst_lines(worst.emitted.as_vec3(), worst.reference_shape.as_vec3()));
        }
        if settings.overlays.grid {
            lines.extend(axis_lines(&self.scene.bounds));
        }
        // A camera that looks through its own frustum would see nothing of it but the picture's border.
        if let Some((camera, viewport)) = self.view.lod_camera.filter(|(camera, _)| *camera != self.view.camera) {
            lines.extend(lod_camera_lines(&camera, viewport, &self.scene.bounds));
        }
        lines.extend(&self.subject.more_lines[half as usize]);
        if let Some(patch) = self.subject.selected.filter(|_| is_same) {
            let outlines = measured.map(|measured| &measured.outlines);
            let edges = patch_edges(topology, patch, outlines, settings.tessellation.convention);
            lines.extend(patch_lines(&edges, patch_width(topology, patch, outlines)));
        }
        Ok(lines)
    }

    /// The distance of a half from the reference surface, if it was measured.
    fn accuracy(&self, half: SplitSide) -> Option<AccuracyStats> {
        let (name, reference_shape) = self.subject.reference_surface.as_ref()?;
        let results = self.results(half)?;
        let is_whole = results.survey.as_ref()?.culled.total() == 0;
        results.accuracy.as_ref().map(|accuracy| AccuracyStats::new(name, reference_shape, accuracy, is_whole))
    }

    /// The deviation that the overlay shows on a half, if the overlay is on.
    fn deviation(&self, half: SplitSide) -> Option<DeviationStats> {
        self.results(half)?.deviation.as_ref().map(|field| DeviationStats::new(field, self.scale))
    }
}
