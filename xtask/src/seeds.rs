//! `cargo xtask seeds`: the hard cases that fuzzing starts from.

use crate::{Failure, cargo, finish};

/// Writes them.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    if let Some(argument) = arguments.first() {
        return Err(Failure { message: format!("seeds takes nothing, not {argument}"), code: 2 });
    }
    let mut command = cargo();
    command.args(["run", "--quiet", "--release", "--package", "gz-tests", "--bin", "seeds"]);
    finish(&mut command, "writing the seeds")
}
