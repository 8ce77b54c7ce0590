//! `cargo xtask seeds`: the seeds of the fuzz targets.
#![forbid(unsafe_code)]

use gz_tests::fuzz::seeds;
use std::process::ExitCode;

fn main() -> ExitCode {
    if let Some(argument) = std::env::args().nth(1) {
        eprintln!("seeds: expected nothing, not {argument}");
        return ExitCode::from(2);
    }
    match seeds::write() {
        Ok(count) => {
            println!("{count} seeds are written");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("seeds: {}: {error}", seeds::folder("").display());
            ExitCode::from(1)
        }
    }
}
