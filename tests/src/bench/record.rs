//! Figures kept in `docs/bench`, with what they were measured with.

use super::timing::machine;
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A file of figures to be written.
#[derive(Debug)]
pub struct Record {
    file: NewFile,
    settings: Vec<String>,
}

impl Record {
    /// `docs/bench/KIND-REVISION.csv`; a revision with changes that are not committed is called dirty. `settings` are lines about this
    /// bench beside revision, the time of its commit (seconds since 1970, day), machine, rounds and compiler.
    ///
    /// # Errors
    ///
    /// If the folder takes no new file.
    pub fn new(kind: &str, rounds: usize, settings: &[String]) -> Result<Self, AppError> {
        Self::within(&workspace().join("docs/bench"), kind, rounds, settings)
    }

    fn within(folder: &Path, kind: &str, rounds: usize, settings: &[String]) -> Result<Self, AppError> {
        std::fs::create_dir_all(folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
        let revision = revision();
        let mut lines = vec![
            format!("revision: {revision}"),
            format!("committed: {}", first_line("git", &["show", "-s", "--format=%ct, %cs", "HEAD"])),
            format!("machine: {}", machine(0)),
            format!("rounds: {rounds}"),
            format!("rustc: {}", first_line("rustc", &["--version"])),
        ];
        lines.extend_from_slice(settings);
        Ok(Self { file: NewFile::at(&folder.join(format!("{kind}-{revision}.csv")))?, settings: lines })
    }

    /// Writes settings, column names and rows.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write(&self, head: &str, rows: impl IntoIterator<Item = Vec<String>>) -> Result<(), AppError> {
        let text = text(&self.settings, head, rows);
        self.file.write(text.as_bytes())?;
        println!("written to {}", self.file.path().display());
        Ok(())
    }
}

/// When the revision that a record names was committed, in seconds since 1970. Unlike the time of its file, it is the same in every clone.
pub fn committed(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("# committed: "))?;
    line.split(',').next()?.parse().ok()
}

/// Settings as comments, then a line of column names, then the rows. A cell with a comma is put in quotes.
fn text(settings: &[String], head: &str, rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let settings = settings.iter().map(|line| format!("# {line}\n"));
    let cell = |cell: String| if cell.contains(',') { format!("\"{cell}\"") } else { cell };
    let rows = rows.into_iter().map(|row| row.into_iter().map(cell).collect::<Vec<_>>().join(",") + "\n");
    settings.chain([format!("{head}\n")]).chain(rows).collect()
}

/// The first line that a program says, nothing when it cannot be had.
pub fn first_line(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).current_dir(workspace()).output();
    let text = output.ok().filter(|output| output.status.success()).map(|output| output.stdout).unwrap_or_default();
    String::from_utf8_lossy(&text).lines().next().unwrap_or_default().trim().to_owned()
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

fn workspace() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row;

    #[test]
    fn settings_come_first_and_commas_are_quoted() {
        let rows = [row!["a", 1], row!["b, c", 2.5]];
        let text = text(&["one".to_owned(), "two".to_owned()], "name,value", rows);
        assert_eq!(text, "# one\n# two\nname,value\na,1\n\"b, c\",2.5\n");
    }

    #[test]
    fn a_record_says_where_it_comes_from() {
        let folder = std::env::temp_dir().join(format!("gz-record-{}", std::process::id()));
        let record = Record::within(&folder, "kind", 3, &["mesh: none".to_owned()]).unwrap();
        record.write("x", [row![1]]).unwrap();
        let written = std::fs::read_to_string(record.file.path()).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        for line in ["# revision: ", "# committed: ", "# machine: ", "# rounds: 3\n", "# rustc: ", "# mesh: none\nx\n1\n"] {
            assert!(written.contains(line), "{line} in {written}");
        }
        assert!(record.file.path().file_name().unwrap().to_string_lossy().starts_with("kind-"));
    }
}
