//! Opens the window, replaces a graphics device that was lost, and shows a screen if it can't be replaced.

pub(super) mod device_lost;
pub(super) mod fatal_screen;
pub(crate) mod run;

use device_lost::DeviceLosses;
use fatal_screen::FatalScreen;

pub(crate) use run::{WindowError, run};

/// The losses of the devices that the window was drawn with.
#[derive(Default)]
pub(super) struct WindowState {
    pub losses: DeviceLosses,
    /// Shown in place of everything else if a lost device isn't replaced.
    pub fatal_screen: Option<FatalScreen>,
}
