//! Where the files that a scene names are found: beside it, or in the folder of course data.

use super::spot::SceneText;
use crate::error::LoadError;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// Paths that begin so are looked up in the folder of course data.
const COURSE: &str = "hw:";

/// The environment variable that names the folder of course data.
pub(super) const COURSE_VARIABLE: &str = "GZ_HW_DATA";

/// Whether `name` is looked up in the folder of course data.
pub(super) fn is_course_data(name: &str) -> bool {
    name.starts_with(COURSE)
}

/// Finds the files that one scene names.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finder<'a> {
    /// The scene.
    pub(super) text: SceneText<'a>,
    /// The folder of course data, if the environment names one.
    pub(super) course: Option<&'a Path>,
}

/// Why something that a scene names cannot be had.
#[derive(Debug)]
pub(super) struct Absent {
    /// What to tell the user.
    pub(super) error: LoadError,
    /// Whether it is course data that is not there, as not everybody may have it: something else can stand in.
    pub(super) is_course_data: bool,
}

impl From<LoadError> for Absent {
    fn from(error: LoadError) -> Self {
        Self { error, is_course_data: false }
    }
}

impl Finder<'_> {
    /// The path of the existing file that a scene calls `name`.
    ///
    /// A plain name is resolved beside the scene file, `hw:name` in the folder of course data.
    pub(super) fn find(&self, name: &Spanned<String>) -> Result<PathBuf, Absent> {
        let given = name.get_ref();
        let absent =
            |is_course_data, message: String| Err(Absent { error: self.text.error(name.span(), message), is_course_data });
        let Some(inside) = given.strip_prefix(COURSE) else {
            let path = self.text.path.parent().unwrap_or(Path::new("")).join(given);
            return if path.is_file() { Ok(path) } else { absent(false, format!("no such file: {}", path.display())) };
        };
        let Some(folder) = self.course else {
            let hint = format!("set {COURSE_VARIABLE} to the folder of course data");
            return absent(true, format!("\"{given}\" is course data: {hint}"));
        };
        let path = folder.join(inside);
        if path.is_file() {
            return Ok(path);
        }
        let hint = format!("{COURSE_VARIABLE} must be the folder of course data");
        absent(true, format!("no such file: {} ({hint})", path.display()))
    }
}
