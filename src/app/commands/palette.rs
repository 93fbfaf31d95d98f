//! The window that searches for a command by a part of its name.

use egui::{Button, Context, Key, TextEdit};

use crate::app::App;
use crate::commands::{Availability, Command, all, shown_key};

/// How many commands are listed at once.
const LISTED: usize = 14;

pub(crate) struct Palette {
    query: String,
    /// The index, among the commands found, of the one that Enter chooses.
    at: usize,
    commands: Vec<Command>,
    /// What was possible when the search was opened.
    now: Availability,
}

/// Returns the commands whose names or descriptions contain every word of the query, ignoring case. Those where the query's words
/// begin words of the name come first, then others whose names contain them, then those whose descriptions do.
fn found(commands: &[Command], query: &str) -> Vec<usize> {
    let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    let begins = |name: &str, word: &String| {
        name.split(|c: char| !c.is_alphanumeric()).any(|own| own.starts_with(word.as_str()))
    };
    let rank = |command: &Command| {
        let (name, text) = (command.name.to_lowercase(), command.text.to_lowercase());
        match () {
            () if words.iter().all(|word| begins(&name, word)) => Some(0),
            () if words.iter().all(|word| name.contains(word.as_str())) => Some(1),
            () if words.iter().all(|word| begins(&name, word) || begins(&text, word)) => Some(2),
            () => None,
        }
    };
    let mut found: Vec<(u8, usize)> =
        commands.iter().enumerate().filter_map(|(index, command)| Some((rank(command)?, index))).collect();
    found.sort();
    found.into_iter().map(|(_, index)| index).collect()
}

impl Palette {
    /// Shows the search field and the list. Returns the command that is chosen.
    fn rows(&mut self, ui: &mut egui::Ui) -> Option<usize> {
        // The keys that move through the list must not reach the text field.
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
        let is_possible = |index: &usize| self.commands[*index].why_not(&self.now).is_none();
        let mut chosen = found.get(self.at).copied().filter(|index| enter && is_possible(index));
        let first = (self.at + 1).saturating_sub(LISTED);
        for (row, &index) in found.iter().enumerate().skip(first).take(LISTED) {
            if self.row(ui, index, row == self.at) {
                chosen = Some(index);
            }
        }
        if found.is_empty() {
            ui.weak("No command has these words.");
        }
        chosen
    }

    /// Shows a command with its key, dim if it isn't possible. Returns true if it is clicked.
    fn row(&self, ui: &mut egui::Ui, index: usize, is_selected: bool) -> bool {
        let command = &self.commands[index];
        let why_not = command.why_not(&self.now);
        let button = Button::selectable(is_selected, &*command.name).truncate();
        let button = match command.keys.first() {
            Some(key) => button.shortcut_text(shown_key(ui.ctx(), key)),
            None => button,
        };
        let button = button.min_size(egui::vec2(ui.available_width(), 0.0));
        let response = ui.add_enabled(why_not.is_none(), button).on_hover_text(&*command.text);
        let not_now = || format!("{} Not now: {}", command.text, why_not.unwrap_or_default());
        response.on_disabled_hover_ui(|ui| drop(ui.label(not_now()))).clicked()
    }
}

impl App {
    pub(in crate::app) fn search_commands(&mut self) {
        let now = self.availability();
        self.commands.palette = Some(Palette { query: String::new(), at: 0, commands: all(&now), now });
    }

    pub(in crate::app) fn palette_window(&mut self, context: &Context) {
        let Some(palette) = &mut self.commands.palette else { return };
        let window = egui::Window::new("Commands").title_bar(false).resizable(false);
        let window = window.anchor(egui::Align2::CENTER_TOP, egui::vec2(0.0, 40.0)).default_width(360.0);
        let Some(shown) = window.show(context, |ui| palette.rows(ui)) else { return };
        let is_elsewhere = |at: egui::Pos2| !shown.response.rect.contains(at);
        let pressed = context.input(|input| input.pointer.press_origin().filter(|_| input.pointer.any_pressed()));
        match shown.inner.flatten() {
            Some(index) => {
                let command = self.commands.palette.take().map(|mut palette| palette.commands.swap_remove(index));
                command.into_iter().for_each(|command| self.give(context, &command));
            }
            None if pressed.is_some_and(is_elsewhere) => self.commands.palette = None,
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(query: &str, most: usize) -> Vec<String> {
        let all = all(&Availability::default());
        found(&all, query).into_iter().take(most).map(|index| all[index].name.to_string()).collect()
    }

    #[test]
    fn every_word_must_match_and_beginnings_of_words_come_first() {
        assert_eq!(names("", usize::MAX).len(), all(&Availability::default()).len());
        assert_eq!(names("FRAC odd", 9), ["Partitioning: Fractional odd"]);
        assert_eq!(names("frame", 3), ["Frame", "Frame patch", "Overlay: Wireframe"]);
        assert_eq!(names("surf fl", 1), ["Surface: Flat"]);
        assert_eq!(names("rame", 9), ["Frame", "Frame patch", "Overlay: Wireframe"]);
        assert_eq!(names("frame odd", 9), [""; 0]);
    }

    #[test]
    fn words_of_descriptions_are_found_after_names() {
        let tolerance = names("tolerance", usize::MAX);
        assert!(tolerance.iter().any(|name| name == "Colours: Excess triangles"), "{tolerance:?}");
        let edge = names("edge", usize::MAX);
        let last_named =
            edge.iter().rposition(|name| name.to_lowercase().contains("edge")).expect("commands about edges");
        assert!(edge[..last_named].iter().all(|name| name.to_lowercase().contains("edge")), "{edge:?}");
    }

    #[test]
    fn commands_without_a_key_are_found() {
        for (query, name) in [
            ("factor up", "Factor up"),
            ("weld 1e-5", "Weld: 1e-5"),
            ("weld exact", "Weld: Exact"),
            ("crease on", "Crease band: On"),
            ("background", "Background colour…"),
            ("save picture", "Save picture…"),
            ("export", "Export mesh…"),
            ("rest pose", "Animation: Rest pose"),
            ("reset", "Reset settings"),
        ] {
            assert_eq!(names(query, 1), [name], "{query}");
        }
    }
}
