//! What the words after `cargo xtask bench` mean.

use gz_app::error::AppError;

/// Which bench.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bench {
    /// The paper's two tables.
    Paper,
    /// The best (MAX_DEPTH, MIN_SIZE) against the tree that tunes itself.
    Grid,
    /// The tree against plain brute force in C, and ours.
    Brute,
    /// Time and memory against the number of triangles.
    Scale,
    /// Bytes, build time and speed for several settings of the builder.
    Front,
    /// The most memory that a render of many triangles takes.
    Memory,
    /// Equal answers over every scene of assets.
    Agree,
    /// Kernels and steps of the walk.
    Micro,
    /// The tree against the same walk in plain f32.
    Exactness,
}

/// What a bench was asked to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Which one.
    pub bench: Bench,
    /// Scenes in place of the bench's own.
    pub scenes: Vec<String>,
    /// Threads, 0 for all cores. One unless said.
    pub threads: usize,
    /// Rounds in which contenders take turns; `None` for the bench's own number.
    pub rounds: Option<usize>,
    /// At most this many rays of a scene, evenly spaced; `None` for all.
    pub rays: Option<usize>,
    /// At most this many triangles (`scale`); `None` for the bench's own limit.
    pub limit: Option<usize>,
    /// Whether the figures go to `docs/bench` too (`micro`, `exactness`).
    pub write: bool,
}

const USAGE: &str = "bench paper|grid|brute|scale|front|memory|agree|micro|exactness [--scene NAME|FILE|teapot:SEGMENTS|uneven] [--threads N] [--rounds N] [--rays N] [--limit TRIANGLES], micro and exactness [--write], or bench frames or peers";

impl Options {
    /// Reads the words.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for a word that means nothing.
    pub fn parse(words: &[String]) -> Result<Self, AppError> {
        let usage = |what: String| AppError::Usage(format!("{what}: use {USAGE}"));
        let mut words = words.iter();
        let bench = match words.next().map(String::as_str) {
            Some("paper") => Bench::Paper,
            Some("grid") => Bench::Grid,
            Some("brute") => Bench::Brute,
            Some("scale") => Bench::Scale,
            Some("front") => Bench::Front,
            Some("memory") => Bench::Memory,
            Some("agree") => Bench::Agree,
            Some("micro") => Bench::Micro,
            Some("exactness") => Bench::Exactness,
            Some(other) => return Err(usage(format!("there is no bench {other}"))),
            None => return Err(usage("no bench is named".to_owned())),
        };
        let mut options = Self { bench, scenes: Vec::new(), threads: 1, rounds: None, rays: None, limit: None, write: false };
        while let Some(option) = words.next() {
            if option == "--write" && matches!(bench, Bench::Micro | Bench::Exactness) {
                options.write = true;
                continue;
            }
            let value = words.next().ok_or_else(|| usage(format!("{option} has no value")))?;
            let number = || value.parse::<usize>().map_err(|_| usage(format!("{option} {value} is not a number")));
            let at_least_one =
                || number().and_then(|n| if n > 0 { Ok(n) } else { Err(usage(format!("{option} must be above 0"))) });
            match option.as_str() {
                "--scene" => options.scenes.push(value.clone()),
                "--threads" => options.threads = number()?,
                "--rounds" => options.rounds = Some(at_least_one()?),
                "--rays" => options.rays = Some(at_least_one()?),
                "--limit" => options.limit = Some(at_least_one()?),
                _ => return Err(usage(format!("there is no option {option}"))),
            }
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
        let options = parse("grid --rounds 7 --scene uneven --threads 2 --scene teapot:16").unwrap();
        assert_eq!((options.bench, options.threads, options.rounds), (Bench::Grid, 2, Some(7)));
        assert_eq!(options.scenes, ["uneven", "teapot:16"]);
        assert_eq!(parse("paper").unwrap().threads, 1);
        assert!(parse("micro --write --rounds 3").unwrap().write && parse("exactness --write").unwrap().write);
    }

    #[test]
    fn what_means_nothing_is_a_usage_error_in_one_line() {
        for bad in ["", "papers", "paper --rounds", "paper --rounds x", "paper --rounds 0", "paper --size 3", "paper --write"] {
            let error = parse(bad).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{bad}");
            assert!(!error.to_string().contains('\n'), "{bad}");
        }
    }
}
