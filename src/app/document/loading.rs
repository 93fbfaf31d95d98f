//! Opens meshes and loads them again. A new load cancels the one before it.

use std::path::PathBuf;
use std::sync::Arc;

use super::Document;
use crate::app::App;
use crate::app::jobs::background_job::Stopped;
use crate::app::jobs::companion_files::absolute_path;
use crate::app::jobs::file_watch::{Stamped, sources};
use crate::app::jobs::job_list::{LeftChoice, Load, Work};
use crate::app::jobs::scenes::scene_of;
use crate::commands::CompanionFile;
use geometry::names::shown;
use geometry::progress::{Progress, Stage};
use gpu::GpuError;
use inspect::engine::{self, Engine, Loaded, Preparation};
use inspect::render::Camera;
use inspect::settings::Settings;
use load::environment_file::is_environment;
use load::format::Format;
use load::{Contents, Import, LoadError, Source};

fn panicked(source: &Source, stopped: &Stopped) -> String {
    format!("{}: loading it {stopped}; the file may be damaged", source.title())
}

/// The part of a load that reading the mesh counts as. Compiling shaders, of which no part is known, is the rest.
const READ: f32 = 0.8;

/// Loads a mesh, and makes the pipelines that a picture with these settings needs, so that the first picture doesn't wait for the
/// driver's compiler. Fails with a sentence.
fn load(
    engine: &Engine,
    source: &Source,
    (preparation, is_again): (&Preparation, bool),
    settings: &Settings,
    progress: &Progress,
) -> Result<Document, String> {
    let read_from = Stamped::now(sources(source, preparation.heights.as_ref()));
    let reading = progress.part(0.0, READ);
    let loaded = if is_again {
        load_again(source, preparation.clone(), &reading)
    } else {
        engine::load(source, preparation, &reading)
    };
    let loaded = loaded.map_err(|error| error.to_string())?;
    progress.set(READ);
    document_of(engine, loaded, settings, read_from, progress)
}

/// Loads a mesh again, whose file may have changed: what is said of parts and morph targets that it no longer has is forgotten, with a
/// warning.
fn load_again(source: &Source, mut preparation: Preparation, progress: &Progress) -> Result<Loaded, LoadError> {
    let mut forgotten = Vec::new();
    loop {
        let error = match engine::load(source, &preparation, progress) {
            Ok(loaded) => return Ok(Loaded { warnings: [forgotten, loaded.warnings].concat(), ..loaded }),
            Err(error) => error,
        };
        let parts = &mut preparation.parts;
        match &error {
            LoadError::Absent { what, name, .. } if parts.forget(name) => {
                forgotten
                    .push(format!("it no longer has the {what} {}; what was set for it is forgotten.", shown(name)));
            }
            LoadError::Empty { .. } if !parts.only.is_empty() => {
                parts.only.clear();
                forgotten.push("it no longer has the parts that alone were shown; all are.".to_owned());
            }
            _ => return Err(error),
        }
    }
}

/// A mesh that was read from these files, and those that it names, with all that a picture needs. Fails with a sentence.
fn document_of(
    engine: &Engine,
    loaded: Loaded,
    settings: &Settings,
    read_from: Stamped,
    progress: &Progress,
) -> Result<Document, String> {
    let no_room = |error: GpuError| format!("{}: {error}", loaded.source.title());
    progress.enter(Stage::Device);
    let scene = scene_of(engine, &loaded).map_err(no_room)?;
    engine.prepare(&scene, settings).map_err(no_room)?;
    let named = Stamped::now(loaded.files.iter().cloned());
    Ok(Document::new(loaded, scene, read_from.and(named)))
}

impl App {
    /// Starts to load a mesh on a thread of its own; a load that is under way is cancelled. If it is the mesh that is open,
    /// it keeps its view and its preparation.
    pub fn open(&mut self, context: &egui::Context, source: Source) {
        let same = self.document.as_ref().filter(|document| document.loaded.source == source);
        let preparation = same.map(|document| document.loaded.preparation.clone());
        let keep_view = preparation.is_some();
        let preparation = preparation.unwrap_or_else(|| self.plain(&source));
        // It is about the file before.
        self.dialogs.notice = None;
        self.load(context, source, preparation, keep_view);
    }

    /// Takes the mesh that is being opened as the command line says, instead of as it was kept.
    pub fn open_as(&mut self, context: &egui::Context, change: impl FnOnce(&mut Preparation)) {
        let Some(load) = self.jobs.load() else { return };
        let (source, mut preparation) = (load.source.clone(), load.preparation.clone());
        change(&mut preparation);
        self.settings.import = preparation.import;
        self.load(context, source, preparation, false);
    }

    /// Loads the same mesh again if `change` changes its preparation.
    pub fn prepare(&mut self, context: &egui::Context, change: impl FnOnce(&mut Preparation)) {
        let Some(source) = self.source().cloned() else { return };
        let before = self.preparation();
        let mut preparation = before.clone();
        change(&mut preparation);
        if preparation != before {
            self.load(context, source, preparation, true);
        }
    }

    /// Begins a load that is under way anew, on another device.
    pub(in crate::app) fn load_anew(&mut self, context: &egui::Context) {
        if let Some(Load { source, preparation, keep_view, exchanges: false, .. }) = self.jobs.load() {
            self.load(context, source.clone(), preparation.clone(), *keep_view);
        }
    }

    /// Starts to open a mesh that was loaded for the left half, which then gets the one that is open.
    pub(super) fn exchange_meshes(&mut self, context: &egui::Context, left: Loaded) {
        let (engine, settings) = (self.engine.clone(), self.settings);
        let (source, preparation) = (left.source.clone(), left.preparation.clone());
        let files = sources(&source, preparation.heights.as_ref());
        let read = move |progress: &Progress| document_of(&engine, left, &settings, Stamped::now(files), progress);
        self.jobs.start(context, Work::Mesh, format!("Exchanging {}", source.title()), read, Self::take_loaded);
        self.jobs.last_load = Some(Load { source, preparation, keep_view: false, has_changed: false, exchanges: true });
    }

    fn load(&mut self, context: &egui::Context, source: Source, preparation: Preparation, keep_view: bool) {
        let (engine, settings) = (self.engine.clone(), self.settings);
        let (wanted, prepared) = (source.clone(), preparation.clone());
        let read = move |progress: &Progress| load(&engine, &wanted, (&prepared, keep_view), &settings, progress);
        self.jobs.start(context, Work::Mesh, format!("Loading {}", source.title()), read, Self::take_loaded);
        self.jobs.last_load = Some(Load { source, preparation, keep_view, has_changed: false, exchanges: false });
    }

    /// The preparation of the mesh, or of the load of the same mesh that is under way.
    pub(in crate::app) fn preparation(&self) -> Preparation {
        let again = self.jobs.load().filter(|load| load.keep_view).map(|load| &load.preparation);
        let shown = self.document.as_ref().map(|document| &document.loaded.preparation);
        again.or(shown).cloned().unwrap_or_else(|| self.plain(&Source::default()))
    }

    /// What the file offers to choose from.
    pub(in crate::app) fn contents(&self) -> Arc<Contents> {
        self.document.as_ref().map(|document| document.loaded.contents.clone()).unwrap_or_default()
    }

    /// A preparation that leaves the mesh as the file has it, but for normals, axis and unit that were chosen.
    fn plain(&self, source: &Source) -> Preparation {
        let import = self.persistence.import_of(source, &self.settings);
        Preparation { limits: self.jobs.limits, import, ..Preparation::default() }
    }

    /// Loads the mesh again if its normals, its axis or its unit were changed, also by undo. While something is dragged, and
    /// while another mesh is being loaded, it waits.
    pub(in crate::app) fn follow_file_choices(&mut self, context: &egui::Context) {
        let opens_another = self.jobs.load().is_some_and(|load| !load.keep_view);
        if self.document.is_none() || opens_another || context.egui_is_using_pointer() {
            return;
        }
        let import = self.settings.import;
        self.prepare(context, |preparation| preparation.import = import);
    }

    /// Goes back to the normals, the axis and the unit that the mesh has, after a load that came to nothing.
    pub(in crate::app) fn keep_file_choices(&mut self) {
        if let Some(document) = &self.document {
            self.settings.import = document.loaded.preparation.import;
        }
    }

    /// Takes over the axis and the unit of a mesh that was opened. This isn't a step of undo, because it follows from the mesh.
    fn take_placement(&mut self) {
        let Some(document) = &self.document else { return };
        let Import { up, unit, .. } = document.loaded.preparation.import;
        let place = move |settings: &mut Settings| {
            (settings.import.up, settings.import.unit) = (up, unit);
        };
        place(&mut self.settings);
        self.history.change_all(|step| place(&mut step.settings));
    }

    /// Loads the same mesh again; settings and camera stay.
    pub fn reload(&mut self, context: &egui::Context) {
        let source = self.source().cloned();
        source.into_iter().for_each(|source| self.open(context, source));
    }

    fn take_loaded(&mut self, context: &egui::Context, ended: Result<Result<Document, String>, Stopped>) {
        let Some(Load { source, keep_view, has_changed, exchanges, .. }) = self.jobs.last_load.take() else { return };
        match ended.unwrap_or_else(|stopped| Err(panicked(&source, &stopped))) {
            Ok(document) if exchanges => self.take_exchanged(context, document),
            Ok(document) => self.take_document(context, Document { has_changed, ..document }, keep_view),
            Err(mut why) => {
                let is_there = |path: &PathBuf| path.try_exists().unwrap_or(true);
                if matches!(&source, Source::File(path) if !is_there(path)) && self.persistence.gone(&source) {
                    why += "; it was removed from the recent files";
                }
                self.dialogs.error = Some(why);
                self.keep_file_choices();
                // If the first file can't be loaded, the window shows its default mesh.
                if self.document.is_none() {
                    self.open(context, Source::default());
                }
            }
        }
    }

    /// Puts a document in the place of the one before, with which all goes that belonged to it. The same mesh keeps its view.
    pub(super) fn take_document(&mut self, context: &egui::Context, document: Document, keep_view: bool) {
        self.dialogs.typed = None;
        self.jobs.stop_of_document();
        self.viewport.preview.forget();
        let place =
            |document: &Document| (document.loaded.contents.scene, document.loaded.preparation.import.placement());
        let placed = place(&document);
        let mut before = self.document.replace(document);
        // Until they are found again, so that nothing in the title moves.
        let neighbours = before.as_mut().and_then(|before| before.neighbours.take());
        if let (Some(document), Some(neighbours)) = (&mut self.document, neighbours)
            && let Source::File(path) = &document.loaded.source
        {
            document.neighbours = neighbours.of(&absolute_path(path.clone()));
        }
        if let (true, Some(document), Some(before)) = (keep_view, &mut self.document, &mut before) {
            let is_prepared_alike = document.loaded.preparation == before.loaded.preparation;
            let is_newer = document.has_changed || is_prepared_alike && document.files != before.files;
            document.version = before.version + u64::from(is_newer);
            document.before = if is_newer { Some(before.kept()) } else { before.before.take() };
        }
        self.say_title(context);
        self.check_mesh(context);
        self.watch_mesh(context);
        self.find_neighbours(context);
        // Scenes may be at different places, and of different sizes.
        let was_placed = before.as_ref().map(place);
        let is_placed_anew = was_placed.is_some_and(|before| before != placed);
        let is_turned = was_placed.is_some_and(|before| before.1 != placed.1);
        if !keep_view || is_turned {
            (self.viewport.frozen, self.viewport.ruler) = (None, None);
        }
        if !keep_view {
            self.close_companion(CompanionFile::ReferenceShape);
            self.close_companion(CompanionFile::LeftMesh);
        } else {
            self.follow_reference_shape(context, is_turned);
        }
        if keep_view && is_turned {
            self.forget_earlier();
        }
        if let Some(LeftChoice::Read(from, morphs)) = self.left_choice()
            && (from.is_none() || is_turned)
        {
            // It is prepared as this one is, and the mesh of another file turned and scaled.
            self.read_left(context, from, morphs);
        }
        let is_first = before.is_none();
        if !is_first {
            self.dialogs.error = None;
        }
        self.take_heights(before.is_some_and(|document| document.loaded.mesh.heights.is_some()));
        if !keep_view {
            (self.panels.dragged_morphs, self.panels.dragged_heights) = (None, None);
            self.take_placement();
            self.take_preparation();
        }
        self.keep_playback(keep_view);
        if !keep_view && !is_first {
            self.face_another();
        }
        if !keep_view || is_placed_anew {
            self.frame();
        }
        self.look_as_before(keep_view);
        self.viewport.opened = Some(self.viewport.camera);
        self.keep_factors(context, keep_view);
    }

    /// Names the mesh in the window's title.
    pub(in crate::app) fn say_title(&self, context: &egui::Context) {
        if let Some(source) = self.source() {
            context.send_viewport_cmd(egui::ViewportCommand::Title(format!("{} - pnaen", source.title())));
        }
    }

    /// Looks at another mesh from the usual direction, without what only a first start has.
    fn face_another(&mut self) {
        self.viewport.camera = Camera::framing(&Default::default(), glam::Vec2::ONE);
        let import = self.settings.import;
        if self.settings == (Settings { import, ..Settings::greeting() }) {
            self.settings = Settings { import, ..Settings::opening() };
        }
    }

    /// Opens a file that is dropped on the window. Of several, it opens the first mesh, or else the first file, and the first
    /// environment beside it. The meshes are then the list whose next one can be opened.
    pub(in crate::app) fn take_dropped(&mut self, context: &egui::Context) {
        let dropped: Vec<PathBuf> =
            context.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        let (environments, others): (Vec<_>, Vec<_>) = dropped.into_iter().partition(|path| is_environment(path));
        if let Some(path) = environments.into_iter().next() {
            self.read_environment(context, path, true);
        }
        let meshes: Vec<_> = others.iter().filter(|path| Format::from_name(path).is_some()).cloned().collect();
        let Some(path) = meshes.first().or(others.first()).cloned() else { return };
        self.dropped = if meshes.len() > 1 { meshes } else { Vec::new() };
        self.open_path(context, path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::jobs::background_job::caught;

    #[test]
    fn a_load_that_panics_returns_an_error_that_names_the_file() {
        let indices: &[u32] = std::hint::black_box(&[]);
        let stopped = caught::<()>(|| panic!("index {} of {}", 7, indices.len())).expect_err("it panicked");
        let said = panicked(&Source::File("models/odd.glb".into()), &stopped);
        assert_eq!(said, "odd.glb: loading it stopped unexpectedly (index 7 of 0); the file may be damaged");
    }
}
