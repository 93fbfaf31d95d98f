//! The menus, keys and search that give commands, all made from the table in [`crate::commands`], and what each command
//! does.

mod copy_command;
mod key_list;
mod keyboard;
mod menu_bar;
mod palette;
mod perform;

use crate::commands::{Action, Menu};
use palette::Palette;

/// The open windows that belong to commands.
#[derive(Default)]
pub(super) struct Commands {
    pub shows_keys: bool,
    /// The search for a command, while it is open.
    pub palette: Option<Palette>,
    /// The command line that was copied, and what is said about it, while it is shown.
    pub copied: Option<(String, &'static str)>,
    /// The menu of the bar whose name was clicked last, unless that closed it.
    pub clicked_menu: Option<Menu>,
    pub last: Option<Action>,
}
