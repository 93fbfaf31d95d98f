//! Functions of the user's own in place of LOD or of the surface: WGSL files that are read again whenever they change on disk. A
//! version that can't be used leaves the last good one in place.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::background_job::caught;
use super::companion_files::{absolute_path, new_generation};
use super::file_watch::{Stamped, watch};
use super::job_list::Work;
use super::patience::Patience;
use crate::app::App;
use crate::app::text::file_name;
use crate::commands::CompanionFile;
use geometry::names::shown_path;
use geometry::progress::Progress;
use geometry::tessellate::{Lod, Surface, Tessellation};
use gpu::{GpuError, LodShader, SurfaceShader, UserReport, UserShader};
use inspect::engine::Engine;
use inspect::settings::Settings;
use inspect::user_shader::read_user_shader;

/// A file whose functions take the place of a setting.
pub(crate) trait UserShaderSlot: UserShader {
    type Setting: Copy;

    const FILE: CompanionFile;

    /// The setting while functions take its place. Nothing depends on it then.
    const PLACEHOLDER: Self::Setting;

    fn setting(tessellation: &mut Tessellation) -> &mut Self::Setting;

    fn slot(app: &mut App) -> &mut Option<OpenShader<Self>>;

    fn open_in(app: &App) -> Option<&OpenShader<Self>>;

    /// Lets the driver compile it.
    ///
    /// # Errors
    /// The driver refuses it, out of memory, or a lost device.
    fn prepare(engine: &Engine, shader: &Arc<Self>) -> Result<(), GpuError>;
}

/// Declares the files: the setting with its type and placeholder, where the app has the file, and what its functions are called in the
/// pipelines.
macro_rules! user_shader_slots {
    ($($shader:ident: $setting:ident: $type:ty = $placeholder:expr, $slot:ident, $pipeline:ident;)+) => {$(
        impl UserShaderSlot for $shader {
            type Setting = $type;
            const FILE: CompanionFile = CompanionFile::$shader;
            const PLACEHOLDER: $type = $placeholder;

            fn setting(tessellation: &mut Tessellation) -> &mut $type {
                &mut tessellation.$setting
            }

            fn slot(app: &mut App) -> &mut Option<OpenShader<Self>> {
                &mut app.$slot
            }

            fn open_in(app: &App) -> Option<&OpenShader<Self>> {
                app.$slot.as_ref()
            }

            fn prepare(engine: &Engine, shader: &Arc<Self>) -> Result<(), GpuError> {
                engine.pipelines.$pipeline(shader).prepare(&engine.gpu)
            }
        }
    )+};
}

user_shader_slots! {
    LodShader: lod: Lod = Lod::Uniform, lod_shader, user_lod;
    SurfaceShader: surface: Surface = Surface::OF_USER_SHADER, surface_shader, user_surface;
}

/// A version of a file, and a number of its own.
type Version<S> = (Arc<S>, u64);

/// The file that is open, and what was made of it.
pub(crate) struct OpenShader<S: UserShaderSlot> {
    pub path: PathBuf,
    /// The last version that can be used; none if none could.
    shader: Option<Version<S>>,
    /// The version before that, should the present one take too long.
    before: Option<Version<S>>,
    /// Why the newest version can't be used, in a sentence.
    pub error: Option<String>,
    /// The setting that is there again when the file is closed.
    replaced: S::Setting,
}

impl<S: UserShaderSlot> OpenShader<S> {
    pub(crate) fn name(&self) -> String {
        file_name(&self.path)
    }

    /// Whether some version of the file can be used.
    pub(crate) fn is_used(&self) -> bool {
        self.shader.is_some()
    }

    /// What is used, and its number.
    pub(crate) fn shader(&self) -> Option<Version<S>> {
        self.shader.clone()
    }
}

/// What came of reading the file.
type Read<S> = Result<Arc<S>, String>;

/// Reads and compiles the file, and again after every change, until nobody wants it any more.
fn read_versions<S: UserShaderSlot>(engine: &Engine, path: &Path, take: &dyn Fn(Read<S>) -> bool, wanted: &Progress) {
    let files = Stamped::now([path.to_owned()]);
    let read = || {
        let shader = read_user_shader(path).map_err(|error| error.to_string())?;
        S::prepare(engine, &shader).map(|()| shader).map_err(|error| error.to_string())
    };
    let send = || {
        let version = caught(read);
        take(version.unwrap_or_else(|stopped| Err(format!("reading {} {stopped}", shown_path(path)))))
    };
    if send() {
        watch(files, &Patience::default(), wanted, send);
    }
}

impl App {
    /// Opens a file with functions of the user's own, which take the place of a setting once they can be used, and watches it.
    pub(super) fn open_shader<S: UserShaderSlot>(&mut self, context: &egui::Context, path: PathBuf) {
        self.forget_shader::<S>();
        let replaced = *S::setting(&mut self.settings.tessellation);
        *S::slot(self) =
            Some(OpenShader { path: absolute_path(path), shader: None, before: None, error: None, replaced });
        self.watch_shader::<S>(context);
    }

    /// Reads the file, even if it hasn't changed, and watches it for this window.
    pub(in crate::app) fn watch_shader<S: UserShaderSlot>(&mut self, context: &egui::Context) {
        let Some(path) = S::open_in(self).map(|open| open.path.clone()) else { return };
        let engine = self.engine.clone();
        let read = move |wanted: &Progress, take: &dyn Fn(Read<S>) -> bool| read_versions(&engine, &path, take, wanted);
        self.jobs.follow(context, Work::Companion(S::FILE), read, |app, _, version| app.take_version::<S>(version));
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
    pub(in crate::app) fn open_shader_file<S: UserShaderSlot>(&self) -> Option<&Path> {
        S::open_in(self).map(|open| &*open.path)
    }

    /// The settings with those that are there again when files of factors and shaders are closed.
    pub(in crate::app) fn settings_without_files(&self) -> Settings {
        let mut own = self.settings.tessellation;
        own.lod = self.given.as_ref().map_or(own.lod, |given| given.content.lod);
        self.put_back::<LodShader>(&mut own);
        self.put_back::<SurfaceShader>(&mut own);
        self.settings.with(own)
    }

    fn put_back<S: UserShaderSlot>(&self, tessellation: &mut Tessellation) {
        if let Some(open) = S::open_in(self).filter(|open| open.is_used()) {
            *S::setting(tessellation) = open.replaced;
        }
    }

    /// Closes the file, so that the setting holds again.
    pub(in crate::app) fn forget_shader<S: UserShaderSlot>(&mut self) {
        let mut own = self.settings.tessellation;
        self.put_back::<S>(&mut own);
        self.settings.tessellation = own;
        self.jobs.stop(Work::Companion(S::FILE));
        *S::slot(self) = None;
    }

    /// Puts functions in the place of a setting that was set while they are used.
    pub(in crate::app) fn replace_again<S: UserShaderSlot>(&mut self) {
        let own = *S::setting(&mut self.settings.tessellation);
        let Some(open) = S::slot(self).as_mut().filter(|open| open.is_used()) else { return };
        open.replaced = own;
        *S::setting(&mut self.settings.tessellation) = S::PLACEHOLDER;
    }

    /// Takes a new version of the file; none if its watch has ended.
    fn take_version<S: UserShaderSlot>(&mut self, version: Option<Read<S>>) {
        let Some(open) = S::slot(self) else { return };
        let was_used = open.is_used();
        match version {
            Some(Ok(shader)) => {
                open.error = None;
                if open.shader.as_ref().is_none_or(|(known, _)| *known != shader) {
                    open.before = open.shader.replace((shader, new_generation()));
                }
            }
            Some(Err(why)) => open.error = Some(why),
            None => {
                let why = format!("watching {} stopped unexpectedly; open it again", open.name());
                open.error.get_or_insert(why);
                return;
            }
        }
        if !was_used {
            // The setting may have been set while the file was read.
            self.replace_again::<S>();
        }
    }

    /// Whether the functions give the factors that are shown. Under subtriangulation, which has the same number of segments everywhere,
    /// they give none.
    pub(in crate::app) fn uses_lod_shader(&self) -> bool {
        self.lod_shader_file().is_some() && !self.settings.tessellation.partitioning.has_one_factor()
    }

    /// Whether a function gives the control points that are shown, but for those left of a split.
    pub(in crate::app) fn uses_surface_shader(&self) -> bool {
        self.surface_shader_file().is_some()
    }

    /// Goes back to the versions before, if loops of the present ones took too long for the picture that was counted.
    pub(in crate::app) fn stop_slow_shaders(&mut self) {
        let Some(document) = &self.document else { return };
        let (tessellator, shown) = (&document.scene.tessellator, document.from_files);
        let (of_lod, of_surface) = (tessellator.user_lod_report(), tessellator.user_surface_report());
        self.stop_if_slow::<LodShader>(of_lod, shown.factors);
        self.stop_if_slow::<SurfaceShader>(of_surface, shown.surface);
    }

    /// The same for what a shader reported, and the number of its version that the picture has.
    fn stop_if_slow<S: UserShaderSlot>(&mut self, report: Option<UserReport>, shown: u64) {
        let Some(open) = S::slot(self) else { return };
        let is_shown = open.shader.as_ref().is_some_and(|(_, generation)| *generation == shown);
        if is_shown && report.is_some_and(|report| report.stopped > 0) {
            open.error = Some(GpuError::UserShaderTimedOut(S::PURPOSE.name).to_string());
            open.shader = open.before.take();
            if open.shader.is_none() {
                let replaced = open.replaced;
                *S::setting(&mut self.settings.tessellation) = replaced;
            }
        }
    }

    /// What is said about factors of the functions that aren't numbers, if there are any in the picture.
    pub(in crate::app) fn not_numbers_said(&self) -> Option<String> {
        let report = self.document.as_ref()?.scene.tessellator.user_lod_report()?;
        inspect::shot::not_numbers_said(report.not_numbers)
    }

    /// What is said about sides whose control points aren't numbers, if there are any in the picture.
    pub(in crate::app) fn straight_sides_said(&self) -> Option<String> {
        let report = self.document.as_ref()?.scene.tessellator.user_surface_report()?;
        inspect::shot::straight_sides_said(report.not_numbers)
    }
}
