//! A whole frame beside POV-Ray and Mitsuba: `cargo xtask bench frames`.
//!
//! The scene is `tests/peers/frames/teapots.toml`; each renderer has it in its own words, with the triangles as we have placed them.

mod contender;
mod gz;
mod mitsuba;
mod options;
mod pixels;
mod povray;

use super::indexed::Indexed;
use super::memory;
use super::record::Record;
use super::table::lines;
use super::timing::{Ratio, machine, median};
use crate::row;
use contender::{Contender, Rays, Turn};
use gz::Gz;
use gz_app::compare;
use gz_app::error::AppError;
use gz_app::load::{self, Overrides};
use gz_app::picture::Picture;
use gz_shade::SceneNeeds;
use mitsuba::Mitsuba;
use options::Options;
use povray::Povray;
use std::path::Path;

/// Side of the picture that brute force renders too.
const CHECKED_SIDE: u32 = 96;
/// Rays by kind may be this far apart for times to be compared as they are.
const SAME_WORK: f64 = 0.1;
/// How many times faster than POV-Ray a frame is to be.
const GOAL: f64 = 40.0;

/// Does what `words` ask for, printing as it goes.
///
/// # Errors
///
/// Usage errors, a renderer that fails, and answers that differ from those of brute force.
pub fn run(words: &[String]) -> Result<(), AppError> {
    let options = Options::parse(words)?;
    let folder = options.dir.join("frames");
    std::fs::create_dir_all(&folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
    println!("{}", machine(options.threads[0]));
    let gz = Gz::new(&folder, options.depth)?;
    check(&gz, &folder, options.side)?;

    let teapots = teapots(gz.scene())?;
    let povray = Povray::new(&folder, options.depth, &teapots)?;
    if povray.is_none() {
        println!("POV-Ray: left out: there is no program povray (the Debian package of that name)");
    }
    let mitsuba = match Mitsuba::new(&options.dir, &folder, options.depth, &teapots) {
        Ok(mitsuba) => Some(mitsuba),
        Err(error) => {
            println!("Mitsuba: left out: {error}");
            None
        }
    };
    let contenders: Vec<&dyn Contender> = std::iter::once(&gz as &dyn Contender)
        .chain(povray.as_ref().map(|it| it as &dyn Contender))
        .chain(mitsuba.as_ref().map(|it| it as &dyn Contender))
        .collect();
    let race = Race::run(&contenders, &options)?;
    print!("{}", race.table(&options));
    let rays = gz.rays()?;
    if let Some(povray) = &povray {
        let theirs = povray.rays(options.side)?;
        print!("{}", ray_table(&rays, &theirs));
        print!("{}", race.verdict(&options, &rays, &theirs));
        println!("pictures: {}", apart(&gz.picture(), &povray.picture())?);
    }
    for contender in &contenders {
        println!("picture of {}: {}", contender.name(), contender.picture().display());
    }
    let growth = pixels::run(&gz, &options)?;
    if options.write {
        let settings = [format!("scene: tests/peers/frames/teapots.toml, depth {}", options.depth)];
        let record = Record::new("frames", options.rounds, &settings)?;
        record.write(HEAD, race.cells(options.side).chain(growth.iter().flat_map(pixels::Size::cells)))?;
    }
    Ok(())
}

/// Our own answers, before anything is timed.
fn check(gz: &Gz, folder: &Path, side: u32) -> Result<(), AppError> {
    let hits = folder.join("gz.hits");
    gz.with_hits(side, &hits)?;
    let overrides = Overrides { size: Some((side, side)), ..Overrides::default() };
    let (checked, differing, triangles) = memory::check(gz.scene(), &overrides, &hits)?;
    println!("{triangles} triangles; {checked} pixels' T-values checked by brute force, {differing} differ");
    if differing > 0 {
        return Err(AppError::Differs(format!("{differing} of {checked} T-values differ from those of brute force")));
    }
    gz.agrees_with_brute_force(CHECKED_SIDE)?;
    println!("the whole picture at {CHECKED_SIDE}x{CHECKED_SIDE} by brute force: 0 pixels differ");
    Ok(())
}

/// The teapots of the scene by material, as placed in world space.
fn teapots(scene: &Path) -> Result<Vec<(&'static str, Indexed)>, AppError> {
    let draft = load::scene(scene, &Overrides::default())?;
    let needs = SceneNeeds::of(&draft.scene);
    let scene = draft.place(needs)?;
    let of = |name: &str| {
        let is_of = |tri: &u32| scene.material(*tri).name == name;
        Indexed::of((0..scene.tris.len() as u32).filter(is_of).map(|tri| scene.tris.position(tri)))
    };
    Ok(["matte", "glass"].map(|name| (name, of(name))).to_vec())
}

/// Everybody's turns.
struct Race {
    entries: Vec<Entry>,
}

/// One contender with one number of threads.
struct Entry {
    name: String,
    threads: usize,
    turns: Vec<Turn>,
}

impl Entry {
    fn traces(&self) -> Vec<f64> {
        self.turns.iter().map(|turn| turn.trace).collect()
    }

    fn wholes(&self) -> Vec<f64> {
        self.turns.iter().map(|turn| turn.whole).collect()
    }
}

impl Race {
    /// Lets everybody have a turn with each number of threads in each round; who begins moves on.
    fn run(contenders: &[&dyn Contender], options: &Options) -> Result<Self, AppError> {
        let pairs = || options.threads.iter().flat_map(|&threads| contenders.iter().map(move |it| (*it, threads)));
        let mut entries: Vec<Entry> =
            pairs().map(|(it, threads)| Entry { name: it.name(), threads, turns: Vec::new() }).collect();
        let pairs: Vec<_> = pairs().collect();
        for round in 0..options.rounds {
            for turn in 0..pairs.len() {
                let k = (round + turn) % pairs.len();
                let (contender, threads) = pairs[k];
                entries[k].turns.push(contender.frame(threads, options.side)?);
            }
        }
        Ok(Self { entries })
    }

    fn find(&self, name: &str, threads: usize) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name == name && entry.threads == threads)
    }

    fn table(&self, options: &Options) -> String {
        let mut rows = vec![row![
            "renderer",
            "threads",
            "trace s",
            "process s",
            "gz traces faster by [95% interval]",
            "whole process by",
            "scaling of trace"
        ]];
        for entry in &self.entries {
            let ratio = |times: fn(&Entry) -> Vec<f64>| match self.find("gz", entry.threads) {
                Some(ours) if entry.name != "gz" => Ratio::of(&times(entry), &times(ours)).to_string(),
                _ => "-".to_owned(),
            };
            let first = self.find(&entry.name, options.threads[0]).filter(|first| first.threads != entry.threads);
            rows.push(row![
                entry.name,
                entry.threads,
                format!("{:.3}", median(&entry.traces())),
                format!("{:.3}", median(&entry.wholes())),
                ratio(Entry::traces),
                ratio(Entry::wholes),
                first.map_or_else(|| "-".to_owned(), |first| Ratio::of(&first.traces(), &entry.traces()).to_string()),
            ]);
        }
        let Options { side, depth, rounds, .. } = *options;
        format!(
            "\n{side}x{side}, one sample a pixel, {depth} bounces; medians of {rounds} rounds in turns. Trace: first ray to last \
             colour, by each one's own clock\n{}",
            lines(&rows)
        )
    }

    /// Whether the goal is reached on one thread, as it is or by rays.
    fn verdict(&self, options: &Options, ours: &Rays, theirs: &Rays) -> String {
        let povray = |entry: &&Entry| entry.name.starts_with("POV-Ray") && entry.threads == options.threads[0];
        let (Some(gz), Some(povray)) = (self.find("gz", options.threads[0]), self.entries.iter().find(povray)) else {
            return String::new();
        };
        let by_frame = Ratio::of(&povray.traces(), &gz.traces());
        let by_ray = by_frame.mean * ours.all() as f64 / theirs.all() as f64;
        let (how, ratio) = if ours.is_like(theirs) { ("per frame", by_frame.mean) } else { ("per ray", by_ray) };
        let verdict = if ratio >= GOAL { "reached" } else { "NOT reached" };
        format!(
            "against POV-Ray, {} threads: {by_frame} per frame, {by_ray:.2}x per ray; goal of {GOAL} times {how}: {verdict}\n",
            options.threads[0]
        )
    }

    fn cells(&self, side: u32) -> impl Iterator<Item = Vec<String>> + '_ {
        self.entries.iter().map(move |entry| {
            let all = |times: Vec<f64>| times.iter().map(|s| format!("{s:.6}")).collect::<Vec<_>>().join(" ");
            row![
                entry.name,
                entry.threads,
                side,
                format!("{:.6}", median(&entry.traces())),
                all(entry.traces()),
                all(entry.wholes())
            ]
        })
    }
}

/// Columns of the record.
const HEAD: &str = "renderer,threads,side,trace s median,trace s by round,process s by round";

impl Rays {
    /// Each kind's number as a share of the other's; none counts as equal to none.
    fn shares(&self, other: &Self) -> [f64; 3] {
        let share = |a: u64, b: u64| if a == b { 1.0 } else { a as f64 / b as f64 };
        [share(self.primary, other.primary), share(self.bounced, other.bounced), share(self.shadow, other.shadow)]
    }

    /// Whether no kind is more than a tenth apart.
    fn is_like(&self, other: &Self) -> bool {
        self.shares(other).iter().all(|share| (share - 1.0).abs() <= SAME_WORK)
    }
}

fn ray_table(ours: &Rays, theirs: &Rays) -> String {
    let mut rows = vec![row!["rays", "gz", "POV-Ray", "gz / POV-Ray"]];
    let mut add = |what: &str, a: u64, b: u64| rows.push(row![what, a, b, format!("{:.3}", a as f64 / b as f64)]);
    add("primary", ours.primary, theirs.primary);
    add("mirror and glass", ours.bounced, theirs.bounced);
    add("shadow", ours.shadow, theirs.shadow);
    add("all", ours.all(), theirs.all());
    add("questions for shadow rays", ours.shadow_questions, theirs.shadow_questions);
    let like = if ours.is_like(theirs) { "each kind within 10%: frames are compared" } else { "a kind is more than 10% apart" };
    format!("{}{like}\n", lines(&rows))
}

/// How far apart two pictures are, in one line.
fn apart(one: &Path, other: &Path) -> Result<String, AppError> {
    let difference = compare::pictures(&Picture::read(one)?, &Picture::read(other)?, 8.0).map_err(AppError::Io)?;
    let share = 100.0 * difference.over as f64 / difference.pixels.max(1) as f64;
    Ok(format!("{share:.2}% of the pixels of gz and POV-Ray are more than 8 of 255 apart, RMSE {:.2}", difference.rmse))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rays(primary: u64, bounced: u64, shadow: u64) -> Rays {
        Rays { primary, bounced, shadow, shadow_questions: 2 * shadow }
    }

    fn entry(name: &str, threads: usize, traces: &[f64]) -> Entry {
        let turns = traces.iter().map(|&trace| Turn { trace, whole: trace + 1.0 }).collect();
        Entry { name: name.to_owned(), threads, turns }
    }

    fn options() -> Options {
        Options::parse(&[]).unwrap()
    }

    #[test]
    fn work_within_a_tenth_is_the_same() {
        let ours = rays(100, 200, 300);
        assert!(ours.is_like(&rays(100, 190, 320)) && ours.is_like(&ours));
        assert!(!ours.is_like(&rays(100, 200, 400)));
        assert!(rays(1, 0, 0).is_like(&rays(1, 0, 0)));
        let table = ray_table(&ours, &rays(100, 200, 400));
        assert!(table.contains("0.750") && table.ends_with("a kind is more than 10% apart\n"), "{table}");
    }

    #[test]
    fn ratios_are_to_ours_on_as_many_threads_and_scaling_to_ones_own() {
        let entries = vec![
            entry("gz", 1, &[1.0, 1.0]),
            entry("POV-Ray 3.7", 1, &[50.0, 50.0]),
            entry("gz", 2, &[0.5, 0.5]),
            entry("POV-Ray 3.7", 2, &[30.0, 30.0]),
        ];
        let race = Race { entries };
        let table = race.table(&options());
        assert!(table.contains("50.00x") && table.contains("60.00x") && table.contains("2.00x [2.00, 2.00]"), "{table}");
        assert!(table.contains("1.67x"), "{table}");
        let like = race.verdict(&options(), &rays(1, 2, 3), &rays(1, 2, 3));
        assert!(like.ends_with("goal of 40 times per frame: reached\n"), "{like}");
        // Half the rays in the same time are half as fast.
        let fewer = race.verdict(&options(), &rays(1, 2, 3), &rays(2, 4, 6));
        assert!(fewer.contains("25.00x per ray") && fewer.ends_with("per ray: NOT reached\n"), "{fewer}");
        assert_eq!(race.cells(64).count(), 4);
    }

    #[test]
    fn the_scene_is_what_the_bench_says() {
        let teapots = teapots(&contender::source("teapots.toml")).unwrap();
        let count = |k: usize| teapots[k].1.triangles.len();
        assert_eq!((teapots[0].0, count(0), teapots[1].0, count(1)), ("matte", 16384, "glass", 16384));
    }

    #[test]
    fn the_other_scenes_have_the_same_numbers() {
        let read = |name: &str| std::fs::read_to_string(contender::source(name)).unwrap();
        let (toml, pov, py) = (read("teapots.toml"), read("teapots.pov"), read("teapots.py"));
        let is_place = |key: &str| ["position", "look_at", "direction"].contains(&key);
        let vectors: Vec<&str> =
            toml.lines().filter_map(|line| line.split_once(" = [")).filter(|(key, _)| is_place(key)).map(|(_, v)| v).collect();
        assert_eq!(vectors.len(), 5);
        for vector in vectors {
            let numbers = vector.trim_end_matches(']');
            assert!(pov.contains(&format!("<{numbers}>")) && py.contains(&format!("[{numbers}]")), "{numbers}");
        }
    }
}
