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
        let frame = context.input(|input| Frame::from_viewport(input.viewport()));
        self.is_done = frame.is_some() || start.elapsed() > TOLD_WITHIN;
        if let Some(size) = frame.and_then(|frame| frame.fitting()) {
            context.send_viewport_cmd(ViewportCommand::InnerSize(size));
        }
    }
}

/// The sizes of a window's content, of the window with its frame, and of the screen, in points.
#[derive(Clone, Copy, Debug)]
struct Frame {
    inner: Vec2,
    outer: Vec2,
    screen: Vec2,
}

impl Frame {
    /// None while the window has no frame or isn't free to have another size.
    fn from_viewport(window: &ViewportInfo) -> Option<Self> {
        let fills = [window.maximized, window.fullscreen].contains(&Some(true));
        let (inner, outer) = (window.inner_rect?.size(), window.outer_rect?.size());
        (outer != inner && !fills).then_some(Self { inner, outer, screen: window.monitor_size? })
    }

    /// The size of the content with which the window fits the screen; none if it does already.
    fn fitting(self) -> Option<Vec2> {
        let excess = (self.outer - self.screen).max(Vec2::ZERO);
        (excess != Vec2::ZERO).then_some(self.inner - excess)
    }
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
        let fitting = |window: &ViewportInfo| Frame::from_viewport(window).and_then(Frame::fitting);
        assert_eq!(fitting(&window(vec2(1280.0, 720.0))), Some(vec2(1280.0, 696.0)));
        assert_eq!(fitting(&window(vec2(1400.0, 700.0))), Some(vec2(1280.0, 696.0)));
        assert_eq!(fitting(&window(vec2(1280.0, 696.0))), None);
        let maximized = ViewportInfo { maximized: Some(true), ..window(vec2(1280.0, 720.0)) };
        assert_eq!(fitting(&maximized), None);
        let frameless =
            ViewportInfo { outer_rect: window(vec2(1280.0, 720.0)).inner_rect, ..window(vec2(1280.0, 720.0)) };
        assert!(Frame::from_viewport(&frameless).is_none(), "the frame may come later");
    }
}
