//! The folder in which competitors are built, and what building takes: a C++ compiler, Python with pip, cargo, the network.
//!
//! Below the folder: `build` (the race, embree4.so, rs_peers.so), `meshes`, `rays`, `venv` (Python with Embree's shared library and
//! numpy), `npm` (what is downloaded for meshes), `cargo` (our own library). What is there is not made again; the race itself and our
//! library are, when their sources are newer.

use crate::bench::record::first_line;
use crate::bench::tools::{Venv, answers, run};
use gz_app::error::AppError;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Python packages: Embree's shared library comes with the first.
const PACKAGES: [&str; 2] = ["embreex==4.4.0.post1", "numpy"];
/// The folder among the installed packages that has it.
const LIBRARIES: &str = "embreex.libs";

/// Competitors and the program that races them, ready to run.
#[derive(Debug)]
pub(super) struct Workshop {
    dir: PathBuf,
    /// The program that races competitors.
    pub(super) race: PathBuf,
    /// Our tree.
    pub(super) ours: PathBuf,
    /// Embree.
    pub(super) embree: PathBuf,
    /// obvhs and parry3d.
    pub(super) rivals: PathBuf,
}

impl Workshop {
    /// Builds in `dir` what is not there yet.
    ///
    /// # Errors
    ///
    /// [`AppError::Io`] in one line that says what is missing or failed.
    pub(super) fn open(dir: &Path) -> Result<Self, AppError> {
        if !cfg!(all(target_arch = "x86_64", target_os = "linux")) {
            return Err(AppError::Io("the peers bench needs Linux on x86-64: that is what Embree's wheel is for".to_owned()));
        }
        for part in ["build", "meshes", "rays"] {
            let folder = dir.join(part);
            std::fs::create_dir_all(&folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
        }
        let dir = dir.canonicalize().map_err(|error| AppError::Io(format!("{}: {error}", dir.display())))?;
        let build = dir.join("build");
        let this = Self {
            race: build.join("race"),
            ours: dir.join("cargo/release/libgz.so"),
            embree: build.join("embree4.so"),
            rivals: build.join("rs_peers.so"),
            dir,
        };
        this.require_tools()?;
        this.build_race()?;
        this.build_embree()?;
        this.build_ours()?;
        this.build_rivals()?;
        Ok(this)
    }

    /// The file `part/name` of the folder.
    pub(super) fn file(&self, part: &str, name: &str) -> PathBuf {
        self.dir.join(part).join(name)
    }

    /// Says what is missing before anything is begun.
    fn require_tools(&self) -> Result<(), AppError> {
        let needs_compiler = !self.embree.exists() || self.race_is_stale();
        if needs_compiler && compiler().is_none() {
            return Err(AppError::Io("the peers bench needs a C++ compiler: none of $CXX, c++, g++ and clang++ runs".to_owned()));
        }
        if !self.embree.exists() && !self.dir.join("venv").exists() && !answers("python3") {
            return Err(AppError::Io("the peers bench needs python3 with pip, for Embree's shared library".to_owned()));
        }
        Ok(())
    }

    fn race_is_stale(&self) -> bool {
        let made = modified(&self.race);
        let sources = std::fs::read_dir(peers("harness")).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
        made.is_none() || sources.filter_map(|path| modified(&path)).max() > made
    }

    fn build_race(&self) -> Result<(), AppError> {
        if !self.race_is_stale() {
            return Ok(());
        }
        println!("building the race");
        let mut command = compile(&self.race);
        command.arg(peers("harness/race.cpp")).args(["-ldl", "-lpthread"]);
        finish(&mut command, "the C++ compiler", &self.race)
    }

    fn build_embree(&self) -> Result<(), AppError> {
        if self.embree.exists() {
            return Ok(());
        }
        let library = self.embree_library()?;
        println!("building the competitor Embree");
        let mut command = compile(&self.embree);
        command.args(["-shared", "-fPIC"]).arg(peers("harness/embree.cpp")).arg(&library);
        if let Some(folder) = library.parent() {
            command.arg(format!("-Wl,-rpath,{}", folder.display()));
        }
        finish(&mut command, "the C++ compiler", &self.embree)
    }

    fn build_ours(&self) -> Result<(), AppError> {
        let mut command = cargo_build("plugin", &self.dir.join("cargo"));
        // As anybody builds the product: for no particular processor.
        command.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS");
        run(&mut command, "cargo build of our library")
    }

    fn build_rivals(&self) -> Result<(), AppError> {
        if self.rivals.exists() {
            return Ok(());
        }
        println!("building the competitors obvhs and parry3d");
        let target = self.dir.join("rivals");
        // At their best: for this very processor.
        let mut command = cargo_build("rivals", &target);
        run(command.env("RUSTFLAGS", "-C target-cpu=native"), "cargo build of obvhs and parry3d")?;
        let (made, part) = (target.join("release/librs_peers.so"), part_of(&self.rivals));
        let copied = std::fs::copy(&made, &part).and_then(|_| std::fs::rename(&part, &self.rivals));
        copied.map_err(|error| AppError::Io(format!("{}: {error}", self.rivals.display())))
    }

    /// The Python of the folder, which has Embree's wheel and numpy.
    ///
    /// # Errors
    ///
    /// If it cannot be made.
    pub(super) fn python(&self) -> Result<PathBuf, AppError> {
        Venv::of(&self.dir).with(&PACKAGES, LIBRARIES)
    }

    /// Embree's shared library, where the wheel has put it.
    fn embree_library(&self) -> Result<PathBuf, AppError> {
        self.python()?;
        let libraries = Venv::of(&self.dir).package(LIBRARIES).and_then(|folder| std::fs::read_dir(folder).ok());
        let mut libraries = libraries.into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
        let is_embree = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libembree4"));
        libraries.find(is_embree).ok_or_else(|| AppError::Io(format!("{} brought no libembree4", PACKAGES[0])))
    }
}

/// A file or folder of `tests/peers`.
pub(super) fn peers(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("peers").join(name)
}

/// The C++ compiler.
pub(super) fn compiler() -> Option<String> {
    let named = std::env::var("CXX").ok();
    named.into_iter().chain(["c++", "g++", "clang++"].map(str::to_owned)).find(|program| answers(program))
}

/// What the competitors are, for a record.
pub(super) fn settings() -> [String; 2] {
    [
        format!("C++: {}, -O3 -march=native", compiler().map_or_else(String::new, |cxx| first_line(&cxx, &["--version"]))),
        "gz: no target-cpu; obvhs 0.4.0 and parry3d 0.31.1: target-cpu=native; Embree of embreex 4.4.0".to_owned(),
    ]
}

/// The compiler's command for `product`, which [`finish`] puts in its place.
fn compile(product: &Path) -> Command {
    let mut command = Command::new(compiler().unwrap_or_else(|| "c++".to_owned()));
    command.args(["-O3", "-march=native", "-std=c++17", "-o"]).arg(part_of(product));
    command
}

/// Runs a compiler and renames what it made: a run that is stopped leaves no half a product, and one that runs keeps its own.
fn finish(command: &mut Command, what: &str, product: &Path) -> Result<(), AppError> {
    run(command, what)?;
    std::fs::rename(part_of(product), product).map_err(|error| AppError::Io(format!("{}: {error}", product.display())))
}

fn part_of(product: &Path) -> PathBuf {
    product.with_extension("part")
}

fn cargo_build(package: &str, target: &Path) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let manifest = peers(package).join("Cargo.toml");
    command.args(["build", "--quiet", "--release", "--locked", "--manifest-path"]).arg(manifest).arg("--target-dir").arg(target);
    command
}

fn modified(path: &Path) -> Option<std::time::SystemTime> {
    std::fs::metadata(path).ok()?.modified().ok()
}
