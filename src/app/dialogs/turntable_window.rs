//! The window that chooses how a turntable is saved.

use egui::{DragValue, Grid, Ui};

use super::picture_window::LABELS;
use crate::app::App;
use crate::app::jobs::picture_job::PictureChoices;
use crate::app::widgets::control_row;
use crate::commands::{Purpose, Written};
use inspect::shot::{FPS, FRAMES, Turn};

/// The choices, which last as long as the program runs, and whether the window is open.
#[derive(Clone, Copy, Default)]
pub(crate) struct TurntableWindow {
    pub is_open: bool,
    pub turn: Turn,
    /// Whether it is one GIF file, rather than a folder of PNG files.
    pub is_gif: bool,
    pub choices: PictureChoices,
}

impl App {
    pub(in crate::app) fn turntable_window(&mut self, context: &egui::Context) {
        if !self.dialogs.turntable.is_open {
            return;
        }
        let mut own = self.dialogs.turntable;
        let (mut is_open, mut saves, mut copies) = (true, false, false);
        let window = egui::Window::new("Save turntable").open(&mut is_open).resizable(false).collapsible(false);
        window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(context, |ui| {
            ui.label("The camera turns once around the vertical axis through the point that it looks at.");
            turn_rows(ui, &mut own);
            self.picture_rows(ui, &mut own.choices);
            [saves, copies] = self.save_buttons(ui, "Asks for the name, draws the pictures, and writes them.");
        });
        own.is_open = is_open && !saves;
        self.dialogs.turntable = own;
        if saves {
            let written = if own.is_gif { Written::Gif } else { Written::Folder };
            self.ask_for(context, Purpose::Write(written));
        } else if copies {
            let (theme, turn) = (context.theme(), Some((own.turn, own.is_gif)));
            let command = self.command_of(theme, &own.choices, &self.viewport.camera, None, turn);
            self.copy_line(context, command);
        }
    }
}

/// The rows about the number of pictures, and what they are written as.
fn turn_rows(ui: &mut Ui, own: &mut TurntableWindow) {
    Grid::new("turn").num_columns(2).min_col_width(LABELS).show(ui, |ui| {
        let frames = DragValue::new(&mut own.turn.frames).range(FRAMES);
        control_row(ui, "Pictures", "The number of pictures in one turn (--frames).", frames);
        ui.label("Written as").on_hover_text("A folder of pictures, or one file.");
        ui.horizontal(|ui| {
            let hover = "Numbered PNG files in a new folder.";
            ui.radio_value(&mut own.is_gif, false, "PNG files").on_hover_text(hover);
            let hover = "One GIF file that repeats, with up to 256 colours a picture.";
            ui.radio_value(&mut own.is_gif, true, "Animated GIF").on_hover_text(hover);
        });
        ui.end_row();
        if own.is_gif {
            let fps = DragValue::new(&mut own.turn.fps).range(FPS);
            control_row(ui, "Pictures a second", "How fast the GIF plays (--fps).", fps);
        }
    });
}
