//! How a person gives commands: the menus, the keys and the window that searches.

pub mod menu_bar;
pub mod palette;

use palette::Palette;

/// What is open of that.
#[derive(Default)]
pub struct Commands {
    pub shows_keys: bool,
    /// While commands are searched.
    pub palette: Option<Palette>,
    /// The command line that was copied, while it is shown.
    pub copied: Option<String>,
}
