//! What the words after `cargo xtask report` mean.

use super::run::Mode;
use gz_app::error::AppError;
use std::path::PathBuf;

/// What is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// How much is measured.
    pub mode: Mode,
    /// Compare what is committed instead of measuring.
    pub check: bool,
    /// Measure sections again that are measured already.
    pub fresh: bool,
    /// Only these sections are measured; the others are taken as they are. All when empty.
    pub only: Vec<String>,
    /// What random inputs follow from.
    pub seed: u64,
    /// Let scenes use the course's data; the report then goes elsewhere unless a folder is named.
    pub course: bool,
    /// Where the report goes.
    pub folder: Option<PathBuf>,
}

const USAGE: &str = "report [--quick|--full] [--check] [--fresh] [--only SECTION] [--seed N] [--course] [--out FOLDER]";

impl Options {
    /// Reads the words.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for a word that means nothing.
    pub fn parse(words: &[String]) -> Result<Self, AppError> {
        let usage = |what: String| AppError::Usage(format!("{what}: use {USAGE}"));
        let mut options =
            Self { mode: Mode::Quick, check: false, fresh: false, only: Vec::new(), seed: 1, course: false, folder: None };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| usage(format!("{word} has no value")));
            match word.as_str() {
                "--quick" => options.mode = Mode::Quick,
                "--full" => options.mode = Mode::Full,
                "--check" => options.check = true,
                "--fresh" => options.fresh = true,
                "--course" => options.course = true,
                "--only" => options.only.push(value()?.clone()),
                "--out" => options.folder = Some(PathBuf::from(value()?)),
                "--seed" => {
                    let text = value()?;
                    options.seed = text.parse().map_err(|_| usage(format!("--seed {text} is not a number")))?;
                }
                _ => return Err(usage(format!("there is no option {word}"))),
            }
        }
        let sections = super::sections::all(true);
        let known = |id: &String| sections.iter().any(|section| section.id == id);
        if let Some(unknown) = options.only.iter().find(|id| !known(id)) {
            let names: Vec<&str> = sections.iter().map(|section| section.id).collect();
            return Err(usage(format!("there is no section {unknown}; there are {}", names.join(", "))));
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
        let options = parse("--seed 7 --full --only kernels --out a/b --fresh").unwrap();
        assert_eq!((options.mode, options.seed, options.fresh, options.check), (Mode::Full, 7, true, false));
        assert_eq!((options.only, options.folder), (vec!["kernels".to_owned()], Some(PathBuf::from("a/b"))));
        assert_eq!(parse("").unwrap().mode, Mode::Quick);
    }

    #[test]
    fn what_means_nothing_is_a_usage_error_in_one_line() {
        for bad in ["more", "--seed", "--seed x", "--only nothing", "--out"] {
            let error = parse(bad).unwrap_err();
            assert!(error.exit_code() == 2 && !error.to_string().contains('\n'), "{bad}: {error}");
        }
    }
}
