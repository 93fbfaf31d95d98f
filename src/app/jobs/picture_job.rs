//! What files of pictures, of factors and of the tessellated mesh are made from: the window's mesh, settings and camera, in a scene of
//! their own.

use std::path::Path;
use std::sync::Arc;

use super::scenes::arena_bytes;
use crate::app::App;
use geometry::defaults::with_defaults;
use geometry::progress::Progress;
use geometry::tessellate::Tessellated;
use gpu::{Gpu, GpuError, Timing};
use inspect::engine::Engine;
use inspect::export::{Exported, ending};
use inspect::measure::EmittedChunk;
use inspect::reference_shape::ReferenceShape;
use inspect::render::Scene;
use inspect::settings::{ARENA_BYTES, Choice, ColorSource, Overlays, Settings, SplitSide};
use inspect::shot::files::{to_json, write_factors, write_text};
use inspect::shot::{Shot, ShotError, ShotView, StatsWanted, Subject};

/// How much of the progress is for reading the mesh back from the device; the rest is for writing the file.
const READING: f32 = 0.8;

with_defaults! {
    /// How a picture is saved.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(crate) struct PictureChoices {
        /// Width and height in px; none for those of the viewport.
        pub size: Option<[u32; 2]> = None,
        pub transparent: bool = false,
        /// Whether overlays and the selection are drawn.
        pub overlays: bool = true,
        pub legend: bool = false,
    }
}

/// Everything that a thread needs to draw what the window shows.
pub(crate) struct ShotParts {
    engine: Engine,
    make: Box<dyn FnOnce() -> Result<Scene, GpuError> + Send>,
    subject: Subject,
    view: ShotView,
}

impl ShotParts {
    /// Draws the picture and writes it as a PNG file that holds this command, or a report on it as a page. Writes nothing if it was
    /// cancelled.
    ///
    /// # Errors
    /// The device fails, or the file can't be written; as a sentence.
    pub(crate) fn save(self, command: &str, path: &Path, progress: &Progress) -> Result<(), String> {
        if ending(path) == "html" {
            return self.with_shot(|shot| shot.write_report(path, command, progress));
        }
        self.with_shot(|shot| {
            let picture = shot.picture(None, progress)?;
            progress.check()?;
            shot.write(path, &picture, command)
        })
    }

    /// Measures the picture, on a device of its own so that nothing else is timed, and writes its stats. Writes nothing if it
    /// was cancelled.
    ///
    /// # Errors
    /// The device fails, or the file can't be written; as a sentence.
    pub(crate) fn save_stats(self, adapter: &wgpu::Adapter, path: &Path, progress: &Progress) -> Result<(), String> {
        let Self { subject, view, .. } = self;
        let engine = Engine::new(Gpu::on(adapter).map_err(|error| error.to_string())?);
        let subject = Subject { arena_bytes: ARENA_BYTES, ..subject };
        let (own, loaded) = (engine.clone(), subject.loaded.clone());
        let make = Box::new(move || own.scene(&loaded, ARENA_BYTES));
        Self { engine, make, subject, view }.with_shot(|shot| {
            shot.picture(Some(StatsWanted { error: true }), progress)?;
            progress.check()?;
            shot.stats()?.map_or(Ok(()), |stats| write_text(path, &to_json(&stats)?))
        })
    }

    /// Writes the factors of this view as CSV. Writes nothing if it was cancelled.
    ///
    /// # Errors
    /// The device fails, or the file can't be written; as a sentence.
    pub(crate) fn save_factors(self, path: &Path, progress: &Progress) -> Result<(), String> {
        self.with_scene(|engine, mut scene, subject, view| {
            let inputs = subject.settings.inputs(view.lod_view(&scene));
            write_factors(&engine, &mut scene, &inputs, path, progress)
        })
    }

    /// Writes the mesh that is emitted for this view. Writes nothing if it was cancelled. Returns sentences about what is drawn but
    /// couldn't be written.
    ///
    /// # Errors
    /// The device fails, or the file can't be written; as a sentence.
    pub(crate) fn export(self, path: &Path, progress: &Progress) -> Result<Vec<String>, String> {
        self.with_scene(|engine, mut scene, subject, view| {
            let inputs = subject.settings.inputs(view.lod_view(&scene));
            engine.count(&mut scene, &inputs, &mut Timing::Off)?;
            let (vertices, triangles) = scene.tessellator.totals();
            Exported::check(path, &subject.loaded.mesh, vertices, triangles)?;
            let mut tessellated = Tessellated::default();
            let mut append = |chunk: &EmittedChunk| tessellated.append(chunk.vertices, chunk.triangles);
            engine.visit_watched(&mut scene, &mut [&mut append], &progress.part(0.0, READING))?;
            progress.check()?;
            let posed = subject.loaded.posed(subject.moment);
            let exported = Exported::new(&posed.mesh, &posed.topology, &tessellated);
            progress.check()?;
            let said = exported.write(path)?;
            Ok(left_out(&tessellated, posed.topology.patches.len()).into_iter().chain(said).collect())
        })
    }

    /// Makes what is drawn, on a scene of its own so that the window's isn't changed, and hands it over.
    ///
    /// # Errors
    /// The device fails, or `draw` does; as a sentence.
    pub(crate) fn with_shot(self, draw: impl FnOnce(&mut Shot) -> Result<(), ShotError>) -> Result<(), String> {
        self.with_scene(|engine, scene, subject, view| draw(&mut Shot::new(engine, scene, subject, view)?))
    }

    /// The same with what a shot is made of.
    fn with_scene<T>(
        self,
        act: impl FnOnce(Engine, Scene, Subject, ShotView) -> Result<T, ShotError>,
    ) -> Result<T, String> {
        let Self { engine, make, subject, view } = self;
        let own = engine.clone();
        // What the device refuses, such as a picture that is too large for its memory, is this file's error.
        let attempted = engine.gpu.attempt(move || {
            let mut scene = make()?;
            subject.apply_to_scene(&own, &mut scene)?;
            act(own, scene, subject, view)
        });
        attempted.map_err(|error| error.to_string())?.map_err(|error| error.to_string())
    }
}

/// A sentence about patches that aren't in the file, if there are any: somebody who didn't set clipping or culling expects all.
fn left_out(tessellated: &Tessellated, patches: usize) -> Option<String> {
    let mut is_written = vec![false; patches];
    tessellated.vertices.iter().for_each(|vertex| is_written[vertex.patch() as usize] = true);
    let left_out = is_written.iter().filter(|is_written| !**is_written).count();
    let said = || {
        format!(
            "{left_out} of {patches} patches aren't drawn in this view, and aren't in the file. To export all of them, switch off \
             Clipping and Cull back faces (under Advanced)."
        )
    };
    (left_out > 0).then(said)
}

impl App {
    /// Width and height of a picture that is saved with these choices, in px.
    pub(in crate::app) fn saved_size(&self, choices: &PictureChoices) -> [u32; 2] {
        choices.size.unwrap_or_else(|| self.viewport.picture.size().to_array().map(|side| side as u32))
    }

    pub(in crate::app) fn saved_settings_of(&self, theme: egui::Theme, choices: &PictureChoices) -> Settings {
        let mut settings = self.settings_in(theme);
        if !choices.overlays {
            settings.change_looks(|own| own.overlays = Overlays::default());
        }
        settings
    }

    /// From where a picture with these choices is seen.
    pub(in crate::app) fn shot_view(&self, choices: &PictureChoices) -> ShotView {
        ShotView {
            camera: self.viewport.camera,
            lod_camera: self.viewport.frozen.map(|frozen| (frozen.camera, frozen.viewport)),
            size: self.saved_size(choices),
            transparent: choices.transparent,
            legend: choices.legend,
        }
    }

    /// What a picture with these choices is drawn from; none without a mesh. `command` draws the same.
    pub(in crate::app) fn shot_parts(&self, theme: egui::Theme, choices: &PictureChoices) -> Option<ShotParts> {
        let document = self.document.as_ref()?;
        let settings = self.saved_settings_of(theme, choices);
        let topology = document.shown().1;
        let lines = |half| {
            let hit = if half == SplitSide::Right { self.hit_lines() } else { Vec::new() };
            let selected =
                if document.scene.shares_pose(half) { self.selection_lines(&topology, half) } else { Vec::new() };
            [self.ruler_lines(), selected, hit].concat()
        };
        let subject = Subject {
            loaded: document.loaded.clone(),
            left: self.other_left().map(|left| left.content.clone()),
            moment: document.moment,
            left_pose: document.scene.left_pose(),
            given: document.scene.tessellator.given().cloned(),
            surface_shader: document.scene.tessellator.surface_shader().cloned(),
            matcap: self.matcap.as_ref().map(|chosen| chosen.content.clone()),
            // The scene is made from one that has it.
            environment: None,
            settings,
            reference_surface: self.reference_surface(&settings),
            selected: self.selected_patch().filter(|_| choices.overlays),
            more_lines: if choices.overlays { SplitSide::BOTH.map(lines) } else { Default::default() },
            arena_bytes: arena_bytes(&self.engine),
        };
        let make = Box::new(document.scene.sibling(subject.arena_bytes));
        Some(ShotParts { engine: self.engine.clone(), make, subject, view: self.shot_view(choices) })
    }

    /// What commands compare with, and its name: the chosen surface; and while the overlay is on, an exact one.
    fn reference_surface(&self, settings: &Settings) -> Option<(String, Arc<ReferenceShape>)> {
        let is_shown = settings.any_half_shows(ColorSource::ReferenceSurface);
        let (own, reference_shape) = (self.source()?.to_string(), self.yardstick().1?);
        let name = match self.reference_shape.as_ref().map(|chosen| &chosen.from) {
            Some(Some(source)) => source.to_string(),
            Some(None) => format!("{own} ({})", self.own_scheme().name()),
            None => Some(own).filter(|_| is_shown)?,
        };
        Some((name, reference_shape))
    }
}
