//! The command gz.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(gz_app::cli::run(std::env::args_os()))
}
