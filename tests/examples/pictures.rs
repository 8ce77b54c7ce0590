//! Writes the pictures of failures beside their cures, and of a Z-buffer beside the T-value buffer of its view, into a folder:
//! `cargo run --release -p gz-tests --example pictures -- out [WIDTH]`.
#![forbid(unsafe_code)]

use gz_app::error::AppError;
use gz_tests::failures;
use gz_tests::z_buffer::teapot_view;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (folder, width) = match &words[..] {
        [folder] => (folder, Some(320)),
        [folder, width] => (folder, width.parse().ok().filter(|n| (16..=4096).contains(n))),
        _ => (&String::new(), None),
    };
    let done = match width {
        Some(width) => write_all(Path::new(folder), width),
        None => Err(AppError::Usage("expected a folder, and a width from 16 to 4096".to_owned())),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("pictures: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn write_all(folder: &Path, width: u32) -> Result<(), AppError> {
    let write = |name: String, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).map_err(|error| AppError::Io(format!("{}: {error}", path.display())))
    };
    std::fs::create_dir_all(folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
    for failure in failures::all(width)? {
        write(format!("{}-wrong.png", failure.name), &failure.wrong.png()?)?;
        write(format!("{}-cure.png", failure.name), &failure.cure.png()?)?;
        println!("{}: {} pixels differ", failure.name, failure.differing());
    }
    let view = teapot_view(width)?;
    for (name, shot) in [("z", view.z_shot()), ("t", view.t_shot()), ("z-t", view.difference_shot())] {
        write(format!("{name}-buffer.png"), &shot.png()?)?;
    }
    println!("Z-buffer and T-value buffer: {:?}", view.difference());
    Ok(())
}
