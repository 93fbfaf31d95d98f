//! Functions of the user's own in place of LOD or of the surface: WGSL files that are read again whenever they change on disk. A
//! version that can't be used leaves the last good one in place.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::time::{Duration, SystemTime};

use super::background_job::{caught, spawn};
use super::document::Document;
use crate::app::App;
use crate::engine::Engine;
use crate::gpu::{GpuError, LodShader, OwnReport, OwnShader, SurfaceShader, Tessellator};
use crate::names::shown_path;
use crate::own_shader::read_own_shader;
use crate::progress::Progress;
use crate::settings::Settings;
use crate::tessellate::{Lod, Partitioning, Surface, Tessellation};

/// A file whose functions take the place of a setting.
pub(crate) trait Replacing: OwnShader {
    type Setting: Copy;

    /// The setting while functions take its place. Nothing depends on it then.
    const MEANWHILE: Self::Setting;

    fn setting(tessellation: &mut Tessellation) -> &mut Self::Setting;

    fn slot(app: &mut App) -> &mut Option<OpenShader<Self>>;

    fn open_in(app: &App) -> Option<&OpenShader<Self>>;

    /// Lets the driver compile it.
    ///
    /// # Errors
    /// The driver refuses it, out of memory, or a lost device.
    fn prepare(engine: &Engine, shader: &Arc<Self>) -> Result<(), GpuError>;

    /// What it reported of the picture that was counted.
    fn report(tessellator: &Tessellator) -> Option<OwnReport>;

    /// The number of the version that the document's scene has.
    fn shown(document: &Document) -> u64;
}

impl Replacing for LodShader {
    type Setting = Lod;

    const MEANWHILE: Lod = Lod::Uniform;

    fn setting(tessellation: &mut Tessellation) -> &mut Lod {
        &mut tessellation.lod
    }

    fn slot(app: &mut App) -> &mut Option<OpenShader<Self>> {
        &mut app.lod_shader
    }

    fn open_in(app: &App) -> Option<&OpenShader<Self>> {
        app.lod_shader.as_ref()
    }

    fn prepare(engine: &Engine, shader: &Arc<Self>) -> Result<(), GpuError> {
        engine.pipelines.own_lod(shader).prepare(&engine.gpu)
    }

    fn report(tessellator: &Tessellator) -> Option<OwnReport> {
        tessellator.own_lod_report()
    }

    fn shown(document: &Document) -> u64 {
        document.given
    }
}

impl Replacing for SurfaceShader {
    type Setting = Surface;

    const MEANWHILE: Surface = Surface::Pn;

    fn setting(tessellation: &mut Tessellation) -> &mut Surface {
        &mut tessellation.surface
    }

    fn slot(app: &mut App) -> &mut Option<OpenShader<Self>> {
        &mut app.surface_shader
    }

    fn open_in(app: &App) -> Option<&OpenShader<Self>> {
        app.surface_shader.as_ref()
    }

    fn prepare(engine: &Engine, shader: &Arc<Self>) -> Result<(), GpuError> {
        engine.pipelines.own_surface(shader).prepare(&engine.gpu)
    }

    fn report(tessellator: &Tessellator) -> Option<OwnReport> {
        tessellator.own_surface_report()
    }

    fn shown(document: &Document) -> u64 {
        document.surface_shader
    }
}

/// A version of a file, and a number of its own.
type Version<S> = (Arc<S>, u64);

/// The file that is open, and what was made of it.
pub(crate) struct OpenShader<S: Replacing> {
    pub path: PathBuf,
    /// The last version that can be used; none if none could.
    shader: Option<Version<S>>,
    /// The version before that, should the present one take too long.
    before: Option<Version<S>>,
    /// Why the newest version can't be used, in a sentence.
    error: Option<String>,
    watch: Watch<S>,
    /// The setting that is there again when the file is closed.
    replaced: S::Setting,
}

impl<S: Replacing> OpenShader<S> {
    /// The file's name.
    pub(crate) fn name(&self) -> String {
        shown_path(Path::new(self.path.file_name().unwrap_or_default()))
    }

    /// Why the newest version of the file can't be used, in a sentence.
    pub(crate) fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }

    /// Whether some version of the file can be used.
    pub(crate) fn is_used(&self) -> bool {
        self.shader.is_some()
    }

    /// Whether the file is read for the first time.
    pub(crate) fn is_opening(&self) -> bool {
        self.shader.is_none() && self.error.is_none()
    }

    /// What is used, and its number.
    pub(crate) fn shader(&self) -> Option<Version<S>> {
        self.shader.clone()
    }
}

/// A number for what takes the place of a setting, which nothing else has, from 1 on.
pub(super) fn new_generation() -> u64 {
    static GENERATION: AtomicU64 = AtomicU64::new(1);
    GENERATION.fetch_add(1, Ordering::Relaxed)
}

/// How often the file is looked at.
const EVERY: Duration = Duration::from_millis(250);

/// What came of reading the file.
type Read<S> = Result<Arc<S>, String>;

/// The thread that watches the file. It ends when this is dropped.
struct Watch<S> {
    versions: Receiver<Read<S>>,
    wanted: Progress,
}

impl<S> Drop for Watch<S> {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}

impl<S: Replacing> Watch<S> {
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
fn watch<S: Replacing>(
    engine: &Engine,
    context: &egui::Context,
    path: &Path,
    versions: &Sender<Read<S>>,
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
fn read<S: Replacing>(engine: &Engine, path: &Path) -> Read<S> {
    let shader = read_own_shader(path).map_err(|error| error.to_string())?;
    S::prepare(engine, &shader).map_err(|error| error.to_string())?;
    Ok(shader)
}

impl App {
    /// Opens a file with functions of the user's own, which take the place of LOD once they can be used, and watches it.
    pub fn open_lod_shader(&mut self, context: &egui::Context, path: PathBuf) {
        self.forget_factors();
        self.open_shader::<LodShader>(context, path);
    }

    /// The same for a function that takes the place of the surface.
    pub fn open_surface_shader(&mut self, context: &egui::Context, path: PathBuf) {
        self.open_shader::<SurfaceShader>(context, path);
    }

    fn open_shader<S: Replacing>(&mut self, context: &egui::Context, path: PathBuf) {
        // A dash would be standard input, and the copied command needs the whole path.
        let path = std::path::absolute(&path).unwrap_or(path);
        self.forget_shader::<S>();
        *S::slot(self) = Some(OpenShader {
            watch: Watch::start(&self.engine, context, path.clone()),
            path,
            shader: None,
            before: None,
            error: None,
            replaced: *S::setting(&mut self.settings.tessellation),
        });
    }

    /// Reads the file again, even if it hasn't changed, and watches it for this window.
    pub(in crate::app) fn reload_shader<S: Replacing>(&mut self, context: &egui::Context) {
        let engine = self.engine.clone();
        if let Some(open) = S::slot(self) {
            open.watch = Watch::start(&engine, context, open.path.clone());
        }
    }

    /// The file with functions that give factors, if it is open and one of its versions can be used.
    pub fn lod_shader_file(&self) -> Option<&Path> {
        self.lod_shader.as_ref().filter(|open| open.is_used()).map(|open| &*open.path)
    }

    /// The file with the function that gives control points, if it is open and one of its versions can be used.
    pub fn surface_shader_file(&self) -> Option<&Path> {
        self.surface_shader.as_ref().filter(|open| open.is_used()).map(|open| &*open.path)
    }

    /// The file that is open, also if none of its versions can be used.
    pub(in crate::app) fn open_shader_file<S: Replacing>(&self) -> Option<&Path> {
        S::open_in(self).map(|open| &*open.path)
    }

    /// The settings with those that are there again when files of factors and shaders are closed.
    pub(in crate::app) fn settings_without_files(&self) -> Settings {
        let mut own = self.settings.tessellation;
        own.lod = self.given.as_ref().map_or(own.lod, |given| given.lod);
        self.put_back::<LodShader>(&mut own);
        self.put_back::<SurfaceShader>(&mut own);
        self.settings.with(own)
    }

    fn put_back<S: Replacing>(&self, tessellation: &mut Tessellation) {
        if let Some(open) = S::open_in(self).filter(|open| open.is_used()) {
            *S::setting(tessellation) = open.replaced;
        }
    }

    /// Why the newest version of the LOD shader can't be used, in a sentence.
    pub fn lod_shader_error(&self) -> Option<&str> {
        self.lod_shader.as_ref().and_then(OpenShader::error)
    }

    /// Why the newest version of the surface shader can't be used, in a sentence.
    pub fn surface_shader_error(&self) -> Option<&str> {
        self.surface_shader.as_ref().and_then(OpenShader::error)
    }

    /// Closes the file, so that the setting holds again.
    pub(in crate::app) fn forget_shader<S: Replacing>(&mut self) {
        let mut own = self.settings.tessellation;
        self.put_back::<S>(&mut own);
        self.settings.tessellation = own;
        *S::slot(self) = None;
    }

    /// Lets the file that was open at a step of undo be open again.
    pub(in crate::app) fn take_back_shader<S: Replacing>(&mut self, context: &egui::Context, path: Option<PathBuf>) {
        if self.open_shader_file::<S>() != path.as_deref() {
            *S::slot(self) = None;
            path.into_iter().for_each(|path| self.open_shader::<S>(context, path));
        }
    }

    /// Puts functions in the place of a setting that was set while they are used.
    pub(in crate::app) fn replace_again<S: Replacing>(&mut self) {
        let own = *S::setting(&mut self.settings.tessellation);
        let Some(open) = S::slot(self).as_mut().filter(|open| open.is_used()) else { return };
        open.replaced = own;
        *S::setting(&mut self.settings.tessellation) = S::MEANWHILE;
    }

    /// Takes new versions of the file, unless they take too long.
    pub(in crate::app) fn take_shader<S: Replacing>(&mut self) {
        let own = *S::setting(&mut self.settings.tessellation);
        let Some(open) = S::slot(self) else { return };
        let was_used = open.is_used();
        loop {
            match open.watch.versions.try_recv() {
                Ok(Ok(shader)) => {
                    open.error = None;
                    if open.shader.as_ref().is_none_or(|(known, _)| *known != shader) {
                        open.before = open.shader.replace((shader, new_generation()));
                    }
                }
                Ok(Err(why)) => open.error = Some(why),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => {
                    let why = format!("watching {} stopped unexpectedly; open it again", open.name());
                    open.error.get_or_insert(why);
                    break;
                }
            }
        }
        if open.is_used() && !was_used {
            // It may have been set while the file was read.
            open.replaced = own;
            *S::setting(&mut self.settings.tessellation) = S::MEANWHILE;
        }
        self.stop_slow_shader::<S>();
    }

    /// Whether the functions give the factors that are shown. Under subtriangulation, which has the same number of segments everywhere,
    /// they give none.
    pub(in crate::app) fn uses_lod_shader(&self) -> bool {
        self.lod_shader_file().is_some() && self.settings.tessellation.partitioning != Partitioning::Subtriangulation
    }

    /// Whether a function gives the control points that are shown, but for those left of a split.
    pub(in crate::app) fn uses_surface_shader(&self) -> bool {
        self.surface_shader_file().is_some()
    }

    /// Goes back to the version before, if loops of the present one took too long for the picture that was counted.
    fn stop_slow_shader<S: Replacing>(&mut self) {
        let Some(document) = &self.document else { return };
        let (report, shown) = (S::report(&document.scene.tessellator), S::shown(document));
        let Some(open) = S::slot(self) else { return };
        let is_shown = open.shader.as_ref().is_some_and(|(_, generation)| *generation == shown);
        if is_shown && report.is_some_and(|report| report.stopped > 0) {
            open.error = Some(GpuError::OwnStopped(S::purpose().name).to_string());
            open.shader = open.before.take();
            if open.shader.is_none() {
                let replaced = open.replaced;
                *S::setting(&mut self.settings.tessellation) = replaced;
            }
        }
    }

    /// What is said about factors of the functions that aren't numbers, if there are any in the picture.
    pub(in crate::app) fn not_numbers_said(&self) -> Option<String> {
        let report = self.document.as_ref()?.scene.tessellator.own_lod_report()?;
        crate::cli::not_numbers_said(report.not_numbers)
    }

    /// What is said about sides whose control points aren't numbers, if there are any in the picture.
    pub(in crate::app) fn straight_sides_said(&self) -> Option<String> {
        let report = self.document.as_ref()?.scene.tessellator.own_surface_report()?;
        crate::cli::straight_sides_said(report.not_numbers)
    }

    /// The number of the function that is to give control points; 0 for the surface's own.
    pub(in crate::app) fn surface_shader_wanted(&self) -> u64 {
        self.surface_shader.as_ref().and_then(OpenShader::shader).map_or(0, |(_, generation)| generation)
    }

    /// Gives the scene the function of the user's own for control points, or takes it back, while no picture is under way. Returns
    /// the number of the one that the picture has.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(in crate::app) fn give_surface_shader(&mut self) -> Result<u64, GpuError> {
        let wanted = self.surface_shader_wanted();
        let shader = self.surface_shader.as_ref().and_then(OpenShader::shader);
        let Some(document) = &mut self.document else { return Ok(0) };
        if document.surface_shader != wanted && self.viewport.picture.is_free() && self.viewport.left.is_made() {
            document.scene.tessellator.set_surface_shader(shader.map(|(shader, _)| shader))?;
            document.surface_shader = wanted;
        }
        Ok(document.surface_shader)
    }
}
