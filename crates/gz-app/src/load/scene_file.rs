//! Scene files: from TOML to a draft. docs/SCENE.md is the reference of all keys.

use super::draft::{Draft, Surroundings, assemble};
use super::entries::{Entries, extension};
use super::keys::SceneKeys;
use super::lights::lights;
use super::settings::{Overrides, settings};
use super::source::{COURSE_VARIABLE, Finder};
use super::spot::{SceneText, line_starts};
use super::{bare, surfaces};
use crate::error::LoadError;
use gz_core::GzColor;
use gz_shade::Background;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Reads a scene: a `.toml` scene file, or a bare `.obj` or `.asc` mesh, which is put before a camera and three lights.
///
/// Files that a scene names are looked for beside it; `hw:NAME` in the folder that the environment variable `GZ_HW_DATA` names.
///
/// # Errors
///
/// If the file has another extension, cannot be read, or says something that cannot be rendered. The error names the line of the
/// scene, or the file that it leads to.
pub fn scene(path: &Path, overrides: &Overrides) -> Result<Draft, LoadError> {
    let course = std::env::var_os(COURSE_VARIABLE).filter(|folder| !folder.is_empty()).map(PathBuf::from);
    scene_with(path, overrides, course.as_deref())
}

/// [`scene`] with the folder of course data given.
pub(super) fn scene_with(path: &Path, overrides: &Overrides, course: Option<&Path>) -> Result<Draft, LoadError> {
    expect_scene(path)?;
    match extension(path).as_str() {
        "toml" => from_toml(path, overrides, course),
        _ => bare::scene(path, overrides),
    }
}

/// Refuses, by its name alone, a file that cannot be a scene.
///
/// # Errors
///
/// If its extension is none of toml, obj and asc.
pub fn expect_scene(path: &Path) -> Result<(), LoadError> {
    match extension(path).as_str() {
        "toml" | "obj" | "asc" => Ok(()),
        _ => Err(LoadError::bad(path, None, "a scene is a .toml, .obj or .asc file")),
    }
}

fn from_toml(path: &Path, overrides: &Overrides, course: Option<&Path>) -> Result<Draft, LoadError> {
    let bytes = std::fs::read(path).map_err(|error| LoadError::io(path, &error))?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count();
        LoadError::bad(path, line, "not UTF-8 text")
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    // Old Mac line ends, which TOML does not know.
    let text = if text.contains('\n') { Cow::Borrowed(text) } else { Cow::Owned(text.replace('\r', "\n")) };
    let starts = line_starts(&text);
    let text = SceneText { path, text: &text, starts: &starts };
    let keys: SceneKeys = toml::from_str(text.text).map_err(|error| text.toml_error(&error))?;

    let mut warnings = Vec::new();
    let finder = Finder { text, course };
    let set = settings(text, &keys, overrides)?;
    let lights = lights(text, &keys.light, &set)?;
    let (mut palette, names) = surfaces::palette(&finder, &keys.texture, &keys.material, set.mode, &mut warnings)?;
    let parts = Entries { finder, names: &names, model: set.camera.model(), palette: &mut palette, warnings: &mut warnings }
        .parts(&keys.mesh)?;
    let around = Surroundings {
        camera: set.camera,
        lights,
        ambient: keys.ambient.map_or(GzColor::ZERO, |color| color.0),
        background: keys.background.map_or(Background::Plain(GzColor::ZERO), |value| value.0),
        rules: set.rules,
    };
    assemble(path, around, parts, palette, warnings)
}

#[cfg(test)]
#[path = "scene_file_tests.rs"]
mod tests;
