//! `cargo xtask golden`: small renders against their references.

use crate::{Failure, cargo, finish};

/// Runs the golden tests; with `--bless` they write their references instead.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    let mut command = cargo();
    command.args(["test", "--package", "gz-tests", "--test", "golden"]);
    match arguments {
        [] => {}
        [bless] if bless == "--bless" => {
            command.env("GZ_BLESS", "1");
        }
        _ => return Err(Failure { message: format!("golden takes --bless or nothing, not {}", arguments.join(" ")), code: 2 }),
    }
    command.args(["--", "--nocapture"]);
    finish(&mut command, "the golden test")
}
