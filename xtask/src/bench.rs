//! `cargo xtask bench`: measurements, optimised and with this processor's answers checked first.

use crate::{Failure, cargo, finish};

/// Starts the bench that the first argument names; the rest goes to it.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    let mut command = cargo();
    // Files among the arguments are meant from where the user stands.
    if let Ok(here) = std::env::current_dir() {
        command.current_dir(here);
    }
    command.args(["run", "--quiet", "--release", "--package", "gz-tests", "--bin", "bench", "--"]).args(arguments);
    finish(&mut command, "the bench")
}
