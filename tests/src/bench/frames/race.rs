//! Everybody's turns on the frame, and what they tell.

use super::contender::{Contender, Rays, Turn};
use super::options::Options;
use crate::bench::table::lines;
use crate::bench::timing::{Ratio, median};
use crate::row;
use gz_app::error::AppError;

/// Rays by kind may be this far apart for times to be compared as they are.
const SAME_WORK: f64 = 0.1;
/// How many times faster than POV-Ray a frame is to be.
const GOAL: f64 = 40.0;

/// Everybody's turns.
pub(super) struct Race {
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
    pub(super) fn run(contenders: &[&dyn Contender], options: &Options) -> Result<Self, AppError> {
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

    pub(super) fn table(&self, options: &Options) -> String {
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
    pub(super) fn verdict(&self, options: &Options, ours: &Rays, theirs: &Rays) -> String {
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

    pub(super) fn cells(&self, side: u32) -> impl Iterator<Item = Vec<String>> + '_ {
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

/// Rays by kind side by side.
pub(super) fn ray_table(ours: &Rays, theirs: &Rays) -> String {
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
}
