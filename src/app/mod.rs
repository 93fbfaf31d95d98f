//! The window. It edits [`Settings`] and a [`Camera`](inspect::render::Camera), and shows what the engine makes of them; it holds no
//! mathematics.

mod commands;
mod dialogs;
mod document;
mod for_tests;
mod history;
mod jobs;
mod painting;
mod panels;
mod patch_names;
pub mod persistence;
mod sections;
mod style;
mod text;
mod viewport;
mod wheel;
mod widgets;
pub mod window;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use image::RgbaImage;

use geometry::mesh::Texture;
use gpu::{Gpu, GpuError, LodShader, SurfaceShader};
use inspect::engine::Engine;
use inspect::render::{WindowPipelines, lay_over};
use inspect::settings::Settings;
use load::Source;
use load::files::Limits;

use commands::Commands;
use dialogs::Dialogs;
use document::Document;
use history::{History, Undoable, ViewHistory};
use jobs::companion_files::{ChosenReferenceShape, LeftMesh, Light, OpenFile};
use jobs::given_factors::GivenFactors;
use jobs::job_list::Jobs;
use jobs::user_shader_job::OpenShader;
use painting::{filled, panel_frame};
use panels::Panels;
use viewport::Viewport;
use viewport::pointer_value::PointerValue;
use window::WindowState;

pub use persistence::Persistence;
pub use window::{WindowError, run};

/// The window's state, grouped as this module's submodules are.
pub struct App {
    engine: Engine,
    render_state: egui_wgpu::RenderState,
    painting: WindowPipelines,
    settings: Settings,
    /// The meshes that were dropped on the window together.
    dropped: Vec<PathBuf>,
    history: History<Undoable>,
    /// Whether files of a step of undo are being read.
    takes_back: bool,
    view_history: ViewHistory,
    /// The mesh that is open; none before the first one is loaded.
    document: Option<Document>,
    /// The reference surface that was chosen for the mesh, if one was.
    reference_shape: Option<ChosenReferenceShape>,
    /// What is left of the split in place of the mesh, if something is.
    left_mesh: Option<LeftMesh>,
    /// Factors of a file in place of those of LOD, if there are any.
    given: Option<OpenFile<GivenFactors>>,
    /// The file with functions of the user's own in place of LOD, if one is open.
    lod_shader: Option<OpenShader<LodShader>>,
    /// The file with a function of the user's own in place of the surface, if one is open.
    surface_shader: Option<OpenShader<SurfaceShader>>,
    /// A picture of a lit sphere in place of those that are made in code, if one was opened.
    matcap: Option<OpenFile<Arc<Texture>>>,
    environment: Option<OpenFile<Light>>,
    viewport: Viewport,
    panels: Panels,
    jobs: Jobs,
    dialogs: Dialogs,
    commands: Commands,
    persistence: Persistence,
    window: WindowState,
}

impl App {
    /// # Errors
    /// The window isn't drawn through wgpu.
    pub fn new(context: &eframe::CreationContext, source: Option<Source>, limits: Limits) -> Result<Self, GpuError> {
        let render_state = context.wgpu_render_state.as_ref().ok_or(GpuError::NoAdapter)?;
        let gpu = Gpu::new(&render_state.adapter, render_state.device.clone(), render_state.queue.clone());
        Self::with_engine(context, Engine::new(gpu), source, limits)
    }

    /// The same with an engine that others may use too. It must be on the device that the window is drawn with.
    ///
    /// # Errors
    /// The window isn't drawn through wgpu, or the device is lost.
    pub fn with_engine(
        context: &eframe::CreationContext,
        engine: Engine,
        source: Option<Source>,
        limits: Limits,
    ) -> Result<Self, GpuError> {
        let render_state = context.wgpu_render_state.clone().ok_or(GpuError::NoAdapter)?;
        let painting = WindowPipelines::new(&engine.gpu, render_state.target_format)?;
        style::style(&context.egui_ctx);
        let mut app = Self {
            viewport: Viewport::new(&engine),
            engine,
            render_state,
            painting,
            settings: if source.is_some() { Settings::opening() } else { Settings::greeting() },
            dropped: Vec::new(),
            history: History::default(),
            takes_back: false,
            view_history: ViewHistory::default(),
            document: None,
            reference_shape: None,
            left_mesh: None,
            given: None,
            lod_shader: None,
            surface_shader: None,
            matcap: None,
            environment: None,
            panels: Panels::default(),
            jobs: Jobs::new(limits),
            dialogs: Dialogs::default(),
            commands: Commands::default(),
            persistence: Persistence::default(),
            window: WindowState::default(),
        };
        app.viewport.greets = source.is_none();
        app.open(&context.egui_ctx, source.unwrap_or_default());
        Ok(app)
    }

    /// The selected edge: an index into the topology's edges.
    pub fn selected_edge(&self) -> Option<u32> {
        self.document.as_ref()?.selection.edge
    }

    /// Vertices and triangles of what is shown.
    pub fn totals(&self) -> Option<(u64, u64)> {
        let totals = |document: &Document| document.scene.tessellator.totals();
        self.viewport.preview.totals.or(self.document.as_ref().map(totals))
    }

    /// The source of the mesh that is open, not of one that is being loaded.
    pub fn source(&self) -> Option<&Source> {
        self.document.as_ref().map(|document| &document.loaded.source)
    }

    /// The viewport's picture as it is shown, without the texts over it; none before the first one.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read_picture(&self) -> Result<Option<RgbaImage>, GpuError> {
        let read = self.viewport.picture.target.as_ref().map(|(target, _)| target.read(&self.engine.gpu));
        let mut picture = read.transpose()?;
        if let Some((picture, outlines)) = picture.as_mut().zip(self.found_outlines()) {
            lay_over(picture, &outlines.picture, &self.settings);
        }
        Ok(picture)
    }

    pub fn switch_previews(&mut self) {
        self.viewport.preview.is_on = !self.viewport.preview.is_on;
    }

    /// Whether a preview is shown in place of the full picture.
    pub fn shows_preview(&self) -> bool {
        self.viewport.preview.shown(&self.viewport.picture).is_some()
    }

    /// Whether something is still being loaded, drawn or measured.
    pub fn is_busy(&self) -> bool {
        let looks = self.viewport.pointer.as_ref().is_some_and(PointerValue::is_busy);
        let measures = self.document.as_ref().is_some_and(Document::is_busy);
        self.jobs.is_busy() || measures || looks || self.viewport.picture.is_busy()
    }
}

impl Drop for App {
    /// A software driver that still compiles or draws while the process ends would crash.
    fn drop(&mut self) {
        if self.engine.gpu.is_software() {
            self.engine.gpu.wait();
        }
    }
}

impl eframe::App for App {
    fn raw_input_hook(&mut self, context: &egui::Context, input: &mut egui::RawInput) {
        input.events = self.window.events.pace(std::mem::take(&mut input.events));
        if self.window.events.are_waiting() {
            context.request_repaint();
        }
    }

    fn logic(&mut self, context: &egui::Context, _frame: &mut eframe::Frame) {
        if self.is_lost() {
            // This window can't show anything any more; the one that replaces it can.
            return context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        if self.window.fatal_screen.is_some() {
            return self.fatal_screen_keys(context);
        }
        self.window.fitting.fit(context);
        self.take_found(context);
        self.compare_again(context);
        self.stop_slow_shaders();
        self.measure_current(context);
        self.take_device_problem();
        self.take_dropped(context);
        self.hold_typing(context);
        self.note_press(context);
        self.viewport.pace.note(context);
        self.shortcuts(context);
        self.play_on(context);
        self.follow_file_choices(context);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if self.is_lost() {
            return;
        }
        if self.window.fatal_screen.is_some() {
            return self.show_fatal_screen(ui);
        }
        ui.painter().add(filled(&self.painting, ui.ctx().content_rect(), ui.visuals().panel_fill));
        let frame = panel_frame(ui);
        egui::Panel::top("menu").frame(frame).show(ui, |ui| self.menu_bar(ui));
        egui::Panel::bottom("status").frame(frame).show(ui, |ui| self.status_line(ui));
        let has_measurements = self.side_panels(ui);
        self.chart_panel(ui);
        egui::Panel::top("toolbar").frame(frame).show(ui, |ui| self.toolbar(ui));
        self.timeline(ui);
        egui::CentralPanel::no_frame().show(ui, |ui| self.viewport_panel(ui, has_measurements));
        self.windows(ui.ctx());
        // Measuring the chart waits while the window draws or measures.
        self.panels.chart.held.store(self.is_busy(), Ordering::Relaxed);
        self.note_state(ui.ctx());
        self.keep(ui.ctx());
        if self.is_lost() {
            // egui can't paint this frame with a lost device.
            ui.ctx().request_discard("the device was lost");
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    fn on_exit(&mut self) {
        if let Err(error) = self.keep_for_good() {
            // There is no window any more to show the error in.
            let _ = std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("pnaen: {error}\n"));
        }
    }
}
