//! The desktop's file dialogs. rfd reports a missing dialog only in its log, so this listens to the log.

use std::cell::Cell;
use std::path::PathBuf;
use std::sync::Once;

use log::{Level, LevelFilter, Log, Metadata, Record};

#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    Chosen(PathBuf),
    Cancelled,
    /// No dialog could be shown: no portal answers on the session's bus, and zenity isn't installed.
    NoDialog,
}

/// Shows a dialog, and waits for its answer.
pub(super) fn ask(dialog: impl FnOnce() -> Option<PathBuf>) -> Asked {
    static LISTENS: Once = Once::new();
    LISTENS.call_once(|| {
        // If another logger is set already, a missing dialog looks like a cancelled one.
        if log::set_logger(&DialogLog).is_ok() {
            log::set_max_level(LevelFilter::Error);
        }
    });
    IS_MISSING.set(false);
    match dialog() {
        Some(path) => Asked::Chosen(path),
        None if IS_MISSING.take() => Asked::NoDialog,
        None => Asked::Cancelled,
    }
}

thread_local! {
    /// Whether rfd has logged on this thread that zenity, which it tries last, is missing.
    static IS_MISSING: Cell<bool> = const { Cell::new(false) };
}

struct DialogLog;

impl Log for DialogLog {
    fn enabled(&self, metadata: &Metadata) -> bool {
        metadata.level() == Level::Error && metadata.target().starts_with("rfd")
    }

    fn log(&self, record: &Record) {
        if self.enabled(record.metadata()) && record.args().to_string().contains("with zenity") {
            IS_MISSING.set(true);
        }
    }

    fn flush(&self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_dialog_is_told_from_a_cancelled_one() {
        let missing = || {
            log::error!(target: "rfd::backend", "Failed to pick file with zenity: No such file or directory");
            None
        };
        let no_portal = || {
            log::error!(target: "rfd::backend", "OpenFile failed: no portal");
            None
        };
        assert_eq!(ask(missing), Asked::NoDialog);
        assert_eq!(ask(no_portal), Asked::Cancelled, "rfd shows zenity after that");
        assert_eq!(ask(|| Some("a.glb".into())), Asked::Chosen("a.glb".into()));
    }
}
