//! What exactness costs, `cargo xtask bench exactness`: the tree against the same walk in plain f32, and how far up the ladder rays go.
//!
//! Times and counts are taken apart: nothing is counted while anything is timed.

use super::options::Options;
use super::rays::{RaySet, answers, differing, other_triangle, room, trace};
use super::record::Record;
use super::scenes::{BenchScene, DEFAULT, bench_scene};
use super::table::lines;
use super::timing::{Ratio, median, take_turns};
use crate::row;
use gz_app::error::AppError;
use gz_bsp::{BspTree, PlainF32Tree, Visits};
use gz_core::kernel::{FilterSpace, Rung, answer_rung, rung};
use gz_core::{BruteForce, GzRay, TriBuffer, TriId};

/// The scenes, unless the options name others: that of `cargo xtask render`, and a teapot of 16 thousand triangles.
const SCENES: [&str; 2] = [DEFAULT, "teapot:16"];
/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 15;
/// Random lines beside the rays of the picture.
const RANDOM: usize = 1 << 16;
/// Brute force checks so many triangle tests' worth of each set.
const CHECKED_TESTS: f64 = 1e8;

/// `cargo xtask bench exactness`: on the default scenes or those named.
///
/// # Errors
///
/// If a scene cannot be loaded or an answer of ours is wrong.
pub fn run(options: &Options) -> Result<(), AppError> {
    let named: Vec<&str> = options.scenes.iter().map(String::as_str).collect();
    let rounds = options.rounds.unwrap_or(ROUNDS);
    let mut rows = Vec::new();
    for name in if named.is_empty() { &SCENES[..] } else { &named } {
        let scene = bench_scene(name)?;
        let tree = BspTree::build(&scene.tris);
        for (set, rays) in sets(&scene, options.rays) {
            if !rays.is_empty() {
                rows.push(measure(&scene, &tree, set, &rays, rounds)?);
            }
        }
    }
    print!("{}", tables(&rows, rounds));
    if options.write {
        Record::new("exactness", rounds, &[])?.write(HEAD, rows.iter().map(Row::cells))?;
    }
    Ok(())
}

/// The rays of a scene by kind, and random lines through it.
fn sets(scene: &BenchScene, most: Option<usize>) -> [(&'static str, RaySet); 4] {
    let rays = &scene.rays;
    let random = RaySet::random(&scene.tris.bounds(), RANDOM);
    let sets = [("primary", rays.primary()), ("shadow", rays.shadow()), ("bounced", rays.bounced()), ("random", random)];
    sets.map(|(name, rays)| (name, most.map_or_else(|| rays.clone(), |most| rays.sample(most))))
}

/// One scene and set.
struct Row {
    scene: String,
    triangles: usize,
    set: &'static str,
    rays: usize,
    /// Rays that plain f32 answers with another triangle, or with a hit for a miss.
    wrong: u64,
    /// Rays whose answer differs at all, T, u and v included.
    differ: u64,
    ladder: Ladder,
    /// Seconds of each round.
    certified: Vec<f64>,
    plain: Vec<f64>,
}

fn measure(scene: &BenchScene, tree: &BspTree<'_>, set: &'static str, rays: &RaySet, rounds: usize) -> Result<Row, AppError> {
    let tris = &scene.tris;
    let few = rays.sample((CHECKED_TESTS / tris.len().max(1) as f64) as usize);
    let wrong = differing(&answers(&BruteForce::new(tris), &few), &answers(tree, &few));
    println!("{}, {set}: {} rays, {} checked by brute force, {wrong} differ", scene.name, rays.len(), few.len());
    if wrong > 0 {
        return Err(AppError::Differs(format!("{wrong} answers differ from those of brute force")));
    }
    let plain = PlainF32Tree(tree);
    let (truth, unproved) = (answers(tree, rays), answers(&plain, rays));
    let any = rays.batches.iter().all(|asked| asked.any);
    let differ = differing(&truth, &unproved);
    let ladder = Ladder::of(tris, tree, rays);
    let (mut found, mut found_plain) = (room(rays), room(rays));
    let mut contenders: Vec<Box<dyn FnMut() + '_>> =
        vec![Box::new(|| trace(tree, rays, &mut found)), Box::new(|| trace(&plain, rays, &mut found_plain))];
    let times = take_turns(rounds, &mut contenders);
    drop(contenders);
    if differing(&truth, &found) + differing(&unproved, &found_plain) > 0 {
        return Err(AppError::Differs("answers change from round to round".to_owned()));
    }
    let [certified, plain] = [times[0].clone(), times[1].clone()];
    let wrong = if any { differ } else { other_triangle(&truth, &unproved) };
    let (scene, triangles) = (scene.name.clone(), tris.len());
    Ok(Row { scene, triangles, set, rays: rays.len(), wrong, differ, ladder, certified, plain })
}

/// How many rays needed what: by the highest rung among the triangles that a ray is tested against, and by what formed its answer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Ladder {
    rays: u64,
    /// Rays on which f64 decided a hit or a miss, but nothing above it.
    f64_decides: u64,
    /// Rays on which whole numbers did.
    exact_decides: u64,
    /// Hits with T, u and v, which f64 forms, ...
    answers: u64,
    /// ... and those whose rounding only whole numbers settle.
    exact_answers: u64,
}

impl Ladder {
    /// Of the rays by themselves, as the walk of a single ray has it: in packets f32 may decide a little less or more.
    fn of(tris: &TriBuffer, tree: &BspTree<'_>, rays: &RaySet) -> Self {
        let space = FilterSpace::new(tris.bounds().reaches());
        let mut ladder = Self::default();
        for asked in &rays.batches {
            let batch = asked.batch();
            for i in 0..asked.len {
                let ray = batch.ray(i);
                let mut climb = Climb { ray: &ray, tris, space: &space, leaves: asked.leaves(i), highest: Rung::F32 };
                ladder.rays += 1;
                if asked.any {
                    tree.any_hit_counted(&ray, asked.classes, &mut climb);
                } else {
                    let hit = tree.closest_hit_counted(&ray, asked.classes, &mut climb);
                    if hit.is_hit() {
                        ladder.answers += 1;
                        let exact = answer_rung(&ray, tris.position(hit.tri)) == Rung::Exact;
                        ladder.exact_answers += u64::from(exact);
                    }
                }
                match climb.highest {
                    Rung::F32 => {}
                    Rung::F64 => ladder.f64_decides += 1,
                    Rung::Exact => ladder.exact_decides += 1,
                }
            }
        }
        ladder
    }
}

/// One ray on its way.
struct Climb<'c> {
    ray: &'c GzRay,
    tris: &'c TriBuffer,
    space: &'c FilterSpace,
    leaves: Option<TriId>,
    highest: Rung,
}

impl Visits for Climb<'_> {
    fn test(&mut self, tri: TriId) {
        // The triangle that a ray leaves is known not to be hit and not asked.
        if self.leaves != Some(tri) {
            let (_, by) = rung(self.ray, self.tris.position(tri), Some(self.space));
            self.highest = self.highest.max(by);
        }
    }
}

/// Columns of the record.
const HEAD: &str = "scene,triangles,set,rays,certified Mrays/s,plain f32 Mrays/s,certified takes,low,high,plain f32 wrong,plain f32 differ,f64 decides,whole numbers decide,answers,answers by whole numbers,certified s by round,plain f32 s by round";

impl Row {
    fn speed(&self, times: &[f64]) -> String {
        format!("{:.2}", self.rays as f64 / median(times) / 1e6)
    }

    fn ratio(&self) -> Ratio {
        Ratio::of(&self.certified, &self.plain)
    }

    fn cells(&self) -> Vec<String> {
        let all = |times: &[f64]| times.iter().map(|time| format!("{time:.6}")).collect::<Vec<_>>().join(" ");
        let (ratio, ladder) = (self.ratio(), &self.ladder);
        row![
            self.scene,
            self.triangles,
            self.set,
            self.rays,
            self.speed(&self.certified),
            self.speed(&self.plain),
            format!("{:.4}", ratio.mean),
            format!("{:.4}", ratio.low),
            format!("{:.4}", ratio.high),
            self.wrong,
            self.differ,
            ladder.f64_decides,
            ladder.exact_decides,
            ladder.answers,
            ladder.exact_answers,
            all(&self.certified),
            all(&self.plain)
        ]
    }
}

fn tables(rows: &[Row], rounds: usize) -> String {
    let mut costs = vec![row!["scene", "set", "rays", "exact Mrays/s", "plain f32", "exact takes [95% interval]", "plain wrong"]];
    let mut climbs = vec![row![
        "scene",
        "set",
        "rays",
        "f32 decides",
        "f64 decides",
        "whole numbers",
        "hits",
        "their T, u, v by whole numbers"
    ]];
    for row in rows {
        let (exact, plain) = (row.speed(&row.certified), row.speed(&row.plain));
        costs.push(row![row.scene, row.set, row.rays, exact, plain, row.ratio(), row.wrong]);
        let ladder = &row.ladder;
        let share = |n: u64, of: u64| format!("{n} ({:.4}%)", 100.0 * n as f64 / of.max(1) as f64);
        let by_f32 = ladder.rays - ladder.f64_decides - ladder.exact_decides;
        climbs.push(row![
            row.scene,
            row.set,
            ladder.rays,
            share(by_f32, ladder.rays),
            share(ladder.f64_decides, ladder.rays),
            share(ladder.exact_decides, ladder.rays),
            ladder.answers,
            share(ladder.exact_answers, ladder.answers)
        ]);
    }
    format!(
        "\nthe same walk with and without proof; medians of {rounds} rounds in turns; wrong: another triangle, or a hit for a miss\n{}\n\
         rays by the highest rung that it took to decide their hits and misses, one ray at a time\n{}",
        lines(&costs),
        lines(&climbs)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ray_stands_on_one_rung_and_ours_is_right() {
        let scene = bench_scene("teapot:3").unwrap();
        let tree = BspTree::build(&scene.tris);
        for (set, rays) in sets(&scene, Some(2000)) {
            let row = measure(&scene, &tree, set, &rays, 2).unwrap();
            let Ladder { rays: n, f64_decides, exact_decides, answers, exact_answers } = row.ladder;
            assert!(n == rays.len() as u64 && f64_decides + exact_decides <= n && exact_answers <= answers, "{set}");
            // Bounds and rounding settle nearly everything.
            assert!((f64_decides + exact_decides) * 10 < n.max(10), "{set}: {:?}", row.ladder);
            assert!(row.wrong <= row.differ && row.differ <= n, "{set}");
            assert_eq!(row.cells().len(), HEAD.split(',').count());
            assert!(tables(&[row], 2).contains(set));
        }
    }

    #[test]
    fn a_ray_through_a_corner_is_not_left_to_f32() {
        let scene = bench_scene("teapot:3").unwrap();
        let tree = BspTree::build(&scene.tris);
        let [corner, ..] = *scene.tris.position(500);
        let eye = corner + gz_core::GzCoord::new(0.5, 4.0, 8.0);
        let mut climb = Climb {
            ray: &GzRay::new(eye, corner - eye),
            tris: &scene.tris,
            space: &FilterSpace::new(scene.tris.bounds().reaches()),
            leaves: None,
            highest: Rung::F32,
        };
        tree.closest_hit_counted(&climb.ray.clone(), gz_core::ClassMask::ALL, &mut climb);
        assert_ne!(climb.highest, Rung::F32);
    }
}
