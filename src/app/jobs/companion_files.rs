//! Files that are open beside the mesh: what they have in common.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::job_list::Work;
use crate::app::App;
use crate::commands::CompanionFile;
use geometry::names::shown_path;
use geometry::progress::Progress;
use gpu::{LodShader, SurfaceShader};
use load::Source;

/// A file that is open, and what was read from it.
pub(crate) struct OpenFile<T> {
    /// Absolute: a dash would be standard input, and copied commands and the next window need all of it.
    pub path: PathBuf,
    /// A number of its own for each file that was read.
    pub generation: u64,
    pub content: T,
}

impl<T> OpenFile<T> {
    pub(crate) fn new(path: PathBuf, content: T) -> Self {
        Self { path, generation: new_generation(), content }
    }

    pub(crate) fn name(&self) -> String {
        file_name(&self.path)
    }
}

/// The file's name without its folder.
pub(crate) fn file_name(path: &Path) -> String {
    shown_path(Path::new(path.file_name().unwrap_or(path.as_os_str())))
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
    pub(super) fn read_companion<T: Send + 'static>(
        &mut self,
        context: &egui::Context,
        work: Work,
        title: String,
        what: String,
        read: impl FnOnce(&Progress) -> Result<T, String> + Send + 'static,
        take: impl FnOnce(&mut Self, T) + 'static,
    ) {
        self.jobs.start(context, work, title, read, move |app, _, ended| {
            match ended.unwrap_or_else(|stopped| Err(format!("reading {what} {stopped}"))) {
                Ok(read) => take(app, read),
                Err(why) => {
                    if work == Work::Light {
                        app.cancel_environment();
                    }
                    app.dialogs.error = Some(why);
                }
            }
        });
    }

    /// What is open, or being opened, beside the mesh.
    pub(in crate::app) fn companion(&self, companion: CompanionFile) -> Option<Source> {
        let path = match companion {
            CompanionFile::ReferenceShape => return self.reference_shape().cloned(),
            CompanionFile::LeftMesh => return self.left_mesh.as_ref().and_then(|left| left.source.clone()),
            CompanionFile::Factors => self.factors_file(),
            CompanionFile::LodShader => self.open_shader_file::<LodShader>(),
            CompanionFile::SurfaceShader => self.open_shader_file::<SurfaceShader>(),
            CompanionFile::Matcap => self.matcap_image(),
            CompanionFile::Environment => self.environment_file(),
        };
        path.map(|path| Source::File(path.to_owned()))
    }

    pub(in crate::app) fn close_companion(&mut self, companion: CompanionFile) {
        match companion {
            CompanionFile::ReferenceShape => self.forget_reference_shape(),
            CompanionFile::LeftMesh => self.forget_left_mesh(),
            CompanionFile::Factors => self.forget_factors(),
            CompanionFile::LodShader => self.forget_shader::<LodShader>(),
            CompanionFile::SurfaceShader => self.forget_shader::<SurfaceShader>(),
            CompanionFile::Matcap => self.forget_matcap(),
            CompanionFile::Environment => self.close_environment(),
        }
    }

    /// Starts to open a file beside the mesh, or a shape as the reference surface or in the left half. Until it is read, what is open stays.
    pub(in crate::app) fn open_companion(&mut self, context: &egui::Context, companion: CompanionFile, source: Source) {
        match (companion, source) {
            (CompanionFile::ReferenceShape, source) => self.open_reference_shape(context, source),
            (CompanionFile::LeftMesh, source) => self.open_left_mesh(context, source),
            (CompanionFile::Factors, Source::File(path)) => self.open_factors(context, path),
            (CompanionFile::LodShader, Source::File(path)) => self.open_lod_shader(context, path),
            (CompanionFile::SurfaceShader, Source::File(path)) => self.open_surface_shader(context, path),
            (CompanionFile::Matcap, Source::File(path)) => self.open_matcap(context, path),
            (CompanionFile::Environment, Source::File(path)) => self.open_environment(context, path),
            // Shapes are surfaces, and nothing else.
            _ => {}
        }
    }
}
