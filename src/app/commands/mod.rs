//! How a person gives commands: the menus, the keys and the search, all made from the table in [`crate::commands`]; and
//! what the window does then.

mod copy_command;
mod key_list;
mod keyboard;
mod menu_bar;
mod palette;
mod perform;

use crate::commands::Action;
use palette::Palette;

/// Windows of commands that are open.
#[derive(Default)]
pub(super) struct Commands {
    pub shows_keys: bool,
    /// While commands are searched.
    pub palette: Option<Palette>,
    /// The command line that was copied, while it is shown.
    pub copied: Option<String>,
    /// What was last performed.
    pub last: Option<Action>,
}
