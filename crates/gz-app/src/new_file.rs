//! Writing a file whole or not at all.

use crate::error::AppError;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A file that is going to be written: its folder has been found to take new files.
///
/// The content goes to a temporary file beside it, which is renamed at the end, so that a run that is stopped halfway leaves an
/// older file of that name as it was and never half a new one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NewFile {
    path: PathBuf,
}

impl NewFile {
    /// A file at `path`, which may exist already. Nothing is left behind in the folder until [`Self::write`].
    ///
    /// # Errors
    ///
    /// [`AppError::Io`] if `path` is a folder, or its folder does not exist or takes no new file.
    pub fn at(path: &Path) -> Result<Self, AppError> {
        let file = Self { path: path.to_owned() };
        if path.is_dir() {
            return Err(AppError::Io(format!("{}: is a folder, not a file", path.display())));
        }
        let folder = file.folder();
        if !folder.is_dir() {
            return Err(AppError::Io(format!("{}: there is no folder {}", path.display(), folder.display())));
        }
        let temporary = file.temporary();
        std::fs::File::create(&temporary).map_err(|error| file.refused(&error))?;
        std::fs::remove_file(&temporary).map_err(|error| file.refused(&error))?;
        Ok(file)
    }

    /// Where the file will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether both names are the same file, as far as the file system can tell before either is written.
    pub fn is(&self, other: &Path) -> bool {
        // A file that does not exist yet is told by its folder.
        let place = |path: &Path| {
            let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let beside = || Some(folder.canonicalize().ok()?.join(path.file_name()?));
            path.canonicalize().ok().or_else(beside)
        };
        self.path == other || place(&self.path).is_some_and(|a| place(other) == Some(a))
    }

    /// Writes `bytes` as the whole content.
    ///
    /// # Errors
    ///
    /// [`AppError::Io`] if it cannot be written; the temporary file is then removed.
    pub fn write(&self, bytes: &[u8]) -> Result<(), AppError> {
        self.write_with(|file| file.write_all(bytes).map_err(|error| self.refused(&error)))
    }

    /// Writes the whole content piece by piece, as `fill` hands it over.
    ///
    /// # Errors
    ///
    /// [`AppError::Io`] if it cannot be written, and whatever `fill` fails with; the temporary file is then removed.
    pub fn write_with(&self, fill: impl FnOnce(&mut std::fs::File) -> Result<(), AppError>) -> Result<(), AppError> {
        let temporary = self.temporary();
        let write = || -> Result<(), AppError> {
            let refused = |error: std::io::Error| self.refused(&error);
            let mut file = std::fs::File::create(&temporary).map_err(refused)?;
            fill(&mut file)?;
            file.flush().map_err(refused)?;
            drop(file);
            std::fs::rename(&temporary, &self.path).map_err(refused)
        };
        write().inspect_err(|_| {
            let _ = std::fs::remove_file(&temporary); // it may not exist: the first error is the one to tell
        })
    }

    fn folder(&self) -> &Path {
        self.path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
    }

    /// Beside the file, so that the rename stays within one file system; with the process number, so that two runs do not meet.
    fn temporary(&self) -> PathBuf {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        self.folder().join(format!(".{name}.{}.part", std::process::id()))
    }

    /// What to tell when writing into this file fails.
    pub fn refused(&self, error: &std::io::Error) -> AppError {
        let cause = match error.kind() {
            ErrorKind::PermissionDenied => format!("permission denied in folder {}", self.folder().display()),
            ErrorKind::StorageFull => "the disk is full".to_owned(),
            _ => error.to_string(),
        };
        AppError::Io(format!("{}: {cause}", self.path.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of this test alone.
    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("gz-new-file-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn only_the_finished_file_is_left() {
        let folder = folder("whole");
        let file = NewFile::at(&folder.join("a.bin")).unwrap();
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
        file.write(b"one").unwrap();
        file.write(b"two").unwrap();
        assert_eq!(std::fs::read(file.path()).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_folder_that_is_missing_or_in_the_way_is_found_out_first() {
        let folder = folder("missing");
        let message = |path: &Path| NewFile::at(path).unwrap_err().to_string();
        let lost = folder.join("no/a.png");
        assert_eq!(message(&lost), format!("{}: there is no folder {}", lost.display(), folder.join("no").display()));
        assert_eq!(message(&folder), format!("{}: is a folder, not a file", folder.display()));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn one_file_under_two_names_is_recognised() {
        let folder = folder("same");
        let file = NewFile::at(&folder.join("a.png")).unwrap();
        assert!(file.is(&folder.join("./a.png")) && !file.is(&folder.join("b.png")));
        file.write(b"").unwrap();
        assert!(file.is(&folder.join("../").join(folder.file_name().unwrap()).join("a.png")));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
