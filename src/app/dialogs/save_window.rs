//! The windows that choose how a picture, and how a turntable, is saved.

use egui::{DragValue, Grid, Ui};

use crate::app::App;
use crate::app::jobs::picture_job::PictureChoices;
use crate::app::widgets::control_row;
use crate::commands::{Purpose, Written};
use inspect::render::{Usual, legend_of};
use inspect::shot::{FPS, FRAMES, Turn};

/// The sides of pictures, in px: those that the option `--size` takes.
const SIDES: std::ops::RangeInclusive<u32> = 1..=16384;

/// The width of labels in points: that of the longest, "Pictures a second".
const LABELS: f32 = 108.0;

/// The choices, which last as long as the program runs, and whether the window is open.
#[derive(Clone, Copy, Default)]
pub(crate) struct SaveWindow {
    pub is_open: bool,
    pub choices: PictureChoices,
    /// How a turntable turns.
    pub turn: Turn,
    /// Whether a turntable is one GIF file, rather than a folder of PNG files.
    pub is_gif: bool,
}

impl App {
    /// Shows the window of a picture, or of a turntable.
    pub(in crate::app) fn save_window(&mut self, context: &egui::Context, turns: bool) {
        let mut own = if turns { self.dialogs.turntable } else { self.dialogs.picture };
        if !own.is_open {
            return;
        }
        let (title, hover) = match turns {
            true => ("Save turntable", "Asks for the name, draws the pictures, and writes them."),
            false => (
                "Save picture",
                "Asks for the name of the file, and writes it: a PNG picture, or a report on it as an HTML page.",
            ),
        };
        let (mut is_open, mut saves, mut copies) = (true, false, false);
        let window = egui::Window::new(title).open(&mut is_open).resizable(false).collapsible(false);
        window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(context, |ui| {
            if turns {
                ui.label("The camera turns once around the vertical axis through the point that it looks at.");
                turn_rows(ui, &mut own);
            }
            self.picture_rows(ui, &mut own.choices);
            [saves, copies] = self.save_buttons(ui, hover);
        });
        own.is_open = is_open && !saves;
        let place = if turns { &mut self.dialogs.turntable } else { &mut self.dialogs.picture };
        *place = own;
        if saves {
            let of_turn = if own.is_gif { Written::Gif } else { Written::Folder };
            self.ask_for(context, Purpose::Write(if turns { of_turn } else { Written::Picture }));
        } else if copies {
            self.copy_command(context, &own.choices, turns.then_some((own.turn, own.is_gif)));
        }
    }

    /// The buttons that save and that copy the command. Returns which are pressed.
    fn save_buttons(&self, ui: &mut Ui, hover: &str) -> [bool; 2] {
        ui.add_space(6.0);
        let buttons = |ui: &mut Ui| {
            let why_not = self.is_writing().then_some("Another file is being written.");
            let save = ui.add_enabled(why_not.is_none(), egui::Button::new("Save…"));
            let save = save.on_hover_text(hover).on_disabled_hover_text(why_not.unwrap_or_default());
            let copy = ui.button("Copy as command");
            let copy = copy.on_hover_text("Copies the pnaen command that draws this without a window.");
            [save.clicked(), copy.clicked()]
        };
        ui.horizontal(buttons).inner
    }

    /// The rows about size, background, overlays and legend, which all kinds of pictures have.
    fn picture_rows(&self, ui: &mut Ui, choices: &mut PictureChoices) {
        Grid::new("picture").num_columns(2).min_col_width(LABELS).show(ui, |ui| {
            self.size_rows(ui, choices);
            ui.label("Background").on_hover_text("What is behind the mesh (--background, --transparent).");
            ui.horizontal(|ui| {
                ui.radio_value(&mut choices.transparent, false, "As shown").on_hover_text("The colour of the view.");
                let hover = "Nothing: where no mesh, line or grid is, the picture is transparent.";
                ui.radio_value(&mut choices.transparent, true, "Transparent").on_hover_text(hover);
            });
            ui.end_row();
        });
        let hover = "Draws what is on over the surface: wireframe, cracks, colours and so on, and the selection. The frustum of \
                     a frozen LOD camera is always drawn.";
        ui.checkbox(&mut choices.overlays, "With overlays").on_hover_text(hover);
        let is_split = self.settings.split.is_some();
        let is_possible = is_split
            || choices.overlays && legend_of(&self.settings, &Usual::default(), &self.legend_distances()).is_some();
        let legend = ui.add_enabled(is_possible, egui::Checkbox::new(&mut choices.legend, "With legend"));
        let hover = "Draws the legend of the surface's colours into the lower right corner, and in a split picture the divider and what \
                     both halves show (--legend).";
        legend.on_hover_text(hover).on_disabled_hover_text("These colours stand for nothing, and have no legend.");
    }

    fn size_rows(&self, ui: &mut Ui, choices: &mut PictureChoices) {
        let (mut size, mut is_changed) = (self.saved_size(choices), false);
        for (name, side) in ["Width", "Height"].into_iter().zip(&mut size) {
            let hover = format!("In px, {} to {} (--size).", SIDES.start(), SIDES.end());
            let drag = DragValue::new(side).range(SIDES).suffix(" px");
            is_changed |= control_row(ui, name, &hover, drag).changed();
        }
        if is_changed {
            choices.size = Some(size);
        }
        ui.label("");
        let back = ui.add_enabled(choices.size.is_some(), egui::Button::new("Size of the view"));
        let hover = "Use the viewport's size and follow it.";
        if back.on_hover_text(hover).on_disabled_hover_text("It has the size of the view.").clicked() {
            choices.size = None;
        }
        ui.end_row();
    }
}

/// The rows about the number of pictures, and what they are written as.
fn turn_rows(ui: &mut Ui, own: &mut SaveWindow) {
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
