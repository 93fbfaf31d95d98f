//! Runs the window frame by frame.

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use pnaen::app::App;

/// How long the tests wait at most: longer than anything here takes on two slow cores beside other work.
pub(super) const PATIENCE: Duration = Duration::from_secs(240);

/// Runs frames until everything is loaded, drawn and measured.
pub(super) fn settle(harness: &mut Harness<App>) {
    let start = Instant::now();
    // A key or click takes effect within two frames.
    harness.run_steps(3);
    loop {
        while harness.state().is_busy() {
            assert!(start.elapsed() < PATIENCE, "the window is still busy");
            std::thread::sleep(Duration::from_millis(2));
            harness.step();
        }
        harness.run_steps(2);
        // What is done may be what something else waited for.
        if !harness.state().is_busy() {
            return;
        }
    }
}
