//! What the words after `cargo xtask bench peers` mean.

use gz_app::error::AppError;
use std::path::PathBuf;

/// The sets of rays that a mesh has: five as `harness/make_rays.hpp` makes them, and the product's own.
pub(super) const SETS: [&str; 7] = ["primscan", "primtile", "shadow", "reflect", "random", "frame-shadow", "frame-reflect"];
/// Those that are raced unless the options say otherwise: all but the one that has the primary rays in another order.
const RACED: [&str; 6] = ["primtile", "shadow", "reflect", "random", "frame-shadow", "frame-reflect"];
/// The meshes, unless the options say otherwise.
pub(super) const MESHES: [&str; 4] = ["teapot1k", "teapot16k", "teapot260k", "dragon871k"];
/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 7;
/// More threads than this are not asked for.
const MAX_THREADS: usize = 256;

/// Where everything from outside is kept unless the options say otherwise.
pub(in crate::bench) fn workshop_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../target/peers")
}

/// What the bench was asked to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Options {
    /// Where competitors are built and meshes, rays and what is downloaded are kept.
    pub(super) dir: PathBuf,
    /// Meshes by name; empty for [`MESHES`], of which one that cannot be had is left out.
    pub(super) meshes: Vec<String>,
    /// Sets of rays.
    pub(super) sets: Vec<String>,
    /// Numbers of threads; empty for the bench's own.
    pub(super) threads: Vec<usize>,
    /// Rounds in which competitors take turns.
    pub(super) rounds: usize,
    /// Whether builds are timed in place of traces.
    pub(super) build: bool,
    /// Whether the figures go to `docs/bench` too.
    pub(super) write: bool,
}

const USAGE: &str = "bench peers [--mesh NAME|SCENE|FILE] [--set primscan|primtile|shadow|reflect|random|frame-shadow|frame-reflect] \
                     [--threads N] [--rounds N] [--build] [--dir DIR] [--write]";

impl Options {
    /// Reads the words. `--mesh`, `--set` and `--threads` may be repeated.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for a word that means nothing.
    pub(super) fn parse(words: &[String]) -> Result<Self, AppError> {
        let usage = |what: String| AppError::Usage(format!("{what}: use {USAGE}"));
        let dir = workshop_folder();
        let (meshes, sets, threads) = (Vec::new(), Vec::new(), Vec::new());
        let mut options = Self { dir, meshes, sets, threads, rounds: ROUNDS, build: false, write: false };
        let mut words = words.iter();
        while let Some(option) = words.next() {
            match option.as_str() {
                "--build" => options.build = true,
                "--write" => options.write = true,
                "--mesh" | "--set" | "--threads" | "--rounds" | "--dir" => {
                    let value = words.next().ok_or_else(|| usage(format!("{option} has no value")))?;
                    let number = || {
                        let number = value.parse::<usize>().ok().filter(|n| *n > 0);
                        number.ok_or_else(|| usage(format!("{option} {value} is not a number above 0")))
                    };
                    match option.as_str() {
                        "--mesh" => options.meshes.push(value.clone()),
                        "--set" if SETS.contains(&value.as_str()) => options.sets.push(value.clone()),
                        "--set" => return Err(usage(format!("there is no set {value}"))),
                        "--threads" => options.threads.push(number()?.min(MAX_THREADS)),
                        "--rounds" => options.rounds = number()?,
                        _ => options.dir = PathBuf::from(value),
                    }
                }
                _ => return Err(usage(format!("there is no option {option}"))),
            }
        }
        if options.build && !options.sets.is_empty() {
            return Err(usage("--build traces no set of rays".to_owned()));
        }
        if options.sets.is_empty() {
            options.sets = RACED.map(str::to_owned).to_vec();
        }
        Ok(options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Options, AppError> {
        Options::parse(&text.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn words_are_read_in_any_order() {
        let options = parse("--rounds 3 --mesh teapot:7 --set random --threads 2 --write --threads 1 --dir x").unwrap();
        assert_eq!((options.rounds, &options.threads[..], options.write, options.build), (3, &[2, 1][..], true, false));
        assert_eq!((&options.meshes[..], &options.sets[..]), (&["teapot:7".to_owned()][..], &["random".to_owned()][..]));
        assert_eq!(options.dir, PathBuf::from("x"));
        let plain = parse("").unwrap();
        assert_eq!((plain.sets.len(), plain.meshes.len(), plain.threads.len()), (6, 0, 0));
        assert!(plain.dir.ends_with("target/peers"));
    }

    #[test]
    fn what_means_nothing_is_a_usage_error_in_one_line() {
        for bad in ["teapot", "--set", "--set primary", "--rounds 0", "--threads x", "--build --set random", "--scene x"] {
            let error = parse(bad).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{bad}");
            assert!(!error.to_string().contains('\n'), "{bad}");
        }
    }
}
