//! The tree that tunes itself against brute force: plain C with `cc -O2`, the paper's test in Rust, and our own.

use super::options::Options;
use super::plain_c::PlainC;
use super::rays::{Answer, answers, differing, room, trace};
use super::scenes::{BenchScene, PAPER, bench_scene};
use super::table::lines;
use super::timing::{Ratio, median, seconds};
use crate::row;
use gz_app::error::AppError;
use gz_bsp::BspTree;
use gz_core::{BruteForce, Hit, Kernel, RayQuery};

/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 7;
/// Rays on which a program without exact tests may give another triangle than the exact one: an edge here and there.
const PLAIN_MAY_DIFFER: f64 = 1e-3;

/// `cargo xtask bench brute`: on the paper's scene, or the scenes named.
///
/// # Errors
///
/// If a scene cannot be loaded, the C program fails, or an answer is wrong.
pub fn run(options: &Options) -> Result<(), AppError> {
    let scenes = if options.scenes.is_empty() { vec![PAPER.to_owned()] } else { options.scenes.clone() };
    for name in &scenes {
        let mut scene = bench_scene(name)?;
        if let Some(most) = options.rays {
            scene.rays = scene.rays.sample(most);
        }
        scene.rays = scene.rays.as_closest();
        contest(&scene, options.rounds.unwrap_or(ROUNDS))?;
    }
    Ok(())
}

fn contest(scene: &BenchScene, rounds: usize) -> Result<(), AppError> {
    let BenchScene { name, tris, rays } = scene;
    println!("\n{name}: {} triangles, {} rays, all asked for the front-most hit", tris.len(), rays.len());
    let tree = BspTree::build(tris);
    let ours = BruteForce::new(tris);
    let plain = BruteForce::with_kernel(tris, Kernel::Plane);
    let c = PlainC::new(tris, rays)?;

    // Answers first.
    let truth = answers(&ours, rays);
    let wrong = differing(&truth, &answers(&tree, rays));
    println!("self-tuned tree against exact brute force: {} rays, {wrong} differ", rays.len());
    if wrong > 0 {
        return Err(AppError::Differs(format!("{wrong} answers differ from those of brute force")));
    }
    if let Some(c) = &c {
        c.seconds()?;
        check_plain(&truth, &c.hits()?)?;
    } else {
        println!("plain C: left out, there is no cc");
    }

    // Then times, in turns. The C program runs by itself and times its own tracing.
    let mut found = room(rays);
    let mut of = |query: &dyn RayQuery| seconds(|| trace(query, rays, &mut found)).0;
    let mut times: [Vec<f64>; 4] = Default::default();
    for _ in 0..rounds {
        times[0].push(of(&tree));
        times[1].push(of(&ours));
        times[2].push(of(&plain));
        if let Some(c) = &c {
            times[3].push(c.seconds()?);
        }
    }
    let mut rows = vec![row!["contender", "trace ms", "ns/ray", "self-tuned is faster by [95% interval]"]];
    for (contender, times_of) in ["self-tuned tree", "our brute force", "plain f32 in Rust", "plain C, cc -O2"].iter().zip(&times)
    {
        if times_of.is_empty() {
            continue;
        }
        let time = median(times_of);
        let per_ray = time * 1e9 / rays.len().max(1) as f64;
        rows.push(row![contender, format!("{:.1}", time * 1e3), format!("{per_ray:.0}"), Ratio::of(times_of, &times[0])]);
    }
    print!("{}", lines(&rows));
    if !times[3].is_empty() {
        let ratio = Ratio::of(&times[3], &times[0]);
        let verdict = if ratio.low >= 100.0 { "reached" } else { "NOT reached" };
        println!("goal of 100 times plain C: {verdict} ({ratio}; {rounds} rounds)");
    }
    Ok(())
}

/// Counts the rays on which the C program has another triangle than the exact answer; it must be close enough to be the same work.
fn check_plain(truth: &[Answer], found: &[Hit]) -> Result<(), AppError> {
    let exact = truth.iter().flat_map(|answer| match answer {
        Answer::Hits(hits) => &hits[..],
        Answer::Blocked(_) => &[],
    });
    let (mut rays, mut other) = (0u64, 0u64);
    for (exact, found) in exact.zip(found) {
        rays += 1;
        other += u64::from(exact.tri != found.tri);
    }
    println!("plain C against exact brute force: {rays} rays, {other} have another triangle (f32, no exact test)");
    if rays != found.len() as u64 || other as f64 > PLAIN_MAY_DIFFER * rays as f64 {
        return Err(AppError::Differs(format!("the plain C program gives another triangle on {other} of {rays} rays")));
    }
    Ok(())
}
