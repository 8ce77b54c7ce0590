//! Measurements behind `cargo xtask bench`: the paper's tables again, and what came after them.
//!
//! Every bench compares answers before it reports a time. Contenders take turns within each round, so that whatever else the
//! machine does falls on all of them; a ratio is formed within a round and comes with its 95% interval.

pub mod agree;
pub mod brute;
pub mod counted;
pub mod exactness;
pub mod frames;
pub mod front;
pub mod grid;
pub mod growth;
pub mod indexed;
pub mod memory;
pub mod micro;
pub mod options;
pub mod paper;
pub mod peers;
pub mod plain_c;
pub mod rays;
pub mod record;
pub mod recorder;
pub mod scale;
pub mod scenes;
pub mod table;
pub mod timing;
pub mod tools;

use gz_app::error::AppError;
use options::{Bench, Options};

/// Does the bench that `words` ask for, printing as it goes.
///
/// # Errors
///
/// Usage errors, scenes that cannot be loaded, and answers that differ.
pub fn run(words: &[String]) -> Result<(), AppError> {
    // These have other options, and programs of their own to time.
    match words.split_first() {
        Some((first, words)) if first == "peers" => return peers::run(words),
        Some((first, words)) if first == "frames" => return frames::run(words),
        _ => {}
    }
    let options = Options::parse(words)?;
    println!("{}", timing::machine(options.threads));
    // One pool for all of a bench: what it times never includes making threads.
    gz_app::threads::with(options.threads, || match options.bench {
        Bench::Paper => paper::run(&options),
        Bench::Grid => grid::run(&options),
        Bench::Brute => brute::run(&options),
        Bench::Scale => scale::run(&options),
        Bench::Front => front::run(&options),
        Bench::Memory => memory::run(&options),
        Bench::Agree => agree::run(&options),
        Bench::Micro => micro::run(&options),
        Bench::Exactness => exactness::run(&options),
    })
}
