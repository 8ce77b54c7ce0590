//! What the words after `cargo xtask verify rays` and `verify scene` mean.

use crate::hard::classes::Class;
use crate::hard::leaving::Label;
use gz_app::error::AppError;
use std::path::PathBuf;

/// `verify rays`.
#[derive(Clone, Debug, PartialEq)]
pub struct RayOptions {
    /// Rays in all classes together, at least; whole blocks are asked.
    pub count: u64,
    /// Of these, rays asked of the truth and of the comparison kernels too.
    pub truth: u64,
    /// Cases of leaving a surface for each label.
    pub cases: u64,
    /// What everything follows from.
    pub seed: u64,
    /// Classes in place of all.
    pub classes: Vec<Class>,
    /// Labels in place of all.
    pub labels: Vec<Label>,
    /// Threads, 0 for all cores.
    pub threads: usize,
    /// Where the counters are kept between runs.
    pub state: PathBuf,
    /// Begin anew, whatever is kept.
    pub fresh: bool,
}

/// `verify scene`.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneOptions {
    /// Scene files, stems of `assets/scenes`, or all of them.
    pub scenes: Vec<String>,
    /// Picture size in place of the scene's.
    pub size: Option<(u32, u32)>,
    /// Threads for the truth, 0 for all cores.
    pub threads: usize,
}

const RAYS_USAGE: &str = "verify rays [--count N] [--truth N] [--cases N] [--seed N] [--class NAME] [--label F1] [--threads N] [--state FILE] [--fresh]";
const SCENE_USAGE: &str = "verify scene NAME|FILE|all [--size WxH] [--threads N]";

/// What is checked unless something else is said: a few minutes' worth.
const COUNT: u64 = 10_000_000;

impl RayOptions {
    /// Reads the words behind `verify rays`.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for a word that means nothing.
    pub fn parse(words: &[String]) -> Result<Self, AppError> {
        let usage = |what: String| AppError::Usage(format!("{what}: use {RAYS_USAGE}"));
        let (mut count, mut truth, mut cases) = (COUNT, None, None);
        let mut options = Self {
            count,
            truth: 0,
            cases: 0,
            seed: 1,
            classes: Vec::new(),
            labels: Vec::new(),
            threads: 0,
            state: PathBuf::new(),
            fresh: false,
        };
        let mut words = words.iter();
        while let Some(option) = words.next() {
            if option == "--fresh" {
                options.fresh = true;
                continue;
            }
            let value = words.next().ok_or_else(|| usage(format!("{option} has no value")))?;
            let number = || whole(value).ok_or_else(|| usage(format!("{option} {value} is not a whole number")));
            match option.as_str() {
                "--count" => count = number()?,
                "--truth" => truth = Some(number()?),
                "--cases" => cases = Some(number()?),
                "--seed" => options.seed = number()?,
                "--threads" => options.threads = number()? as usize,
                "--state" => options.state = PathBuf::from(value),
                "--class" => {
                    let class = Class::ALL.into_iter().find(|class| class.name() == value);
                    options.classes.push(class.ok_or_else(|| usage(format!("there is no class {value}: {}", class_names())))?);
                }
                "--label" => {
                    let label = Label::ALL.into_iter().find(|label| format!("{label:?}") == *value);
                    options.labels.push(label.ok_or_else(|| usage(format!("there is no label {value}: {}", label_names())))?);
                }
                _ => return Err(usage(format!("there is no option {option}"))),
            }
        }
        if options.classes.is_empty() {
            options.classes = Class::ALL.to_vec();
        }
        if options.labels.is_empty() {
            options.labels = Label::ALL.to_vec();
        }
        options.count = count;
        options.truth = truth.unwrap_or((count / 100).max(1_000_000)).min(count);
        options.cases = cases.unwrap_or((count / 100).clamp(10_000, 1_000_000));
        if options.state.as_os_str().is_empty() {
            options.state = PathBuf::from(format!("target/verify/rays-{}.state", options.seed));
        }
        Ok(options)
    }
}

impl SceneOptions {
    /// Reads the words behind `verify scene`.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for a word that means nothing, or when no scene is named.
    pub fn parse(words: &[String]) -> Result<Self, AppError> {
        let usage = |what: String| AppError::Usage(format!("{what}: use {SCENE_USAGE}"));
        let mut options = Self { scenes: Vec::new(), size: None, threads: 0 };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| usage(format!("{word} has no value")));
            match word.as_str() {
                "--size" => {
                    let text = value()?;
                    let size = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
                    options.size =
                        Some(size.filter(|(w, h)| *w > 0 && *h > 0).ok_or_else(|| usage(format!("--size {text} is not WxH")))?);
                }
                "--threads" => {
                    let text = value()?;
                    options.threads = text.parse().map_err(|_| usage(format!("--threads {text} is not a number")))?;
                }
                option if option.starts_with('-') => return Err(usage(format!("there is no option {option}"))),
                scene => options.scenes.push(scene.to_owned()),
            }
        }
        if options.scenes.is_empty() {
            return Err(usage("no scene is named".to_owned()));
        }
        Ok(options)
    }
}

/// `1000`, `1_000` or `1e3`.
fn whole(text: &str) -> Option<u64> {
    let plain: String = text.chars().filter(|c| *c != '_').collect();
    if let Ok(number) = plain.parse() {
        return Some(number);
    }
    let number: f64 = plain.parse().ok()?;
    ((0.0..=1e15).contains(&number) && number.fract() == 0.0).then_some(number as u64)
}

fn class_names() -> String {
    Class::ALL.map(Class::name).join(", ")
}

fn label_names() -> String {
    Label::ALL.map(|label| format!("{label:?}")).join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        text.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn counts_have_sensible_shares_of_truth() {
        let options = RayOptions::parse(&words("--count 1e8 --seed 7 --class edges --label F6")).unwrap();
        assert_eq!((options.count, options.truth, options.cases, options.seed), (100_000_000, 1_000_000, 1_000_000, 7));
        assert_eq!((options.classes, options.labels), (vec![Class::Edges], vec![Label::F6]));
        let options = RayOptions::parse(&words("--count 1_000")).unwrap();
        assert_eq!((options.truth, options.cases, options.classes.len()), (1000, 10_000, Class::ALL.len()));
        assert_eq!(RayOptions::parse(&words("--count 1e9 --truth 5e6")).unwrap().truth, 5_000_000);
    }

    #[test]
    fn what_means_nothing_is_a_usage_error_in_one_line() {
        for bad in ["--count", "--count x", "--count 1.5", "--count -1", "--class knots", "--label F99", "more"] {
            let error = RayOptions::parse(&words(bad)).unwrap_err();
            assert!(error.exit_code() == 2 && !error.to_string().contains('\n'), "{bad}: {error}");
        }
        for bad in ["", "--size 3 teapot", "teapot --size 0x4", "teapot --depth 3", "--threads x teapot"] {
            assert_eq!(SceneOptions::parse(&words(bad)).unwrap_err().exit_code(), 2, "{bad}");
        }
        let options = SceneOptions::parse(&words("teapot --size 40x30 a.toml")).unwrap();
        assert_eq!((options.scenes.len(), options.size), (2, Some((40, 30))));
    }
}
