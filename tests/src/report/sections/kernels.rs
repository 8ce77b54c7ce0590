//! Ray-triangle tests: time against wrong answers on hard rays.

use crate::bench::paper::timed;
use crate::bench::rays::RaySet;
use crate::bench::scenes::{PAPER, bench_scene};
use crate::bench::timing::{median, take_turns};
use crate::cells;
use crate::hard::classes::{Class, RAYS};
use crate::judge::{Tally, Verdict, buffer, judge, truth_ray, truth_triangles};
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Column, Kind, Row, Table};
use crate::truth::{Truth, plane_t};
use crate::verify::KERNELS;
use gz_app::args::kernel_name;
use gz_app::error::AppError;
use gz_bsp::BspTree;
use gz_core::kernel::Closest;
use gz_core::{BruteForce, ClassMask, GzRay, Hit, RayBatch, RayQuery, SimdLevel, TriBuffer, with_default_float_control};
use rayon::prelude::*;

const COLUMNS: [Column; 12] = [
    Column::new("test", "test", "", Kind::Label),
    Column::new("arithmetic", "arithmetic", "", Kind::Note),
    Column::new("ns_per_ray", "time", "ns/ray", Kind::Time),
    Column::new("wrong_per_1e9", "wrong", "per 10⁹ rays", Kind::Figure),
    Column::new("wrong", "wrong", "rays", Kind::Count),
    Column::new("false_misses", "missed though hit", "rays", Kind::Count),
    Column::new("false_hits", "hit though missed", "rays", Kind::Count),
    Column::new("elsewhere", "triangle at another T", "rays", Kind::Count),
    Column::new("tied", "another triangle at the same T", "rays", Kind::Count),
    Column::new("bound_per_1e9", "below, at 95%", "per 10⁹ rays", Kind::Figure),
    Column::new("t_wrong", "T not the rounded one", "rays", Kind::Count),
    Column::new("worst_t", "worst T", "ulp", Kind::Count),
];

const CHARTS: [ChartSpec; 1] = [ChartSpec {
    title: "Time against wrong answers",
    caption: "Down and to the left is better. The tests that round sit high, and the more digits the lower. The band at the bottom is for \
              those that gave no wrong answer to any of the rays asked.",
    only: ("", ""),
    drawn: Drawn::Points {
        x: Axis { column: "ns_per_ray", title: "ns per ray against 897 triangles →", scale: Scale::Log },
        y: Axis { column: "wrong_per_1e9", title: "↑ wrong answers per 10⁹ hard rays", scale: Scale::Log },
        series: "",
        label: "test",
        joined: false,
        zeros: "none seen",
    },
}];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "kernels",
    chapter: Chapter::Kernels,
    title: "Eight tests, one answer",
    how: "Errors: every test as brute force on hard rays of eleven classes, against an independent exact answer. Wrong is a hit for a \
          miss, a miss for a hit, or a triangle that lies at another exact T; where several triangles tie, any of them counts as right \
          for the tests that round, while ours must name the lowest. Times, in a run of their own without counters: primary rays of the \
          paper's scene (our stand-in, 897 triangles), one thread, in turns, the median of the rounds. The tests that round are the \
          plain scalar ones, as they are usually written, and <i>ours, one at a time</i> is scalar as well: its f64 test with proof on every \
          triangle. The others of ours filter eight triangles at a time, and the tree asks few of them.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |_| Ok(contenders()),
    measure,
    says,
};

const ONE_BY_ONE: &str = "ours, one at a time";
const BY_TREE: &str = "ours, by the tree";

/// The exact test on every triangle, without the filter before it.
struct OneByOne<'a>(&'a TriBuffer);

impl RayQuery for OneByOne<'_> {
    fn tris(&self) -> &TriBuffer {
        self.0
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        with_default_float_control(|| {
            for (i, hit) in hits.iter_mut().enumerate() {
                let (ray, mut closest) = (rays.ray(i), Closest::default());
                if ray.is_valid() {
                    (0..self.0.len() as u32)
                        .filter(|tri| classes.has(self.0.class(*tri)))
                        .for_each(|tri| closest.consider(&ray, tri, self.0.positions()));
                }
                *hit = closest.hit(&ray, self.0.positions());
            }
        });
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        let mut hits = vec![Hit::MISS; rays.len()];
        self.closest_hits(rays, classes, &mut hits);
        occluded.iter_mut().zip(&hits).for_each(|(occluded, hit)| *occluded = hit.is_hit());
    }
}

/// Those that round, ours one by one, at each SIMD level, and ours through the tree.
fn contenders() -> Vec<String> {
    let plain = KERNELS.into_iter().map(|kernel| kernel_name(kernel).to_owned());
    let ours = SimdLevel::available().iter().map(|level| format!("ours, {level:?}"));
    plain.chain([ONE_BY_ONE.to_owned()]).chain(ours).chain([BY_TREE.to_owned()]).collect()
}

/// Calls `ask` with what answers for each of [`contenders`].
fn with_all(tris: &TriBuffer, ask: impl FnOnce(&[&dyn RayQuery])) {
    let plain = KERNELS.map(|kernel| BruteForce::with_kernel(tris, kernel));
    let ours: Vec<BruteForce<'_>> = SimdLevel::available().iter().map(|&level| BruteForce::new(tris).with_simd(level)).collect();
    let tree = BspTree::build(tris);
    let one_by_one = OneByOne(tris);
    let mut all: Vec<&dyn RayQuery> = plain.iter().map(|brute| brute as &dyn RayQuery).collect();
    all.push(&one_by_one);
    all.extend(ours.iter().map(|brute| brute as &dyn RayQuery));
    all.push(&tree);
    ask(&all);
}

/// Answers of one contender, judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Judged {
    tally: Tally,
    /// Of the wrong triangles, those whose plane the ray meets at another exact t.
    elsewhere: u64,
}

impl Judged {
    fn add(&mut self, found: &Hit, ray: &GzRay, expected: Option<crate::truth::Found>, triangles: &[[[f32; 3]; 3]]) {
        self.tally.add(found, expected);
        if judge(found, expected) == Verdict::Triangle
            && let (Some(expected), Some(line)) = (expected, truth_ray(ray).line())
        {
            let t_of = |tri: u32| plane_t(&line, &triangles[tri as usize]);
            self.elsewhere += u64::from(t_of(found.tri) != t_of(expected.tri));
        }
    }

    fn wrong(&self) -> u64 {
        self.tally.false_hits + self.tally.false_misses + self.elsewhere
    }
}

/// The error run: blocks of every class.
fn errors(run: &Run, blocks: u64) -> Vec<Judged> {
    let of_block = |(class, number): &(Class, u64)| {
        let block = class.block(run.seed, *number);
        let tris = buffer(block.triangles.iter().copied());
        let triangles = truth_triangles(&tris);
        let truth = Truth::new(&triangles);
        let mut judged = vec![Judged::default(); contenders().len()];
        with_all(&tris, |queries| {
            for ray in &block.rays {
                let expected = truth.closest(&truth_ray(ray));
                for (judged, query) in judged.iter_mut().zip(queries) {
                    judged.add(&query.closest_hit(ray), ray, expected, &triangles);
                }
            }
        });
        judged
    };
    let work: Vec<(Class, u64)> = (0..blocks).flat_map(|number| Class::ALL.map(|class| (class, number))).collect();
    let found: Vec<Vec<Judged>> = work.par_iter().map(of_block).collect();
    let mut sum = vec![Judged::default(); contenders().len()];
    for judged in found {
        for (sum, judged) in sum.iter_mut().zip(judged) {
            sum.tally += judged.tally;
            sum.elsewhere += judged.elsewhere;
        }
    }
    sum
}

/// The timing run: nanoseconds a ray of each contender.
fn times(run: &Run, rounds: usize) -> Result<Vec<f64>, AppError> {
    let scene = bench_scene(PAPER)?;
    let primary = scene.rays.primary();
    // The fast ones need more rays for a turn that can be timed.
    let (few, many) = (primary.sample(run.size(32, 3000, 12_000)), primary.sample(run.size(64, usize::MAX, usize::MAX)));
    let mut medians = Vec::new();
    with_all(&scene.tris, |queries| {
        let plain = queries.len() - 1;
        let sets: [&RaySet; 2] = [&few, &many];
        let set = |k: usize| sets[usize::from(k >= plain)];
        let mut turns: Vec<_> = queries.iter().enumerate().map(|(k, query)| timed(*query, set(k))).collect();
        let times = take_turns(rounds, &mut turns);
        medians = times.iter().enumerate().map(|(k, times)| median(times) * 1e9 / set(k).len() as f64).collect();
    });
    Ok(medians)
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let blocks = run.size(1, 8, 400);
    let judged = errors(run, blocks);
    run.progress.say("  kernels: errors counted, now times");
    let times = gz_app::threads::with(1, || times(run, run.rounds()))?;
    let settings = format!(
        "{}; {blocks} blocks of {RAYS} rays in {} classes; {} rounds, 1 thread",
        run.mode.name(),
        Class::ALL.len(),
        run.rounds()
    );
    let rows = contenders().into_iter().zip(&judged).zip(&times).map(|((name, judged), &ns)| {
        let n = judged.tally.rays;
        let per = |count: u64| count as f64 * 1e9 / n.max(1) as f64;
        let tally = judged.tally;
        let bound = (judged.wrong() == 0).then(|| 3e9 / n.max(1) as f64);
        let cells = cells![
            name.as_str(),
            arithmetic(&name),
            ns,
            per(judged.wrong()),
            judged.wrong(),
            tally.false_misses,
            tally.false_hits,
            judged.elsewhere,
            tally.triangles - judged.elsewhere,
            bound,
            tally.t,
            u64::from(tally.worst_t),
        ];
        Row { cells, n, settings: settings.clone() }
    });
    Ok(Measured { rows: rows.collect(), pictures: Vec::new() })
}

fn arithmetic(name: &str) -> &'static str {
    match name {
        "woop" => "f32, f64 at zero",
        "woop-fused" => "f32, fused",
        "moeller-trumbore-f64" => "f64",
        ONE_BY_ONE => "f64 with proof, else exact",
        _ if name.starts_with("ours") => "f32 filter, then exact",
        _ => "f32",
    }
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let (Some(paper), Some(double), Some(tree)) =
        (table.row("test", "plane"), table.row("test", "moeller-trumbore-f64"), table.row("test", BY_TREE))
    else {
        return String::new();
    };
    let rate = |row: usize| table.number(row, "wrong_per_1e9").unwrap_or(f64::NAN);
    let ours_wrong: f64 = (0..table.rows.len()).filter(|&row| table.words(row, "test").starts_with("ours")).map(rate).sum();
    let n = table.rows[tree].n;
    let doubles = if rate(double) > 0.0 {
        format!(
            "More digits help and do not suffice: in f64 {} of a million still go wrong.",
            numbers.count("f64", rate(double) / 1e3, "wrong_per_1e9")
        )
    } else {
        "In f64 none was seen to go wrong here, which bounds the rate and proves nothing.".to_owned()
    };
    let exact = if ours_wrong == 0.0 {
        format!(
            "Ours gave no wrong answer to any of {} rays, at no SIMD level and through no tree.",
            numbers.count("n", n as f64, "n")
        )
    } else {
        "Ours gave wrong answers: that is a bug, please report it.".to_owned()
    };
    format!(
        "The paper's test, the plane first and the rounded point after, gets {} of a million hard rays wrong. {doubles} {exact}",
        numbers.count("plane", rate(paper) / 1e3, "wrong_per_1e9")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::run::Mode;

    #[test]
    fn errors_repeat_and_ours_has_none() {
        let run = Run::new(Mode::Tiny, 5, false);
        let (one, two) = (errors(&run, 1), errors(&run, 1));
        assert_eq!(one, two);
        assert!(one[KERNELS.len()..].iter().all(|judged| judged.tally.is_clean()), "{one:?}");
        assert!(one[0].wrong() > 100 && one[0].elsewhere <= one[0].tally.triangles, "{:?}", one[0]);
    }
}
