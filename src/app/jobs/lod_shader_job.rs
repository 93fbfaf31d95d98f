//! Functions of the user's own in place of LOD: a WGSL file that is read again whenever it changes on disk. A version that can't be
//! used leaves the last good one in place.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::time::{Duration, SystemTime};

use super::background_job::{caught, spawn};
use crate::app::App;
use crate::engine::Engine;
use crate::gpu::LodShader;
use crate::names::shown_path;
use crate::own_shader::read_own_shader;
use crate::progress::Progress;
use crate::settings::Settings;
use crate::tessellate::{Lod, Partitioning, Tessellation};

/// The file that is open, and what was made of it.
pub(crate) struct OpenLodShader {
    pub path: PathBuf,
    /// The last version that can be used, and a number of its own; none if none could.
    shader: Option<(Arc<LodShader>, u64)>,
    /// The version before that, should the present one take too long.
    before: Option<(Arc<LodShader>, u64)>,
    /// Why the newest version can't be used, in a sentence.
    error: Option<String>,
    watch: Watch,
    /// The LOD before.
    lod: Lod,
}

impl OpenLodShader {
    /// The file's name.
    pub(crate) fn name(&self) -> String {
        shown_path(Path::new(self.path.file_name().unwrap_or_default()))
    }

    /// Why the newest version of the file can't be used, in a sentence.
    pub(crate) fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }

    /// Whether some version of the file gives factors.
    pub(crate) fn is_used(&self) -> bool {
        self.shader.is_some()
    }

    /// Whether the file is read for the first time.
    pub(crate) fn is_opening(&self) -> bool {
        self.shader.is_none() && self.error.is_none()
    }

    /// What gives factors, and its number.
    pub(crate) fn shader(&self) -> Option<(Arc<LodShader>, u64)> {
        self.shader.clone()
    }
}

/// A number for what takes the place of LOD, which nothing else has, from 1 on.
pub(super) fn new_generation() -> u64 {
    static GENERATION: AtomicU64 = AtomicU64::new(1);
    GENERATION.fetch_add(1, Ordering::Relaxed)
}

/// How often the file is looked at.
const EVERY: Duration = Duration::from_millis(250);

/// The thread that watches the file. It ends when this is dropped.
struct Watch {
    versions: Receiver<Result<Arc<LodShader>, String>>,
    wanted: Progress,
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}

impl Watch {
    fn start(engine: &Engine, context: &egui::Context, path: PathBuf) -> Self {
        let (sender, versions) = channel();
        let wanted = Progress::default();
        let (engine, context, still_wanted) = (engine.clone(), context.clone(), wanted.clone());
        spawn(move || watch(&engine, &context, &path, &sender, &still_wanted));
        Self { versions, wanted }
    }
}

/// When a file was last written, and its length in bytes; none while it isn't there.
fn stamp(path: &Path) -> Option<(Option<SystemTime>, u64)> {
    std::fs::metadata(path).ok().map(|about| (about.modified().ok(), about.len()))
}

/// Reads and compiles the file, and again after every change, until nobody wants it any more.
fn watch(
    engine: &Engine,
    context: &egui::Context,
    path: &Path,
    versions: &Sender<Result<Arc<LodShader>, String>>,
    wanted: &Progress,
) {
    let mut seen = None;
    while wanted.check().is_ok() {
        let now = stamp(path);
        // An editor may replace the file by another: what isn't there for a moment is no new version, unless it is the first.
        if seen.as_ref() != Some(&now) && (now.is_some() || seen.is_none()) {
            seen = Some(now);
            let version = caught(|| read(engine, path));
            let version = version.unwrap_or_else(|stopped| Err(format!("reading {} {stopped}", shown_path(path))));
            if versions.send(version).is_err() {
                return;
            }
            context.request_repaint();
        }
        std::thread::sleep(EVERY);
    }
}

/// Reads the file, and lets the driver compile it.
fn read(engine: &Engine, path: &Path) -> Result<Arc<LodShader>, String> {
    let shader = read_own_shader(path).map_err(|error| error.to_string())?;
    engine.pipelines.own_lod(&shader).prepare(&engine.gpu).map_err(|error| error.to_string())?;
    Ok(shader)
}

impl App {
    /// Opens a file with functions of the user's own, which take the place of LOD once they can be used, and watches it.
    pub fn open_lod_shader(&mut self, context: &egui::Context, path: PathBuf) {
        // A dash would be standard input, and the copied command needs the whole path.
        let path = std::path::absolute(&path).unwrap_or(path);
        self.forget_factors();
        self.forget_lod_shader();
        self.lod_shader = Some(OpenLodShader {
            watch: Watch::start(&self.engine, context, path.clone()),
            path,
            shader: None,
            before: None,
            error: None,
            lod: self.settings.tessellation.lod,
        });
    }

    /// Reads the file again, even if it hasn't changed, and watches it for this window.
    pub(in crate::app) fn reload_lod_shader(&mut self, context: &egui::Context) {
        if let Some(open) = &mut self.lod_shader {
            open.watch = Watch::start(&self.engine, context, open.path.clone());
        }
    }

    /// The file with functions that give factors, if it is open and one of its versions can be used.
    pub fn lod_shader_file(&self) -> Option<&Path> {
        self.lod_shader.as_ref().filter(|open| open.is_used()).map(|open| &*open.path)
    }

    /// The file that is open, also if none of its versions can be used.
    pub(in crate::app) fn open_lod_shader_file(&self) -> Option<&Path> {
        self.lod_shader.as_ref().map(|open| &*open.path)
    }

    /// The settings with the LOD that is there again when the file is closed.
    pub(in crate::app) fn settings_without_lod_shader(&self) -> Settings {
        let own = self.settings.tessellation;
        match self.lod_shader.as_ref().filter(|open| open.is_used()) {
            Some(open) => self.settings.with(Tessellation { lod: open.lod, ..own }),
            None => self.settings,
        }
    }

    /// Why the newest version of that file can't be used, in a sentence.
    pub fn lod_shader_error(&self) -> Option<&str> {
        self.lod_shader.as_ref().and_then(OpenLodShader::error)
    }

    /// Goes back to the factors of LOD.
    pub(in crate::app) fn forget_lod_shader(&mut self) {
        self.settings = self.settings_without_lod_shader();
        self.lod_shader = None;
    }

    /// Takes new versions of the file.
    pub(in crate::app) fn take_lod_shader(&mut self) {
        let Some(open) = &mut self.lod_shader else { return };
        loop {
            match open.watch.versions.try_recv() {
                Ok(Ok(shader)) => {
                    open.error = None;
                    if open.shader.as_ref().is_none_or(|(known, _)| *known != shader) {
                        open.before = open.shader.replace((shader, new_generation()));
                    }
                    // The functions take LOD's place.
                    self.settings.tessellation.lod = Lod::Uniform;
                }
                Ok(Err(why)) => open.error = Some(why),
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => {
                    let why = format!("watching {} stopped unexpectedly; open it again", open.name());
                    open.error.get_or_insert(why);
                    return;
                }
            }
        }
    }

    /// Whether the functions give the factors that are shown. Under subtriangulation, which has the same number of segments everywhere,
    /// they give none.
    pub(in crate::app) fn uses_lod_shader(&self) -> bool {
        self.lod_shader.as_ref().is_some_and(OpenLodShader::is_used)
            && self.settings.tessellation.partitioning != Partitioning::Subtriangulation
    }

    /// Goes back to the version before, if loops of the present one took too long for the picture that was counted.
    pub(in crate::app) fn stop_slow_lod_shader(&mut self) {
        let report = self.document.as_ref().and_then(|document| document.scene.tessellator.own_lod_report());
        let shown = self.document.as_ref().map_or(0, |document| document.given);
        let Some(open) = &mut self.lod_shader else { return };
        let is_shown = open.shader.as_ref().is_some_and(|(_, generation)| *generation == shown);
        if is_shown && report.is_some_and(|report| report.stopped > 0) {
            open.error = Some(crate::gpu::GpuError::OwnStopped("LOD shader").to_string());
            open.shader = open.before.take();
            if open.shader.is_none() {
                self.settings.tessellation.lod = open.lod;
            }
        }
    }

    /// What is said about factors of the functions that aren't numbers, if there are any in the picture.
    pub(in crate::app) fn not_numbers_said(&self) -> Option<String> {
        let report = self.document.as_ref()?.scene.tessellator.own_lod_report()?;
        crate::cli::not_numbers_said(report.not_numbers)
    }
}
