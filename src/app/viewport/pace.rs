//! How much of a long drawing the device gets at once. The window's own frames wait for it, so it is little while somebody uses the
//! window. While nobody does, it is more, since every part costs a frame.

use std::time::{Duration, Instant};

/// How long after the last input the window counts as used.
const USED: Duration = Duration::from_secs(2);
/// How long the device may be busy at once, in ms, while the window is used.
const MS_IN_USE: f64 = 80.0;
/// The same while it isn't used.
const MS_AT_REST: f64 = 400.0;

/// When the window was last used.
#[derive(Default)]
pub(crate) struct Pace(Option<Instant>);

impl Pace {
    /// Notes whether there is input in this frame.
    pub(crate) fn note(&mut self, context: &egui::Context) {
        if context.input(|input| !input.events.is_empty() || input.pointer.any_down()) {
            self.0 = Some(Instant::now());
        }
    }

    /// How long the device may be busy at once, in ms.
    pub(crate) fn ms(&self) -> f64 {
        if self.0.is_some_and(|input| input.elapsed() < USED) { MS_IN_USE } else { MS_AT_REST }
    }
}

/// The number of steps that take so many ms, after `steps` of them took `taken_ms`. It grows slowly, since the next ones may take
/// longer.
pub(crate) fn next_steps(steps: usize, taken_ms: f64, ms: f64) -> usize {
    let fitting = steps as f64 * ms / taken_ms.max(0.1);
    (fitting as usize).clamp(1, 2 * steps.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_as_many_as_fit_the_time() {
        assert_eq!(next_steps(4, 100.0, 80.0), 3);
        assert_eq!(next_steps(4, 1000.0, 80.0), 1, "one is the least");
        assert_eq!(next_steps(4, 70.0, 80.0), 4);
        assert_eq!(next_steps(4, 1.0, 80.0), 8, "no more than twice as many");
        assert_eq!(next_steps(1, 0.0, 400.0), 2);
    }

    #[test]
    fn less_is_drawn_at_once_while_the_window_is_used() {
        let context = egui::Context::default();
        let mut pace = Pace::default();
        let mut frame = |events: Vec<egui::Event>| {
            let input = egui::RawInput { events, ..egui::RawInput::default() };
            context.run_ui(input, |ui| pace.note(ui.ctx())).textures_delta.clear();
            pace.ms()
        };
        assert_eq!(frame(Vec::new()), MS_AT_REST);
        assert_eq!(frame(vec![egui::Event::PointerMoved(egui::pos2(10.0, 10.0))]), MS_IN_USE);
        assert_eq!(frame(Vec::new()), MS_IN_USE);
    }
}
