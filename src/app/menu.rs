//! The menu bar, and the keys.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::App;
use super::heights::HEIGHT_IMAGE;
use super::typed::{Purpose, taken_at};
use crate::load::Source;
use crate::mesh::Shape;
use crate::render::{Camera, Standpoint};
use crate::settings::Overlay;
use crate::settings::options::FACTOR_RANGE;
use crate::tessellate::{Edges, Lod};

const OPEN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::O);
const OPEN_PATH: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::L);
const COPY: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::K);
const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
const SEARCH: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::P);
pub(super) const QUIT: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Q);

/// Every key, and what it does; shown under Help, and listed in the README.
pub const KEYS: [(&str, &str); 38] = [
    ("Click", "select the triangle, its patch and its nearest edge"),
    ("Left drag, arrows", "orbit"),
    ("Middle or Shift drag, Shift arrows", "pan"),
    ("Wheel, Page Up, Page Down", "zoom (the wheel: to the pointer)"),
    ("F", "frame the mesh"),
    ("Shift+F", "frame the selected patch"),
    ("1, 3, 7", "look from the front, the right, the top"),
    ("5", "perspective or orthographic"),
    ("+, -", "tessellation factor up or down by 1"),
    ("W", "wireframe"),
    ("P", "patch borders"),
    ("B", "colours: barycentric"),
    ("A", "adjacency edges"),
    ("C", "cracks"),
    ("O", "folds"),
    ("T", "T-junctions"),
    ("K", "back faces"),
    ("H", "colours: factors"),
    ("X", "colours: triangle size"),
    ("U", "colours: factors below 2"),
    ("V", "colours: deviation"),
    ("N", "normals"),
    ("S", "split view"),
    ("E", "edges as published, or computed once"),
    ("L", "adaptive LOD"),
    ("D", "displacement, where there are heights"),
    ("Z", "freeze the LOD camera"),
    ("G", "chart of speed against accuracy"),
    ("Space", "play or pause the animation"),
    ("R", "reload the file"),
    ("Ctrl+O", "open a file"),
    ("Ctrl+L", "type a path to open"),
    ("Ctrl+P", "search commands"),
    ("Ctrl+Z", "undo a setting"),
    ("Ctrl+Shift+Z", "redo it"),
    ("Ctrl+K", "copy the command that draws this picture"),
    ("Esc", "cancel loading, close a message, deselect"),
    ("Ctrl+Q", "quit"),
];

/// Spacing that both themes share: calm, and the same everywhere.
pub fn style(context: &egui::Context) {
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.slider_width = 82.0;
        // Beside it a number as wide as the rest of a combo box.
        style.spacing.interact_size.x = 58.0;
        // Beside what scrolls, not over it.
        style.spacing.scroll.floating_allocated_width = style.spacing.scroll.bar_width;
        style.spacing.combo_width = 148.0;
        style.interaction.tooltip_delay = 0.4;
    });
    // Dim on black as it comes.
    context.style_mut_of(egui::Theme::Dark, |style| {
        style.visuals.weak_text_color = Some(egui::Color32::from_gray(135));
    });
    // Pale on white as it comes: boxes and tracks get an outline, and warnings are dark enough to be read.
    context.style_mut_of(egui::Theme::Light, |style| {
        style.visuals.warn_fg_color = egui::Color32::from_rgb(150, 75, 0);
        style.visuals.widgets.inactive.bg_stroke = egui::Stroke::new(1.0, egui::Color32::from_gray(165));
        style.visuals.weak_text_color = Some(egui::Color32::from_gray(95));
    });
}

impl App {
    pub(super) fn menu_bar(&mut self, ui: &mut egui::Ui) {
        egui::MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| self.file_menu(ui));
            ui.menu_button("Edit", |ui| self.edit_menu(ui));
            ui.menu_button("View", |ui| self.view_menu(ui));
            ui.menu_button("Help", |ui| {
                let search = egui::Button::new("Search commands…").shortcut_text(ui.ctx().format_shortcut(&SEARCH));
                if ui.add(search).on_hover_text("Everything that can be done, by name.").clicked() {
                    self.search_commands();
                    ui.close();
                }
                if ui.button("Keys…").clicked() {
                    self.shows_keys = true;
                    ui.close();
                }
                ui.hyperlink_to("The PN-AEN white paper", WHITE_PAPER);
            });
            let source = self.document.as_ref().map(|document| &document.loaded.source);
            let (title, whole) = source.map_or_else(Default::default, |source| (source.title(), source.to_string()));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.weak(concat!("pnaen ", env!("CARGO_PKG_VERSION")));
                ui.separator();
                ui.add(egui::Label::new(egui::RichText::new(title).strong()).truncate()).on_hover_text(whole);
            });
        });
    }

    fn file_menu(&mut self, ui: &mut egui::Ui) {
        let entry = |ui: &mut egui::Ui, text: &str, shortcut: &KeyboardShortcut| {
            ui.add(egui::Button::new(text).shortcut_text(ui.ctx().format_shortcut(shortcut))).clicked()
        };
        if entry(ui, "Open…", &OPEN) {
            self.open_dialog(ui.ctx());
        }
        if entry(ui, "Open path…", &OPEN_PATH) {
            self.type_path(Purpose::Open);
        }
        self.recent_menu(ui);
        let height_image = ui.add_enabled(self.document.is_some(), egui::Button::new("Height image…"));
        if height_image.on_hover_text(HEIGHT_IMAGE).clicked() {
            self.height_dialog(ui.ctx());
        }
        let reload = egui::Button::new("Reload").shortcut_text("R");
        if ui.add_enabled(self.document.is_some(), reload).clicked() {
            self.reload(ui.ctx());
        }
        ui.separator();
        let hover = "Holds the mesh against what it should have been: the high-poly original, say.";
        if ui.button("Truth…").on_hover_text(hover).clicked() {
            self.truth_dialog(ui.ctx());
        }
        if ui.button("Truth path…").on_hover_text(hover).clicked() {
            self.type_path(Purpose::Truth);
        }
        let forget = egui::Button::new("No truth");
        let hover = "Goes back to the surface that a shape is sampled from, or that the tessellation converges to.";
        if ui.add_enabled(self.truth.is_some(), forget).on_hover_text(hover).clicked() {
            self.forget_truth();
        }
        ui.separator();
        ui.menu_button("Shapes", |ui| {
            for shape in Shape::ALL {
                if ui.button(shape.title()).clicked() {
                    self.open(ui.ctx(), Source::Shape(shape));
                    ui.close();
                }
            }
        });
        ui.separator();
        self.forget_menu(ui);
        ui.separator();
        if entry(ui, "Quit", &QUIT) {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    fn edit_menu(&mut self, ui: &mut egui::Ui) {
        let entry = |ui: &mut egui::Ui, text: &str, shortcut: &KeyboardShortcut, is_enabled: bool, hover: &str| {
            let button = egui::Button::new(text).shortcut_text(ui.ctx().format_shortcut(shortcut));
            ui.add_enabled(is_enabled, button).on_hover_text(hover).clicked()
        };
        if entry(ui, "Undo", &UNDO, self.can_undo(), "Goes back to the settings before the last change.") {
            self.undo();
        }
        if entry(ui, "Redo", &REDO, self.can_redo(), "Goes forward to the settings that were undone.") {
            self.redo();
        }
        ui.separator();
        let hover = "Copies the pnaen command that draws this picture without a window.";
        if entry(ui, "Copy as command", &COPY, self.document.is_some(), hover) {
            self.copy_command(ui.ctx());
        }
    }

    fn view_menu(&mut self, ui: &mut egui::Ui) {
        let entry =
            |ui: &mut egui::Ui, text: &str, key: &str| ui.add(egui::Button::new(text).shortcut_text(key)).clicked();
        if entry(ui, "Frame", "F") {
            self.frame();
        }
        let frame_patch = egui::Button::new("Frame patch").shortcut_text("Shift+F");
        if ui.add_enabled(self.selected_patch().is_some(), frame_patch).clicked() {
            self.frame_patch();
        }
        for (text, key, standpoint) in
            [("Front", "1", Standpoint::Front), ("Right", "3", Standpoint::Right), ("Top", "7", Standpoint::Top)]
        {
            if entry(ui, text, key) {
                self.camera.look_from(standpoint);
            }
        }
        ui.checkbox(&mut self.camera.orthographic, "Orthographic").on_hover_text("No perspective (5)");
        ui.separator();
        let mut shows_chart = self.chart.is_open;
        let hover = "Speed against accuracy, of this mesh in this view (G)";
        if ui.checkbox(&mut shows_chart, "Chart").on_hover_text(hover).changed() {
            self.toggle_chart();
        }
        ui.separator();
        let mut theme = ui.ctx().options(|options| options.theme_preference);
        for (choice, text) in [
            (egui::ThemePreference::System, "Theme of the system"),
            (egui::ThemePreference::Light, "Light theme"),
            (egui::ThemePreference::Dark, "Dark theme"),
        ] {
            if ui.radio_value(&mut theme, choice, text).changed() {
                ui.ctx().set_theme(theme);
            }
        }
    }

    /// Shows all of the mesh: all through its clip, and as far as heights lift it.
    pub(super) fn frame(&mut self) {
        if let Some(document) = &self.document {
            self.camera.frame(&document.scene.drawn_bounds(&self.settings), self.viewport.size());
            self.framed = Some(self.camera);
        }
    }

    /// Whether the camera still is where [`Self::frame`] last put it; it may have turned.
    pub(super) fn is_framed(&self) -> bool {
        let place = |camera: &Camera| (camera.target, camera.distance);
        self.framed.as_ref().map(place) == Some(place(&self.camera))
    }

    /// Keys that work wherever the pointer is, unless text is being typed.
    pub(super) fn shortcuts(&mut self, context: &egui::Context) {
        // A list that is open takes the key for itself.
        if context.input(|input| input.key_pressed(Key::Escape)) && !egui::Popup::is_any_open(context) {
            if self.palette.take().is_some() || self.command.take().is_some() {
                // Only that.
            } else if self.load.is_none() && self.viewport.is_long() {
                self.viewport.cancel();
            } else {
                self.load = None;
                self.truth_load = None;
                self.error = None;
                self.typed = None;
                self.shows_keys = false;
                self.deselect();
            }
        }
        if let Some(place) = taken_at(context, &OPEN) {
            self.open_dialog(context);
            self.hold_from(context, place);
        }
        if let Some(place) = taken_at(context, &OPEN_PATH) {
            self.type_path(Purpose::Open);
            self.hold_from(context, place);
        }
        if context.input_mut(|input| input.consume_shortcut(&QUIT)) {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        if context.input_mut(|input| input.consume_shortcut(&SEARCH)) {
            self.search_commands();
        }
        let asks = self.typed.is_some()
            || self.palette.is_some()
            || self.dialog.as_ref().is_some_and(|dialog| dialog.is_new(context));
        if asks || context.egui_wants_keyboard_input() {
            return;
        }
        self.edit_keys(context);
        self.overlay_keys(context);
        self.camera_keys(context);
        let steps = presses(context, Key::Plus) + presses(context, Key::Equals) - presses(context, Key::Minus);
        if steps != 0.0 && matches!(self.settings.tessellation.used_lod(), Lod::Uniform | Lod::Distance) {
            let factor = self.settings.tessellation.factor + steps;
            self.settings.tessellation.factor = factor.clamp(FACTOR_RANGE.least, FACTOR_RANGE.most);
        }
        // What has the focus takes it.
        if pressed(context, Key::Space) && context.memory(|memory| memory.focused().is_none()) {
            self.toggle_playing(context);
        }
        if pressed(context, Key::R) {
            self.reload(context);
        }
        if pressed(context, Key::L) {
            self.toggle_lod();
        }
        if pressed(context, Key::D) {
            self.toggle_displacement();
        }
        if pressed(context, Key::G) {
            self.toggle_chart();
        }
        if pressed(context, Key::Z) {
            self.toggle_frozen();
        }
        if pressed(context, Key::E) {
            let published = self.settings.tessellation.edges == Edges::AsPublished;
            self.settings.set_edges(if published { Edges::PerEdge } else { Edges::AsPublished });
        }
    }

    /// The longer shortcut first: the other one is taken with Shift as well.
    fn edit_keys(&mut self, context: &egui::Context) {
        if context.input_mut(|input| input.consume_shortcut(&REDO)) {
            self.redo();
        }
        if context.input_mut(|input| input.consume_shortcut(&UNDO)) {
            self.undo();
        }
        if context.input_mut(|input| input.consume_shortcut(&COPY)) {
            self.copy_command(context);
        }
    }

    fn overlay_keys(&mut self, context: &egui::Context) {
        let keys =
            [Key::W, Key::P, Key::B, Key::A, Key::C, Key::O, Key::T, Key::K, Key::H, Key::X, Key::U, Key::N, Key::V];
        for (key, overlay) in keys.into_iter().zip(Overlay::ALL) {
            if pressed(context, key) {
                self.settings.overlays.toggle(overlay);
            }
        }
        if pressed(context, Key::S) {
            self.toggle_split();
        }
    }

    fn camera_keys(&mut self, context: &egui::Context) {
        let standpoints =
            [(Key::Num1, Standpoint::Front), (Key::Num3, Standpoint::Right), (Key::Num7, Standpoint::Top)];
        for (key, standpoint) in standpoints {
            if pressed(context, key) {
                self.camera.look_from(standpoint);
            }
        }
        if pressed(context, Key::Num5) {
            self.camera.orthographic = !self.camera.orthographic;
        }
        if pressed(context, Key::F) {
            self.frame();
        }
        if context.input_mut(|input| input.consume_key(Modifiers::SHIFT, Key::F)) {
            self.frame_patch();
        }
    }
}

const WHITE_PAPER: &str = "https://developer.download.nvidia.com/whitepapers/2010/PN-AEN-Triangles-Whitepaper.pdf";

/// Whether a key was pressed by itself.
fn pressed(context: &egui::Context, key: Key) -> bool {
    presses(context, key) > 0.0
}

/// How often a key was pressed since the last frame; Shift may be needed for the key itself, so it doesn't matter.
fn presses(context: &egui::Context, key: Key) -> f32 {
    let by_itself = |event: &&egui::Event| match event {
        egui::Event::Key { key: pressed, pressed: true, modifiers, .. } => {
            let shifted = modifiers.shift && !matches!(key, Key::Plus | Key::Equals);
            *pressed == key && !(modifiers.alt || modifiers.ctrl || modifiers.command) && !shifted
        }
        _ => false,
    };
    context.input(|input| input.events.iter().filter(by_itself).count()) as f32
}
