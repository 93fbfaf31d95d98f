//! Every command by its name: what menus, keys and lists do, found by typing a part of it.

use egui::{Button, Context, Key, TextEdit, ThemePreference};

use super::App;
use super::choices::switched_overlays;
use super::typed::Purpose;
use crate::load::Source;
use crate::mesh::Shape;
use crate::render::Standpoint;
use crate::settings::{Choice, Colors, Declaration, Settings, Value, options};
use crate::tessellate::Edges;

/// Commands that are listed at once.
const LISTED: usize = 14;

/// The window that searches.
pub struct Palette {
    query: String,
    /// Which of those found.
    at: usize,
    commands: Vec<Command>,
}

struct Command {
    /// What it belongs to, and what it is.
    title: String,
    /// That does the same; empty if none does.
    key: &'static str,
    run: Run,
}

type Run = Box<dyn Fn(&mut App, &Context)>;

type Plain = (&'static str, &'static str, fn(&mut App, &Context));

/// Those that aren't one of several.
const PLAIN: [Plain; 30] = [
    ("Open…", "Ctrl+O", |app, context| app.open_dialog(context)),
    ("Open path…", "Ctrl+L", |app, _| app.type_path(Purpose::Open)),
    ("Height image…", "", |app, context| app.height_dialog(context)),
    ("Reload", "R", |app, context| app.reload(context)),
    ("Truth…", "", |app, context| app.truth_dialog(context)),
    ("Truth path…", "", |app, _| app.type_path(Purpose::Truth)),
    ("No truth", "", |app, _| app.forget_truth()),
    ("Undo", "Ctrl+Z", |app, _| app.undo()),
    ("Redo", "Ctrl+Shift+Z", |app, _| app.redo()),
    ("Copy as command", "Ctrl+K", |app, context| app.copy_command(context)),
    ("Frame", "F", |app, _| app.frame()),
    ("Frame patch", "Shift+F", |app, _| app.frame_patch()),
    ("Front", "1", |app, _| app.camera.look_from(Standpoint::Front)),
    ("Right", "3", |app, _| app.camera.look_from(Standpoint::Right)),
    ("Top", "7", |app, _| app.camera.look_from(Standpoint::Top)),
    ("Orthographic", "5", |app, _| app.camera.orthographic = !app.camera.orthographic),
    ("Adaptive LOD", "L", |app, _| app.toggle_lod()),
    ("Cull back faces", "", |app, _| {
        app.settings.tessellation.cull_back_faces = !app.settings.tessellation.cull_back_faces
    }),
    ("Freeze LOD camera", "Z", |app, _| app.toggle_frozen()),
    ("Displacement", "D", |app, _| app.toggle_displacement()),
    ("Split view", "S", |app, _| app.toggle_split()),
    ("Play or pause", "Space", |app, context| app.toggle_playing(context)),
    ("At rest", "", |app, _| app.choose_clip(None)),
    ("Deselect", "Esc", |app, _| app.deselect()),
    ("Chart", "G", |app, _| app.toggle_chart()),
    ("Theme of the system", "", |_, context| context.set_theme(ThemePreference::System)),
    ("Light theme", "", |_, context| context.set_theme(ThemePreference::Light)),
    ("Dark theme", "", |_, context| context.set_theme(ThemePreference::Dark)),
    ("Keys…", "", |app, _| app.shows_keys = true),
    ("Quit", "Ctrl+Q", |_, context| context.send_viewport_cmd(egui::ViewportCommand::Close)),
];

/// A command for each value of a setting.
fn choices<T: Choice>(
    what: &'static str,
    values: impl IntoIterator<Item = T>,
    set: fn(&mut Settings, T),
) -> impl Iterator<Item = Command> {
    values.into_iter().map(move |value| Command {
        title: format!("{what}: {}", value.label()),
        key: "",
        run: Box::new(move |app, _| set(&mut app.settings, value)),
    })
}

/// A command for each value of an option.
fn option_choices(option: &'static Declaration) -> impl Iterator<Item = Command> {
    option.kind.descriptions().into_iter().map(move |value| Command {
        title: format!("{}: {}", option.label, value.label),
        key: "",
        run: Box::new(move |app, _| _ = option.set(&mut app.settings, Value::Name(value.name))),
    })
}

/// All that there is now.
fn commands(app: &App) -> Vec<Command> {
    let plain = |(title, key, run): Plain| Command { title: title.to_owned(), key, run: Box::new(run) };
    let mut all: Vec<Command> = PLAIN.into_iter().map(plain).collect();
    all.extend(option_choices(&options::SURFACE));
    all.extend(option_choices(&options::NORMALS));
    all.extend(option_choices(&options::PARTITIONING));
    all.extend(choices(options::EDGES.label, Edges::ALL.iter().copied(), Settings::set_edges));
    all.extend(option_choices(&options::LOD));
    all.extend(option_choices(&options::CLIP));
    all.extend(option_choices(&options::CONVENTION));
    all.extend(choices("Colours", Colors::ALL.iter().copied(), |settings, colors| settings.overlays.colors = colors));
    all.extend(choices("Overlay", switched_overlays(), |settings, overlay| settings.overlays.toggle(overlay)));
    let opens = |title: String, source: Source| Command {
        title,
        key: "",
        run: Box::new(move |app, context| app.open(context, source.clone())),
    };
    all.extend(Shape::ALL.map(|shape| opens(format!("Shape: {}", shape.title()), Source::Shape(shape))));
    let recent = app.lasting.recent().map(|path| Source::File(path.into()));
    all.extend(recent.map(|source| opens(format!("Recent: {}", source.title()), source)));
    all
}

/// Those whose titles have every word of the query, in any case; where words of titles begin with its words first.
fn found(commands: &[Command], query: &str) -> Vec<usize> {
    let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    let begins = |title: &str, word: &String| {
        title.split(|c: char| !c.is_alphanumeric()).any(|own| own.starts_with(word.as_str()))
    };
    let rank = |index: &usize| {
        let title = commands[*index].title.to_lowercase();
        !words.iter().all(|word| begins(&title, word))
    };
    let has = |index: &usize| {
        let title = commands[*index].title.to_lowercase();
        words.iter().all(|word| title.contains(word.as_str()))
    };
    let mut found: Vec<usize> = (0..commands.len()).filter(has).collect();
    found.sort_by_key(rank);
    found
}

impl Palette {
    /// The command that was chosen, if one was.
    fn rows(&mut self, ui: &mut egui::Ui) -> Option<usize> {
        // What goes through the list isn't for the field.
        let [down, up, enter] = [Key::ArrowDown, Key::ArrowUp, Key::Enter]
            .map(|key| ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, key)));
        let label = ui.label("Search commands");
        let before = self.query.clone();
        let field = ui.add(TextEdit::singleline(&mut self.query).desired_width(f32::INFINITY));
        field.labelled_by(label.id).request_focus();
        let found = found(&self.commands, &self.query);
        let last = found.len().saturating_sub(1);
        self.at = if self.query == before { self.at } else { 0 };
        self.at = (self.at + usize::from(down)).saturating_sub(usize::from(up)).min(last);
        let mut chosen = found.get(self.at).copied().filter(|_| enter);
        let first = (self.at + 1).saturating_sub(LISTED);
        for (row, &index) in found.iter().enumerate().skip(first).take(LISTED) {
            let Command { title, key, .. } = &self.commands[index];
            let button = Button::selectable(row == self.at, title);
            let button = if key.is_empty() { button } else { button.shortcut_text(*key) };
            if ui.add(button.min_size(egui::vec2(ui.available_width(), 0.0))).clicked() {
                chosen = Some(index);
            }
        }
        if found.is_empty() {
            ui.weak("No command has these words.");
        }
        chosen
    }
}

impl App {
    /// Opens the window that searches for a command.
    pub(super) fn search_commands(&mut self) {
        self.palette = Some(Palette { query: String::new(), at: 0, commands: commands(self) });
    }

    pub(super) fn palette_window(&mut self, context: &Context) {
        let Some(palette) = &mut self.palette else { return };
        let window = egui::Window::new("Commands").title_bar(false).resizable(false);
        let window = window.anchor(egui::Align2::CENTER_TOP, egui::vec2(0.0, 40.0)).default_width(360.0);
        let Some(shown) = window.show(context, |ui| palette.rows(ui)) else { return };
        let is_elsewhere = |at: egui::Pos2| !shown.response.rect.contains(at);
        let pressed = context.input(|input| input.pointer.press_origin().filter(|_| input.pointer.any_pressed()));
        match shown.inner.flatten() {
            Some(index) => {
                let command = self.palette.take().map(|mut palette| palette.commands.swap_remove(index));
                command.into_iter().for_each(|command| (command.run)(self, context));
            }
            None if pressed.is_some_and(is_elsewhere) => self.palette = None,
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn titles(query: &str) -> Vec<String> {
        let titled = |title: &str| Command { title: title.to_owned(), key: "", run: Box::new(|_, _| {}) };
        let all = ["Frame", "Surface: Flat", "Partitioning: Fractional odd", "LOD: Uniform", "Frame patch"].map(titled);
        found(&all, query).into_iter().map(|index| all[index].title.clone()).collect()
    }

    #[test]
    fn every_word_must_be_there_and_beginnings_come_first() {
        assert_eq!(titles("").len(), 5);
        assert_eq!(titles("FRAC odd"), ["Partitioning: Fractional odd"]);
        assert_eq!(titles("fra"), ["Frame", "Partitioning: Fractional odd", "Frame patch"]);
        assert_eq!(titles("la"), ["Surface: Flat"]);
        assert_eq!(
            titles("f"),
            ["Frame", "Surface: Flat", "Partitioning: Fractional odd", "Frame patch", "LOD: Uniform"]
        );
        assert_eq!(titles("frame odd"), [""; 0]);
    }
}
