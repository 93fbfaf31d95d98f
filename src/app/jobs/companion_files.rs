//! What is open beside the mesh: a reference surface, a mesh left of the split, a matcap and light, and what they have in common with
//! factors and shaders of a file.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::job_list::{LeftChoice, Work};
use crate::app::App;
use crate::app::text::file_name;
use crate::commands::CompanionFile;
use geometry::names::shown_path;
use geometry::progress::Progress;
use gpu::{LodShader, SurfaceShader};
use inspect::engine::{self, Loaded};
use inspect::reference_shape::ReferenceShape;
use inspect::render::LeftPose;
use inspect::render::environment::Environment;
use inspect::settings::{Colors, Lighting};
use load::environment_file::EnvironmentFile;
use load::import::Subdivide;
use load::{MorphWeights, Source, load_matcap};

/// What is open, and what it was read from.
pub(crate) struct Opened<S, T> {
    pub from: S,
    /// A number of its own for all that was read, from 2 on.
    pub generation: u64,
    pub content: T,
}

/// A file. Its path is absolute: a dash would be standard input, and copied commands and the next window need all of it.
pub(crate) type OpenFile<T> = Opened<PathBuf, T>;

/// The reference surface that was chosen for the mesh: that of a source, or without one the limit of the mesh's own cage.
pub(crate) type ChosenReferenceShape = Opened<Option<Source>, Arc<ReferenceShape>>;

/// A mesh left of the split in place of the one that is open.
pub(crate) type LeftMesh = Opened<LeftChoice, Loaded>;

pub(crate) struct Light {
    /// What was repaired, in sentences.
    pub warnings: Vec<String>,
    /// On the device.
    pub environment: Arc<Environment>,
}

impl<S, T> Opened<S, T> {
    pub(crate) fn new(from: S, content: T) -> Self {
        Self { from, generation: new_generation(), content }
    }
}

impl<T> OpenFile<T> {
    pub(crate) fn name(&self) -> String {
        file_name(&self.from)
    }
}

/// The path from the root, or as it is without a working folder.
pub(crate) fn absolute_path(path: PathBuf) -> PathBuf {
    std::path::absolute(&path).unwrap_or(path)
}

/// A number that nothing else has, from 2 on.
pub(crate) fn new_generation() -> u64 {
    static GENERATION: AtomicU64 = AtomicU64::new(2);
    GENERATION.fetch_add(1, Ordering::Relaxed)
}

impl App {
    /// Starts to read `what`, a source as messages name it. `take` gets what was read; until then, all stays as it is. `read` fails with
    /// a sentence.
    pub(in crate::app) fn read_companion<T: Send + 'static>(
        &mut self,
        context: &egui::Context,
        companion: CompanionFile,
        title: String,
        what: String,
        read: impl FnOnce(&Progress) -> Result<T, String> + Send + 'static,
        take: impl FnOnce(&mut Self, T) + 'static,
    ) {
        self.jobs.start(context, Work::Companion(companion), title, read, move |app, _, ended| {
            match ended.unwrap_or_else(|stopped| Err(format!("reading {what} {stopped}"))) {
                Ok(read) => take(app, read),
                Err(mut why) => {
                    let is_same_mesh = matches!(app.jobs.left, Some(LeftChoice::Read(None, _)));
                    if companion == CompanionFile::Environment {
                        app.cancel_environment();
                    } else if companion == CompanionFile::LeftMesh && is_same_mesh {
                        // What is there may be the mesh as it no longer is.
                        app.close_companion(companion);
                        why += "; the left half has no weights of its own any more";
                    }
                    app.dialogs.error = Some(why);
                }
            }
        });
    }

    /// The source of what is open, or being opened, beside the mesh.
    pub(in crate::app) fn companion(&self, companion: CompanionFile) -> Option<Source> {
        let path = match companion {
            CompanionFile::ReferenceShape => return self.reference_shape().cloned(),
            CompanionFile::LeftMesh => return self.left_mesh.as_ref().map(|left| left.content.source.clone()),
            CompanionFile::Factors => self.factors_file(),
            CompanionFile::LodShader => self.open_shader_file::<LodShader>(),
            CompanionFile::SurfaceShader => self.open_shader_file::<SurfaceShader>(),
            CompanionFile::Matcap => self.matcap_image(),
            CompanionFile::Environment => self.environment_file(),
        };
        path.map(|path| Source::File(path.to_owned()))
    }

    /// Closes what is open, and stops reading it. What it took the place of is there again: the exact surface of a shape or the limit
    /// surface, the mesh in both halves, a setting, or the studio's light.
    pub(in crate::app) fn close_companion(&mut self, companion: CompanionFile) {
        self.jobs.stop(Work::Companion(companion));
        match companion {
            CompanionFile::ReferenceShape => self.reference_shape = None,
            CompanionFile::LeftMesh => self.left_mesh = None,
            CompanionFile::Factors => self.forget_factors(),
            CompanionFile::LodShader => self.forget_shader::<LodShader>(),
            CompanionFile::SurfaceShader => self.forget_shader::<SurfaceShader>(),
            CompanionFile::Matcap => self.matcap = None,
            CompanionFile::Environment => {
                self.environment = None;
                self.cancel_environment();
            }
        }
    }

    /// Starts to open a file beside the mesh, or a shape as the reference surface or in the left half. Until it is read, what is open stays.
    pub(in crate::app) fn open_companion(&mut self, context: &egui::Context, companion: CompanionFile, source: Source) {
        match (companion, source) {
            (CompanionFile::ReferenceShape, source) => self.read_reference(context, Some(source), true),
            (CompanionFile::LeftMesh, source) => self.read_left(context, Some(source), MorphWeights::new()),
            (CompanionFile::Factors, Source::File(path)) => self.open_factors(context, path),
            (CompanionFile::LodShader, Source::File(path)) => {
                self.forget_factors();
                self.open_shader::<LodShader>(context, path);
            }
            (CompanionFile::SurfaceShader, Source::File(path)) => self.open_shader::<SurfaceShader>(context, path),
            (CompanionFile::Matcap, Source::File(path)) => self.open_matcap(context, path),
            (CompanionFile::Environment, Source::File(path)) => self.read_environment(context, path, true),
            // Shapes are surfaces, and nothing else.
            _ => {}
        }
    }
}

/// The reference surface that the mesh is compared with.
impl App {
    /// Starts to load a reference surface, or without a source the limit of the mesh's own cage. Until it is loaded, the one before it
    /// stays. `is_chosen` says whether deviation is shown once it is read.
    pub(in crate::app) fn read_reference(&mut self, context: &egui::Context, from: Option<Source>, is_chosen: bool) {
        let (own, preparation) = (self.source().cloned().unwrap_or_default(), self.preparation());
        let subdivide = if from.is_some() { Subdivide::File } else { self.own_scheme() };
        let what = from.as_ref().unwrap_or(&own).title();
        let (wanted, half) = (from.clone(), self.panels.edited);
        self.jobs.reference = (from.clone(), is_chosen);
        let load = move |progress: &Progress| {
            let found = engine::load_reference(wanted.as_ref(), (&own, &preparation), subdivide, progress);
            found.map(Arc::new).map_err(|error| error.to_string())
        };
        let title = format!("Loading the reference surface {what}");
        let take = move |app: &mut Self, reference_shape| {
            app.reference_shape = Some(Opened::new(from, reference_shape));
            if is_chosen {
                app.settings.change_half_looks(half, |own| own.overlays.colors = Colors::Deviation);
            }
        };
        self.read_companion(context, CompanionFile::ReferenceShape, title, what, load, take);
    }

    /// Loads the reference surface again after the mesh was, also one that is still being read: the limit of its own cage, or if the
    /// mesh was turned or scaled a file.
    pub(in crate::app) fn follow_reference_shape(&mut self, context: &egui::Context, is_turned: bool) {
        let chosen = self.reference_shape.as_ref().map(|chosen| (chosen.from.clone(), false));
        let is_read = self.jobs.has(Work::Companion(CompanionFile::ReferenceShape));
        let read = is_read.then(|| self.jobs.reference.clone());
        if let Some((from, is_chosen)) = read.or(chosen)
            && from.as_ref().is_none_or(|source| is_turned && source.shape().is_none())
        {
            self.read_reference(context, from, is_chosen);
        }
    }

    /// The source of the reference surface that was chosen for the mesh, if it has one of its own.
    pub fn reference_shape(&self) -> Option<&Source> {
        self.reference_shape.as_ref().and_then(|chosen| chosen.from.as_ref())
    }

    /// Whether the limit of the mesh's own cage was chosen as reference surface.
    pub fn has_own_limit(&self) -> bool {
        self.reference_shape.as_ref().is_some_and(|chosen| chosen.from.is_none())
    }

    /// How the mesh's own cage is refined where its limit is the reference surface.
    pub(in crate::app) fn own_scheme(&self) -> Subdivide {
        let import = self.preparation().import;
        if import.refines_all() { import.subdivide } else { Subdivide::CatmullClark }
    }

    /// The reference surface that distances are measured from: its number, the surface (none for the limit surface), and
    /// its name. The number is 0 for the limit surface, 1 for the exact surface, and from 2 on for a chosen one. In a pose it
    /// is always the limit surface, and an exact surface isn't used for a displaced mesh.
    pub(in crate::app) fn yardstick(&self) -> (u64, Option<Arc<ReferenceShape>>, String) {
        let limit = || (0, None, "limit surface".to_owned());
        let playback = self.viewport.playback;
        let at_rest = playback.moment().is_none() && playback.left == LeftPose::Same;
        let Some(document) = self.document.as_ref().filter(|_| at_rest) else { return limit() };
        if let Some(chosen) = &self.reference_shape {
            let name = chosen.from.as_ref().map_or_else(|| "subdivision limit".to_owned(), Source::title);
            return (chosen.generation, Some(chosen.content.clone()), name);
        }
        let is_plain = !self.settings.tessellation.displacement.is_on();
        match (&document.exact, document.loaded.source.shape()) {
            (Some(exact), Some(shape)) if is_plain => {
                (1, Some(exact.clone()), format!("exact {}", shape.title().to_lowercase()))
            }
            _ => limit(),
        }
    }
}

/// A picture of a lit sphere from a file, in place of those that are made in code.
impl App {
    /// Starts to read a picture of a lit sphere, which the surface then shows. Until it is read, all stays as it is.
    pub fn open_matcap(&mut self, context: &egui::Context, path: PathBuf) {
        let path = absolute_path(path);
        let (wanted, limits, what, half) = (path.clone(), self.jobs.limits, shown_path(&path), self.panels.edited);
        let read = move |_: &_| load_matcap(&wanted, &limits).map_err(|error| error.to_string());
        self.read_companion(context, CompanionFile::Matcap, String::new(), what, read, move |app, picture| {
            app.matcap = Some(OpenFile::new(path, Arc::new(picture)));
            app.settings.change_half_looks(half, |own| own.overlays.colors = Colors::Matcap);
        });
    }

    /// The file of the picture of a lit sphere, if one was opened.
    pub fn matcap_image(&self) -> Option<&Path> {
        self.matcap.as_ref().map(|chosen| &*chosen.from)
    }
}

/// The file whose light shines on the mesh.
impl App {
    /// Starts to read the light of a file. Until it is read, the light before it stays. `is_chosen` says whether the file's light shines
    /// once it is read, in the half that is edited now.
    pub(in crate::app) fn read_environment(&mut self, context: &egui::Context, path: PathBuf, is_chosen: bool) {
        let path = absolute_path(path);
        let (wanted, limits, gpu, half) = (path.clone(), self.jobs.limits, self.engine.gpu.clone(), self.panels.edited);
        let read = move |progress: &Progress| {
            let part = progress.part(0.0, 0.8);
            let EnvironmentFile { panorama, warnings } =
                EnvironmentFile::load(&wanted, &limits, &part).map_err(|error| error.to_string())?;
            let no_room = |error| format!("{}: {error}", shown_path(&wanted));
            let environment = Arc::new(Environment::from_panorama(&gpu, panorama).map_err(no_room)?);
            Ok(Light { warnings, environment })
        };
        self.jobs.light = Some(path.clone());
        let title = format!("Reading the light of {}", file_name(&path));
        self.read_companion(context, CompanionFile::Environment, title, shown_path(&path), read, move |app, light| {
            app.environment = Some(OpenFile::new(path, light));
            if is_chosen {
                app.settings.change_half_looks(half, |own| own.lighting = Lighting::Environment);
            }
        });
    }

    /// The file whose light is open, or else the one that is being read.
    pub fn environment_file(&self) -> Option<&Path> {
        let open = self.environment.as_ref().map(|open| &*open.from);
        open.or(self.jobs.light.as_deref().filter(|_| self.jobs.has(Work::Companion(CompanionFile::Environment))))
    }

    /// Stops reading a file. The light before it stays.
    pub(in crate::app) fn cancel_environment(&mut self) {
        self.jobs.stop(Work::Companion(CompanionFile::Environment));
        if self.environment.is_none() {
            self.settings.change_looks(|own| {
                if own.lighting == Lighting::Environment {
                    own.lighting = Lighting::Studio;
                }
            });
        }
    }
}
