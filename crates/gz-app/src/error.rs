//! What can go wrong, and the exit code that says so.

use std::path::{Path, PathBuf};

/// A scene, mesh or texture that cannot be used: shown as `assets/scenes/teapot.toml:12: material "brass" is not defined`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// The file.
    pub path: PathBuf,
    /// The line in it, counting from 1, where a line can be named.
    pub line: Option<usize>,
    /// What is wrong, cause first, in one line.
    pub message: String,
    /// Whether the file could not be read at all, as opposed to read and refused.
    pub io: bool,
}

impl LoadError {
    /// A file whose content is refused.
    pub fn bad(path: &Path, line: impl Into<Option<usize>>, message: impl Into<String>) -> Self {
        Self { path: path.to_owned(), line: line.into(), message: message.into(), io: false }
    }

    /// A file that could not be read.
    pub fn io(path: &Path, error: &std::io::Error) -> Self {
        let message = match error.kind() {
            std::io::ErrorKind::NotFound => "no such file".to_owned(),
            std::io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
            _ => error.to_string(),
        };
        Self { path: path.to_owned(), line: None, message, io: true }
    }
}

impl std::fmt::Display for LoadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:", self.path.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        write!(f, " {}", self.message)
    }
}

impl std::error::Error for LoadError {}

/// Why the command ended without doing what it was asked.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// A file could not be written, or something else outside the scene failed.
    #[error("{0}")]
    Io(String),
    /// The options contradict each other or ask for the impossible.
    #[error("{0}")]
    Usage(String),
    /// A scene or asset cannot be read or used.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A comparison or verification failed.
    #[error("{0}")]
    Differs(String),
}

impl AppError {
    /// 1 input/output, 2 usage, 3 bad scene or asset, 4 a comparison failed.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Io(_) => 1,
            Self::Usage(_) => 2,
            Self::Load(error) if error.io => 1,
            Self::Load(_) => 3,
            Self::Differs(_) => 4,
        }
    }
}
