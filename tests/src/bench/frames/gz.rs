//! Ourselves: the command `gz`, as anybody would start it.

use super::contender::{Contender, Rays, Turn, source};
use crate::bench::timing::seconds;
use crate::bench::tools::{run, said};
use gz_app::error::AppError;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The command with the scene.
#[derive(Debug)]
pub(super) struct Gz {
    program: PathBuf,
    folder: PathBuf,
    scene: PathBuf,
    depth: u32,
}

impl Gz {
    /// Builds the command beside this program; pictures go to `folder`.
    ///
    /// # Errors
    ///
    /// If it cannot be built.
    pub(super) fn new(folder: &Path, depth: u32) -> Result<Self, AppError> {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.current_dir(env!("CARGO_MANIFEST_DIR"));
        run(cargo.args(["build", "--quiet", "--release", "--package", "gz-app", "--bin", "gz"]), "cargo build of gz")?;
        let here = std::env::current_exe().map_err(|error| AppError::Io(format!("this program cannot be found: {error}")))?;
        let program = here.with_file_name(format!("gz{}", std::env::consts::EXE_SUFFIX));
        Ok(Self { program, folder: folder.to_owned(), scene: source("teapots.toml"), depth })
    }

    /// The scene file.
    pub(super) fn scene(&self) -> &Path {
        &self.scene
    }

    /// Rays by kind of the picture rendered last.
    ///
    /// # Errors
    ///
    /// If there is none.
    pub(super) fn rays(&self) -> Result<Rays, AppError> {
        rays(&self.stats()?).ok_or_else(|| self.no_figures())
    }

    /// Renders the picture with T-values to `hits`.
    ///
    /// # Errors
    ///
    /// If it fails.
    pub(super) fn with_hits(&self, side: u32, hits: &Path) -> Result<(), AppError> {
        let mut command = self.render(0, side, &self.picture());
        run(command.arg("--tbuffer").arg(hits), "gz render")
    }

    /// Whether the tree and brute force give the same picture of this size.
    ///
    /// # Errors
    ///
    /// [`AppError::Differs`] if they do not.
    pub(super) fn agrees_with_brute_force(&self, side: u32) -> Result<(), AppError> {
        let [tree, brute] = ["check-tree.png", "check-brute.png"].map(|name| self.folder.join(name));
        run(&mut self.render(0, side, &tree), "gz render")?;
        run(self.render(0, side, &brute).args(["--accel", "brute"]), "gz render --accel brute")?;
        let mut compare = Command::new(&self.program);
        let compared = said(compare.arg("compare").args([&tree, &brute]), "gz compare");
        compared.map(|_| ()).map_err(|error| AppError::Differs(format!("tree and brute force give other pictures: {error}")))
    }

    fn render(&self, threads: usize, side: u32, picture: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command.arg("render").arg(&self.scene).arg("--output").arg(picture).args(["--progress", "none"]);
        command.args(["--size".to_owned(), format!("{side}x{side}"), "--threads".to_owned(), threads.to_string()]);
        command.args(["--depth".to_owned(), self.depth.to_string()]).arg("--stats-json").arg(self.stats_file());
        command
    }

    fn stats_file(&self) -> PathBuf {
        self.folder.join("gz.json")
    }

    fn stats(&self) -> Result<Value, AppError> {
        let text = std::fs::read_to_string(self.stats_file()).map_err(|error| AppError::Io(error.to_string()))?;
        serde_json::from_str(&text).map_err(|_| self.no_figures())
    }

    fn no_figures(&self) -> AppError {
        AppError::Io(format!("{} has no figures of a render", self.stats_file().display()))
    }
}

impl Contender for Gz {
    fn name(&self) -> String {
        "gz".to_owned()
    }

    fn frame(&self, threads: usize, side: u32) -> Result<Turn, AppError> {
        let mut command = self.render(threads, side, &self.picture());
        let (whole, ended) = seconds(|| run(&mut command, "gz render"));
        ended?;
        let trace = self.stats()?["seconds"]["trace"].as_f64().ok_or_else(|| self.no_figures())?;
        Ok(Turn { trace, whole })
    }

    fn picture(&self) -> PathBuf {
        self.folder.join("gz.png")
    }
}

fn rays(stats: &Value) -> Option<Rays> {
    let count = |kind: &str| stats["rays"][kind].as_u64();
    let shadow = count("shadow")?;
    Some(Rays {
        primary: count("primary")?,
        bounced: count("mirror")? + count("glass")?,
        shadow,
        shadow_questions: shadow + stats["counters"]["tint_queries"].as_u64()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_by_kind_are_read() {
        let stats = serde_json::json!({
            "rays": { "primary": 4, "shadow": 3, "mirror": 2, "glass": 1, "total": 10 },
            "counters": { "tint_queries": 5 },
        });
        assert_eq!(rays(&stats), Some(Rays { primary: 4, bounced: 3, shadow: 3, shadow_questions: 8 }));
        assert_eq!(rays(&stats).map(|rays| rays.all()), Some(10));
        assert_eq!(rays(&serde_json::json!({ "rays": 3 })), None);
    }
}
