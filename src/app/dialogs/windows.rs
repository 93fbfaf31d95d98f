//! The small windows over the main window.

use super::notice::Notice;
use crate::app::App;

impl App {
    pub(in crate::app) fn windows(&mut self, context: &egui::Context) {
        self.path_window(context);
        self.keys_window(context);
        self.command_window(context);
        self.palette_window(context);
        self.forget_window(context);
        self.background_window(context);
        self.picture_window(context);
        self.turntable_window(context);
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
}
