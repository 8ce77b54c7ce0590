//! Scenes written to a folder of their own for a test.

use super::draft::Draft;
use super::scene_file::scene_with;
use super::settings::Overrides;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A folder that goes away with the test.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("gz-load-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("the folder for temporary files can be written");
        Self(path)
    }

    pub(super) fn path(&self) -> &Path {
        &self.0
    }

    pub(super) fn with(self, name: &str, content: impl AsRef<[u8]>) -> Self {
        std::fs::write(self.0.join(name), content).expect("the folder for temporary files can be written");
        self
    }

    /// Reads a scene of this folder without course data. An error comes as its message, without the folder.
    pub(super) fn read(&self, name: &str, overrides: &Overrides) -> Result<Draft, String> {
        self.read_with_course(name, overrides, None)
    }

    pub(super) fn read_with_course(&self, name: &str, overrides: &Overrides, course: Option<&Path>) -> Result<Draft, String> {
        scene_with(&self.0.join(name), overrides, course).map_err(|error| self.short(&error.to_string()))
    }

    /// `message` without the name of this folder.
    pub(super) fn short(&self, message: &str) -> String {
        message.replace(&format!("{}{}", self.0.display(), std::path::MAIN_SEPARATOR), "")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What is left behind is in the folder for temporary files; a test does not fail over it.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A triangle in the plane z = 0 with corners of small whole numbers, unit normals along z and texture coordinates.
pub(super) const TRIANGLE_OBJ: &str = "v 1 0 0\nv 0 2 0\nv 0 0 0\nvn 0 0 1\nvt 0.25 0\nvt 0 0.5\nvt 0 0\nf 1/1/1 2/2/1 3/3/1\n";

/// The same without texture coordinates and normals.
pub(super) const BARE_OBJ: &str = "v 1 0 0\nv 0 2 0\nv 0 0 0\nf 1 2 3\n";

/// The same as course data.
pub(super) const TRIANGLE_ASC: &str = "triangle1\r1 0 0 0 0 1 0.25 0\r0 2 0 0 0 1 0 0.5\r0 0 0 0 0 1 0 0\r";

/// A pinhole camera and nothing else.
pub(super) const CAMERA: &str = "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n";

/// The camera of Application5, but for its model.
pub(super) const COURSE_CAMERA: &str = "position = [-3, -25, -4]\nlook_at = [7.8, 0.7, 6.5]\nup = [-0.2, 1, 0]\nfov = 63.7\n";

/// The draft of `toml` beside `t.obj`, `bare.obj` and `t.asc`.
pub(super) fn draft(toml: &str) -> Draft {
    draft_with(toml, &Overrides::default())
}

pub(super) fn draft_with(toml: &str, overrides: &Overrides) -> Draft {
    folder(toml).read("s.toml", overrides).unwrap_or_else(|error| panic!("{error}\n{toml}"))
}

/// The message of what is wrong with `toml`.
pub(super) fn message(toml: &str) -> String {
    folder(toml).read("s.toml", &Overrides::default()).map(|_| "nothing is wrong".to_owned()).unwrap_or_else(|error| error)
}

pub(super) fn folder(toml: &str) -> Folder {
    Folder::new().with("s.toml", toml).with("t.obj", TRIANGLE_OBJ).with("bare.obj", BARE_OBJ).with("t.asc", TRIANGLE_ASC)
}
