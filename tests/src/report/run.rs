//! How a report is measured: sizes, seed, and what the machine and the sources are.

use super::progress::Progress;
use crate::bench::timing;
use std::path::Path;
use std::process::Command;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// A few rays of everything, for tests of the report itself.
    Tiny,
    /// About two minutes on two cores.
    Quick,
    /// As long as figures for publication take.
    Full,
}

impl Mode {
    /// Its name in the settings of a row.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tiny => "tiny",
            Self::Quick => "quick",
            Self::Full => "full",
        }
    }
}

/// One making of a report.
#[derive(Debug)]
pub struct Run {
    /// How much is measured.
    pub mode: Mode,
    /// What all random inputs follow from.
    pub seed: u64,
    /// Whether scenes may use the course's data.
    pub course: bool,
    /// The revision of the sources.
    pub revision: String,
    /// The processor.
    pub cpu: String,
    /// Tells what is going on.
    pub progress: Progress,
}

impl Run {
    /// A run of this size on this machine.
    pub fn new(mode: Mode, seed: u64, course: bool) -> Self {
        Self { mode, seed, course, revision: revision(), cpu: timing::machine(1), progress: Progress::new(mode != Mode::Tiny) }
    }

    /// The one of three sizes that this run's mode asks for.
    pub fn size<T>(&self, tiny: T, quick: T, full: T) -> T {
        match self.mode {
            Mode::Tiny => tiny,
            Mode::Quick => quick,
            Mode::Full => full,
        }
    }

    /// Rounds in which contenders take turns.
    pub fn rounds(&self) -> usize {
        self.size(1, 5, 21)
    }
}

/// The revision of everything that figures follow from: documents and the report itself are not among it, so that committing a report
/// does not make it old.
fn revision() -> String {
    const SOURCES: [&str; 6] = ["crates", "tests", "assets", "Cargo.lock", "Cargo.toml", "rust-toolchain.toml"];
    let git = |arguments: &[&str]| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let output = Command::new("git").args(arguments).arg("--").args(SOURCES).current_dir(root).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let Some(name) = git(&["log", "-1", "--format=%h"]).map(|text| text.trim().to_owned()).filter(|name| !name.is_empty()) else {
        return "unknown".to_owned();
    };
    match git(&["diff", "HEAD"]) {
        Some(changes) if changes.is_empty() => name,
        Some(changes) => format!("{name}+{:08x}", hash(changes.as_bytes())),
        None => name,
    }
}

/// FNV-1a, to tell one set of changes from another.
fn hash(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash, &byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}
