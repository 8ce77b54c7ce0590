//! `cargo xtask measure`: figures that the documentation holds, and figures of this machine.
#![forbid(unsafe_code)]

use gz_tests::rendered::scene_path;
use gz_tests::{model, needs_scenes, needs_time, scenes};
use std::process::ExitCode;

/// Why a measurement ended badly, and the exit code that says so.
struct Failure(String, u8);

const USAGE: &str = "expected `model`, `model --write`, `model --check` or `needs`";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["model"] => measure_model(What::Print),
        ["model", "--write"] => measure_model(What::Write),
        ["model", "--check"] => measure_model(What::Check),
        ["needs"] => measure_needs(),
        _ => Err(Failure(USAGE.to_owned(), 2)),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure(message, code)) => {
            eprintln!("measure: {message}");
            ExitCode::from(code)
        }
    }
}

/// What becomes of the tables.
#[derive(Clone, Copy, PartialEq, Eq)]
enum What {
    Print,
    /// Into the page, between its marks.
    Write,
    /// Compared with the page.
    Check,
}

fn measure_model(what: What) -> Result<(), Failure> {
    let tables = model::tables().map_err(|error| Failure(error.to_string(), 3))?;
    if what == What::Print {
        let text: Vec<String> = tables.iter().map(model::Table::markdown).collect();
        print!("{}", text.join("\n"));
        return Ok(());
    }
    let path = model::page_path();
    let named = |reason: String| format!("{}: {reason}", path.display());
    let page = std::fs::read_to_string(&path).map_err(|error| Failure(named(error.to_string()), 1))?;
    let new = model::with_tables(&page, &tables).map_err(|reason| Failure(named(reason), 3))?;
    if new == page {
        println!("{}: the tables are up to date", path.display());
        return Ok(());
    }
    if what == What::Check {
        return Err(Failure(named("the tables are stale: cargo xtask measure model --write".to_owned()), 4));
    }
    std::fs::write(&path, new).map_err(|error| Failure(named(error.to_string()), 1))?;
    println!("{}: the tables are written", path.display());
    Ok(())
}

fn measure_needs() -> Result<(), Failure> {
    const RUNS: usize = 7;
    println!("computed needs over all needs, 320x240, both in turn, median of {RUNS} runs; below 1 is time saved");
    println!("scene               needs  bytes/triangle  rays                 place  shade  whole, least to greatest");
    let folder = std::env::temp_dir().join(format!("gz-measure-{}", std::process::id()));
    let large = needs_scenes::write(&folder, "nothing, 230 k", &needs_scenes::plain_and_large())
        .map_err(|error| Failure(format!("{}: {error}", folder.display()), 1))?;
    let names = scenes::usable();
    for path in names.iter().map(|name| scene_path(name)).chain([large]) {
        let it = needs_time::saving(&path, RUNS).map_err(|error| Failure(error.to_string(), 3))?;
        println!(
            "{:<18}  {:>2}/10  {:>3} of {:<7}  {:>9}/{:<9}  {:>5.2}  {:>5.2}  {:.2} to {:.2}",
            it.name, it.needs, it.bytes[0], it.bytes[1], it.rays[0], it.rays[1], it.place, it.shade, it.spread[0], it.spread[1]
        );
    }
    // What is left in the temporary folder harms nobody.
    let _ = std::fs::remove_dir_all(&folder);
    Ok(())
}
