//! Arguments in, window or command out.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use pnaen::app::{self, WindowError};
use pnaen::cli::{self, Cli};

/// Where the picture goes when there is no display to open a window on.
const PREVIEW: &str = "pnaen-preview.png";

fn main() -> ExitCode {
    let Cli { command, file } = Cli::parse();
    if let Some(command) = command {
        return cli::run(command);
    }
    match app::run(file.clone()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(WindowError::NoDisplay(reason)) => match cli::preview(file, Path::new(PREVIEW)) {
            Ok(()) => {
                println!("There is no display to open a window on ({reason}); the picture it would have shown is in {PREVIEW}.");
                ExitCode::SUCCESS
            }
            Err(error) => cli::fail(&error),
        },
        Err(error) => cli::fail(&error),
    }
}
