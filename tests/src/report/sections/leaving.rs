//! Ways to leave a surface: time against acne and leaks.

use crate::bench::timing::{median, take_turns};
use crate::cells;
use crate::hard::leaving::{Label, Outcome, Wrong, run as run_cases};
use crate::model::primary_hits;
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Cell, Column, Kind, Row, Table};
use gz_app::args::leave_name;
use gz_app::error::AppError;
use gz_bsp::BspTree;
use gz_core::glam::DVec3;
use gz_core::{ClassMask, GzCoord, Hit, LeavePolicy, PerRay, RayBatch, RayQuery, TriId, side_of};
use gz_shade::Scene;
use rayon::prelude::*;

const COLUMNS: [Column; 17] = [
    Column::new("policy", "policy", "", Kind::Label),
    Column::new("ns_per_ray", "time", "ns/ray", Kind::Time),
    Column::new("wrong_per_1e6", "acne and leaks", "per 10⁶ rays", Kind::Figure),
    Column::new("acne", "acne", "rays", Kind::Count),
    Column::new("leaks", "leaks", "rays", Kind::Count),
    Column::new("bound_per_1e6", "below, at 95%", "per 10⁶ rays", Kind::Figure),
    Column::new("F1", "flat quads", "per 10⁶", Kind::Figure),
    Column::new("F2", "diagonals, grazing", "per 10⁶", Kind::Figure),
    Column::new("F3", "folds", "per 10⁶", Kind::Figure),
    Column::new("F4", "box, near edges", "per 10⁶", Kind::Figure),
    Column::new("F5", "box, on edges", "per 10⁶", Kind::Figure),
    Column::new("F6", "gaps", "per 10⁶", Kind::Figure),
    Column::new("F8", "near light", "per 10⁶", Kind::Figure),
    Column::new("F12", "around 0", "per 10⁶", Kind::Figure),
    Column::new("G7", "thin slabs", "per 10⁶", Kind::Figure),
    Column::new("G8", "thin slab far out", "per 10⁶", Kind::Figure),
    Column::new("G13", "block, at edges", "per 10⁶", Kind::Figure),
];

const CHARTS: [ChartSpec; 2] = [
    ChartSpec {
        title: "Time against acne and leaks",
        caption: "Each point is a way to start a secondary ray. Those above the band go wrong on the hard cases; which cases, the bars \
                  below tell.",
        only: ("", ""),
        drawn: Drawn::Points {
            x: Axis { column: "ns_per_ray", title: "ns per shadow ray, start and trace →", scale: Scale::Log },
            y: Axis { column: "wrong_per_1e6", title: "↑ acne and leaks per 10⁶ hard cases", scale: Scale::Log },
            series: "",
            label: "policy",
            joined: false,
            zeros: "none seen",
        },
    },
    ChartSpec {
        title: "Where each goes wrong",
        caption: "Wrong answers per 10⁶ cases of each kind, one kind behind the other. A step off the surface cures acne and leaks through gaps and thin slabs; skipping \
                  the own triangle, the paper's rule, leaves the acne of its neighbours.",
        only: ("", ""),
        drawn: Drawn::Bars {
            parts: &["F1", "F2", "F3", "F4", "F5", "F6", "F8", "F12", "G7", "G8", "G13"],
            title: "wrong per 10⁶ cases of a kind, added up →",
        },
    },
];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "leaving",
    chapter: Chapter::Leaving,
    title: "Six ways to start a shadow ray",
    how: "Errors: hits on eleven kinds of surfaces where starting a ray is hard, equally many of each, judged by the exact answer from the \
          exact hit point. Cases in which a few roundings of the start change the exact answer count for nobody. Times, in a run of their \
          own: shadow rays of the scene <code>shadows</code> through the self-tuned tree in batches, the start computed anew each turn, one \
          thread, in turns. <i>bare</i>: the hit point in f32; <i>identity</i>: the same, own triangle skipped (the paper); <i>epsilon</i>: \
          hits up to t = 1e-4 do not count; <i>waechter-binder</i>: moved by 256 steps of f32; <i>error-bound</i>: moved out of the box of \
          rounding errors; <i>exact</i>: a point in f64 proved to lie on the leaving side.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |_| Ok(LeavePolicy::ALL.map(leave_name).to_vec()),
    measure,
    says,
};

/// The error run: cases of each label.
fn errors(run: &Run, cases: u64) -> Vec<(Label, Outcome)> {
    let of = |label: &Label| (*label, run_cases(*label, run.seed ^ ((*label as u64 + 1) << 48), cases));
    Label::ALL.par_iter().map(of).collect()
}

/// Shadow rays to be left for: hits with the directions of lights that they face.
struct Starts {
    weights: Vec<[f64; 3]>,
    tris: Vec<TriId>,
    directions: Vec<GzCoord>,
}

impl Starts {
    fn of(scene: &Scene) -> Self {
        let mut starts = Self { weights: Vec::new(), tris: Vec::new(), directions: Vec::new() };
        // Light by light, as a frame asks.
        for light in &scene.lights {
            for (ray, hit) in primary_hits(scene).filter(|(_, hit)| hit.is_hit()) {
                let corners = scene.tris.position(hit.tri);
                let direction = light.arrive(DVec3::ZERO).direction;
                if side_of(corners, direction) == -side_of(corners, ray.direction) {
                    starts.weights.push(gz_core::kernel::hit_weights(&ray, corners));
                    starts.tris.push(hit.tri);
                    starts.directions.push(direction);
                }
            }
        }
        starts
    }
}

/// Rays that are asked about together.
const BATCH: usize = 1024;

/// Starts and traces all rays by one policy; returns how many are blocked.
fn trace(scene: &Scene, tree: &BspTree<'_>, starts: &Starts, policy: LeavePolicy) -> usize {
    let (mut origins, mut leaves, mut directions) = (Vec::new(), Vec::new(), Vec::new());
    let (mut hits, mut blocked, mut count) = (Vec::new(), Vec::new(), 0);
    for first in (0..starts.tris.len()).step_by(BATCH) {
        origins.clear();
        leaves.clear();
        directions.clear();
        for k in first..(first + BATCH).min(starts.tris.len()) {
            let corners = scene.tris.position(starts.tris[k]);
            if let Some(ray) = policy.leave(corners, starts.weights[k], starts.directions[k]) {
                origins.push(ray.origin);
                leaves.push(starts.tris[k]);
                directions.push(starts.directions[k]);
            }
        }
        let (origin, direction) = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]));
        let batch = RayBatch::new(origins.len(), origin, direction, PerRay::One(policy.tmin()), PerRay::One(f32::INFINITY));
        if policy.skips_source() {
            hits.clear();
            hits.resize(batch.len(), Hit::MISS);
            tree.closest_hits(&batch, ClassMask::ALL, &mut hits);
            for (k, (&hit, &own)) in hits.iter().zip(&leaves).enumerate() {
                let (mut hit, mut ray): (Hit, _) = (hit, batch.ray(k));
                while hit.is_hit() && hit.tri == own {
                    ray.tmin = hit.t.next_up();
                    hit = tree.closest_hit(&ray);
                }
                count += usize::from(hit.is_hit());
            }
        } else {
            blocked.clear();
            blocked.resize(batch.len(), false);
            // Only the exact way may promise that a ray does not meet what it leaves.
            let batch = if policy == LeavePolicy::Exact { batch.leaving(&leaves) } else { batch };
            tree.any_hits(&batch, ClassMask::ALL, &mut blocked);
            count += blocked.iter().filter(|blocked| **blocked).count();
        }
    }
    count
}

/// The timing run: nanoseconds a ray by policy, and how many rays that is of.
fn times(run: &Run) -> Result<(Vec<f64>, usize), AppError> {
    let (scene, _) = crate::model::placed("shadows", &crate::model::sized(run.size(16, 256, 640), run.size(12, 192, 480)))?;
    let tree = BspTree::build(&scene.tris);
    let starts = Starts::of(&scene);
    let mut turns: Vec<Box<dyn FnMut() + '_>> = Vec::new();
    for policy in LeavePolicy::ALL {
        let (scene, tree, starts) = (&scene, &tree, &starts);
        turns.push(Box::new(move || {
            std::hint::black_box(trace(scene, tree, starts, policy));
        }));
    }
    let rays = starts.tris.len();
    let times = take_turns(run.rounds(), &mut turns);
    drop(turns);
    Ok((times.iter().map(|times| median(times) * 1e9 / rays.max(1) as f64).collect(), rays))
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let cases = run.size(64, 4096, 1_000_000);
    let outcomes = errors(run, cases);
    run.progress.say("  leaving: errors counted, now times");
    let (times, rays) = gz_app::threads::with(1, || times(run))?;
    let settings = format!(
        "{}; {cases} cases of each of {} kinds; {rays} shadow rays, {} rounds, 1 thread",
        run.mode.name(),
        Label::ALL.len(),
        run.rounds()
    );
    let n: u64 = outcomes.iter().map(|(_, outcome)| outcome.cases).sum();
    let rows = LeavePolicy::ALL.into_iter().enumerate().zip(times).map(|((k, policy), ns)| {
        let wrong = |outcome: &Outcome| outcome.wrong[k];
        let acne: u64 = outcomes.iter().map(|(_, outcome)| wrong(outcome).acne).sum();
        let leaks: u64 = outcomes.iter().map(|(_, outcome)| wrong(outcome).leaks).sum();
        let per = |count: u64, n: u64| count as f64 * 1e6 / n.max(1) as f64;
        let mut cells = cells![
            leave_name(policy),
            ns,
            per(acne + leaks, n),
            acne,
            leaks,
            (acne + leaks == 0).then(|| 3e6 / n.max(1) as f64),
        ];
        cells.extend(outcomes.iter().map(|(_, outcome)| {
            let Wrong { acne, leaks } = wrong(outcome);
            Cell::from(per(acne + leaks, outcome.cases))
        }));
        Row { cells, n, settings: settings.clone() }
    });
    Ok(Measured { rows: rows.collect(), pictures: Vec::new() })
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let rows = ["exact", "bare", "identity", "epsilon", "waechter-binder", "error-bound"].map(|name| table.row("policy", name));
    let [Some(exact), Some(bare), Some(identity), ..] = rows else { return String::new() };
    let rate = |row: usize| table.number(row, "wrong_per_1e6").unwrap_or(f64::NAN);
    let time = |row: usize| table.number(row, "ns_per_ray").unwrap_or(f64::NAN);
    let best = rows[1..].iter().flatten().copied().min_by(|&a, &b| rate(a).total_cmp(&rate(b))).unwrap_or(bare);
    let of_exact = if rate(exact) == 0.0 { "The exact way made none" } else { "The exact way made some, which is a bug" };
    let cost = time(exact) / time(bare);
    let price = if cost < 1.0 {
        format!("and takes {} of the time of starting from the bare hit point", numbers.say("cost", cost, "ns_per_ray", ""))
    } else {
        format!("and takes {} times as long as starting from the bare hit point", numbers.say("cost", cost, "ns_per_ray", ""))
    };
    format!(
        "Of a million hard cases the bare hit point gets {} wrong and the paper's rule {}. The best of the usual cures is {} with {}. \
         {of_exact}, {price}.",
        numbers.count("bare", rate(bare), "wrong_per_1e6"),
        numbers.count("identity", rate(identity), "wrong_per_1e6"),
        table.words(best, "policy"),
        numbers.count("best", rate(best), "wrong_per_1e6"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::run::Mode;

    #[test]
    fn the_columns_name_the_labels_in_their_order() {
        let names: Vec<String> = Label::ALL.iter().map(|label| format!("{label:?}")).collect();
        assert_eq!(COLUMNS[6..].iter().map(|column| column.name).collect::<Vec<_>>(), names);
    }

    #[test]
    fn every_policy_traces_the_same_rays_and_the_exact_one_blocks_as_brute_force_does() {
        let run = Run::new(Mode::Tiny, 1, false);
        let (scene, _) = crate::model::placed("shadows", &crate::model::sized(24, 18)).unwrap();
        let (tree, starts) = (BspTree::build(&scene.tris), Starts::of(&scene));
        let expected = (0..starts.tris.len())
            .filter_map(|k| {
                LeavePolicy::Exact.leave(scene.tris.position(starts.tris[k]), starts.weights[k], starts.directions[k])
            })
            .filter(|ray| gz_core::BruteForce::new(&scene.tris).any_hit(ray))
            .count();
        assert_eq!(trace(&scene, &tree, &starts, LeavePolicy::Exact), expected);
        assert!(trace(&scene, &tree, &starts, LeavePolicy::Bare) > expected);
        let (one, two) = (errors(&run, 64), errors(&run, 64));
        assert_eq!(one, two);
    }
}
