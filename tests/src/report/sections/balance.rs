//! How balanced trees are, and whether that is what counts.

use crate::bench::paper::timed;
use crate::bench::rays::RaySet;
use crate::bench::scenes::{PAPER, bench_scene};
use crate::bench::timing::{median, seconds, take_turns};
use crate::cells;
use crate::plain_trees::{PlainMidpoint, PlainRules, PolygonBsp, PolygonRules, Shape};
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_bsp::VisitCount;
use gz_core::{BruteForce, GzRay, Hit, RayQuery, TriBuffer};
use rayon::prelude::*;

const COLUMNS: [Column; 15] = [
    Column::new("tree", "tree", "", Kind::Label),
    Column::new("kind", "planes", "", Kind::Note),
    Column::new("balance", "lesser child holds", "%", Kind::Figure),
    Column::new("leaves", "leaves", "", Kind::Count),
    Column::new("empty", "empty leaves", "%", Kind::Figure),
    Column::new("mean_level", "mean level of leaves", "", Kind::Figure),
    Column::new("even_level", "if perfectly even", "", Kind::Figure),
    Column::new("deepest", "deepest level", "", Kind::Count),
    Column::new("largest", "largest leaf", "triangles", Kind::Count),
    Column::new("copies", "entries", "per triangle", Kind::Figure),
    Column::new("visits_per_ray", "nodes and leaves", "per ray", Kind::Figure),
    Column::new("tests_per_ray", "tests", "per ray", Kind::Figure),
    Column::new("wrong", "wrong", "answers", Kind::Count),
    Column::new("build_ms", "build", "ms", Kind::Time),
    Column::new("ns_per_ray", "time", "ns/ray", Kind::Time),
];

const CHARTS: [ChartSpec; 1] = [ChartSpec {
    title: "Balance against tests",
    caption: "To the right a tree is more even, down it asks a ray less. If balance were what counts, the points would fall from left to right.",
    only: ("", ""),
    drawn: Drawn::Points {
        x: Axis { column: "balance", title: "share of the lesser child, % (50 is even) →", scale: Scale::Linear },
        y: Axis { column: "tests_per_ray", title: "↑ triangle tests per ray", scale: Scale::Log },
        series: "kind",
        label: "tree",
        joined: false,
        zeros: "",
    },
}];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "balance",
    chapter: Chapter::Tree,
    title: "Does an even tree matter?",
    how: "The paper's 3.3.1 on its scene. Midpoint planes as the paper has them, and the BSP tree that the name comes from: each node cut by the plane of one \
          of its triangles (the first, or the best of eight tried), triangles in the plane kept there, those across it listed on both sides. \
          Both walks are plain and exact. Visits and tests are counted on evenly spaced rays; times, in a run of their own, on the same rays, \
          one thread, in turns.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |_| Ok(midpoints().map(|(name, _)| name).chain(polygons().map(|(name, _)| name)).collect()),
    measure,
    says,
};

fn midpoints() -> impl Iterator<Item = (String, PlainRules)> {
    [5, 10, 15, 20]
        .into_iter()
        .map(|max_depth| (format!("midpoint ({max_depth}, 5)"), PlainRules { max_depth, ..PlainRules::default() }))
}

fn polygons() -> impl Iterator<Item = (String, PolygonRules)> {
    [("polygon, first plane", 1), ("polygon, best of 8", 8)]
        .into_iter()
        .map(|(name, tried)| (name.to_owned(), PolygonRules { tried, ..PolygonRules::default() }))
}

/// A tree, with what it takes to count its walk.
struct Built<'a> {
    name: String,
    kind: &'static str,
    shape: Shape,
    build: f64,
    query: Box<dyn RayQuery + 'a>,
    walk: Box<dyn Fn(&GzRay, &mut VisitCount) -> Hit + Sync + 'a>,
}

fn trees(tris: &TriBuffer) -> Vec<Built<'_>> {
    let mut trees = Vec::new();
    let all = gz_core::ClassMask::ALL;
    for (name, rules) in midpoints() {
        let (build, tree) = seconds(|| PlainMidpoint::build(tris, rules));
        let counted = PlainMidpoint::build(tris, rules);
        trees.push(Built {
            name,
            kind: "midpoint planes",
            shape: tree.shape(),
            build,
            query: Box::new(tree),
            walk: Box::new(move |ray, visits| counted.closest_hit_counted(ray, all, visits)),
        });
    }
    for (name, rules) in polygons() {
        let (build, tree) = seconds(|| PolygonBsp::build(tris, rules));
        let counted = PolygonBsp::build(tris, rules);
        trees.push(Built {
            name,
            kind: "planes of triangles",
            shape: tree.shape(),
            build,
            query: Box::new(tree),
            walk: Box::new(move |ray, visits| counted.closest_hit_counted(ray, all, visits)),
        });
    }
    trees
}

/// The error run: visits of all rays together, and answers with another triangle than brute force.
fn counts(tree: &Built<'_>, rays: &[GzRay], truth: &[Hit]) -> (VisitCount, u64) {
    let of_part = |(rays, truth): (&[GzRay], &[Hit])| {
        let (mut visits, mut wrong) = (VisitCount::default(), 0u64);
        for (ray, truth) in rays.iter().zip(truth) {
            wrong += u64::from((tree.walk)(ray, &mut visits).tri != truth.tri);
        }
        (visits, wrong)
    };
    let parts: Vec<(VisitCount, u64)> = rays.par_chunks(512).zip(truth.par_chunks(512)).map(of_part).collect();
    parts.into_iter().fold((VisitCount::default(), 0), |(mut sum, wrong), (part, more)| {
        sum.nodes += part.nodes;
        sum.leaves += part.leaves;
        sum.tests += part.tests;
        (sum, wrong + more)
    })
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let scene = bench_scene(PAPER)?;
    let set: RaySet = scene.rays.as_closest().sample(run.size(200, 20_000, usize::MAX));
    let rays: Vec<GzRay> = set.rays().map(|(ray, _)| ray).collect();
    let brute = BruteForce::new(&scene.tris);
    let truth: Vec<Hit> = rays.par_iter().map(|ray| brute.closest_hit(ray)).collect();
    let trees = trees(&scene.tris);
    let found: Vec<(VisitCount, u64)> = trees.iter().map(|tree| counts(tree, &rays, &truth)).collect();
    let few = set.sample(run.size(100, 4000, 20_000));
    let times = gz_app::threads::with(1, || {
        let mut turns: Vec<_> = trees.iter().map(|tree| timed(&*tree.query, &few)).collect();
        Ok(take_turns(run.size(1, 3, 11), &mut turns))
    })?;
    let n = rays.len() as u64;
    let settings = format!("{}; {n} rays counted, {} timed, 1 thread", run.mode.name(), few.len());
    let rows = trees.iter().zip(&found).zip(&times).map(|((tree, (visits, wrong)), times)| {
        let share = |count: u64| count as f64 / n.max(1) as f64;
        let Shape { stats, mean_level, balance } = tree.shape;
        let cells = cells![
            tree.name.as_str(),
            tree.kind,
            100.0 * balance,
            stats.leaves,
            100.0 * stats.empty_leaves as f64 / stats.leaves.max(1) as f64,
            mean_level,
            tree.shape.even_level(),
            stats.depth,
            stats.largest_leaf,
            stats.references as f64 / scene.tris.len() as f64,
            share(visits.nodes + visits.leaves),
            share(visits.tests),
            *wrong,
            tree.build * 1e3,
            median(times) * 1e9 / few.len().max(1) as f64,
        ];
        Row { cells, n, settings: settings.clone() }
    });
    Ok(Measured { rows: rows.collect(), pictures: Vec::new() })
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let (Some(midpoint), Some(polygon)) = (table.row("tree", "midpoint (15, 5)"), table.row("tree", "polygon, best of 8")) else {
        return String::new();
    };
    let of = |row: usize, name: &str| table.number(row, name).unwrap_or(f64::NAN);
    let more_even = of(polygon, "balance") > of(midpoint, "balance");
    let fewer_tests = of(polygon, "tests_per_ray") < of(midpoint, "tests_per_ray");
    let faster = of(polygon, "ns_per_ray") < of(midpoint, "ns_per_ray");
    let so = match (more_even, faster) {
        (true, false) => "They are more even and slower: evenness does not make a tree fast",
        (true, true) => "They are more even and faster: here evenness pays",
        (false, false) => "They are less even and slower",
        (false, true) => "They are less even and still faster with the same plain walk",
    };
    format!(
        "At (15, 5) the lesser child of a midpoint cut holds {} of what both hold, and {} of the leaves are empty: midpoint trees are far from \
         even. Planes taken from triangles share out {}; {} entries a triangle stand against {}, {} tests a ray ({}) against {}, {} nodes and \
         leaves a ray against {}. {so}.",
        numbers.say("midpoint balance", of(midpoint, "balance"), "balance", " %"),
        numbers.say("midpoint empty", of(midpoint, "empty"), "empty", " %"),
        numbers.say("polygon balance", of(polygon, "balance"), "balance", " %"),
        numbers.say("polygon copies", of(polygon, "copies"), "copies", ""),
        numbers.say("midpoint copies", of(midpoint, "copies"), "copies", ""),
        numbers.say("polygon tests", of(polygon, "tests_per_ray"), "tests_per_ray", ""),
        if fewer_tests { "fewer" } else { "more" },
        numbers.say("midpoint tests", of(midpoint, "tests_per_ray"), "tests_per_ray", ""),
        numbers.say("polygon visits", of(polygon, "visits_per_ray"), "visits_per_ray", ""),
        numbers.say("midpoint visits", of(midpoint, "visits_per_ray"), "visits_per_ray", ""),
    )
}
