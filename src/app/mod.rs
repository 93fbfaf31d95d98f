//! The window. It edits [`Settings`] and a [`Camera`], and shows what the engine makes of them; it holds no mathematics.

mod animation;
mod beside;
mod chart;
mod chart_panel;
mod charting;
mod checks;
mod choices;
mod desktop;
mod deviating;
mod deviation;
mod diagram;
mod document;
mod facts;
mod farewell;
mod heights;
mod history;
mod labels;
mod lasting;
mod left;
mod legend;
mod loading;
mod lost;
mod marked;
mod measuring;
mod menu;
mod names;
mod option_rows;
mod palette;
mod panels;
mod patch;
mod pattern;
mod pick;
mod picture;
mod rim;
mod run;
mod status;
mod text;
mod truth;
mod typed;
mod viewport;
mod widgets;
mod windows;
mod worst;

use image::RgbaImage;

use crate::engine::{Engine, Loaded};
use crate::files::Limits;
use crate::gpu::{Gpu, GpuError};
use crate::load::Source;
use crate::measure::{Cracks, Sizes};
use crate::render::Camera;
use crate::settings::Settings;
use crate::tessellate::{Displacement, LodView};

use animation::Playback;
use chart::Chart;
use deviating::Deviating;
use document::{Document, Load};
use farewell::Farewell;
use history::History;
use left::Left;
use lost::Losses;
use marked::Marked;
use measuring::Measuring;
use palette::Palette;
use pick::Selection;
use picture::Viewport;
use truth::{Chosen, TruthLoad};
use typed::{Dialog, Typed};

pub use lasting::Lasting;
pub use run::{WindowError, run, run_watched};

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
    dialog: Option<Dialog>,
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
    /// The path that is being typed, while that window is open.
    typed: Option<Typed>,
    shows_keys: bool,
    lasting: Lasting,
    losses: Losses,
    /// In place of all else, once the device isn't replaced any more.
    farewell: Option<Farewell>,
    history: History,
    /// While commands are searched.
    palette: Option<Palette>,
    /// The command that was copied, while it is shown.
    command: Option<String>,
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
            typed: None,
            shows_keys: false,
            lasting: Lasting::default(),
            losses: Losses::default(),
            farewell: None,
            history: History::default(),
            palette: None,
            command: None,
            error: None,
        };
        app.open(&context.egui_ctx, source.unwrap_or_default());
        Ok(app)
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

    /// The device that everything is made and drawn on.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// The picture in the middle as it is shown, without what is written over it; none before the first.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read_picture(&self) -> Result<Option<RgbaImage>, GpuError> {
        self.viewport.target.as_ref().map(|(target, _)| target.read(&self.engine.gpu)).transpose()
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

    fn take_checks(&mut self) {
        let stopped = self.document.as_mut().and_then(|document| document.checks.take_stopped());
        if let Some(stopped) = stopped {
            self.error = Some(format!("looking through the mesh {stopped}: what it found until then is shown"));
        }
    }
}

impl eframe::App for App {
    fn logic(&mut self, context: &egui::Context, _frame: &mut eframe::Frame) {
        if self.is_lost() {
            // The window can't show anything any more; what follows it can.
            return context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        if self.farewell.is_some() {
            return self.farewell_keys(context);
        }
        self.take_loaded(context);
        self.take_truth();
        self.take_checks();
        self.take_dialog(context);
        self.take_chart(context);
        self.take_device_problem();
        self.take_dropped(context);
        self.hold_typing(context);
        self.shortcuts(context);
        self.play_on(context);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if self.is_lost() {
            return;
        }
        if self.farewell.is_some() {
            return self.farewell(ui);
        }
        egui::Panel::top("menu").show(ui, |ui| self.menu_bar(ui));
        egui::Panel::bottom("status").show(ui, |ui| self.status_line(ui));
        egui::Panel::left("settings").resizable(false).exact_size(264.0).show(ui, |ui| self.settings_panel(ui));
        egui::Panel::right("facts").resizable(false).exact_size(284.0).show(ui, |ui| self.facts_panel(ui));
        self.chart_panel(ui);
        egui::CentralPanel::no_frame().show(ui, |ui| self.viewport_panel(ui));
        self.windows(ui.ctx());
        self.hold_chart();
        self.note_settings(ui.ctx());
        self.keep(ui.ctx());
        if self.is_lost() {
            // egui can't paint what was just made of it.
            ui.ctx().request_discard("the device was lost");
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    fn on_exit(&mut self) {
        if let Err(error) = self.keep_for_good() {
            // There is no window any more to say it in.
            let _ = std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("pnaen: {error}\n"));
        }
    }
}
