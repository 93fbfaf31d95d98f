//! The program: opens the window, or runs a command.

use std::process::ExitCode;

fn main() -> ExitCode {
    let Cli { command, file, limit, adapter } = Cli::parse();
    quiet_driver();
    if let Some(command) = command {
        return cli::run(command);
    }
    let reason = match app::run(file.clone(), limit.limits(), adapter.choice()) {
        Ok(()) => return ExitCode::SUCCESS,
        Err(WindowError::NoDisplay(reason)) => reason,
        Err(error) => return cli::fail(&error),
    };
    if let Err(error) = cli::preview(file, limit, adapter, Path::new(PREVIEW)) {
        return cli::fail(&error);
    }
    let said = "There is no display to open a window on";
    // A closed standard output is no failure.
    let _ =
        writeln!(std::io::stdout(), "{said} ({reason}); the picture that the window would have shown is in {PREVIEW}.");
    ExitCode::SUCCESS
}

/// Turns Mesa's device selection off where there is no desktop session: it would look for a Wayland display and complain
/// on standard error. Commands need no display and choose their adapter themselves.
fn quiet_driver() {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: nothing else runs yet that could read the environment at the same time.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}
