//! The best (MAX_DEPTH, MIN_SIZE) of the whole grid against the tree that tunes itself.

use super::agree::settings;
use super::counted::{PerRayVisits, visits};
use super::options::Options;
use super::paper::timed;
use super::rays::{RaySet, answers, differing, room, trace};
use super::scenes::{BenchScene, DEFAULT, PAPER, bench_scene};
use super::table::lines;
use super::timing::{Ratio, median, seconds, take_turns};
use crate::row;
use gz_app::error::AppError;
use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{BruteForce, RayQuery, TriBuffer};

/// The scenes, unless the options name others: the paper's, the default one, teapots of 16 thousand and 1 million triangles, and very
/// uneven triangles.
const SCENES: [&str; 5] = [PAPER, DEFAULT, "teapot:16", "teapot:125", "uneven"];
/// Rounds of the final, unless the options say otherwise.
const ROUNDS: usize = 11;
/// A setting meets ever more of the rays as long as it takes at most so many times as long as the best so far, both measured in the
/// time of the self-tuned tree at the same moment, so that a busy machine does not decide.
const HEATS: [(usize, f64); 3] = [(64, 8.0), (1024, 3.0), (4096, f64::INFINITY)];
/// Seconds that a turn of the final may take: settings that are so slow meet fewer rays, evenly spaced.
const TURN: f64 = 1.0;
/// Settings that go to the final.
const FINALISTS: usize = 4;
/// Brute force checks so many triangle tests' worth of the rays; the rest is checked by the tree that brute force has checked.
const CHECKED_TESTS: f64 = 4e9;

/// `cargo xtask bench grid`.
///
/// # Errors
///
/// If a scene cannot be loaded or an answer differs.
pub fn run(options: &Options) -> Result<(), AppError> {
    let scenes = match options.scenes.is_empty() {
        true => SCENES.map(str::to_owned).to_vec(),
        false => options.scenes.clone(),
    };
    println!(
        "The settings are of the paper's tree with its plain recursive walk and f64 tests alone; the self-tuned tree has its own"
    );
    println!("walk with SIMD. What does not depend on that is beside the times: nodes, leaves and triangles that a ray visits.");
    let mut wrong = 0;
    for name in &scenes {
        let mut scene = bench_scene(name)?;
        if let Some(most) = options.rays {
            scene.rays = scene.rays.sample(most);
        }
        wrong += contest(&scene, options.rounds.unwrap_or(ROUNDS));
    }
    match wrong {
        0 => Ok(()),
        n => Err(AppError::Differs(format!("{n} answers differ"))),
    }
}

/// A setting that came through all heats.
pub(super) struct Finalist<'a> {
    pub(super) setting: Midpoint,
    pub(super) tree: MidpointTree<'a>,
    /// Its time in the last heat, in times of the self-tuned tree.
    time: f64,
    /// Seconds a ray in the last heat.
    pub(super) per_ray: f64,
}

/// Holds the contest on one scene and prints it; returns how many answers differ.
fn contest(scene: &BenchScene, rounds: usize) -> u64 {
    let BenchScene { name, tris, rays } = scene;
    println!("\n{name}: {} triangles, {} rays as the frame asks them", tris.len(), rays.len());
    let (build, tuned) = seconds(|| BspTree::build(tris));
    let mut wrong = check(tris, rays, &tuned);

    let Heats { finalists, tried, refused, stopped, differing: in_heats } = heats(tris, rays, &tuned);
    wrong += in_heats;
    println!(
        "settings: {tried} within the budget ({stopped} of them stopped as too slow on a part of the rays), {refused} over it; \
         {in_heats} of their answers differ"
    );

    // The final: all in turns, best by median. Answers first.
    let slowest = finalists.iter().map(|finalist| finalist.per_ray).fold(0.0, f64::max);
    let rays = &rays.sample(if slowest > 0.0 { (TURN / slowest) as usize } else { usize::MAX });
    let truth = answers(&tuned, rays);
    let in_final: u64 = finalists.iter().map(|finalist| differing(&truth, &answers(&finalist.tree, rays))).sum();
    println!("finalists: {} rays each, {in_final} answers differ", rays.len());
    wrong += in_final;
    let mut contenders: Vec<Box<dyn FnMut() + '_>> = finalists.iter().map(|f| timed(&f.tree, rays)).collect();
    contenders.push(timed(&tuned, rays));
    let times = take_turns(rounds, &mut contenders);
    drop(contenders);
    let (of_tuned, of_settings) = times.split_last().expect("the tree that tunes itself takes part");
    let best = (0..finalists.len()).min_by(|&a, &b| median(&of_settings[a]).total_cmp(&median(&of_settings[b])));

    let mut rows = vec![row![
        "tree",
        "trace ms",
        "ns/ray",
        "nodes/ray",
        "leaves/ray",
        "groups/ray",
        "triangles/ray",
        "f64 tests/ray",
        "MiB"
    ]];
    let line = |name: String, times: &[f64], visits: PerRayVisits, triangles: f64, bytes: usize| {
        let time = median(times);
        row![
            name,
            format!("{:.1}", time * 1e3),
            format!("{:.0}", time * 1e9 / rays.len().max(1) as f64),
            format!("{:.2}", visits.nodes),
            format!("{:.2}", visits.leaves),
            format!("{:.2}", visits.groups),
            format!("{triangles:.2}"),
            format!("{:.2}", visits.tests),
            format!("{:.2}", bytes as f64 / f64::from(1 << 20)),
        ]
    };
    for (finalist, times) in finalists.iter().zip(of_settings) {
        let visits = visits(&finalist.tree, rays);
        let bytes = gz_bsp::TreeStats::of(&finalist.tree).bytes;
        let name = format!("({}, {})", finalist.setting.max_depth, finalist.setting.min_size);
        rows.push(line(name, times, visits, visits.tests, bytes));
    }
    let tuned_visits = visits(&tuned, rays);
    // A filtered group is eight triangles looked at.
    rows.push(line("self-tuned".to_owned(), of_tuned, tuned_visits, 8.0 * tuned_visits.groups, tuned.bytes()));
    print!("{}", lines(&rows));
    if let Some(best) = best {
        let Midpoint { max_depth, min_size, .. } = finalists[best].setting;
        let ratio = Ratio::of(&of_settings[best], of_tuned);
        let of_best = visits(&finalists[best].tree, rays);
        println!(
            "time: ({max_depth}, {min_size}) takes {ratio} of self-tuned, 95% interval of {rounds} paired rounds: {}",
            if ratio.low > 1.0 { "self-tuned is faster" } else { "NOT shown to be faster" }
        );
        println!(
            "visits, whatever the walk: nodes {:.2}x (one of eight cells stands for up to seven), leaves {:.2}x, tests in f64 {:.2}x, \
             triangles looked at {:.2}x (eight at a time)",
            of_best.nodes / tuned_visits.nodes,
            of_best.leaves / tuned_visits.leaves,
            of_best.tests / tuned_visits.tests,
            of_best.tests / (8.0 * tuned_visits.groups),
        );
    }
    println!("self-tuned is built in {:.1} ms", build * 1e3);
    wrong
}

/// Compares the tree that tunes itself with brute force on as many of the rays as that has time for.
pub(super) fn check(tris: &TriBuffer, rays: &RaySet, tuned: &BspTree<'_>) -> u64 {
    let few = rays.sample((CHECKED_TESTS / tris.len().max(1) as f64) as usize);
    let wrong = differing(&answers(&BruteForce::new(tris), &few), &answers(tuned, &few));
    println!("checked by brute force: {} rays, {wrong} differ", few.len());
    wrong
}

/// What came of the heats.
pub(super) struct Heats<'a> {
    /// The fastest first.
    pub(super) finalists: Vec<Finalist<'a>>,
    tried: usize,
    refused: usize,
    stopped: usize,
    pub(super) differing: u64,
}

/// Lets every setting of the grid trace ever more of the rays, until it is clearly slower than the best so far; the fastest go to the
/// final. Whatever is traced is compared with the answers of `tuned`.
pub(super) fn heats<'a>(tris: &'a TriBuffer, rays: &RaySet, tuned: &BspTree<'_>) -> Heats<'a> {
    let parts = HEATS.map(|(most, _)| rays.sample(most));
    let truths = parts.each_ref().map(|part| answers(tuned, part));
    let mut best = [f64::INFINITY; HEATS.len()];
    let mut result = Heats { finalists: Vec::new(), tried: 0, refused: 0, stopped: 0, differing: 0 };

    // Deep ones first: among them are the fast ones, which stop the others early.
    let mut all: Vec<Midpoint> = settings(Midpoint::default().node_budget).collect();
    all.sort_by_key(|setting| (std::cmp::Reverse(setting.max_depth), setting.min_size.abs_diff(5)));
    'settings: for setting in all {
        let Ok(tree) = MidpointTree::build(tris, setting) else {
            result.refused += 1;
            continue;
        };
        result.tried += 1;
        let (mut time, mut per_ray) = (f64::INFINITY, 0.0);
        for (k, ((part, truth), (_, slack))) in parts.iter().zip(&truths).zip(HEATS).enumerate() {
            let mut found = room(part);
            let mut once = |query: &dyn RayQuery| seconds(|| trace(query, part, &mut found)).0;
            // The least of three counts; the setting comes last, so that its answers are there to be compared.
            let of_tuned = (0..3).map(|_| once(tuned)).fold(f64::INFINITY, f64::min);
            let of_setting = (0..3).map(|_| once(&tree)).fold(f64::INFINITY, f64::min);
            (time, per_ray) = (of_setting / of_tuned, of_setting / part.len().max(1) as f64);
            result.differing += differing(truth, &found);
            if time > slack * best[k] {
                result.stopped += 1;
                continue 'settings;
            }
            best[k] = best[k].min(time);
        }
        result.finalists.push(Finalist { setting, tree, time, per_ray });
        result.finalists.sort_by(|a, b| a.time.total_cmp(&b.time));
        result.finalists.truncate(FINALISTS);
    }
    result
}
