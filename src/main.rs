//! The program `pnaen`.

use std::process::ExitCode;

fn main() -> ExitCode {
    pnaen::run()
}
