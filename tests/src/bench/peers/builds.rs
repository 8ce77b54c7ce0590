//! Building: our tree against Embree's best, one process a build, in turns.

use super::meshes::Mesh;
use super::options::Options;
use super::workshop::{Workshop, settings};
use crate::bench::record::Record;
use crate::bench::table::lines;
use crate::bench::timing::{Ratio, machine, median};
use crate::row;
use gz_app::error::AppError;
use std::process::{Command, Stdio};

/// Numbers of threads, unless the options say otherwise.
const THREADS: [usize; 2] = [1, 2];
/// Bytes of a triangle in the triangle buffer, positions alone.
const BUFFER: f64 = 36.0;

/// One build.
#[derive(Clone, Debug, PartialEq)]
struct Build {
    seconds: f64,
    /// Bytes as the competitor counts them.
    bytes: f64,
    /// By how much resident memory has grown.
    grown: f64,
    /// By how much it had grown at most.
    peak: f64,
}

impl Build {
    /// The line that the race prints.
    fn parse(line: &str) -> Option<Self> {
        let numbers: Vec<f64> = line.split_whitespace().skip(1).map(str::parse).collect::<Result<_, _>>().ok()?;
        let [seconds, bytes, grown, peak] = numbers[..] else { return None };
        Some(Self { seconds, bytes, grown, peak })
    }
}

/// Builds all meshes and prints the table.
///
/// # Errors
///
/// If the race fails.
pub(super) fn run(workshop: &Workshop, options: &Options, meshes: &[Mesh]) -> Result<(), AppError> {
    let competitors = [format!("{}:default", workshop.ours.display()), format!("{}:1", workshop.embree.display())];
    let threads = if options.threads.is_empty() { THREADS.to_vec() } else { options.threads.clone() };
    println!("{}", machine(threads[0]));
    let head = "mesh,triangles,threads,gz s,Embree s,gz is faster by [95% interval],gz B/tri,with triangles,Embree B/tri,gz RSS/tri,Embree RSS/tri,gz peak/tri,Embree peak/tri";
    let mut rows = vec![head.split(',').map(str::to_owned).collect::<Vec<_>>()];
    let mut records = Vec::new();
    for mesh in meshes {
        for &threads in &threads {
            println!("{}, {threads} threads", mesh.name);
            let mut builds = [Vec::new(), Vec::new()];
            for round in 0..options.rounds {
                for turn in 0..2 {
                    let k = (round + turn) % 2;
                    builds[k].push(build(workshop, mesh, threads, &competitors[k])?);
                }
            }
            let seconds = builds.each_ref().map(|builds| builds.iter().map(|build| build.seconds).collect::<Vec<_>>());
            let per_triangle =
                |k: usize, of: fn(&Build) -> f64| median(&builds[k].iter().map(of).collect::<Vec<_>>()) / mesh.triangles as f64;
            let cell = |value: f64| format!("{value:.1}");
            let [bytes, grown, peak]: [fn(&Build) -> f64; 3] = [|b| b.bytes, |b| b.grown, |b| b.peak];
            let mut row = row![mesh.name, mesh.triangles, threads];
            row.extend(seconds.each_ref().map(|seconds| format!("{:.4}", median(seconds))));
            row.push(Ratio::of(&seconds[1], &seconds[0]).to_string());
            row.extend(row![cell(per_triangle(0, bytes)), cell(per_triangle(0, bytes) + BUFFER), cell(per_triangle(1, bytes))]);
            row.extend(row![cell(per_triangle(0, grown)), cell(per_triangle(1, grown))]);
            row.extend(row![cell(per_triangle(0, peak)), cell(per_triangle(1, peak))]);
            rows.push(row);
            for (name, builds) in ["gz:default", "embree4:1"].iter().zip(&builds) {
                records.extend(builds.iter().map(|b| {
                    row![mesh.name, mesh.triangles, threads, name, format!("{:.6}", b.seconds), b.bytes, b.grown, b.peak]
                }));
            }
        }
    }
    println!("\nmedians of {} builds, each alone in its process; Embree builds with its highest quality", options.rounds);
    print!("{}", lines(&rows));
    println!(
        "B/tri: as each counts its own, Embree with its copy of vertices and indices; RSS: growth of resident memory by the build"
    );
    if options.write {
        Record::new("peers-build", options.rounds, &settings())?
            .write("mesh,triangles,threads,competitor,seconds,bytes,RSS growth,peak growth", records)?;
    }
    Ok(())
}

fn build(workshop: &Workshop, mesh: &Mesh, threads: usize, competitor: &str) -> Result<Build, AppError> {
    let mut race = Command::new(&workshop.race);
    race.arg("build").arg(&mesh.path).arg(threads.to_string()).arg(competitor).stderr(Stdio::inherit());
    let output = race.output().map_err(|error| AppError::Io(format!("the race cannot be started: {error}")))?;
    match Build::parse(&String::from_utf8_lossy(&output.stdout)) {
        Some(build) if output.status.success() => Ok(build),
        _ => Err(AppError::Io(format!("the build of {competitor} failed"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_a_build_is_read() {
        let build = Build::parse("gz:default 0.25 1000 2000 3000\n").unwrap();
        assert_eq!(build, Build { seconds: 0.25, bytes: 1000.0, grown: 2000.0, peak: 3000.0 });
        assert_eq!((Build::parse(""), Build::parse("gz:default 1 2 3"), Build::parse("gz 1 2 x 4")), (None, None, None));
    }
}
