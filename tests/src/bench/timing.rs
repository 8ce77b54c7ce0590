//! Taking turns, medians, and how sure a ratio is.

use gz_core::SimdLevel;
use std::time::Instant;

/// Seconds that `work` takes.
pub fn seconds<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let done = work();
    (start.elapsed().as_secs_f64(), done)
}

/// Times every contender once a round; which one begins moves on from round to round. Row `k` holds the seconds of contender `k`.
pub fn take_turns(rounds: usize, contenders: &mut [Box<dyn FnMut() + '_>]) -> Vec<Vec<f64>> {
    let n = contenders.len();
    let mut times = vec![Vec::with_capacity(rounds); n];
    for round in 0..rounds {
        for turn in 0..n {
            let k = (round + turn) % n;
            times[k].push(seconds(&mut contenders[k]).0);
        }
    }
    times
}

/// The middle value; the mean of both middle ones of an even number. NaN of nothing.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => (sorted[n / 2 - 1] + sorted[n / 2]) / 2.0,
    }
}

/// How many times longer one takes than another, with the 95% interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// The geometric mean of the rounds' ratios.
    pub mean: f64,
    /// Lower end of the interval; 0 for a single round.
    pub low: f64,
    /// Upper end; infinite for a single round.
    pub high: f64,
}

impl Ratio {
    /// Of paired rounds: `slow[i]` and `fast[i]` were measured in the same round.
    ///
    /// Logarithms of the rounds' ratios are averaged; the interval is Student's, for their number.
    pub fn of(slow: &[f64], fast: &[f64]) -> Self {
        let logs: Vec<f64> = slow.iter().zip(fast).map(|(s, f)| (s / f).ln()).collect();
        let n = logs.len() as f64;
        let mean = logs.iter().sum::<f64>() / n;
        if logs.len() < 2 {
            return Self { mean: mean.exp(), low: 0.0, high: f64::INFINITY };
        }
        let variance = logs.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
        let half = student_975(logs.len() - 1) * (variance / n).sqrt();
        Self { mean: mean.exp(), low: (mean - half).exp(), high: (mean + half).exp() }
    }
}

impl std::fmt::Display for Ratio {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Two decimals say nothing of a hundredth.
        let decimals = if self.mean < 0.1 { 4 } else { 2 };
        write!(f, "{:.decimals$}x [{:.decimals$}, {:.decimals$}]", self.mean, self.low, self.high)
    }
}

/// The 97.5% point of Student's distribution.
fn student_975(freedom: usize) -> f64 {
    const POINTS: [f64; 12] = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179];
    // Beyond the table 1.96 + 2.5 / n, which is above the true point by less than 1%.
    POINTS.get(freedom.max(1) - 1).copied().unwrap_or(1.96 + 2.5 / freedom as f64)
}

/// The machine and how it is used, in one line.
pub fn machine(threads: usize) -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let used = if threads == 0 { cores } else { threads };
    format!(
        "{}, {cores} hardware threads, {used} used, {:?}; times hold for this machine only, ratios are of paired rounds",
        cpu.as_deref().unwrap_or(std::env::consts::ARCH),
        SimdLevel::best()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_of_paired_rounds_ignores_what_both_share() {
        // The machine slows down threefold over the rounds; the ratio stays 2.
        let fast = [1.0, 1.5, 2.0, 3.0];
        let slow = fast.map(|t| 2.0 * t);
        let ratio = Ratio::of(&slow, &fast);
        assert!((ratio.mean - 2.0).abs() < 1e-12 && ratio.low > 1.999 && ratio.high < 2.001, "{ratio}");
        let noisy = Ratio::of(&[2.0, 3.0, 2.5, 2.2], &[1.0, 1.2, 1.1, 1.3]);
        assert!(noisy.low < noisy.mean && noisy.mean < noisy.high, "{noisy}");
        assert_eq!(Ratio::of(&[2.0], &[1.0]).to_string(), "2.00x [0.00, inf]");
        assert_eq!(Ratio::of(&[1.0, 1.0], &[256.0, 256.0]).to_string(), "0.0039x [0.0039, 0.0039]");
    }

    #[test]
    fn medians_are_in_the_middle() {
        assert_eq!((median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0, 2.0, 3.0])), (2.0, 2.5));
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn every_contender_has_a_turn_in_every_round() {
        let counts = std::cell::RefCell::new([0; 3]);
        let mut contenders: Vec<Box<dyn FnMut() + '_>> = (0..3usize)
            .map(|k| -> Box<dyn FnMut() + '_> {
                let counts = &counts;
                Box::new(move || counts.borrow_mut()[k] += 1)
            })
            .collect();
        let times = take_turns(4, &mut contenders);
        drop(contenders);
        assert_eq!((counts.into_inner(), times.len(), times[0].len()), ([4; 3], 3, 4));
    }
}
