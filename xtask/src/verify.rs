//! `cargo xtask verify`: figures against references outside of the repository.

use crate::{Failure, cargo, finish};

/// Starts the verification that the first argument names; the rest goes to it.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    match arguments.first().map(String::as_str) {
        Some("homework") => {}
        Some(other) => {
            return Err(Failure { message: format!("there is nothing called {other} to verify: use homework"), code: 2 });
        }
        None => return Err(Failure { message: "verify what? use homework".to_owned(), code: 2 }),
    }
    let mut command = cargo();
    command.args(["run", "--quiet", "--release", "--package", "gz-tests", "--bin", "verify", "--"]).args(arguments);
    finish(&mut command, "the verification")
}
