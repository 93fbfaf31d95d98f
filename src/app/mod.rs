//! The window. It edits [`Settings`] and a [`Camera`], and shows what the engine makes of them; it holds no mathematics.

mod animation;
mod beside;
mod chart;
mod chart_panel;
mod charting;
mod checks;
mod choices;
mod deviating;
mod deviation;
mod diagram;
mod document;
mod facts;
mod heights;
mod labels;
mod lasting;
mod left;
mod legend;
mod marked;
mod measuring;
mod menu;
mod names;
mod panels;
mod patch;
mod pattern;
mod pick;
mod picture;
mod rim;
mod status;
mod text;
mod truth;
mod viewport;
mod widgets;
mod windows;
mod worst;

use std::sync::Arc;

use thiserror::Error;

use crate::engine::{Engine, Loaded, Preparation};
use crate::gpu::{AdapterChoice, BACKENDS, Gpu, GpuError, device_descriptor};
use crate::measure::{Cracks, Sizes};
use crate::mesh::{Limits, Source};
use crate::render::Camera;
use crate::settings::Settings;
use crate::tessellate::{Displacement, LodView};

use animation::Playback;
use beside::Beside;
use chart::Chart;
use deviating::Deviating;
use document::{Document, Load, NotLoaded};
use lasting::{LEAST_SIZE, folder};
use left::Left;
use marked::Marked;
use measuring::Measuring;
use pick::Selection;
use picture::Viewport;
use truth::{Chosen, TruthLoad};

pub use lasting::Lasting;

#[derive(Debug, Error)]
pub enum WindowError {
    /// Why, in a few words.
    #[error("no window could be opened ({0})")]
    NoDisplay(String),
    #[error("the window can't be drawn ({0}): check the graphics driver, or use the commands (pnaen --help)")]
    Failed(String),
}

/// Opens the window on `source`, or on a cube made in code, and returns when it is closed; on the adapter that was asked
/// for. Files larger than `limits` says aren't opened.
///
/// # Errors
/// There is no display, or none that a window can be drawn on.
pub fn run(source: Option<Source>, limits: Limits, adapter: AdapterChoice) -> Result<(), WindowError> {
    if cfg!(target_os = "linux") && !["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some())
    {
        return Err(WindowError::NoDisplay("neither DISPLAY nor WAYLAND_DISPLAY is set".into()));
    }
    let lasting = Lasting::read(folder().as_deref());
    let frame = lasting.frame();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("pnaen")
            .with_app_id("pnaen")
            .with_inner_size(frame.size)
            .with_maximized(frame.is_maximized)
            .with_min_inner_size(LEAST_SIZE),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: wgpu_configuration(adapter),
        ..Default::default()
    };
    let create: eframe::AppCreator = Box::new(|context| {
        let mut app = App::new(context, source, limits)?;
        app.resume(&context.egui_ctx, lasting);
        Ok(Box::new(app))
    });
    let window = eframe::run_native("pnaen", options, create);
    window.map_err(|error| match error {
        // Their texts are about the window library's own files.
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => {
            WindowError::NoDisplay("the display that DISPLAY or WAYLAND_DISPLAY names can't be opened".into())
        }
        error => WindowError::Failed(error.to_string()),
    })
}

/// The device that egui draws with is the engine's own.
fn wgpu_configuration(choice: AdapterChoice) -> egui_wgpu::WgpuConfiguration {
    let mut configuration = egui_wgpu::WgpuConfiguration::default();
    if let egui_wgpu::WgpuSetup::CreateNew(new) = &mut configuration.wgpu_setup {
        new.instance_descriptor.backends = BACKENDS;
        new.power_preference = wgpu::PowerPreference::HighPerformance;
        new.device_descriptor = Arc::new(device_descriptor);
        if choice != AdapterChoice::Best {
            new.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
                let shows =
                    |adapter: &&wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
                let able: Vec<_> = adapters.iter().filter(shows).cloned().collect();
                choice.among(&able).cloned().map_err(|error| error.to_string())
            }));
        }
    }
    configuration
}

/// The window's state.
pub struct App {
    engine: Engine,
    render_state: egui_wgpu::RenderState,
    settings: Settings,
    camera: Camera,
    /// As it was when it last framed the whole mesh.
    framed: Option<Camera>,
    /// Where the split was when it was last on.
    last_split: f32,
    /// What displacement was before it was last switched.
    last_displacement: Displacement,
    /// The view that LOD and clipping stay computed for, while frozen.
    frozen: Option<LodView>,
    document: Option<Document>,
    load: Option<Load>,
    /// Of files that are opened.
    limits: Limits,
    dialog: Option<Beside<Option<std::path::PathBuf>>>,
    /// Whether the dialog, or the window that takes a path, is for a truth.
    asks_for_truth: bool,
    /// What the mesh should have been, if that was chosen.
    truth: Option<Chosen>,
    truth_load: Option<TruthLoad>,
    /// The width of a rim that is being dragged.
    dragged_rim: Option<f32>,
    viewport: Viewport,
    playback: Playback,
    measuring: Measuring,
    deviating: Deviating,
    left: Left,
    chart: Chart,
    /// What lines are over the mesh.
    marked: Option<Marked>,
    /// The edge that is looked at, in the topology of what is shown.
    selected_edge: Option<u32>,
    selection: Selection,
    /// What is being typed as a path to open, while that window is open.
    typed_path: Option<String>,
    shows_keys: bool,
    lasting: Lasting,
    /// What went wrong last, until it is closed.
    error: Option<String>,
}

impl App {
    /// # Errors
    /// The window isn't drawn through wgpu.
    pub fn new(context: &eframe::CreationContext, source: Option<Source>, limits: Limits) -> Result<Self, GpuError> {
        let render_state = context.wgpu_render_state.clone().ok_or(GpuError::NoAdapter)?;
        let gpu = Gpu::new(&render_state.adapter, render_state.device.clone(), render_state.queue.clone());
        let engine = Engine::new(gpu);
        menu::style(&context.egui_ctx);
        let mut app = Self {
            viewport: Viewport::new(&engine),
            engine,
            render_state,
            settings: Settings::opening(),
            camera: Camera::framing(&Default::default(), glam::Vec2::ONE),
            framed: None,
            last_split: 0.5,
            last_displacement: Displacement::Off,
            frozen: None,
            document: None,
            load: None,
            limits,
            dialog: None,
            asks_for_truth: false,
            truth: None,
            truth_load: None,
            dragged_rim: None,
            playback: Playback::default(),
            measuring: Measuring::default(),
            deviating: Deviating::default(),
            left: Left::default(),
            chart: Chart::default(),
            marked: None,
            selected_edge: None,
            selection: Selection::default(),
            typed_path: None,
            shows_keys: false,
            lasting: Lasting::default(),
            error: None,
        };
        app.open(&context.egui_ctx, source.unwrap_or_default());
        Ok(app)
    }

    /// Starts to load a mesh beside the window; a load that is under way is cancelled. The mesh that is open keeps its
    /// view, and what was made of it.
    pub fn open(&mut self, context: &egui::Context, source: Source) {
        let same = self.document.as_ref().filter(|document| document.loaded.source == source);
        let preparation = same.map(|document| document.loaded.preparation.clone());
        let keep_view = preparation.is_some();
        let preparation = preparation.unwrap_or_else(|| self.plain());
        self.load = Some(Load::start(&self.engine, context, source, preparation, keep_view));
    }

    /// Loads the same mesh again with something else made of it: `change` changes what is, or is on its way.
    pub fn prepare(&mut self, context: &egui::Context, change: impl FnOnce(&mut Preparation)) {
        let Some(Loaded { source, .. }) = self.document.as_ref().map(|document| &document.loaded) else { return };
        let mut preparation = self.preparation();
        change(&mut preparation);
        self.load = Some(Load::start(&self.engine, context, source.clone(), preparation, true));
    }

    /// What is made of the mesh, or will be once it is loaded again.
    fn preparation(&self) -> Preparation {
        let again = self.load.as_ref().filter(|load| load.keep_view).map(|load| &load.preparation);
        let shown = self.document.as_ref().map(|document| &document.loaded.preparation);
        again.or(shown).cloned().unwrap_or_else(|| self.plain())
    }

    /// Nothing is made of a mesh but what the file holds.
    fn plain(&self) -> Preparation {
        Preparation { limits: self.limits, ..Preparation::default() }
    }

    /// Loads the same mesh again; settings and camera stay.
    pub fn reload(&mut self, context: &egui::Context) {
        if let Some(source) = self.document.as_ref().map(|document| document.loaded.source.clone()) {
            self.open(context, source);
        }
    }

    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Cracks of what is shown, once they are measured.
    pub fn cracks(&self) -> Option<&Cracks> {
        self.measuring.cracks()
    }

    /// Sizes of the triangles shown, if they were measured from where one looks.
    pub fn sizes_shown(&self) -> Option<&Sizes> {
        let seen_from = self.viewport.seen_from()?;
        self.measuring.sizes().filter(|sizes| sizes.view == seen_from)
    }

    /// The edge that is looked at.
    pub fn selected_edge(&self) -> Option<u32> {
        self.selected_edge
    }

    /// What is shown, as loaded.
    pub fn loaded(&self) -> Option<&Loaded> {
        self.document.as_ref().map(|document| &document.loaded)
    }

    /// Vertices and triangles of what is shown.
    pub fn totals(&self) -> Option<(u64, u64)> {
        self.document.as_ref().map(|document| document.scene.tessellator.totals())
    }

    /// What is shown; not what is being loaded.
    pub fn source(&self) -> Option<&Source> {
        self.document.as_ref().map(|document| &document.loaded.source)
    }

    /// How many pictures have been drawn.
    pub fn pictures(&self) -> u64 {
        self.viewport.pictures()
    }

    /// Whether something is still being loaded, drawn or measured.
    pub fn is_busy(&self) -> bool {
        let loads = self.load.is_some() || self.truth_load.is_some();
        let measures = self.measuring.is_busy() || self.deviating.is_busy() || self.left.is_busy();
        loads || measures || self.viewport.is_busy() || self.selection.is_busy()
    }

    /// Whether the mesh is still being looked through: that doesn't change the picture by itself.
    pub fn is_checking(&self) -> bool {
        self.document.as_ref().is_some_and(|document| document.checks.is_busy())
    }

    fn take_loaded(&mut self, context: &egui::Context) {
        // It is framed for the viewport, whose size the first frame tells.
        if self.viewport.target.is_none() {
            return;
        }
        let Some(load) = &mut self.load else { return };
        let Some(result) = load.take() else { return };
        let (keep_view, source) = (load.keep_view, load.source.clone());
        self.load = None;
        match result {
            Ok(document) => {
                if !keep_view {
                    self.frozen = None;
                    self.forget_truth();
                }
                self.chart.stop();
                let title = format!("{} - pnaen", document.loaded.source.title());
                context.send_viewport_cmd(egui::ViewportCommand::Title(title));
                let before = self.document.replace(document);
                if before.is_some() {
                    self.error = None;
                }
                self.take_heights(before.and_then(|document| document.loaded.preparation.heights).as_ref());
                self.keep_playback(keep_view);
                if !keep_view {
                    self.frame();
                    self.look_as_before();
                }
                self.measuring = Measuring::default();
                self.left.forget();
                self.deselect();
            }
            Err(Some(NotLoaded { mut why, is_gone })) => {
                if is_gone && self.lasting.gone(&source) {
                    why += "; it isn't listed as recent any more";
                }
                self.error = Some(why);
                // A window shows something, also if the first file can't be.
                if self.document.is_none() {
                    self.open(context, Source::default());
                }
            }
            // Cancelled by the person in front of the window, who knows.
            Err(None) => {}
        }
    }

    fn take_dialog(&mut self, context: &egui::Context) {
        let Some(ended) = self.dialog.as_ref().and_then(Beside::take) else { return };
        self.dialog = None;
        match ended {
            Ok(Some(path)) if std::mem::take(&mut self.asks_for_truth) => self.open_truth(context, Source::File(path)),
            Ok(Some(path)) => self.open_path(context, path),
            Ok(None) => {}
            Err(stopped) => {
                self.error = Some(format!("the desktop's file dialog {stopped}; type a path instead (Ctrl+L)"));
            }
        }
    }

    fn take_checks(&mut self) {
        let stopped = self.document.as_mut().and_then(|document| document.checks.take_stopped());
        if let Some(stopped) = stopped {
            self.error = Some(format!("looking through the mesh {stopped}: what it found until then is shown"));
        }
    }

    fn take_device_problem(&mut self) {
        if let Err(problem) = self.engine.gpu.check() {
            self.error = Some(problem.to_string());
        }
    }
}

impl eframe::App for App {
    fn logic(&mut self, context: &egui::Context, _frame: &mut eframe::Frame) {
        self.take_loaded(context);
        self.take_truth();
        self.take_checks();
        self.take_dialog(context);
        self.take_chart(context);
        self.take_device_problem();
        let dropped = context.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).next());
        if let Some(path) = dropped {
            self.open_path(context, path);
        }
        self.shortcuts(context);
        self.play_on(context);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        egui::Panel::top("menu").show(ui, |ui| self.menu_bar(ui));
        egui::Panel::bottom("status").show(ui, |ui| self.status_line(ui));
        egui::Panel::left("settings").resizable(false).exact_size(264.0).show(ui, |ui| self.settings_panel(ui));
        egui::Panel::right("facts").resizable(false).exact_size(284.0).show(ui, |ui| self.facts_panel(ui));
        self.chart_panel(ui);
        egui::CentralPanel::no_frame().show(ui, |ui| self.viewport_panel(ui));
        self.windows(ui.ctx());
        self.hold_chart();
        self.keep(ui.ctx());
    }

    fn on_exit(&mut self) {
        if let Err(error) = self.keep_for_good() {
            // There is no window any more to say it in.
            let _ = std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("pnaen: {error}\n"));
        }
    }
}
