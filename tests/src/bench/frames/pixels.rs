//! The time of a frame against its pixels.

use super::contender::{Contender, Turn};
use super::options::Options;
use crate::bench::growth::Power;
use crate::bench::table::lines;
use crate::bench::timing::median;
use crate::row;
use gz_app::error::AppError;

/// Side of the smallest picture; each next has twice the side.
const FIRST: u32 = 256;
/// A picture that takes longer than this is rendered in the first round only.
const ONCE: f64 = 20.0;
/// Rounds, where the options ask for more.
const ROUNDS: usize = 3;

/// The turns of one size.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Size {
    side: u32,
    threads: usize,
    turns: Vec<Turn>,
}

impl Size {
    fn pixels(&self) -> f64 {
        f64::from(self.side) * f64::from(self.side)
    }

    fn trace(&self) -> f64 {
        median(&self.turns.iter().map(|turn| turn.trace).collect::<Vec<_>>())
    }

    /// Rows of the record.
    pub(super) fn cells(&self) -> impl Iterator<Item = Vec<String>> {
        let all = |time: fn(&Turn) -> f64| self.turns.iter().map(|t| format!("{:.6}", time(t))).collect::<Vec<_>>().join(" ");
        std::iter::once(row![
            "gz by pixels",
            self.threads,
            self.side,
            format!("{:.6}", self.trace()),
            all(|turn| turn.trace),
            all(|turn| turn.whole)
        ])
    }
}

/// Renders pictures of ever more pixels, in turns, on the first number of threads; prints how time grows.
///
/// # Errors
///
/// If the contender fails.
pub(super) fn run(contender: &dyn Contender, options: &Options) -> Result<Vec<Size>, AppError> {
    let (rounds, threads) = (options.rounds.min(ROUNDS), options.threads[0]);
    let mut sizes: Vec<Size> = sides(options.to).into_iter().map(|side| Size { side, threads, turns: Vec::new() }).collect();
    if sizes.len() < 2 {
        return Ok(Vec::new());
    }
    for round in 0..rounds {
        for size in &mut sizes {
            if round == 0 || size.trace() <= ONCE {
                size.turns.push(contender.frame(threads, size.side)?);
            }
        }
    }
    print!("{}", table(&sizes));
    Ok(sizes)
}

/// Sides of the pictures, up to `to`.
fn sides(to: u32) -> Vec<u32> {
    std::iter::successors(Some(FIRST), |side| side.checked_mul(2)).take_while(|&side| side <= to).collect()
}

fn table(sizes: &[Size]) -> String {
    let mut rows = vec![row!["side", "pixels", "trace s", "ns/pixel", "rounds"]];
    for size in sizes {
        let time = size.trace();
        let each = format!("{:.1}", time * 1e9 / size.pixels());
        rows.push(row![size.side, size.pixels(), format!("{time:.4}"), each, size.turns.len()]);
    }
    let (pixels, times): (Vec<f64>, Vec<f64>) = sizes.iter().map(|size| (size.pixels(), size.trace())).unzip();
    let fit = match Power::fit(&pixels, &times) {
        Some(Power { exponent, residual }) => {
            format!("time of a frame: pixels^{exponent:.3}, residual {:.1}%", 100.0 * residual)
        }
        None => "too few sizes for an exponent".to_owned(),
    };
    format!("\n{}{fit}\n", lines(&rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_double_up_to_the_largest() {
        assert_eq!(sides(4096), [256, 512, 1024, 2048, 4096]);
        assert_eq!((sides(1000), sides(0)), (vec![256, 512], vec![]));
    }

    #[test]
    fn time_in_proportion_to_pixels_has_exponent_1() {
        let size = |side: u32| {
            let trace = f64::from(side * side) * 1e-7;
            Size { side, threads: 1, turns: vec![Turn { trace, whole: trace }; 3] }
        };
        let table = table(&[size(256), size(512), size(1024)]);
        assert!(table.ends_with("time of a frame: pixels^1.000, residual 0.0%\n") && table.contains("100.0"), "{table}");
        assert_eq!(size(256).cells().next().unwrap()[..3], row!["gz by pixels", 1, 256]);
    }
}
