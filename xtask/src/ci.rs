//! `cargo xtask ci`: what has to pass before a push.

use crate::{Failure, cargo, finish};

/// Format, clippy, docs and tests, in this order, up to the first that fails.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    if !arguments.is_empty() {
        return Err(Failure { message: format!("ci takes no arguments, not {}", arguments.join(" ")), code: 2 });
    }
    finish(cargo().args(["fmt", "--all", "--check"]), "the format check (cargo fmt mends it)")?;
    finish(cargo().args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]), "clippy")?;
    finish(cargo().args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"), "the documentation")?;
    finish(cargo().args(["test", "--workspace"]), "a test")
}
