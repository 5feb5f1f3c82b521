//! The program `snapload`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(snapload_cli::command(std::env::args_os()))
}
