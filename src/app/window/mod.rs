//! Opens the window, replaces a graphics device that was lost, and shows a screen if it can't be replaced.

pub(super) mod device_lost;
mod event_pacing;
pub(super) mod fatal_screen;
mod fitting;
pub mod run;

use device_lost::DeviceLosses;
use event_pacing::PacedEvents;
use fatal_screen::FatalScreen;
use fitting::Fitting;

pub use run::{WindowError, run};

#[derive(Default)]
pub(super) struct WindowState {
    /// The losses of the devices that it was drawn with.
    pub losses: DeviceLosses,
    pub events: PacedEvents,
    pub fitting: Fitting,
    /// Shown in place of everything else if a lost device isn't replaced.
    pub fatal_screen: Option<FatalScreen>,
}
