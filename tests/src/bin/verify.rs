//! `cargo xtask verify`: measurements against references outside of the repository.
#![forbid(unsafe_code)]

use gz_tests::homework;
use std::process::ExitCode;

fn main() -> ExitCode {
    let what: Vec<String> = std::env::args().skip(1).collect();
    if what != ["homework"] {
        eprintln!("verify: expected `homework`");
        return ExitCode::from(2);
    }
    let Some(data) = homework::data_folder() else {
        eprintln!("verify: set GZ_HW_DATA to the folder of course data");
        return ExitCode::from(3);
    };
    let rows = match homework::table(&data) {
        Ok(rows) => rows,
        Err(error) => {
            eprintln!("verify: {error}");
            return ExitCode::from(3);
        }
    };
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
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::from(4) }
}
