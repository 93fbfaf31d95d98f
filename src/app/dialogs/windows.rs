//! The small windows over the main window: which there are, and those with the last message and with the warnings of files.

use std::time::Duration;

use crate::app::App;

/// How long a sentence stays, in seconds.
const SHOWN: f64 = 10.0;

/// What has just ended, such as a file that was written: sentences, a line each. One is shown in the status line for a while; several
/// are to be read, and stay in a window until it is closed.
pub(in crate::app) struct Notice {
    text: String,
    /// When it was first shown in the status line, by the window's clock.
    since: Option<f64>,
}

impl Notice {
    pub(in crate::app) fn new(text: String) -> Self {
        Self { text, since: None }
    }

    /// The text, if it has several sentences.
    pub(in crate::app) fn for_window(&self) -> Option<&str> {
        Some(&*self.text).filter(|text| text.contains('\n'))
    }
}

impl App {
    pub(in crate::app) fn windows(&mut self, context: &egui::Context) {
        self.path_window(context);
        self.keys_window(context);
        self.command_window(context);
        self.palette_window(context);
        self.forget_window(context);
        self.background_window(context);
        self.save_window(context, false);
        self.save_window(context, true);
        self.warnings_window(context);
        self.message_window(context);
    }

    /// The upper end of a message: below the toolbar, so that this stays in reach.
    pub(in crate::app) fn message_place(&self) -> egui::Pos2 {
        self.viewport.rect.unwrap_or(egui::Rect::NOTHING).center_top() + egui::vec2(0.0, 8.0)
    }

    /// Shows the last error, or what is to be read about the last file that was written, until it is closed.
    fn message_window(&mut self, context: &egui::Context) {
        let notice = self.dialogs.notice.as_ref().and_then(Notice::for_window);
        let (title, text) = match (&self.dialogs.error, notice) {
            (Some(error), _) => ("Problem", &**error),
            (None, Some(notice)) => ("Written", notice),
            (None, None) => return,
        };
        let mut closed = false;
        let window = egui::Window::new(title).resizable(false).collapsible(false);
        let window = window.pivot(egui::Align2::CENTER_TOP).fixed_pos(self.message_place());
        window.default_width(420.0).show(context, |ui| {
            ui.label(text);
            closed = ui.button("Close").clicked() || ui.input(|input| input.key_pressed(egui::Key::Enter));
        });
        if closed && self.dialogs.error.take().is_none() {
            self.dialogs.notice = None;
        }
    }

    /// The sentence that the status line shows now, if there is one.
    pub(in crate::app) fn said(&mut self, context: &egui::Context) -> Option<String> {
        let notice = self.dialogs.notice.as_mut().filter(|notice| notice.for_window().is_none())?;
        let now = context.input(|input| input.time);
        // The clock of another window begins anew.
        let since = notice.since.map_or(now, |since| since.min(now));
        notice.since = Some(since);
        let left = SHOWN - (now - since);
        if left <= 0.0 {
            self.dialogs.notice = None;
            return None;
        }
        context.request_repaint_after(Duration::from_secs_f64(left));
        Some(notice.text.clone())
    }

    /// What was repaired or left out of the mesh's files and of the file of light.
    pub(in crate::app) fn warnings(&self) -> impl Iterator<Item = &str> {
        let of_mesh = self.document.iter().flat_map(|document| &document.loaded.warnings);
        of_mesh.chain(self.environment.iter().flat_map(|open| &open.content.warnings)).map(String::as_str)
    }

    pub(in crate::app) fn warnings_window(&mut self, context: &egui::Context) {
        if !self.dialogs.shows_warnings {
            return;
        }
        let warnings: Vec<&str> = self.warnings().collect();
        let mut closed = false;
        let mut is_open = true;
        let window = egui::Window::new("Warnings").open(&mut is_open);
        let window = window.resizable(false).collapsible(false).anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO);
        window.default_width(460.0).show(context, |ui| {
            let height = (context.content_rect().height() - 160.0).max(80.0);
            egui::ScrollArea::vertical().max_height(height).show(ui, |ui| {
                if warnings.is_empty() {
                    ui.label("The file was read as it is: nothing was repaired or left out.");
                }
                for warning in &warnings {
                    ui.add(egui::Label::new(*warning).wrap());
                    ui.add_space(4.0);
                }
            });
            ui.horizontal(|ui| {
                let copy = ui.add_enabled(!warnings.is_empty(), egui::Button::new("Copy"));
                if copy.on_hover_text("Copies all warnings, one a line.").clicked() {
                    ui.ctx().copy_text(warnings.join("\n"));
                }
                closed = ui.button("Close").clicked();
            });
        });
        self.dialogs.shows_warnings = is_open && !closed;
    }
}
