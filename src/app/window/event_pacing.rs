//! Events of the pointer and of keys, as many a frame as egui can tell apart, so that none is lost while frames are slow.
//!
//! egui looks at the state that a frame's events leave. If a button is pressed and released in one frame, it sees no drag; and
//! what is typed in the frame of a click comes before the field that the click opens.

use std::collections::VecDeque;

use egui::Event;

#[derive(Debug, Default)]
pub(in crate::app) struct PacedEvents(VecDeque<Event>);

impl PacedEvents {
    /// Takes in a frame's events, and returns those that the frame may handle: up to the next press or release of a button, which
    /// is the last one of its frame. A release waits for the frame after the movement before it.
    pub(in crate::app) fn pace(&mut self, events: Vec<Event>) -> Vec<Event> {
        self.0.extend(events);
        let mut now = Vec::new();
        let mut has_moved = false;
        while let Some(event) = self.0.front() {
            has_moved |= matches!(event, Event::PointerMoved(_));
            let is_button = matches!(event, Event::PointerButton { .. });
            if has_moved && matches!(event, Event::PointerButton { pressed: false, .. }) {
                break;
            }
            now.extend(self.0.pop_front());
            if is_button {
                break;
            }
        }
        now
    }

    /// Whether events wait, so that another frame is needed.
    pub(in crate::app) fn are_waiting(&self) -> bool {
        !self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use egui::{Modifiers, PointerButton, pos2};

    use super::*;

    fn moved(x: f32) -> Event {
        Event::PointerMoved(pos2(x, 0.0))
    }

    fn button(x: f32, pressed: bool) -> Event {
        let (pos, button, modifiers) = (pos2(x, 0.0), PointerButton::Primary, Modifiers::NONE);
        Event::PointerButton { pos, button, pressed, modifiers }
    }

    /// The events of each frame, if all come in the first.
    fn frames(events: Vec<Event>) -> Vec<Vec<Event>> {
        let mut paced = PacedEvents::default();
        let mut frames = vec![paced.pace(events)];
        while paced.are_waiting() {
            frames.push(paced.pace(Vec::new()));
        }
        frames
    }

    #[test]
    fn a_quick_drag_takes_a_frame_for_its_press_its_movement_and_its_release() {
        let drag = vec![moved(1.0), button(1.0, true), moved(5.0), moved(9.0), button(9.0, false)];
        let expected =
            vec![vec![moved(1.0), button(1.0, true)], vec![moved(5.0), moved(9.0)], vec![button(9.0, false)]];
        assert_eq!(frames(drag), expected);
    }

    #[test]
    fn what_is_typed_after_a_click_comes_after_it() {
        let typed = vec![button(1.0, true), button(1.0, false), Event::Text("1".into()), Event::Text("2".into())];
        let expected = vec![
            vec![button(1.0, true)],
            vec![button(1.0, false)],
            vec![Event::Text("1".into()), Event::Text("2".into())],
        ];
        assert_eq!(frames(typed), expected);
    }

    #[test]
    fn events_without_buttons_come_at_once_and_in_order() {
        let events = vec![moved(1.0), Event::Text("a".into()), moved(2.0), Event::Copy];
        assert_eq!(frames(events.clone()), [events]);
        assert_eq!(frames(Vec::new()), [Vec::new()]);
    }

    #[test]
    fn later_events_wait_behind_those_that_wait() {
        let mut paced = PacedEvents::default();
        assert_eq!(paced.pace(vec![button(1.0, true), button(1.0, false)]), [button(1.0, true)]);
        assert_eq!(paced.pace(vec![moved(2.0)]), [button(1.0, false)]);
        assert_eq!(paced.pace(Vec::new()), [moved(2.0)]);
        assert!(!paced.are_waiting());
    }
}
