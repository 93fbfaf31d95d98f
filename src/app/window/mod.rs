//! Opens the window, replaces a graphics device that was lost, and shows a screen if it can't be replaced.

pub mod device_lost;
pub mod fatal_screen;
mod run;

use device_lost::DeviceLosses;
use fatal_screen::FatalScreen;

pub use run::{WindowError, run, run_watched};

/// The losses of the devices that the window was drawn with.
#[derive(Default)]
pub struct WindowState {
    pub losses: DeviceLosses,
    /// Shown in place of everything else if a lost device isn't replaced.
    pub fatal_screen: Option<FatalScreen>,
}
