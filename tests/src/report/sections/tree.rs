//! The paper's tree over the grid that its two tables are lines of, beside brute force and the tree that tunes itself.

use crate::bench::counted::{brute_tests, visits_and_answers};
use crate::bench::paper::{PUBLISHED, PUBLISHED_BRUTE, timed};
use crate::bench::rays::{Answer, RaySet, answers, differing};
use crate::bench::scenes::{PAPER, bench_scene};
use crate::bench::timing::{median, seconds, take_turns};
use crate::cells;
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Cell, Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_bsp::{BspTree, CostStats, Midpoint, MidpointTree, TreeStats};
use gz_core::{BruteForce, Kernel, RayQuery, TriBuffer};
use rayon::prelude::*;

/// MAX_DEPTH and MIN_SIZE of the paper's tables.
const DEPTHS: [u32; 6] = [5, 8, 10, 12, 15, 20];
const SIZES: [usize; 6] = [3, 5, 10, 15, 20, 30];

const COLUMNS: [Column; 21] = [
    Column::new("tree", "tree", "", Kind::Label),
    Column::new("by_size", "MIN_SIZE line", "", Kind::Note),
    Column::new("by_depth", "MAX_DEPTH line", "", Kind::Note),
    Column::new("max_depth", "MAX_DEPTH", "", Kind::Count),
    Column::new("min_size", "MIN_SIZE", "", Kind::Count),
    Column::new("nodes", "nodes", "", Kind::Count),
    Column::new("leaves", "leaves", "", Kind::Count),
    Column::new("empty", "empty leaves", "", Kind::Count),
    Column::new("references", "references", "", Kind::Count),
    Column::new("largest", "largest leaf", "triangles", Kind::Count),
    Column::new("kb", "memory", "kB", Kind::Figure),
    Column::new("nodes_per_ray", "nodes", "per ray", Kind::Figure),
    Column::new("tests_per_ray", "tests", "per ray", Kind::Figure),
    Column::new("fewer", "fewer tests", "×", Kind::Figure),
    Column::new("build_ms", "build", "ms", Kind::Time),
    Column::new("trace_ms", "trace", "ms/frame", Kind::Time),
    Column::new("speedup", "speed-up", "× plain brute", Kind::Time),
    Column::new("paper_ms", "paper", "ms", Kind::Figure),
    Column::new("paper_speedup", "paper speed-up", "×", Kind::Figure),
    Column::new("wrong", "wrong", "answers", Kind::Count),
    Column::new("bound_per_1e9", "wrong below, at 95%", "per 10⁹", Kind::Figure),
];

const X_DEPTH: Axis = Axis { column: "max_depth", title: "MAX_DEPTH →", scale: Scale::Linear };
const Y_TIME: Axis = Axis { column: "trace_ms", title: "↑ ms to trace the frame", scale: Scale::Log };
const LINES: Drawn = Drawn::Points { x: X_DEPTH, y: Y_TIME, series: "by_size", label: "", joined: true, zeros: "" };

const CHARTS: [ChartSpec; 4] = [
    ChartSpec {
        title: "MAX_DEPTH: deeper is faster, up to a point",
        caption: "The paper's first table is the line of MIN_SIZE 10. Below depth 12 the depth decides alone; beyond, MIN_SIZE does.",
        only: ("", ""),
        drawn: LINES,
    },
    ChartSpec {
        title: "MIN_SIZE: smaller leaves pay once the tree may be deep enough",
        caption: "The paper's second table is the line of MAX_DEPTH 15.",
        only: ("", ""),
        drawn: Drawn::Points {
            x: Axis { column: "min_size", title: "MIN_SIZE →", scale: Scale::Linear },
            y: Y_TIME,
            series: "by_depth",
            label: "",
            joined: true,
            zeros: "",
        },
    },
    ChartSpec {
        title: "The paper's speed-ups beside ours",
        caption: "Each point is a row of its tables: what it gained over its brute force, and what the same setting gains here over the \
                  same test. Its settings rank the same on another machine; what differs is how much a test in f64 and a step of the \
                  walk cost beside a test in f32.",
        only: ("", ""),
        drawn: Drawn::Points {
            x: Axis { column: "paper_speedup", title: "the paper's speed-up →", scale: Scale::Log },
            y: Axis { column: "speedup", title: "↑ speed-up here", scale: Scale::Log },
            series: "",
            label: "tree",
            joined: false,
            zeros: "",
        },
    },
    ChartSpec {
        title: "Memory against time: where the front lies",
        caption: "Down and to the left is better. The tree that tunes itself has its own walk with SIMD, so that its place shows both \
                  its planes and that walk; tests and nodes a ray, which do not depend on the walk, are in the table.",
        only: ("", ""),
        drawn: Drawn::Points {
            x: Axis { column: "kb", title: "kB beyond the triangles →", scale: Scale::Log },
            y: Y_TIME,
            series: "by_size",
            label: "tree",
            joined: false,
            zeros: "",
        },
    },
];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "tree",
    chapter: Chapter::Tree,
    title: "The paper's whole grid",
    how: "The paper's scene (our stand-in, which gives its tree sizes and tests a ray to the digit) at 256 by 256 with the rays of the \
          paper's program: primary rays, three shadow rays a hit, mirror rays; 196 043 in all, every one asked for the front-most hit. \
          Errors and counts are of evenly spaced rays, n of them, against exact brute force. Times, in a run of their own: one thread, in \
          turns; slow settings trace as many rays as time allows and are scaled to the frame. <i>Plain brute force</i> is the paper's test \
          in f32 on every triangle.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |_| Ok(labels()),
    measure,
    says,
};

fn settings() -> Vec<Midpoint> {
    let of = |(max_depth, min_size)| Midpoint { max_depth, min_size, ..Midpoint::default() };
    DEPTHS.into_iter().flat_map(|max_depth| SIZES.map(|min_size| (max_depth, min_size))).map(of).collect()
}

fn name(setting: &Midpoint) -> String {
    format!("({}, {})", setting.max_depth, setting.min_size)
}

const PLAIN: &str = "plain brute force";
const OURS: &str = "ours, brute force";
const TUNED: &str = "self-tuned";

fn labels() -> Vec<String> {
    [PLAIN, OURS].into_iter().map(str::to_owned).chain(settings().iter().map(name)).chain([TUNED.to_owned()]).collect()
}

fn built(tris: &TriBuffer, setting: Midpoint) -> Result<MidpointTree<'_>, AppError> {
    MidpointTree::build(tris, setting).map_err(|error| AppError::Usage(error.to_string()))
}

/// What does not depend on the machine.
struct Counts {
    /// The columns from nodes to tests a ray.
    cells: Vec<Cell>,
    tests: f64,
    wrong: u64,
}

/// The error run of one setting.
fn counts(tris: &TriBuffer, rays: &RaySet, truth: &[Answer], setting: Midpoint) -> Result<Counts, AppError> {
    let tree = built(tris, setting)?;
    let TreeStats { nodes, leaves, empty_leaves, references, largest_leaf, bytes, .. } = TreeStats::of(&tree);
    let (visits, found) = visits_and_answers(&tree, rays);
    let cells = cells![nodes, leaves, empty_leaves, references, largest_leaf, bytes as f64 / 1e3, visits.nodes, visits.tests];
    Ok(Counts { cells, tests: visits.tests, wrong: differing(truth, &found) })
}

/// The error run of the tree that tunes itself, asked ray by ray and in batches.
fn tuned_counts(tris: &TriBuffer, rays: &RaySet, truth: &[Answer]) -> Counts {
    let tree = BspTree::build(tris);
    let CostStats { nodes, leaves, references, largest_leaf, bytes, .. } = CostStats::of(&tree);
    let (visits, found) = visits_and_answers(&tree, rays);
    let cells = cells![
        nodes,
        leaves,
        Cell::Missing,
        references,
        largest_leaf,
        bytes as f64 / 1e3,
        visits.nodes,
        // Eight triangles are looked at in each group.
        8.0 * visits.groups
    ];
    let wrong = differing(truth, &found) + differing(truth, &answers(&tree, rays));
    Counts { cells, tests: 8.0 * visits.groups, wrong }
}

/// The timing run: seconds to build and to trace all of `rays`, for plain and our brute force, the settings and the tree that tunes itself.
/// `tests`: what a ray costs about, for how many rays there is time.
fn times(tris: &TriBuffer, rays: &RaySet, tests: &[f64], budget: f64, rounds: usize) -> Result<Vec<(f64, f64)>, AppError> {
    let (plain, ours) = (BruteForce::with_kernel(tris, Kernel::Plane), BruteForce::new(tris));
    let trees = settings().into_iter().map(|setting| built(tris, setting)).collect::<Result<Vec<_>, _>>()?;
    let tuned = BspTree::build(tris);
    let queries: Vec<&dyn RayQuery> = [&plain as &dyn RayQuery, &ours]
        .into_iter()
        .chain(trees.iter().map(|tree| tree as &dyn RayQuery))
        .chain([&tuned as &dyn RayQuery])
        .collect();
    let parts: Vec<RaySet> = tests.iter().map(|tests| rays.sample((budget / tests.max(1.0)) as usize)).collect();
    let mut turns: Vec<_> = queries.iter().zip(&parts).map(|(query, part)| timed(*query, part)).collect();
    let traces = take_turns(rounds, &mut turns);
    drop(turns);
    let build = |k: usize| -> f64 {
        let once = || match k {
            0 => 0.0,
            1 => seconds(|| BruteForce::new(tris)).0,
            _ if k < queries.len() - 1 => seconds(|| built(tris, settings()[k - 2])).0,
            _ => seconds(|| BspTree::build(tris)).0,
        };
        median(&(0..rounds).map(|_| once()).collect::<Vec<_>>())
    };
    let scale = |part: &RaySet| rays.len() as f64 / part.len().max(1) as f64;
    Ok(traces.iter().zip(&parts).enumerate().map(|(k, (times, part))| (build(k), median(times) * scale(part))).collect())
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let scene = bench_scene(PAPER)?;
    let (tris, all) = (&scene.tris, scene.rays.as_closest());
    let rays = all.sample(run.size(300, 30_000, usize::MAX));
    let truth = answers(&BruteForce::new(tris), &rays);
    let mut found =
        settings().into_par_iter().map(|setting| counts(tris, &rays, &truth, setting)).collect::<Result<Vec<_>, _>>()?;
    found.push(tuned_counts(tris, &rays, &truth));
    run.progress.say("  tree: errors counted, now times");

    let every = brute_tests(tris.len(), &all);
    // A test of the filter costs an eighth or less of a plain one.
    let tests: Vec<f64> = [every, every / 8.0].into_iter().chain(found.iter().map(|counts| counts.tests)).collect();
    let budget = run.size(2e4, 1.5e6, 2e7);
    let times = gz_app::threads::with(1, || times(tris, &all, &tests, budget, run.rounds()))?;
    let plain_time = times[0].1;
    let settings_text = format!(
        "{}; {} rays for errors, {} for times, {} rounds, 1 thread",
        run.mode.name(),
        rays.len(),
        all.len(),
        run.rounds()
    );
    let n = rays.len() as u64;
    let row = |name: String, setting: Option<Midpoint>, counts: Option<&Counts>, (build, trace): (f64, f64)| {
        let published = setting.and_then(|it| PUBLISHED.iter().find(|(d, s, _)| (*d, *s) == (it.max_depth, it.min_size)));
        let ms = if name == PLAIN { Some(PUBLISHED_BRUTE) } else { published.map(|(.., ms)| *ms) };
        let mut cells = cells![
            name.as_str(),
            setting.map_or_else(|| name.clone(), |it| format!("MIN_SIZE {}", it.min_size)),
            setting.map_or_else(|| name.clone(), |it| format!("MAX_DEPTH {}", it.max_depth)),
            setting.map(|it| it.max_depth),
            setting.map(|it| it.min_size),
        ];
        match counts {
            Some(counts) => cells.extend(counts.cells.iter().cloned()),
            None => {
                cells.extend(vec![Cell::Missing; 7]);
                cells.push(every.into());
            }
        }
        let tests = counts.map_or(every, |counts| counts.tests);
        let wrong = counts.map(|counts| counts.wrong);
        cells.extend(cells![
            every / tests,
            build * 1e3,
            trace * 1e3,
            plain_time / trace,
            ms,
            ms.map(|ms| PUBLISHED_BRUTE / ms),
            wrong,
            wrong.filter(|wrong| *wrong == 0).map(|_| 3e9 / n as f64),
        ]);
        Row { cells, n, settings: settings_text.clone() }
    };
    let mut rows = vec![row(PLAIN.to_owned(), None, None, times[0]), row(OURS.to_owned(), None, None, times[1])];
    for ((setting, counts), times) in settings().into_iter().zip(&found).zip(&times[2..]) {
        rows.push(row(name(&setting), Some(setting), Some(counts), *times));
    }
    rows.push(row(TUNED.to_owned(), None, found.last(), times[times.len() - 1]));
    Ok(Measured { rows, pictures: Vec::new() })
}

/// The fastest of the paper's settings, by row.
pub(in crate::report) fn fastest(table: &Table) -> Option<usize> {
    let time = |row: &usize| table.number(*row, "trace_ms").unwrap_or(f64::INFINITY);
    let rows = (0..table.rows.len()).filter(|&row| table.number(row, "max_depth").is_some());
    rows.min_by(|a, b| time(a).total_cmp(&time(b)))
}

/// How alike two rankings of the same rows are: Spearman's coefficient, 1 for equal, -1 for opposite ones.
fn rank_correlation(pairs: &[(f64, f64)]) -> f64 {
    let ranks = |values: Vec<f64>| -> Vec<f64> {
        let rank = |x: f64| {
            let (below, equal) = (values.iter().filter(|y| **y < x).count(), values.iter().filter(|y| **y == x).count());
            below as f64 + (equal as f64 - 1.0) / 2.0
        };
        values.iter().map(|&x| rank(x)).collect()
    };
    let (a, b) = (ranks(pairs.iter().map(|p| p.0).collect()), ranks(pairs.iter().map(|p| p.1).collect()));
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (ma, mb) = (mean(&a), mean(&b));
    let product: f64 = a.iter().zip(&b).map(|(x, y)| (x - ma) * (y - mb)).sum();
    let square = |v: &[f64], m: f64| v.iter().map(|x| (x - m) * (x - m)).sum::<f64>();
    product / (square(&a, ma) * square(&b, mb)).sqrt()
}

/// The paper's speed-ups and ours, and how alike they rank.
pub(in crate::report) fn agreement(table: &Table) -> f64 {
    let pair = |row: usize| Some((table.number(row, "paper_speedup")?, table.number(row, "speedup")?));
    let pairs: Vec<(f64, f64)> =
        (0..table.rows.len()).filter(|&row| table.number(row, "max_depth").is_some()).filter_map(pair).collect();
    rank_correlation(&pairs)
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let (Some(best), Some(tuned)) = (fastest(table), table.row("tree", TUNED)) else { return String::new() };
    let time = |row: usize| table.number(row, "trace_ms").unwrap_or(f64::NAN);
    let beaten = (0..table.rows.len())
        .filter(|&row| table.number(row, "max_depth").is_some())
        .filter(|&row| time(row) > time(tuned) && table.number(row, "kb") > table.number(tuned, "kb"))
        .count();
    let ratio = time(best) / time(tuned);
    let verdict = if ratio > 1.0 {
        format!("takes {} times as long as the tree that tunes itself", numbers.say("ratio", ratio, "trace_ms", ""))
    } else {
        format!(
            "is faster than the tree that tunes itself, which takes {} times as long",
            numbers.say("ratio", 1.0 / ratio, "trace_ms", "")
        )
    };
    let wrong: f64 = (0..table.rows.len()).filter_map(|row| table.number(row, "wrong")).sum();
    let answers =
        if wrong == 0.0 { "No tree gave an answer that brute force did not." } else { "Some answers differ: that is a bug." };
    format!(
        "The fastest of the grid is {}, which {verdict}; {} of the 36 settings are behind it in both memory and time. The paper's eleven \
         speed-ups and ours rank alike with a coefficient of {}. {answers}",
        table.words(best, "tree"),
        numbers.count("beaten", beaten as f64, "kb, trace_ms"),
        numbers.say("rank", agreement(table), "paper_speedup, speedup", ""),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rankings_that_agree_have_one_and_opposite_ones_minus_one() {
        assert!((rank_correlation(&[(1.0, 10.0), (2.0, 20.0), (5.0, 21.0)]) - 1.0).abs() < 1e-12);
        assert!((rank_correlation(&[(1.0, 3.0), (2.0, 2.0), (5.0, 1.0)]) + 1.0).abs() < 1e-12);
    }

    #[test]
    fn every_published_row_is_on_the_grid() {
        let all = settings();
        assert!(PUBLISHED.iter().all(|(d, s, _)| all.iter().any(|it| (it.max_depth, it.min_size) == (*d, *s))));
        assert_eq!(labels().len(), 36 + 3);
    }
}
