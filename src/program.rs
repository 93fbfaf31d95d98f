//! The program: arguments in, window or command out.

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;

#[cfg(feature = "app")]
use crate::app::{self, WindowError};
use crate::cli::{self, Cli};
use geometry::names::shown_path;
#[cfg(feature = "app")]
use inspect::engine::Preparation;
use load::Source;

/// The picture's file when no window can be opened.
const PREVIEW: &str = "pnaen-preview.png";

/// Runs the program `pnaen` with the arguments of this process, and returns its exit code: 0, 1 if something went wrong, or
/// 130 after Ctrl-C. Wrong usage ends the process with exit code 2.
pub fn run() -> ExitCode {
    let arguments = Cli::parse();
    quiet_driver();
    if let Err(error) = geometry::cores::start() {
        return cli::fail(&format!("no thread can be started ({error}); let this user run more of them"));
    }
    if let Some(command) = arguments.command {
        return cli::run(command);
    }
    if let Some(Source::File(path)) = &arguments.file
        && matches!(path.try_exists(), Ok(false))
    {
        let path = shown_path(path);
        return cli::fail(&format!(
            "{path} can't be read: there is no such file, and no such command; see pnaen --help"
        ));
    }
    let reason = match open_window(&arguments) {
        Ok(reason) => reason,
        Err(code) => return code,
    };
    let Cli { file, opening, limit, adapter, .. } = arguments;
    if let Err(error) = cli::preview(file, &opening, limit, adapter, Path::new(PREVIEW)) {
        return cli::fail(&error);
    }
    // A closed standard output is no failure.
    let _ = writeln!(std::io::stdout(), "{reason}; the picture that the window would have shown is in {PREVIEW}.");
    ExitCode::SUCCESS
}

/// Opens the window and waits until it is closed. Returns the reason if there can be no window, and as an error the
/// exit code with which the program ends otherwise.
#[cfg(feature = "app")]
fn open_window(Cli { file, opening, limit, adapter, .. }: &Cli) -> Result<String, ExitCode> {
    let change = |preparation: &mut Preparation| opening.change(preparation);
    let opening = (!opening.is_empty()).then_some(&change as &dyn Fn(&mut Preparation));
    match app::run(file.clone(), opening, limit.limits(), adapter.choice(), |_, _| {}) {
        Ok(()) => Err(ExitCode::SUCCESS),
        Err(WindowError::NoDisplay(reason)) => Ok(format!("There is no display to open a window on ({reason})")),
        Err(error) => Err(cli::fail(&error)),
    }
}

#[cfg(not(feature = "app"))]
fn open_window(_: &Cli) -> Result<String, ExitCode> {
    Ok("This program was built without a window".to_owned())
}

/// Turns Mesa's device selection off where there is no desktop session: it would look for a Wayland display and complain
/// on standard error. Commands need no display and choose their adapter themselves.
#[allow(unsafe_code, reason = "the driver reads the environment, and has no other way to be told")]
fn quiet_driver() {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: no other thread runs yet that could read the environment at the same time.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}
