//! Figures kept in `docs/bench`, with what they were measured with.

use super::workshop::{compiler, peers};
use crate::bench::timing::machine;
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use std::path::PathBuf;
use std::process::Command;

/// A file of figures to be written.
pub(super) struct Record {
    file: NewFile,
    settings: Vec<String>,
}

impl Record {
    /// `docs/bench/KIND-REVISION.csv`; a revision with changes that are not committed is called dirty.
    ///
    /// # Errors
    ///
    /// If the folder takes no new file.
    pub(super) fn new(kind: &str, rounds: usize) -> Result<Self, AppError> {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../docs/bench");
        std::fs::create_dir_all(&folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
        let revision = revision();
        let settings = vec![
            format!("revision: {revision}"),
            format!("machine: {}", machine(0)),
            format!("rounds: {rounds}"),
            format!("rustc: {}", first_line("rustc", &["--version"])),
            format!("C++: {}, -O3 -march=native", compiler().map_or_else(String::new, |cxx| first_line(&cxx, &["--version"]))),
            "gz: no target-cpu; obvhs 0.4.0 and parry3d 0.31.1: target-cpu=native; Embree of embreex 4.4.0".to_owned(),
        ];
        Ok(Self { file: NewFile::at(&folder.join(format!("{kind}-{revision}.csv")))?, settings })
    }

    /// Writes settings, column names and rows.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub(super) fn write(&self, head: &str, rows: impl IntoIterator<Item = Vec<String>>) -> Result<(), AppError> {
        let settings = self.settings.iter().map(|line| format!("# {line}\n"));
        let rows = rows.into_iter().map(|row| row.join(",") + "\n");
        let text: String = settings.chain([format!("{head}\n")]).chain(rows).collect();
        self.file.write(text.as_bytes())?;
        println!("written to {}", self.file.path().display());
        Ok(())
    }
}

fn revision() -> String {
    let name = first_line("git", &["rev-parse", "--short", "HEAD"]);
    let changed = !first_line("git", &["status", "--porcelain", "--untracked-files=no"]).is_empty();
    match (name.as_str(), changed) {
        ("", _) => "unknown".to_owned(),
        (name, true) => format!("{name}-dirty"),
        (name, false) => name.to_owned(),
    }
}

/// The first line that a program says, nothing when it cannot be had.
fn first_line(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).current_dir(peers("")).output();
    let text = output.ok().filter(|output| output.status.success()).map(|output| output.stdout).unwrap_or_default();
    String::from_utf8_lossy(&text).lines().next().unwrap_or_default().trim().to_owned()
}
