//! `cargo xtask report`: speed against error, in one page.

use crate::{Failure, cargo, finish};

/// Measures and writes the report; the arguments go to it.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    let mut command = cargo();
    // A folder among the arguments is meant from where the user stands.
    if let Ok(here) = std::env::current_dir() {
        command.current_dir(here);
    }
    // What is published must not show course data, so that it is there only for who asks.
    if !arguments.iter().any(|argument| argument == "--course") {
        command.env_remove("GZ_HW_DATA");
    }
    command.args(["run", "--quiet", "--release", "--package", "gz-tests", "--bin", "report", "--"]).args(arguments);
    finish(&mut command, "the report")
}
