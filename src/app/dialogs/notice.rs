//! What has just ended, such as a file that was written. One sentence is shown in the status line for a while; several are to be
//! read, and stay in a window until it is closed.

use std::time::Duration;

use crate::app::App;

/// How long a sentence stays, in seconds.
const SHOWN: f64 = 10.0;

/// Sentences, a line each.
pub(in crate::app) struct Notice {
    text: String,
    /// When it was first shown in the status line, by the window's clock.
    since: Option<f64>,
}

impl Notice {
    pub(in crate::app) fn new(text: String) -> Self {
        Self { text, since: None }
    }

    /// The text, if it has several sentences.
    pub(in crate::app) fn for_window(&self) -> Option<&str> {
        Some(&*self.text).filter(|text| text.contains('\n'))
    }
}

impl App {
    /// The sentence that the status line shows now, if there is one.
    pub(in crate::app) fn said(&mut self, context: &egui::Context) -> Option<String> {
        let notice = self.dialogs.notice.as_mut().filter(|notice| notice.for_window().is_none())?;
        let now = context.input(|input| input.time);
        // The clock of another window begins anew.
        let since = notice.since.map_or(now, |since| since.min(now));
        notice.since = Some(since);
        let left = SHOWN - (now - since);
        if left <= 0.0 {
            self.dialogs.notice = None;
            return None;
        }
        context.request_repaint_after(Duration::from_secs_f64(left));
        Some(notice.text.clone())
    }
}
