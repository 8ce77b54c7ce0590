//! Other programs that benches use: whether they are there, running them, and Python packages in a folder of their own.

use gz_app::error::AppError;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Whether a program can be started.
pub fn answers(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Runs a program to its end; what it prints is kept back.
///
/// # Errors
///
/// [`AppError::Io`] with the line of what it said that tells most when it fails or cannot be started.
pub fn run(command: &mut Command, what: &str) -> Result<(), AppError> {
    said(command, what).map(|_| ())
}

/// The same, and gives what it printed.
///
/// # Errors
///
/// As [`run`].
pub fn said(command: &mut Command, what: &str) -> Result<Said, AppError> {
    let output = command.output().map_err(|error| AppError::Io(format!("{what} cannot be started: {error}")))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let said = Said { output: text(&output.stdout), errors: text(&output.stderr) };
    if output.status.success() {
        return Ok(said);
    }
    let cause = cause(&said.errors).unwrap_or("it does not say why");
    Err(AppError::Io(format!("{what} failed: {cause}")))
}

/// What a program printed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// On standard output.
    pub output: String,
    /// On standard error.
    pub errors: String,
}

/// The line of an error output that tells most: compilers say the cause first and end with a summary, others end with the cause.
fn cause(text: &str) -> Option<&str> {
    let lines = || text.lines().map(str::trim);
    lines().find(|line| line.contains("error")).or(lines().rfind(|line| !line.is_empty()))
}

/// Python with packages, in a folder of its own.
#[derive(Clone, Debug)]
pub struct Venv(PathBuf);

impl Venv {
    /// That of the workshop folder `dir`, whether it is there or not.
    pub fn of(dir: &Path) -> Self {
        Self(dir.join("venv"))
    }

    /// The folder `name` of an installed package.
    pub fn package(&self, name: &str) -> Option<PathBuf> {
        let entries = std::fs::read_dir(self.0.join("lib")).into_iter().flatten();
        let folders = entries.filter_map(|entry| Some(entry.ok()?.path().join("site-packages").join(name)));
        folders.into_iter().find(|folder| folder.is_dir())
    }

    /// Python, with `packages` fetched unless the folder `installed` tells that they are there.
    ///
    /// # Errors
    ///
    /// [`AppError::Io`] if there is no Python, or pip cannot fetch them.
    pub fn with(&self, packages: &[&str], installed: &str) -> Result<PathBuf, AppError> {
        let python = self.0.join("bin/python");
        if !python.exists() {
            run(Command::new("python3").args(["-m", "venv"]).arg(&self.0), "python3 -m venv")?;
        }
        if self.package(installed).is_none() {
            println!("fetching {}", packages.join(", "));
            run(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(packages), "pip install")?;
        }
        Ok(python)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_that_tells_most_is_found() {
        assert_eq!(cause("In file a.cpp\n  a.cpp:3: error: no such thing\n1 problem\n"), Some("a.cpp:3: error: no such thing"));
        assert_eq!(cause("Traceback\n  File x\nModuleNotFound: mitsuba\n\n"), Some("ModuleNotFound: mitsuba"));
        assert_eq!(cause("\n"), None);
    }

    #[test]
    fn a_program_that_is_not_there_is_one_line() {
        let error = run(&mut Command::new("no-such-program-at-all"), "it").unwrap_err();
        assert!(error.to_string().starts_with("it cannot be started: ") && !error.to_string().contains('\n'));
        assert!(!answers("no-such-program-at-all"));
    }

    #[test]
    fn a_package_that_is_not_installed_is_not_found() {
        assert_eq!(Venv::of(Path::new("no/such/folder")).package("mitsuba"), None);
    }
}
