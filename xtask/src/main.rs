//! `cargo xtask TASK`: builds and starts the right program with the right arguments.
//!
//! Only the standard library is used, so that this builds in a second.
#![forbid(unsafe_code)]

mod bench;
mod ci;
mod golden;
mod lanes;
mod measure;
mod render;
mod report;
mod seeds;
mod verify;

use std::path::PathBuf;
use std::process::{Command, ExitCode};

/// A task: its name, what it takes, what it does, and the function behind it.
struct Task {
    name: &'static str,
    takes: &'static str,
    does: &'static str,
    run: fn(&[String]) -> Result<(), Failure>,
}

/// Why a task failed, and the exit code to end with.
struct Failure {
    message: String,
    code: u8,
}

const TASKS: [Task; 9] = [
    Task {
        name: "render",
        takes: "[NAME|FILE|all] [gz options]",
        does: "render a scene of assets/scenes, a scene file, or all scenes, into out/",
        run: render::run,
    },
    Task {
        name: "golden",
        takes: "[--bless]",
        does: "compare small renders with their references; --bless makes them the references",
        run: golden::run,
    },
    Task {
        name: "verify",
        takes: "rays|scene NAME|FILE|all|builds|homework",
        does: "hard rays and whole frames against an independent truth, builds against each other, pictures against the course's",
        run: verify::run,
    },
    Task {
        name: "measure",
        takes: "model [--write|--check] | needs",
        does: "what approximations cost, for docs/MODEL.md; what computed needs save",
        run: measure::run,
    },
    Task {
        name: "bench",
        takes: "paper|grid|brute|scale|front|memory|agree|micro|frames|peers",
        does: "measure: the paper's tables, the best of its trees, plain C, growth, others (see docs/BENCH.md)",
        run: bench::run,
    },
    Task {
        name: "report",
        takes: "[--quick|--full] [--check]",
        does: "speed against error, in one page: docs/report/index.html (see docs/REPORT.md)",
        run: report::run,
    },
    Task {
        name: "lanes",
        takes: "",
        does: "read the generated code of walk and shading: no kernel may be called that should be inlined",
        run: lanes::run,
    },
    Task {
        name: "seeds",
        takes: "",
        does: "write the hard cases that fuzzing starts from (see tests/fuzz/README.md)",
        run: seeds::run,
    },
    Task { name: "ci", takes: "", does: "format, clippy, docs and tests: what has to pass before a push", run: ci::run },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some((name, rest)) = arguments.split_first() else {
        print!("{}", list());
        return ExitCode::SUCCESS;
    };
    let Some(task) = TASKS.iter().find(|task| task.name == name) else {
        eprint!("xtask: there is no task {name}\n{}", list());
        return ExitCode::from(2);
    };
    match (task.run)(rest) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("xtask: {}", failure.message);
            ExitCode::from(failure.code)
        }
    }
}

fn list() -> String {
    let rows = TASKS.iter().map(|task| format!("  {:<8}{:<50}{}\n", task.name, task.takes, task.does));
    format!("cargo xtask TASK\n\n{}", rows.collect::<String>())
}

/// The folder of the workspace.
fn root() -> PathBuf {
    // Set by cargo when it starts us; xtask lies right below the workspace.
    let here = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from("xtask"), PathBuf::from);
    here.parent().map_or_else(|| PathBuf::from("."), PathBuf::from)
}

/// The cargo that started us, in the folder of the workspace.
fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// Runs `command` to its end. Its exit code becomes ours.
fn finish(command: &mut Command, what: &str) -> Result<(), Failure> {
    let status = command.status().map_err(|error| Failure { message: format!("{what} cannot be started: {error}"), code: 1 })?;
    if status.success() {
        return Ok(());
    }
    let code = status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1);
    Err(Failure { message: format!("{what} failed"), code })
}
