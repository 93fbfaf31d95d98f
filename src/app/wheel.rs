//! Which list a turn of the wheel scrolls. A turn that began beside a list goes past it: otherwise no panel could be scrolled whose
//! lists come under the pointer.

use egui::{Id, Rect, Ui, Vec2};

/// Movements of the wheel that are farther apart than this are two turns, in s.
const PAUSE: f64 = 0.4;

/// The last turn of the wheel. Times are in s.
#[derive(Clone, Copy)]
struct Turn {
    start: f64,
    last: f64,
    list: Option<Id>,
}

/// Returns whether the wheel scrolls a list, whose place in the last frame is given.
pub(super) fn scrolls(ui: &Ui, list: Id, place: Option<Rect>) -> bool {
    let (now, moves) = ui.input(|input| (input.time, input.smooth_scroll_delta() != Vec2::ZERO));
    if !moves {
        return true;
    }
    let known = Id::unique("turn of the wheel");
    let last: Option<Turn> = ui.data(|data| data.get_temp(known));
    let last = last.filter(|turn| now - turn.last <= PAUSE);
    let mut turn = last.unwrap_or(Turn { start: now, last: now, list: None });
    turn.last = now;
    if turn.start == now && place.is_some_and(|place| ui.rect_contains_pointer(place)) {
        turn.list = Some(list);
    }
    ui.data_mut(|data| data.insert_temp(known, turn));
    turn.list == Some(list)
}
