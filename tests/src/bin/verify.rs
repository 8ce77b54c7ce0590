//! `cargo xtask verify`: answers against the independent truth, pictures against the course's references, builds against each other.
#![forbid(unsafe_code)]

use gz_app::error::{AppError, LoadError};
use gz_tests::homework;
use gz_tests::verify::{RayOptions, SceneOptions, hashes, verify_rays, verify_scenes};
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "expected `homework`, `rays [options]`, `scene NAME|FILE|all [options]` or `hashes`";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let done = match words.split_first().map(|(first, rest)| (first.as_str(), rest)) {
        Some(("homework", [])) => verify_homework(),
        Some(("rays", rest)) => RayOptions::parse(rest).and_then(|options| verify_rays(&options)),
        Some(("scene", rest)) => SceneOptions::parse(rest).and_then(|options| verify_scenes(&options)),
        Some(("hashes", [])) => hashes().map(|hashes| hashes.iter().for_each(|hash| println!("{hash}"))),
        _ => Err(AppError::Usage(USAGE.to_owned())),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("verify: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn verify_homework() -> Result<(), AppError> {
    let data = homework::data_folder();
    let data = data.ok_or_else(|| LoadError::bad(Path::new("GZ_HW_DATA"), None, "set it to the folder of course data"))?;
    let rows = homework::table(&data)?;
    for row in &rows {
        let verdict = match (row.holds, row.required.is_empty()) {
            (_, true) => "    ",
            (true, _) => "ok  ",
            (false, _) => "FAIL",
        };
        let required = if row.required.is_empty() { String::new() } else { format!(" (required: {})", row.required) };
        println!("{verdict} {}: {}{required}", row.name, row.measured);
    }
    let failed = rows.iter().filter(|row| !row.holds).count();
    println!("{} of {} rows hold", rows.len() - failed, rows.len());
    if failed == 0 { Ok(()) } else { Err(AppError::Differs(format!("{failed} rows do not hold"))) }
}
