//! Ctrl-C of commands that keep what they have done.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::note;

/// The exit code after Ctrl-C: 128 + SIGINT, as shells return it.
pub(super) const INTERRUPTED: u8 = 130;

/// Returns a flag that Ctrl-C sets. A second Ctrl-C ends the program. `piece` is what the command ends after, such as "setting".
pub(super) fn stop_on_interrupt(piece: &'static str) -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = stop.clone();
    // Without a handler, Ctrl-C ends the program at once, and what was written until then stays.
    let _ = ctrlc::set_handler(move || {
        if set.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        note(&format!("ending after this {piece}; Ctrl-C again ends at once"));
    });
    stop
}
