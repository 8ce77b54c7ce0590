//! `cargo xtask measure`: the figures of docs/MODEL.md, and what computed needs save.

use crate::{Failure, cargo, finish};

/// Starts the measurement that the arguments name.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if !matches!(words[..], ["needs"] | ["model"] | ["model", "--write" | "--check"]) {
        let given = if words.is_empty() { "nothing".to_owned() } else { words.join(" ") };
        return Err(Failure { message: format!("measure takes model [--write|--check] or needs, not {given}"), code: 2 });
    }
    let mut command = cargo();
    command.args(["run", "--quiet", "--release", "--package", "gz-tests", "--bin", "measure", "--"]).args(arguments);
    finish(&mut command, "the measurement")
}
