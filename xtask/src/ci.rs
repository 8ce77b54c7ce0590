//! `cargo xtask ci`: what has to pass before a push.

use crate::{Failure, cargo, finish};

/// Format, clippy (the libraries also without their default features), docs and tests, in this order, up to the first that fails.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    if !arguments.is_empty() {
        return Err(Failure { message: format!("ci takes no arguments, not {}", arguments.join(" ")), code: 2 });
    }
    finish(cargo().args(["fmt", "--all", "--check"]), "the format check (cargo fmt mends it)")?;
    // Outside of the workspace, and so of the line above and the next; built for the peers bench alone.
    let plugin = "tests/peers/plugin/Cargo.toml";
    finish(cargo().args(["fmt", "--check", "--manifest-path", plugin]), "the format check of tests/peers/plugin")?;
    let lint = ["clippy", "--locked", "--manifest-path", plugin, "--target-dir", "target/peers/clippy", "--", "-D", "warnings"];
    finish(cargo().args(lint), "clippy of tests/peers/plugin")?;
    finish(cargo().args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]), "clippy")?;
    // The libraries as others may depend on them: on one thread, without rayon.
    let alone = ["clippy", "-p", "gz-core", "-p", "gz-bsp", "--no-default-features", "--", "-D", "warnings"];
    finish(cargo().args(alone), "clippy without default features")?;
    finish(cargo().args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"), "the documentation")?;
    finish(cargo().args(["test", "--workspace"]), "a test")
}
