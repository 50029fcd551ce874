//! The `partwright` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    partwright::cli::run()
}
