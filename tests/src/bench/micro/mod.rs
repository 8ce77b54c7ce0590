//! Single kernels and steps of the walk, in nanoseconds: `cargo xtask bench micro`.
//!
//! Of the kernels only what gz-core offers to a tree is used, and of the tree only its question; so the figures outlive what is inside.
//! What stands beside is the test of Möller and Trumbore as anybody writes it, in f32 for one ray and one triangle.

mod kernels;
mod walk;

use super::options::Options;
use super::record::Record;
use super::scenes::bench_scene;
use super::table::lines;
use super::timing::{Ratio, median};
use crate::row;
use gz_app::error::AppError;
use gz_core::SimdLevel;
use kernels::Kernels;
use walk::Walk;

/// The scene, unless the options name another: 16 thousand triangles.
const SCENE: &str = "teapot:16";
/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 15;
/// Rays of the walk, evenly spaced over the picture.
const RAYS: usize = 1 << 16;

/// `cargo xtask bench micro`: on one scene or those named.
///
/// # Errors
///
/// If a scene cannot be loaded or an answer is wrong.
pub fn run(options: &Options) -> Result<(), AppError> {
    let scenes = if options.scenes.is_empty() { vec![SCENE.to_owned()] } else { options.scenes.clone() };
    let rounds = options.rounds.unwrap_or(ROUNDS);
    let mut cells = Vec::new();
    for name in &scenes {
        let scene = bench_scene(name)?;
        println!("\n{}: {} triangles; medians of {rounds} rounds in turns", scene.name, scene.tris.len());
        let kernels = Kernels::of(&scene.tris);
        kernels.check()?;
        let walk = Walk::of(&scene, options.rays.unwrap_or(RAYS));
        walk.check()?;
        let mut rows = kernels.time(rounds);
        rows.extend(walk.time(rounds));
        print!("{}", table(&rows));
        cells.extend(rows.iter().map(|row| row.cells(name)));
    }
    if options.write {
        let levels = format!("SIMD level: {:?}", SimdLevel::best());
        Record::new("micro", rounds, &[levels])?.write(HEAD, cells)?;
    }
    Ok(())
}

/// A line of the table.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    what: String,
    /// What is counted.
    unit: &'static str,
    /// How many of them a round has.
    count: f64,
    /// Seconds of each round.
    times: Vec<f64>,
    /// Seconds of the plain test for as many pairs, where that is the same work.
    plain: Vec<f64>,
}

/// Columns of the record.
const HEAD: &str = "scene,what,unit,count,ns median,ns by round,plain f32 ns by round";

impl Row {
    fn each(&self, times: &[f64]) -> f64 {
        median(times) * 1e9 / self.count
    }

    fn cells(&self, scene: &str) -> Vec<String> {
        let all =
            |times: &[f64]| times.iter().map(|time| format!("{:.3}", time * 1e9 / self.count)).collect::<Vec<_>>().join(" ");
        let each = format!("{:.3}", self.each(&self.times));
        row![scene, self.what, self.unit, self.count, each, all(&self.times), all(&self.plain)]
    }
}

fn table(rows: &[Row]) -> String {
    let mut lined = vec![row!["what", "ns", "a", "plain f32 takes [95% interval]"]];
    lined.extend(rows.iter().map(|row| {
        let ratio = match row.plain.is_empty() {
            true => "-".to_owned(),
            false => Ratio::of(&row.plain, &row.times).to_string(),
        };
        row![row.what, format!("{:.2}", row.each(&row.times)), row.unit, ratio]
    }));
    lines(&lined)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_stands_beside_what_does_the_same_work() {
        let row = |what: &str, times: [f64; 2], plain: &[f64]| Row {
            what: what.to_owned(),
            unit: "pair",
            count: 1000.0,
            times: times.to_vec(),
            plain: plain.to_vec(),
        };
        let rows = [row("plain", [4e-6, 4e-6], &[]), row("ours", [1e-6, 1e-6], &[4e-6, 4e-6])];
        let text = table(&rows);
        assert!(text.contains("4.00x [4.00, 4.00]") && text.contains("1.00  pair"), "{text}");
        assert_eq!(rows[1].cells("s"), row!["s", "ours", "pair", 1000, "1.000", "1.000 1.000", "4.000 4.000"]);
    }
}
