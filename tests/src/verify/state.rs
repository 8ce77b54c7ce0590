//! Counters that outlive a run, so that a long one can be stopped and go on.

use super::options::RayOptions;
use super::record::Record;
use crate::judge::Tally;
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use std::fmt::Write;

/// How far a run has come.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    /// What the numbers belong to: this very program, and the options that matter.
    key: String,
    /// Rounds done, a block of each class.
    pub(super) rounds: u64,
    /// A record a class.
    pub(super) records: Vec<Record>,
}

impl State {
    /// Nothing done yet.
    pub(super) fn new(options: &RayOptions, stride: u64) -> Self {
        let classes: Vec<&str> = options.classes.iter().map(|class| class.name()).collect();
        let key = format!(
            "verify rays, program {:016x}, seed {}, truth 1 in {stride}, {}",
            this_program(),
            options.seed,
            classes.join(" ")
        );
        Self { key, rounds: 0, records: vec![Record::default(); options.classes.len()] }
    }

    /// What is kept in the file, if it is of the same program and options; else this, which is nothing. Says which.
    pub(super) fn resumed(self, options: &RayOptions) -> (Self, String) {
        let Ok(text) = std::fs::read_to_string(&options.state) else { return (self, "a new run".to_owned()) };
        let name = options.state.display();
        match self.read(&text) {
            _ if options.fresh => (self, format!("a new run; what {name} holds is given up")),
            Some(kept) => {
                let rays: u64 = kept.records.iter().map(|record| record.rays).sum();
                (kept, format!("going on from {rays} rays of {name}"))
            }
            None => (self, format!("a new run: {name} is of another program or other options")),
        }
    }

    /// Keeps this, whole or not at all.
    pub(super) fn keep(&self, options: &RayOptions) -> Result<(), AppError> {
        if let Some(folder) = options.state.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
        }
        NewFile::at(&options.state)?.write(self.text().as_bytes())
    }

    fn text(&self) -> String {
        let mut text = format!("{}\nrounds {}\n", self.key, self.rounds);
        for record in &self.records {
            let numbers: Vec<String> = numbers(record).iter().map(u64::to_string).collect();
            let _ = writeln!(text, "{}", numbers.join(" ")); // writing to a string cannot fail
        }
        text
    }

    fn read(&self, text: &str) -> Option<Self> {
        let mut lines = text.lines();
        if lines.next()? != self.key {
            return None;
        }
        let rounds = lines.next()?.strip_prefix("rounds ")?.parse().ok()?;
        let record = |line: &str| {
            let numbers: Option<Vec<u64>> = line.split(' ').map(|word| word.parse().ok()).collect();
            of_numbers(&numbers?)
        };
        let records: Option<Vec<Record>> = lines.map(record).collect();
        let records = records.filter(|records| records.len() == self.records.len())?;
        Some(Self { key: self.key.clone(), rounds, records })
    }
}

/// Numbers of a tally in a file.
const A_TALLY: usize = 8;

fn tally_numbers(tally: &Tally) -> [u64; A_TALLY] {
    let Tally { rays, hits, false_hits, false_misses, triangles, t, weights, worst_t } = *tally;
    [rays, hits, false_hits, false_misses, triangles, t, weights, worst_t.into()]
}

fn numbers(record: &Record) -> Vec<u64> {
    let mut numbers = vec![record.rays, record.differing, record.midpoint, record.midpoint_differing];
    numbers.extend(tally_numbers(&record.product));
    numbers.extend(record.kernels.iter().flat_map(tally_numbers));
    numbers
}

fn of_numbers(numbers: &[u64]) -> Option<Record> {
    let tally = |numbers: &[u64]| -> Option<Tally> {
        let [rays, hits, false_hits, false_misses, triangles, t, weights, worst_t] = *numbers.first_chunk::<A_TALLY>()?;
        let worst_t = u32::try_from(worst_t).ok()?;
        Some(Tally { rays, hits, false_hits, false_misses, triangles, t, weights, worst_t })
    };
    let (counts, tallies) = numbers.split_first_chunk::<4>()?;
    let mut record =
        Record { rays: counts[0], differing: counts[1], midpoint: counts[2], midpoint_differing: counts[3], ..Record::default() };
    let (product, kernels) = tallies.split_first_chunk::<A_TALLY>()?;
    record.product = tally(product)?;
    if kernels.len() != record.kernels.len() * A_TALLY {
        return None;
    }
    for (kernel, numbers) in record.kernels.iter_mut().zip(kernels.chunks_exact(A_TALLY)) {
        *kernel = tally(numbers)?;
    }
    Some(record)
}

/// A number of this program's own bytes, by FNV-1a: counts of one build say nothing of another.
fn this_program() -> u64 {
    let bytes = std::env::current_exe().and_then(std::fs::read).unwrap_or_default();
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::Folder;

    #[test]
    fn counters_come_back_and_only_to_their_own_run() {
        let folder = Folder::new("state");
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        let options = RayOptions {
            state: folder.path().join("new/a.state"),
            ..RayOptions::parse(&words("--class edges --class grids")).unwrap()
        };
        let mut state = State::new(&options, 10);
        state.rounds = 7;
        for (k, record) in state.records.iter_mut().enumerate() {
            record.rays = 100 + k as u64;
            record.product.false_misses = 3;
            record.kernels[6].worst_t = u32::MAX;
        }
        state.keep(&options).unwrap();
        let fresh = || State::new(&options, 10);
        assert_eq!(fresh().resumed(&options).0, state);
        assert_eq!(State::new(&options, 11).resumed(&options).0.rounds, 0);
        let other = RayOptions { seed: 2, ..options.clone() };
        assert_eq!(State::new(&other, 10).resumed(&other).0.rounds, 0);
        assert_eq!(fresh().resumed(&RayOptions { fresh: true, ..options.clone() }).0.rounds, 0);
        // A file that is damaged is no run to go on from.
        std::fs::write(&options.state, "nonsense").unwrap();
        assert_eq!(fresh().resumed(&options).0.rounds, 0);
    }
}
