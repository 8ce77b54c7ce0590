//! `cargo xtask verify rays`: hard rays by the million.

use super::options::RayOptions;
use super::record::Record;
use super::state::State;
use super::tables;
use crate::hard::classes::RAYS;
use crate::hard::leaving::{Label, Outcome, run};
use gz_app::error::AppError;
use gz_core::SimdLevel;
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// Rounds between two looks at the clock: a block of each class, 1024 rays.
const AT_A_TIME: u64 = 64;

/// How often progress is told and counters are kept.
const EVERY: Duration = Duration::from_secs(10);

/// Cases of one piece of work.
const CASES_AT_A_TIME: u64 = 4096;

/// Asks hard rays, judges them, and prints what came of it.
///
/// # Errors
///
/// [`AppError::Differs`] if an answer is wrong, [`AppError::Io`] if the counters cannot be kept.
pub fn verify_rays(options: &RayOptions) -> Result<(), AppError> {
    gz_app::threads::with(options.threads, || {
        println!("seed {}, {} threads, {:?}", options.seed, rayon::current_num_threads(), SimdLevel::available());
        let records = classes(options)?;
        print!("{}\n{}\n", tables::classes(options, &records), tables::kernels(options, &records));
        let outcomes = leaving(options);
        print!("{}", tables::leaving(&outcomes));
        println!(
            "acne / light leaks; undecided: moving the start by a few roundings of f64 changes the exact answer, counted for no way"
        );
        let wrong = records.iter().filter(|record| !record.is_clean()).count() + outcomes.iter().filter(|o| !is_clean(o)).count();
        if wrong == 0 {
            return Ok(());
        }
        Err(AppError::Differs(format!("{wrong} classes or labels have wrong answers")))
    })
}

/// Nothing wrong, and at most 1 in a million undecided, but for hits exactly on edges.
fn is_clean((label, outcome): &(Label, Outcome)) -> bool {
    let decided = *label == Label::F5 || outcome.undecided * 1_000_000 <= outcome.cases;
    outcome.is_clean() && decided
}

/// One ray in so many is judged: at least as many as was asked for. An odd number has no factor in common with the rays of a block, so that
/// every place in a block has its turn.
fn stride(options: &RayOptions) -> u64 {
    (options.count / options.truth.max(1)).saturating_sub(1) | 1
}

fn classes(options: &RayOptions) -> Result<Vec<Record>, AppError> {
    let each = options.classes.len() as u64 * RAYS as u64;
    let rounds = options.count.div_ceil(each);
    let stride = stride(options);
    let (mut state, said) = State::new(options, stride).resumed(options);
    println!("{said}; {} rays in {rounds} rounds of {} classes, 1 in {stride} judged", rounds * each, options.classes.len());
    let (start, done_before) = (Instant::now(), state.rounds);
    let mut told = Instant::now();
    while state.rounds < rounds {
        let part = state.rounds..rounds.min(state.rounds + AT_A_TIME);
        let work: Vec<(usize, u64)> =
            part.clone().flat_map(|round| (0..options.classes.len()).map(move |class| (class, round))).collect();
        let found: Vec<Record> =
            work.par_iter().map(|&(class, round)| Record::of(options.classes[class], options.seed, round, stride)).collect();
        for ((class, round), record) in work.into_iter().zip(found) {
            if !record.is_clean() {
                eprintln!("wrong: class {}, seed {}, block {round}: {record:?}", options.classes[class].name(), options.seed);
            }
            state.records[class] += record;
        }
        state.rounds = part.end;
        if told.elapsed() >= EVERY || state.rounds == rounds {
            told = Instant::now();
            state.keep(options)?;
            let rate = ((state.rounds - done_before) * each) as f64 / start.elapsed().as_secs_f64();
            let wrong = state.records.iter().filter(|record| !record.is_clean()).count();
            let share = 100.0 * state.rounds as f64 / rounds as f64;
            eprintln!("{share:5.1} %  {} rays, {wrong} classes with wrong answers, {rate:.0} rays a second", state.rounds * each);
        }
    }
    Ok(state.records)
}

fn leaving(options: &RayOptions) -> Vec<(Label, Outcome)> {
    let of = |label: Label| {
        let pieces = options.cases.div_ceil(CASES_AT_A_TIME);
        let piece = |k: u64| {
            let seed = options.seed ^ ((label as u64 + 1) << 48) ^ (k << 8);
            run(label, seed, CASES_AT_A_TIME.min(options.cases - k * CASES_AT_A_TIME))
        };
        let found: Vec<Outcome> = (0..pieces).into_par_iter().map(piece).collect();
        let mut sum = Outcome::default();
        found.into_iter().for_each(|outcome| sum += outcome);
        (label, sum)
    };
    options.labels.iter().map(|&label| of(label)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::Folder;

    #[test]
    fn every_place_in_a_block_is_judged_in_its_turn() {
        let parse = |text: &str| RayOptions::parse(&text.split(' ').map(str::to_owned).collect::<Vec<_>>()).unwrap();
        for (words, expected) in [("--count 1e8", 99), ("--count 4e6", 3), ("--count 1e5", 1), ("--count 1e9 --truth 1e7", 99)] {
            assert_eq!(stride(&parse(words)), expected);
        }
        let mut judged = [false; RAYS];
        (0..99 * RAYS).step_by(99).for_each(|k| judged[k % RAYS] = true);
        assert!(judged.iter().all(|judged| *judged));
    }

    #[test]
    fn a_small_run_is_clean_and_goes_on_where_it_stopped() {
        let folder = Folder::new("verify-rays");
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        let options = RayOptions::parse(&words("--count 12000 --truth 600 --cases 64 --threads 2")).unwrap();
        let options = RayOptions { state: folder.path().join("a.state"), ..options };
        verify_rays(&options).unwrap();
        let kept = std::fs::read_to_string(&options.state).unwrap();
        assert!(kept.contains("rounds 2\n"), "{kept}");
        // A longer run with the same share of truth takes the first one's counts over.
        let longer = RayOptions { count: 30_000, truth: 1500, ..options.clone() };
        let records = classes(&longer).unwrap();
        assert!(records.iter().all(|record| record.rays == 3 * RAYS as u64 && record.is_clean()));
        let anew = classes(&RayOptions { fresh: true, ..longer }).unwrap();
        assert_eq!(records, anew);
    }
}
