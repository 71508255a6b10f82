//! The `limitmesh` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    limitmesh_cli::program(std::env::args_os()).into()
}
