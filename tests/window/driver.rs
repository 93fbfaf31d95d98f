//! Driving the window as a person does, step by step.

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use pnaen::internals::App;

/// Longer than anything here takes on two slow cores.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);

/// Steps until everything is loaded, drawn and measured.
pub(super) fn settle(harness: &mut Harness<App>) {
    let start = Instant::now();
    // What was just pressed takes effect in the next two steps.
    harness.run_steps(3);
    while harness.state().is_busy() {
        assert!(start.elapsed() < PATIENCE, "the window is still busy");
        std::thread::sleep(Duration::from_millis(2));
        harness.step();
    }
    harness.run_steps(2);
}
