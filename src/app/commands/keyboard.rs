//! Keyboard shortcuts, as the table of commands lists them.

use egui::{Event, Key, KeyboardShortcut};

use crate::app::App;
use crate::commands::{Action, Command, FileAction, Purpose, all};

/// The key that hides the panels while no control has the focus.
const TAB: KeyboardShortcut = KeyboardShortcut::new(egui::Modifiers::NONE, Key::Tab);

impl App {
    /// Performs the commands whose keys were pressed. Commands that work while text is typed come first, because those that
    /// open a text field take the keys that were pressed after them.
    pub(in crate::app) fn shortcuts(&mut self, context: &egui::Context) {
        let is_press = |event: &Event| matches!(event, Event::Key { pressed: true, .. });
        if !context.input(|input| input.events.iter().any(is_press)) {
            return;
        }
        let commands = all(&self.availability());
        let (always, others): (Vec<_>, Vec<_>) = commands.iter().partition(|command| command.works_while_typing());
        for command in always {
            self.press(context, command);
        }
        // An open list takes the keys that name its entries.
        if egui::Popup::is_any_open(context) {
            return;
        }
        let asks = self.dialogs.ask()
            || self.commands.palette.is_some()
            || self.dialogs.pending.as_ref().is_some_and(|dialog| dialog.is_new(context));
        if asks || context.egui_wants_keyboard_input() {
            return;
        }
        for command in others {
            self.press(context, command);
        }
    }

    /// Performs a command as often as its keys were pressed.
    fn press(&mut self, context: &egui::Context, command: &Command) {
        // An open list handles its keys itself, even before one of its entries has the focus.
        let is_in_list = command.action == Action::Cancel && egui::Popup::is_any_open(context);
        let has_focus = command.yields_to_focus() && context.memory(|memory| memory.focused().is_some());
        if has_focus || is_in_list {
            return;
        }
        for shortcut in &command.keys {
            if *shortcut == TAB {
                // Tab goes from control to control once one of them has the focus.
                if context.memory(|memory| memory.focused().is_some()) || egui::Popup::is_any_open(context) {
                    continue;
                }
                if context.input(|input| input.events.iter().any(|event| is_press_of(event, &TAB))) {
                    context.memory_mut(|memory| memory.move_focus(egui::FocusDirection::None));
                }
            }
            for place in take_presses(context, shortcut) {
                self.give(context, command);
                if matches!(command.action, Action::File(FileAction::Ask(Purpose::Open) | FileAction::OpenPath)) {
                    // The keys after this one are text.
                    return self.hold_from(context, place);
                }
            }
        }
    }
}

/// Returns the indices of a shortcut's presses among this frame's events. Presses with a modifier are removed, so that
/// nothing else acts on them.
fn take_presses(context: &egui::Context, shortcut: &KeyboardShortcut) -> Vec<usize> {
    context.input_mut(|input| {
        let is_it = |event: &Event| is_press_of(event, shortcut);
        let mut places: Vec<usize> = (0..input.events.len()).filter(|&place| is_it(&input.events[place])).collect();
        if shortcut.modifiers.any() {
            // Each removed event moves those behind it forward.
            places.iter_mut().enumerate().for_each(|(taken, place)| *place -= taken);
            input.events.retain(|event| !is_it(event));
        }
        places
    })
}

/// Some keyboards need Shift to type a plus, so Shift is ignored for that key.
fn is_press_of(event: &Event, shortcut: &KeyboardShortcut) -> bool {
    let Event::Key { key, pressed: true, modifiers, .. } = event else { return false };
    let wanted = shortcut.modifiers;
    let shift_matters = !matches!(key, Key::Plus | Key::Equals);
    *key == shortcut.logical_key
        && modifiers.alt == wanted.alt
        && (modifiers.ctrl || modifiers.command) == wanted.command
        && (modifiers.shift == wanted.shift || !shift_matters)
}

#[cfg(test)]
mod tests {
    use egui::Modifiers;

    use super::*;

    fn press(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    #[test]
    fn modifiers_are_exactly_those_of_the_shortcut() {
        let (ctrl, both) = (Modifiers::COMMAND, Modifiers::COMMAND.plus(Modifiers::SHIFT));
        let undo = KeyboardShortcut::new(ctrl, Key::Z);
        assert!(is_press_of(&press(Key::Z, ctrl), &undo));
        assert!(
            is_press_of(&press(Key::Z, Modifiers::CTRL.plus(Modifiers::COMMAND)), &undo),
            "a PC's keyboard reports Ctrl as both"
        );
        for other in [Modifiers::NONE, Modifiers::SHIFT, both, Modifiers::ALT.plus(ctrl)] {
            assert!(!is_press_of(&press(Key::Z, other), &undo), "{other:?}");
        }
        let up = KeyboardShortcut::new(Modifiers::NONE, Key::Plus);
        assert!(is_press_of(&press(Key::Plus, Modifiers::SHIFT), &up));
    }

    #[test]
    fn presses_with_a_modifier_are_removed_and_their_positions_returned() {
        let context = egui::Context::default();
        let open = KeyboardShortcut::new(Modifiers::COMMAND, Key::L);
        let letter = || Event::Text("a".into());
        let events = vec![letter(), press(Key::L, Modifiers::COMMAND), letter(), press(Key::L, Modifiers::COMMAND)];
        context.input_mut(|input| input.events = events);
        assert_eq!(take_presses(&context, &open), [1, 2]);
        assert_eq!(context.input(|input| input.events.clone()), [letter(), letter()]);
    }
}
