//! `cargo xtask verify`: answers against the independent truth, builds against each other, pictures against the course's references.

use crate::{Failure, cargo, finish, root};
use std::collections::BTreeMap;

const KNOWN: &str = "use rays, scene NAME|FILE|all, builds or homework";

/// Starts the verification that the first argument names; the rest goes to it.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    match arguments.first().map(String::as_str) {
        Some("homework" | "rays" | "scene") => {}
        Some("builds") if arguments.len() == 1 => return builds(),
        Some("builds") => return Err(Failure { message: "verify builds takes no options".to_owned(), code: 2 }),
        Some(other) => return Err(Failure { message: format!("there is nothing called {other} to verify: {KNOWN}"), code: 2 }),
        None => return Err(Failure { message: format!("verify what? {KNOWN}"), code: 2 }),
    }
    let mut command = cargo();
    // Files among the arguments are meant from where the user stands.
    if let Ok(here) = std::env::current_dir() {
        command.current_dir(here);
    }
    command.args(["run", "--quiet", "--release", "--package", "gz-tests", "--bin", "verify", "--"]).args(arguments);
    finish(&mut command, "the verification")
}

/// Processors that the builds are for.
const TARGETS: [&str; 3] = ["x86-64", "x86-64-v3", "native"];

/// Builds the program that prints the hash of every scene's T-buffer at every SIMD level, for each of [`TARGETS`] and once for debugging, runs
/// each and compares what they print.
fn builds() -> Result<(), Failure> {
    // Hash by scene, with who gave it.
    let mut hashes: BTreeMap<String, BTreeMap<String, Vec<String>>> = BTreeMap::new();
    for (target, profile) in TARGETS.map(|target| (target, "release")).into_iter().chain([("x86-64", "dev")]) {
        let name = format!("{target}, {}", if profile == "dev" { "debug" } else { profile });
        eprintln!("building for {name}");
        let mut command = cargo();
        command
            .args(["run", "--quiet", "--profile", profile, "--package", "gz-tests", "--bin", "verify", "--target-dir"])
            .arg(root().join("target/verify-builds").join(target))
            .args(["--", "hashes"])
            .env("RUSTFLAGS", format!("-C target-cpu={target}"));
        let ended =
            command.output().map_err(|error| Failure { message: format!("{name} cannot be started: {error}"), code: 1 })?;
        if !ended.status.success() {
            let said = String::from_utf8_lossy(&ended.stderr);
            return Err(Failure { message: format!("{name} failed: {}", said.trim_end()), code: 1 });
        }
        for line in String::from_utf8_lossy(&ended.stdout).lines() {
            let mut words = line.split_whitespace();
            let (Some(scene), Some(level), Some(hash)) = (words.next(), words.next(), words.next()) else {
                return Err(Failure { message: format!("{name} printed {line:?}"), code: 1 });
            };
            println!("{scene:<18} {hash} {name}, {level}");
            hashes.entry(scene.to_owned()).or_default().entry(hash.to_owned()).or_default().push(format!("{name}, {level}"));
        }
    }
    let count: usize = hashes.values().flat_map(BTreeMap::values).map(Vec::len).sum();
    let differing: Vec<&str> = hashes.iter().filter(|(_, found)| found.len() > 1).map(|(scene, _)| scene.as_str()).collect();
    if hashes.is_empty() || !differing.is_empty() {
        return Err(Failure { message: format!("T-buffers differ between builds: {}", differing.join(", ")), code: 4 });
    }
    println!("{count} T-buffers of {} scenes: one hash a scene, 0 differ", hashes.len());
    Ok(())
}
