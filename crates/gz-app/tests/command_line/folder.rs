//! A folder of a test's own, and `gz` run in it.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A small scene: a teapot, half of whose picture is background.
pub(crate) const SCENE: &str = "\
[camera]
position = [0.0, 2.0, 12.0]
look_at = [0.0, 1.5, 0.0]
fov = 40.0
[[light]]
direction = [1.0, 2.0, 3.0]
color = [1.0, 1.0, 1.0]
[[mesh]]
teapot = { segments = 3, bottom = true }
";

/// What a run of `gz` left.
#[derive(Debug)]
pub(crate) struct Ended {
    /// Exit code.
    pub(crate) code: i32,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) err: String,
}

/// A folder that goes with the test.
pub(crate) struct Folder {
    path: PathBuf,
}

impl Folder {
    /// A new, empty folder; `name` is the test's.
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gz-cli-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path); // left by a run of the same number, long ago
        std::fs::create_dir_all(&path).expect("the folder for temporary files is writable");
        Self { path }
    }

    /// A folder with the small scene as `scene.toml`.
    pub(crate) fn with_scene(name: &str) -> Self {
        let folder = Self::new(name);
        folder.write("scene.toml", SCENE);
        folder
    }

    /// Writes a file into the folder.
    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path.join(name), text).expect("the folder is writable");
    }

    /// A file of the folder.
    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Where the folder is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The names in the folder, sorted, hidden ones too.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.path).expect("the folder is readable");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("a readable entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs `gz` in the folder with these words.
    pub(crate) fn gz(&self, line: &str) -> Ended {
        let output = Command::new(env!("CARGO_BIN_EXE_gz"))
            .current_dir(&self.path)
            .args(line.split_whitespace())
            .env_remove("GZ_HW_DATA")
            .output()
            .expect("gz can be started");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Ended { code: output.status.code().expect("gz ends by itself"), out: text(&output.stdout), err: text(&output.stderr) }
    }

    /// Runs `gz`, which has to succeed.
    pub(crate) fn done(&self, line: &str) -> Ended {
        let ended = self.gz(line);
        assert_eq!(ended.code, 0, "gz {line}: {}", ended.err);
        ended
    }

    /// Runs `gz`, which has to fail with this exit code and one line on standard error.
    pub(crate) fn fails(&self, line: &str, code: i32, message: &str) {
        let ended = self.gz(line);
        assert_eq!((ended.code, ended.err.as_str()), (code, format!("gz: {message}\n").as_str()), "gz {line}");
        assert!(!self.names().iter().any(|name| name.ends_with(".part") || name == "out.png"), "gz {line} left a file");
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.path);
    }
}
