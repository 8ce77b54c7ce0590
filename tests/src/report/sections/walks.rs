//! Ways to walk the paper's tree: time against answers that brute force does not give.

use crate::bench::paper::timed;
use crate::bench::scenes::{PAPER, bench_scene};
use crate::bench::timing::{median, take_turns};
use crate::cells;
use crate::hard::classes::{Class, RAYS};
use crate::judge::buffer;
use crate::plain_trees::{Disagreement, Ending, Insert, PlainMidpoint, PlainRules};
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_bsp::BspTree;
use gz_core::{BruteForce, Kernel, RayQuery, TriBuffer};
use rayon::prelude::*;

const COLUMNS: [Column; 9] = [
    Column::new("walk", "walk", "", Kind::Label),
    Column::new("setting", "MAX_DEPTH, MIN_SIZE", "", Kind::Label),
    Column::new("ns_per_ray", "time", "ns/ray", Kind::Time),
    Column::new("wrong_per_1e9", "other answers", "per 10⁹ rays", Kind::Figure),
    Column::new("missed", "missed", "rays", Kind::Count),
    Column::new("invented", "invented", "rays", Kind::Count),
    Column::new("other", "another triangle", "rays", Kind::Count),
    Column::new("bound_per_1e9", "below, at 95%", "per 10⁹ rays", Kind::Figure),
    Column::new("test", "test", "", Kind::Note),
];

const CHARTS: [ChartSpec; 1] = [ChartSpec {
    title: "Time against disagreement",
    caption: "Each walk at four depths. Deeper trees are faster and have more voxels to lose a hit between: the walks that stop too early go \
              up as they go left. Padded in f64, the same walk stays in the band.",
    only: ("", ""),
    drawn: Drawn::Points {
        x: Axis { column: "ns_per_ray", title: "ns per ray of the paper's scene →", scale: Scale::Log },
        y: Axis { column: "wrong_per_1e9", title: "↑ answers unlike brute force, per 10⁹ hard rays", scale: Scale::Log },
        series: "walk",
        label: "setting",
        joined: true,
        zeros: "none seen",
    },
}];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "walks",
    chapter: Chapter::Tree,
    title: "Walks that stop too early",
    how: "The paper's tree with mistakes that are easily made, on the hard rays of all classes, against brute force with the same test, so that \
          the walk alone is to blame. <i>First hit found</i>: the near half has some hit, wherever it lies. <i>Before the exit</i>: a hit counts \
          if its t is at most that at which the ray leaves the voxel, in f32. <i>Point in voxel</i>: a hit counts if its point lies in the \
          voxel's box, in f32, as in the paper's program. <i>Corners in boxes</i>: a triangle is listed where a corner of it lies, the paper's \
          first try. Times, in a run of their own: primary and other rays of the paper's scene, one thread, in turns.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |_| Ok(contenders().iter().map(|it| format!("{}, {}", it.name, it.setting())).collect()),
    measure,
    says,
};

/// A walk with its tree; no rules for the tree that tunes itself.
struct Contender {
    name: &'static str,
    rules: Option<PlainRules>,
}

impl Contender {
    fn setting(&self) -> String {
        self.rules.map_or_else(|| "no setting".to_owned(), |it| format!("({}, {})", it.max_depth, it.min_size))
    }

    fn test(&self) -> Kernel {
        self.rules.map_or(Kernel::Certified, |it| it.kernel)
    }

    fn with<T>(&self, tris: &TriBuffer, ask: impl FnOnce(&dyn RayQuery) -> T) -> T {
        match self.rules {
            Some(rules) => ask(&PlainMidpoint::build(tris, rules)),
            None => ask(&BspTree::build(tris)),
        }
    }
}

fn contenders() -> Vec<Contender> {
    let walks = [
        ("padded", Insert::BoxTouches, Ending::Padded, Kernel::Certified),
        ("first hit found", Insert::BoxTouches, Ending::FirstInLeaf, Kernel::Certified),
        ("before the exit", Insert::BoxTouches, Ending::BeforeExit, Kernel::Certified),
        ("point in voxel", Insert::BoxTouches, Ending::PointInVoxel, Kernel::Certified),
        ("paper: point in voxel, its test", Insert::BoxTouches, Ending::PointInVoxel, Kernel::Plane),
        ("corners in boxes", Insert::CornerInside, Ending::Padded, Kernel::Certified),
    ];
    let of = |(name, insert, ending, kernel)| {
        [5, 10, 15, 20]
            .map(|max_depth| Contender { name, rules: Some(PlainRules { max_depth, min_size: 5, insert, ending, kernel }) })
    };
    walks.into_iter().flat_map(of).chain([Contender { name: "self-tuned", rules: None }]).collect()
}

/// The error run: blocks of hard rays.
fn errors(run: &Run, blocks: u64) -> Vec<Disagreement> {
    let of_block = |(class, number): &(Class, u64)| {
        let block = class.block(run.seed, *number);
        let tris = buffer(block.triangles.iter().copied());
        let of = |contender: &Contender| {
            let truth = BruteForce::with_kernel(&tris, contender.test());
            contender.with(&tris, |query| Disagreement::count(query, &truth, &block.rays))
        };
        contenders().iter().map(of).collect::<Vec<_>>()
    };
    let work: Vec<(Class, u64)> = (0..blocks).flat_map(|number| Class::ALL.map(|class| (class, number))).collect();
    let found: Vec<Vec<Disagreement>> = work.par_iter().map(of_block).collect();
    let mut sum = vec![Disagreement::default(); contenders().len()];
    for of_block in found {
        sum.iter_mut().zip(of_block).for_each(|(sum, of_block)| *sum += of_block);
    }
    sum
}

/// The timing run: nanoseconds a ray.
fn times(run: &Run) -> Result<Vec<f64>, AppError> {
    let scene = bench_scene(PAPER)?;
    let rays = scene.rays.as_closest().sample(run.size(32, 6000, 40_000));
    let built: Vec<Box<dyn RayQuery + '_>> = contenders()
        .iter()
        .map(|it| -> Box<dyn RayQuery + '_> {
            match it.rules {
                Some(rules) => Box::new(PlainMidpoint::build(&scene.tris, rules)),
                None => Box::new(BspTree::build(&scene.tris)),
            }
        })
        .collect();
    let mut turns: Vec<_> = built.iter().map(|query| timed(&**query, &rays)).collect();
    let times = take_turns(run.size(1, 3, 11), &mut turns);
    drop(turns);
    Ok(times.iter().map(|times| median(times) * 1e9 / rays.len() as f64).collect())
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let blocks = run.size(1, 2, 200);
    let errors = errors(run, blocks);
    run.progress.say("  walks: errors counted, now times");
    let times = gz_app::threads::with(1, || times(run))?;
    let settings = format!("{}; {blocks} blocks of {RAYS} rays in {} classes; 1 thread", run.mode.name(), Class::ALL.len());
    let contenders = contenders();
    let rows = contenders.iter().zip(&errors).zip(&times).map(|((it, found), &ns)| {
        let n = found.rays;
        let wrong = found.wrong();
        let cells = cells![
            it.name,
            it.setting(),
            ns,
            wrong as f64 * 1e9 / n.max(1) as f64,
            found.missed,
            found.invented,
            found.other,
            (wrong == 0).then(|| 3e9 / n.max(1) as f64),
            if it.test() == Kernel::Plane { "the paper's" } else { "exact" },
        ];
        Row { cells, n, settings: settings.clone() }
    });
    Ok(Measured { rows: rows.collect(), pictures: Vec::new() })
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let rate = |walk: &'static str| {
        (0..table.rows.len())
            .filter(|&row| table.words(row, "walk") == walk)
            .filter_map(|row| table.number(row, "wrong_per_1e9"))
            .fold(0.0, f64::max)
    };
    let padded = if rate("padded") + rate("self-tuned") == 0.0 {
        "Padded, the same walk agrees with brute force on every ray, and so does the tree that tunes itself."
    } else {
        "Padded walks differ from brute force too, which is a bug."
    };
    format!(
        "Taking the first hit found goes wrong on up to {} of the hard rays, a hit before the exit on {}, and the paper's point in the voxel \
         on {}. {padded}",
        numbers.say("first", rate("first hit found") / 1e7, "wrong_per_1e9", " %"),
        numbers.say("exit", rate("before the exit") / 1e7, "wrong_per_1e9", " %"),
        numbers.say("voxel", rate("point in voxel") / 1e7, "wrong_per_1e9", " %"),
    )
}
