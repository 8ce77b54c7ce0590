//! What the words after `cargo xtask bench frames` mean.

use crate::bench::peers::workshop_folder;
use gz_app::error::AppError;
use std::path::PathBuf;

/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 5;
/// Side of the picture, unless the options say otherwise.
const SIDE: u32 = 1024;
/// Side of the largest picture whose time is set against its pixels.
const LARGEST: u32 = 4096;
/// Mirror and glass bounces, unless the options say otherwise.
const DEPTH: u32 = 3;
/// What gz itself takes, and more threads than anybody asks for.
const MOST: [u64; 3] = [65535, 32, 256];

/// What the bench was asked to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Options {
    /// Where pictures and Mitsuba are kept.
    pub(super) dir: PathBuf,
    /// Numbers of threads; each contender has a turn with each.
    pub(super) threads: Vec<usize>,
    /// Rounds in which contenders take turns.
    pub(super) rounds: usize,
    /// Side of the picture in pixels.
    pub(super) side: u32,
    /// Side of the largest picture of the growth; below 512 there is none.
    pub(super) to: u32,
    /// Mirror and glass bounces.
    pub(super) depth: u32,
    /// Whether the figures go to `docs/bench` too.
    pub(super) write: bool,
}

const USAGE: &str = "bench frames [--threads N] [--rounds N] [--side PIXELS] [--to PIXELS] [--depth N] [--dir DIR] [--write]";

impl Options {
    /// Reads the words. `--threads` may be repeated.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for a word that means nothing.
    pub(super) fn parse(words: &[String]) -> Result<Self, AppError> {
        let usage = |what: String| AppError::Usage(format!("{what}: use {USAGE}"));
        let (dir, threads) = (workshop_folder(), Vec::new());
        let mut options = Self { dir, threads, rounds: ROUNDS, side: SIDE, to: LARGEST, depth: DEPTH, write: false };
        let mut words = words.iter();
        while let Some(option) = words.next() {
            if option == "--write" {
                options.write = true;
                continue;
            }
            if !["--threads", "--rounds", "--side", "--to", "--depth", "--dir"].contains(&option.as_str()) {
                return Err(usage(format!("there is no option {option}")));
            }
            let value = words.next().ok_or_else(|| usage(format!("{option} has no value")))?;
            let number = |least: u64, most: u64| {
                let number = value.parse::<u64>().ok().filter(|n| (least..=most).contains(n));
                number.ok_or_else(|| usage(format!("{option} {value} is not a number from {least} to {most}")))
            };
            let [side, depth, threads] = MOST;
            match option.as_str() {
                "--threads" => options.threads.push(number(1, threads)? as usize),
                "--rounds" => options.rounds = number(1, 1000)? as usize,
                "--side" => options.side = number(1, side)? as u32,
                "--to" => options.to = number(0, side)? as u32,
                "--depth" => options.depth = number(0, depth)? as u32,
                _ => options.dir = PathBuf::from(value),
            }
        }
        if options.threads.is_empty() {
            options.threads = vec![1, 2];
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
        let options = parse("--to 0 --threads 2 --write --side 64 --threads 1 --rounds 3 --dir x --depth 2").unwrap();
        assert_eq!((options.to, options.side, options.rounds, options.depth, options.write), (0, 64, 3, 2, true));
        assert_eq!((&options.threads[..], options.dir), (&[2, 1][..], PathBuf::from("x")));
        let plain = parse("").unwrap();
        assert_eq!((&plain.threads[..], plain.side, plain.depth, plain.write), (&[1, 2][..], 1024, 3, false));
        assert!(plain.dir.ends_with("target/peers"));
    }

    #[test]
    fn what_means_nothing_is_a_usage_error_in_one_line() {
        for bad in ["teapot", "--side", "--side 0", "--side 70000", "--rounds 0", "--threads 0", "--depth 33", "--mesh x"] {
            let error = parse(bad).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{bad}");
            assert!(!error.to_string().contains('\n'), "{bad}");
        }
    }
}
