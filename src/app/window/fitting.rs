//! Makes the first window fit its screen with its frame. The window library keeps the content within the screen, but not the title
//! bar, so that on a small screen the status line would lie below its end.

use std::time::{Duration, Instant};

use egui::{Vec2, ViewportCommand, ViewportInfo};

/// Desktops that tell the size of the frame do so within this time.
const TOLD_WITHIN: Duration = Duration::from_secs(2);

#[derive(Debug, Default)]
pub(in crate::app) struct Fitting {
    start: Option<Instant>,
    is_done: bool,
}

impl Fitting {
    /// Makes the window smaller once its frame is known, if it is larger than the screen. Does so once, since a person may want it
    /// larger.
    pub(in crate::app) fn fit(&mut self, context: &egui::Context) {
        if self.is_done {
            return;
        }
        let start = *self.start.get_or_insert_with(Instant::now);
        let fitting = context.input(|input| fitting(input.viewport()));
        self.is_done = fitting.is_some() || start.elapsed() > TOLD_WITHIN;
        if let Some(size) = fitting.flatten() {
            context.send_viewport_cmd(ViewportCommand::InnerSize(size));
        }
    }
}

/// The size of the content with which a window and its frame fit the screen, in points, or none if they do already. Unknown while
/// the window has no frame or isn't free to have another size.
fn fitting(window: &ViewportInfo) -> Option<Option<Vec2>> {
    let fills = [window.maximized, window.fullscreen].contains(&Some(true));
    let (inner, outer) = (window.inner_rect?.size(), window.outer_rect?.size());
    let excess = (outer - window.monitor_size?).max(Vec2::ZERO);
    (outer != inner && !fills).then(|| (excess != Vec2::ZERO).then_some(inner - excess))
}

#[cfg(test)]
mod tests {
    use egui::{Rect, pos2, vec2};

    use super::*;

    /// A window with a title bar of 24 points on a screen of 1280 x 720.
    fn window(inner: Vec2) -> ViewportInfo {
        ViewportInfo {
            inner_rect: Some(Rect::from_min_size(pos2(0.0, 24.0), inner)),
            outer_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), inner + vec2(0.0, 24.0))),
            monitor_size: Some(vec2(1280.0, 720.0)),
            ..ViewportInfo::default()
        }
    }

    #[test]
    fn a_window_and_its_frame_fit_the_screen() {
        assert_eq!(fitting(&window(vec2(1280.0, 720.0))), Some(Some(vec2(1280.0, 696.0))));
        assert_eq!(fitting(&window(vec2(1400.0, 700.0))), Some(Some(vec2(1280.0, 696.0))));
        assert_eq!(fitting(&window(vec2(1280.0, 696.0))), Some(None));
        let maximized = ViewportInfo { maximized: Some(true), ..window(vec2(1280.0, 720.0)) };
        assert_eq!(fitting(&maximized), None);
        let frameless =
            ViewportInfo { outer_rect: window(vec2(1280.0, 720.0)).inner_rect, ..window(vec2(1280.0, 720.0)) };
        assert_eq!(fitting(&frameless), None, "the frame may come later");
    }
}
