//! The desktop's file dialogs. Where there are none, rfd says so nowhere but in its log: this listens there.

use std::cell::Cell;
use std::path::PathBuf;
use std::sync::Once;

use log::{Level, LevelFilter, Log, Metadata, Record};

/// What came of a dialog.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    Chosen(PathBuf),
    Cancelled,
    /// It wasn't shown: no portal answers on the session's bus, and zenity isn't there either.
    NoDialog,
}

/// Shows a dialog, and waits for it.
pub(super) fn ask(dialog: impl FnOnce() -> Option<PathBuf>) -> Asked {
    static LISTENS: Once = Once::new();
    LISTENS.call_once(|| {
        // Another listener would have been there first: then a dialog that isn't shown looks like one that was cancelled.
        if log::set_logger(&Ear).is_ok() {
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
    /// Whether rfd said on this thread that its last resort, zenity, isn't there.
    static IS_MISSING: Cell<bool> = const { Cell::new(false) };
}

struct Ear;

impl Log for Ear {
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
    fn a_dialog_that_is_not_there_is_told_from_one_that_was_cancelled() {
        let missing = || {
            log::error!(target: "rfd::backend", "Failed to pick file with zenity: No such file or directory");
            None
        };
        let no_portal = || {
            log::error!(target: "rfd::backend", "OpenFile failed: no portal");
            None
        };
        assert_eq!(ask(missing), Asked::NoDialog);
        assert_eq!(ask(no_portal), Asked::Cancelled, "zenity was shown after that");
        assert_eq!(ask(|| Some("a.glb".into())), Asked::Chosen("a.glb".into()));
    }
}
