//! Undo and redo of settings.

use std::collections::VecDeque;

use super::App;
use crate::settings::Settings;
use crate::tessellate::Displacement;

/// The greatest number of steps that can be undone.
const MOST: usize = 200;

/// The settings before and after the present ones.
#[derive(Default)]
pub(super) struct History {
    /// None before the first frame.
    now: Option<Settings>,
    past: VecDeque<Settings>,
    future: Vec<Settings>,
}

impl History {
    /// Records settings. It isn't called while the pointer drags, so that a drag is one step.
    fn note(&mut self, settings: &Settings) {
        let before = self.now.replace(*settings);
        let Some(before) = before.filter(|before| before != settings) else { return };
        self.past.push_back(before);
        if self.past.len() > MOST {
            self.past.pop_front();
        }
        self.future.clear();
    }

    /// Sets displacement in all steps, because it follows from the mesh and can't be undone.
    pub(super) fn displace(&mut self, displacement: Displacement) {
        let all = self.now.iter_mut().chain(&mut self.past).chain(&mut self.future);
        all.for_each(|settings| settings.tessellation.displacement = displacement);
    }

    fn undo(&mut self, settings: &Settings) -> Option<Settings> {
        self.note(settings);
        let before = self.past.pop_back()?;
        self.future.extend(self.now.replace(before));
        Some(before)
    }

    fn redo(&mut self, settings: &Settings) -> Option<Settings> {
        self.note(settings);
        let after = self.future.pop()?;
        self.past.extend(self.now.replace(after));
        Some(after)
    }
}

impl App {
    /// Records the settings at the end of a frame.
    pub(super) fn note_settings(&mut self, context: &egui::Context) {
        if !context.egui_is_using_pointer() {
            self.history.note(&self.settings);
        }
    }

    pub(super) fn can_undo(&self) -> bool {
        !self.history.past.is_empty()
    }

    pub(super) fn can_redo(&self) -> bool {
        !self.history.future.is_empty()
    }

    /// Goes back to the settings before the last change.
    pub fn undo(&mut self) {
        let before = self.history.undo(&self.settings);
        self.take_back(before);
    }

    /// Goes forward to those that [`Self::undo`] left.
    pub fn redo(&mut self) {
        let after = self.history.redo(&self.settings);
        self.take_back(after);
    }

    fn take_back(&mut self, settings: Option<Settings>) {
        self.settings = settings.unwrap_or(self.settings);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tessellate::Tessellation;

    fn of(factor: f32) -> Settings {
        Settings::from(Tessellation { factor, ..Tessellation::default() })
    }

    #[test]
    fn undo_and_redo_go_through_the_steps_and_a_change_clears_redo() {
        let mut history = History::default();
        [1.0, 2.0, 2.0, 3.0].map(of).iter().for_each(|settings| history.note(settings));
        assert_eq!(history.undo(&of(3.0)), Some(of(2.0)));
        assert_eq!(history.undo(&of(2.0)), Some(of(1.0)));
        assert_eq!(history.undo(&of(1.0)), None);
        assert_eq!(history.redo(&of(1.0)), Some(of(2.0)));
        // Settings that weren't recorded yet become a step.
        assert_eq!(history.undo(&of(7.0)), Some(of(2.0)));
        assert_eq!(history.redo(&of(2.0)), Some(of(7.0)));
        history.note(&of(8.0));
        assert_eq!(history.redo(&of(8.0)), None);
        assert_eq!(history.undo(&of(8.0)), Some(of(7.0)));
    }

    #[test]
    fn the_number_of_steps_is_limited() {
        let mut history = History::default();
        (0..2 * MOST).for_each(|i| history.note(&of(i as f32)));
        assert_eq!((history.past.len(), history.past[0]), (MOST, of((MOST - 1) as f32)));
    }
}
