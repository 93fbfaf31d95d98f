//! The small windows over everything, and the desktop's file dialogs.

mod background;
mod desktop_dialog;
pub(super) mod typed_path;
pub(super) mod windows;
mod writing;

use typed_path::{PendingDialog, TypedPath};

/// Windows and dialogs that are open.
#[derive(Default)]
pub(super) struct Dialogs {
    /// The desktop's file dialog, until it is answered.
    pub pending: Option<PendingDialog>,
    /// The path that is being typed, while that window is open.
    pub typed_path: Option<TypedPath>,
    /// What went wrong last, until it is closed.
    pub error: Option<String>,
    /// What was written where, until it is closed.
    pub notice: Option<String>,
    /// Whether the colour behind the mesh is being chosen.
    pub chooses_background: bool,
    /// Whether it is asked if everything is to be forgotten.
    pub asks_to_forget: bool,
}
