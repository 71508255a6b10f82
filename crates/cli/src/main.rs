//! The `limitmesh` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    let again = std::env::current_exe().map_or_else(
        |_| std::env::args_os().take(1).collect(),
        |path| vec![path.into()],
    );
    limitmesh_cli::program(std::env::args_os(), &again).into()
}
