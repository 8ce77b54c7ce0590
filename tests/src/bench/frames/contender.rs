//! What renders the frame: programs that are started for each picture.

use gz_app::error::AppError;
use std::path::{Path, PathBuf};

/// One who renders the frame.
pub(super) trait Contender {
    /// What it is called in tables, with its version.
    fn name(&self) -> String;

    /// Renders one picture, `side` pixels wide and high.
    ///
    /// # Errors
    ///
    /// If it fails.
    fn frame(&self, threads: usize, side: u32) -> Result<Turn, AppError>;

    /// Where the picture of the last turn is.
    fn picture(&self) -> PathBuf;
}

/// One picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    /// Seconds from the first ray to the last colour, by the program's own clock: without loading, building and writing.
    pub(super) trace: f64,
    /// Seconds of the whole process.
    pub(super) whole: f64,
}

/// Rays by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Rays {
    /// From the camera.
    pub(super) primary: u64,
    /// Reflected and refracted, by mirrors and by glass.
    pub(super) bounced: u64,
    /// To lights.
    pub(super) shadow: u64,
    /// Questions asked for them: more than one where glass is in the way.
    pub(super) shadow_questions: u64,
}

impl Rays {
    /// Of all kinds; a shadow ray counts once.
    pub(super) fn all(&self) -> u64 {
        self.primary + self.bounced + self.shadow
    }
}

/// A file of `tests/peers/frames`.
pub(super) fn source(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("peers/frames").join(name)
}

/// The number in front of `unit` at the start of `text`.
pub(super) fn number_before(text: &str, unit: &str) -> Option<f64> {
    text.split_once(unit)?.0.trim().parse().ok()
}

/// Copies a file of `tests/peers/frames` into `folder`.
///
/// # Errors
///
/// If it cannot be copied.
pub(super) fn copy(name: &str, folder: &Path) -> Result<(), AppError> {
    let to = folder.join(name);
    std::fs::copy(source(name), &to).map(|_| ()).map_err(|error| AppError::Io(format!("{}: {error}", to.display())))
}
