//! The window itself: opening it, replacing a graphics device that was lost, and the screen that is left when none can be.

pub(super) mod device_lost;
pub(super) mod fatal_screen;
pub(crate) mod run;

use device_lost::DeviceLosses;
use fatal_screen::FatalScreen;

pub(crate) use run::{WindowError, run};

/// What became of the devices that the window was drawn with.
#[derive(Default)]
pub(super) struct WindowState {
    pub losses: DeviceLosses,
    /// Shown in place of everything else, once a lost device isn't replaced any more.
    pub fatal_screen: Option<FatalScreen>,
}
