//! The paper's two tables (its section 4.3), with our times, counts and errors beside its milliseconds.

use super::counted::{Counted, PerRayVisits, brute_tests, visits, visits_and_answers};
use super::options::Options;
use super::rays::{Answer, RaySet, answers, differing, other_triangle, room, trace};
use super::scenes::{BenchScene, DEFAULT, PAPER, bench_scene, has_course_data};
use super::table::lines;
use super::timing::{median, seconds, take_turns};
use crate::row;
use gz_app::error::AppError;
use gz_bsp::{BspTree, CostStats, Midpoint, MidpointTree, TreeStats};
use gz_core::{BruteForce, Kernel, RayQuery, TriBuffer};

/// A row of the paper's tables: MAX_DEPTH, MIN_SIZE, its milliseconds. Brute force took about 2450 ms.
pub(crate) const PUBLISHED: [(u32, usize, f64); 12] = [
    (5, 10, 452.0),
    (8, 10, 214.0),
    (10, 10, 130.0),
    (12, 10, 72.0),
    (15, 10, 57.0),
    (20, 10, 62.0),
    (15, 3, 45.0),
    (15, 5, 45.0),
    (15, 10, 57.0),
    (15, 15, 64.0),
    (15, 20, 98.0),
    (15, 30, 120.0),
];
/// Rows of the first table, over MAX_DEPTH; the others are the second, over MIN_SIZE.
const FIRST_TABLE: usize = 6;
pub(crate) const PUBLISHED_BRUTE: f64 = 2450.0;

/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 5;
/// Rays of a scene that the paper does not have, unless the options say otherwise: its slow settings take their time.
const RAYS: usize = 2_000;
/// Brute force and trees that are nearly as slow are timed on as many of the rays as come to this many triangle tests.
const TIMED_TESTS: f64 = 2e7;

/// `cargo xtask bench paper`.
///
/// # Errors
///
/// If a scene cannot be loaded or an answer differs.
pub fn run(options: &Options) -> Result<(), AppError> {
    let scenes = match options.scenes.is_empty() {
        true => vec![PAPER.to_owned(), DEFAULT.to_owned()],
        false => options.scenes.clone(),
    };
    let mut wrong = 0;
    for name in &scenes {
        let mut scene = bench_scene(name)?;
        let most = options.rays.unwrap_or(if name == PAPER { usize::MAX } else { RAYS });
        scene.rays = scene.rays.sample(most).as_closest();
        let published = name == PAPER && has_course_data() && options.rays.is_none();
        wrong += table(&scene, options.rounds.unwrap_or(ROUNDS), published)?;
    }
    match wrong {
        0 => Ok(()),
        n => Err(AppError::Differs(format!("{n} answers differ from those of brute force"))),
    }
}

/// One contender's measurements.
struct Measured {
    build: Vec<f64>,
    visits: PerRayVisits,
    differing: u64,
}

/// Measures a tree that `build` makes: build times, visits and errors.
fn measure<T: Counted + RayQuery>(
    rounds: usize,
    rays: &RaySet,
    truth: &[Answer],
    build: impl Fn() -> Result<T, AppError>,
) -> Result<(T, Measured), AppError> {
    let (first, tree) = seconds(&build);
    let tree = tree?;
    let times = (1..rounds).map(|_| seconds(&build).0).chain([first]).collect();
    let (visits, found) = visits_and_answers(&tree, rays);
    let measured = Measured { build: times, visits, differing: differing(truth, &found) };
    Ok((tree, measured))
}

/// Prints both tables of a scene; returns how many answers differ from brute force.
fn table(scene: &BenchScene, rounds: usize, published: bool) -> Result<u64, AppError> {
    let BenchScene { name, tris, rays } = scene;
    println!("\n{name}: {} triangles, {} rays, all asked for the front-most hit", tris.len(), rays.len());
    let brute = BruteForce::new(tris);
    let plain = BruteForce::with_kernel(tris, Kernel::Plane);
    let truth = answers(&brute, rays);

    // Build, count and compare.
    let mut trees = Vec::new();
    for (max_depth, min_size, _) in PUBLISHED {
        let setting = Midpoint { max_depth, min_size, ..Midpoint::default() };
        let build = || MidpointTree::build(tris, setting).map_err(|error| AppError::Usage(error.to_string()));
        trees.push(measure(rounds, rays, &truth, build)?);
    }
    let (tuned, mut tuned_measured) = measure(rounds, rays, &truth, || Ok(BspTree::build(tris)))?;
    // What is timed is asked in batches, which may go another way than single rays.
    tuned_measured.differing += differing(&truth, &answers(&tuned, rays));
    let sample = rays.sample(20_000);
    let plain_differs = other_triangle(&answers(&brute, &sample), &answers(&plain, &sample));

    // Trace, in turns.
    let affordable = |tests: f64| rays.sample((TIMED_TESTS / tests.max(1.0)) as usize);
    let scale_of = |part: &RaySet| rays.len() as f64 / part.len().max(1) as f64;
    let few = affordable(tris.len() as f64);
    let scale = scale_of(&few);
    let parts: Vec<RaySet> = trees.iter().map(|(_, measured)| affordable(measured.visits.tests)).collect();
    let mut contenders: Vec<Box<dyn FnMut() + '_>> = vec![timed(&brute, &few), timed(&plain, &few)];
    contenders.extend(trees.iter().zip(&parts).map(|((tree, _), part)| timed(tree, part)));
    contenders.push(timed(&tuned, rays));
    let times = take_turns(rounds, &mut contenders);
    drop(contenders);
    let (brute_time, plain_time) = (median(&times[0]) * scale, median(&times[1]) * scale);

    // Print.
    let head = row![
        "MAX_DEPTH, MIN_SIZE",
        "nodes",
        "leaves",
        "empty",
        "references",
        "largest",
        "nodes/ray",
        "leaves/ray",
        "tests/ray",
        "fewer",
        "build ms",
        "trace ms",
        "vs ours",
        "vs plain",
        "paper ms",
        "paper",
        "errors"
    ];
    let all_tests = brute_tests(tris.len(), rays);
    let mut rows = vec![head.clone()];
    let wrong = trees.iter().map(|(_, measured)| measured.differing).sum::<u64>() + tuned_measured.differing;
    for (k, ((max_depth, min_size, ms), (tree, measured))) in PUBLISHED.iter().zip(&trees).enumerate() {
        if k == FIRST_TABLE {
            rows.push(head.clone());
        }
        let TreeStats { nodes, leaves, empty_leaves, references, largest_leaf, .. } = TreeStats::of(tree);
        let structure = row![format!("({max_depth}, {min_size})"), nodes, leaves, empty_leaves, references, largest_leaf];
        let theirs = if published { row![ms, format!("{:.1}x", PUBLISHED_BRUTE / ms)] } else { row!["-", "-"] };
        let trace = median(&times[2 + k]) * scale_of(&parts[k]);
        rows.push(
            [structure, ours(measured, all_tests, trace, brute_time, plain_time), theirs, row![measured.differing]].concat(),
        );
    }
    let CostStats { nodes, leaves, references, largest_leaf, .. } = CostStats::of(&tuned);
    let structure = row!["self-tuned", nodes, leaves, "-", references, largest_leaf];
    let trace = times.last().map_or(f64::NAN, |times| median(times));
    let figures = ours(&tuned_measured, all_tests, trace, brute_time, plain_time);
    rows.push([structure, figures, row!["-", "-", tuned_measured.differing]].concat());
    print!("{}", lines(&rows));
    let groups = tuned_measured.visits.groups;
    println!(
        "brute force: {all_tests:.2} tests/ray; ours {:.1} ms, plain f32 {:.1} ms{}; plain has another triangle on {plain_differs} of {} rays \
         (it skips no triangle, so rays that leave one hit it again)",
        brute_time * 1e3,
        plain_time * 1e3,
        if scale > 1.0 { format!(" (from one ray in {scale:.0})") } else { String::new() },
        sample.len(),
    );
    println!(
        "self-tuned: nodes have eight cells, {groups:.2} groups of eight triangles are filtered a ray, tests are those in f64 behind it; \
         the other trees are the plain recursive walk with f64 tests alone"
    );
    println!("errors: {wrong} of {} answers differ from brute force in t, triangle, u or v", rays.len() * (trees.len() + 2));
    Ok(wrong)
}

/// Tests, times and speed-ups of a tree as cells.
fn ours(measured: &Measured, all_tests: f64, trace: f64, brute: f64, plain: f64) -> Vec<String> {
    let PerRayVisits { nodes, leaves, tests, .. } = measured.visits;
    row![
        format!("{nodes:.2}"),
        format!("{leaves:.2}"),
        format!("{tests:.2}"),
        format!("{:.1}x", all_tests / tests),
        format!("{:.2}", median(&measured.build) * 1e3),
        format!("{:.1}", trace * 1e3),
        format!("{:.1}x", brute / trace),
        format!("{:.1}x", plain / trace),
    ]
}

/// Asking `query` about all rays, ready to be timed.
pub(crate) fn timed<'q>(query: &'q dyn RayQuery, rays: &'q RaySet) -> Box<dyn FnMut() + 'q> {
    let mut answers = room(rays);
    Box::new(move || {
        trace(query, rays, &mut answers);
        std::hint::black_box(&answers);
    })
}

/// Sizes and tests per ray of the paper's tree over `tris`, as its tables have them.
pub fn structure(tris: &TriBuffer, rays: &RaySet, setting: Midpoint) -> Result<(TreeStats, f64), AppError> {
    let tree = MidpointTree::build(tris, setting).map_err(|error| AppError::Usage(error.to_string()))?;
    Ok((TreeStats::of(&tree), visits(&tree, rays).tests))
}
