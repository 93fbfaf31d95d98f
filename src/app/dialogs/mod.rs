//! The small windows over the main window, and the desktop's file dialogs.

mod background;
mod desktop_dialog;
pub(super) mod purpose;
mod save_window;
pub(super) mod typed_path;
mod typed_text;
mod under_way;
pub(super) mod windows;
mod writing;

use crate::commands::Purpose;
use save_window::SaveWindow;
use typed_path::{PendingDialog, TypedPath};
use windows::Notice;

/// What can be forgotten after a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Forgetting {
    Everything,
    /// The bookmarks of the file that is open.
    Bookmarks,
}

#[derive(Default)]
pub(super) struct Dialogs {
    /// The desktop's file dialog, until it is answered.
    pub pending: Option<PendingDialog>,
    /// The path that is being typed, while that window is open.
    pub typed_path: Option<TypedPath>,
    /// What was typed last as the path of a file to read, until a mesh is opened: it may have a mistake.
    pub typed: Option<(Purpose, String)>,
    /// The folder of the last path that was typed for a file to write.
    pub folder: Option<std::path::PathBuf>,
    /// The last error, until its window is closed.
    pub error: Option<String>,
    /// What was written, or was stopped.
    pub notice: Option<Notice>,
    /// Whether the window for the background colour is open.
    pub chooses_background: bool,
    /// The window that chooses how a picture is saved.
    pub picture: SaveWindow,
    /// The window that chooses how a turntable is saved.
    pub turntable: SaveWindow,
    /// Whether the list of the mesh's warnings is open.
    pub shows_warnings: bool,
    /// What is forgotten if the window that asks for it is answered with yes; none if it isn't open.
    pub asks_to_forget: Option<Forgetting>,
}

impl Dialogs {
    /// Whether a window is open that takes an answer: keys don't act behind it.
    pub(super) fn ask(&self) -> bool {
        self.typed_path.is_some()
            || self.picture.is_open
            || self.turntable.is_open
            || self.chooses_background
            || self.asks_to_forget.is_some()
    }
}
