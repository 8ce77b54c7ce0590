//! Build time, trace time and memory of the self-tuned tree against the number of triangles.

use super::growth::Power;
use super::memory;
use super::options::Options;
use super::rays::{answers, differing, room, trace};
use super::scenes::bench_scene;
use super::table::lines;
use super::timing::{median, seconds};
use crate::row;
use gz_app::error::AppError;
use gz_bsp::BspTree;
use gz_core::BruteForce;

/// Segments of the teapots: 1 thousand, 4, 16, 64, 262 thousand, 1, 4 and 8 million triangles.
pub(crate) const SEGMENTS: [u32; 8] = [4, 8, 16, 32, 64, 125, 250, 354];
/// Above this many triangles a build is timed once.
const ONCE: usize = 2_000_000;
/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 3;
/// Brute force checks so many triangle tests' worth of the rays.
const CHECKED_TESTS: f64 = 1e9;
/// Below this many triangles build time is mostly what every build takes, and is left out of the exponent.
const FITTED_FROM: usize = 4000;
/// Triangles of [`memory::SCENE`].
const LARGEST: usize = 10_240_000;

/// `cargo xtask bench scale`: teapots up to `--limit` triangles, and then the memory of a render of the largest, in a process of its own.
///
/// # Errors
///
/// If an answer differs, or the render takes more memory than it may.
pub fn run(options: &Options) -> Result<(), AppError> {
    let limit = options.limit.unwrap_or(usize::MAX);
    let head = "triangles,build 1 thread s,build all threads s,Mtri/s,primary rays,ns/ray,Mrays/s,bytes/triangle,checked,differ";
    let mut rows = vec![head.split(',').map(str::to_owned).collect::<Vec<_>>()];
    let (mut sizes, mut single, mut shared, mut traced, mut wrong) = (Vec::new(), Vec::new(), Vec::new(), Vec::new(), 0);
    for segments in SEGMENTS {
        // 64 triangles for every segment by segment of the 32 patches.
        if 64 * (segments * segments) as usize > limit {
            break;
        }
        let rounds = |triangles: usize| if triangles > ONCE { 1 } else { options.rounds.unwrap_or(ROUNDS) };
        let size = Size::measure(segments, rounds(64 * (segments * segments) as usize), options.rays, CHECKED_TESTS)?;
        let Size { triangles, build_one, build_all, rays, per_ray, bytes, checked, differing } = size;
        sizes.push(triangles as f64);
        single.push(build_one);
        shared.push(build_all);
        traced.push(per_ray);
        wrong += differing;
        rows.push(row![
            triangles,
            format!("{build_one:.4}"),
            format!("{build_all:.4}"),
            format!("{:.2}", triangles as f64 / build_all / 1e6),
            rays,
            format!("{:.0}", per_ray * 1e9),
            format!("{:.2}", 1e-6 / per_ray),
            format!("{:.1}", bytes as f64 / triangles as f64),
            checked,
            differing,
        ]);
        println!("{triangles} triangles: done");
    }
    print!("{}", lines(&rows));
    let fitted = sizes.iter().position(|&n| n >= FITTED_FROM as f64).unwrap_or(0);
    println!("growth from {FITTED_FROM} triangles, by least squares of logarithms; the residual is its root mean square:");
    for (what, times) in
        [("build time on one thread", &single), ("build time on all threads", &shared), ("time of a primary ray", &traced)]
    {
        match Power::fit(&sizes[fitted..], &times[fitted..]) {
            Some(Power { exponent, residual }) => println!("{what}: n^{exponent:.3}, residual {:.1}%", 100.0 * residual),
            None => println!("{what}: too few sizes for an exponent"),
        }
    }
    match wrong {
        0 if limit >= LARGEST => alone(options),
        0 => Ok(()),
        n => Err(AppError::Differs(format!("{n} answers differ from those of brute force"))),
    }
}

/// What one size of teapot gives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    pub(crate) triangles: usize,
    /// Seconds to build on one thread.
    pub(crate) build_one: f64,
    /// Seconds to build on all.
    pub(crate) build_all: f64,
    /// Primary rays traced.
    pub(crate) rays: usize,
    /// Seconds a ray.
    pub(crate) per_ray: f64,
    /// Bytes of the tree.
    pub(crate) bytes: usize,
    /// Rays compared with brute force.
    pub(crate) checked: usize,
    /// Of these, answers that differ.
    pub(crate) differing: u64,
}

impl Size {
    /// Measures a teapot of so many segments with its primary rays, at most `most` of them, evenly spaced; brute force checks
    /// `checked_tests` triangle tests' worth.
    ///
    /// # Errors
    ///
    /// If there are no threads to be had.
    pub(crate) fn measure(segments: u32, rounds: usize, most: Option<usize>, checked_tests: f64) -> Result<Self, AppError> {
        let scene = bench_scene(&format!("teapot:{segments}"))?;
        let tris = &scene.tris;
        // Primary rays: those that leave the camera, which all start at one point and ask for hits.
        let rays = most.map_or_else(|| scene.rays.primary(), |most| scene.rays.primary().sample(most));
        let (one, all): (Vec<f64>, Vec<f64>) = (0..rounds)
            .map(|_| -> Result<(f64, f64), AppError> {
                let build = || Ok(seconds(|| BspTree::build(tris)).0);
                Ok((gz_app::threads::with(1, build)?, gz_app::threads::with(0, build)?))
            })
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .unzip();
        let tree = BspTree::build(tris);
        let few = rays.sample((checked_tests / tris.len() as f64) as usize);
        let differing = differing(&answers(&BruteForce::new(tris), &few), &answers(&tree, &few));
        let mut found = room(&rays);
        let traces: Vec<f64> = (0..rounds.max(3)).map(|_| seconds(|| trace(&tree, &rays, &mut found)).0).collect();
        Ok(Self {
            triangles: tris.len(),
            build_one: median(&one),
            build_all: median(&all),
            rays: rays.len(),
            per_ray: median(&traces) / rays.len().max(1) as f64,
            bytes: tree.bytes(),
            checked: few.len(),
            differing,
        })
    }
}

/// The exponent of the power of `x` that `y` grows with, by least squares of logarithms; `None` for fewer than two sizes.
pub(crate) fn power_of(x: &[f64], y: &[f64]) -> Option<f64> {
    Power::fit(x, y).map(|power| power.exponent)
}

/// Runs the memory bench in a process of its own, whose peak nothing else has a part in.
fn alone(options: &Options) -> Result<(), AppError> {
    let program = std::env::current_exe().map_err(|error| AppError::Io(format!("this program cannot be found: {error}")))?;
    let mut command = std::process::Command::new(program);
    command.args(["memory", "--scene", memory::SCENE, "--threads", &options.threads.to_string()]);
    let status = command.status().map_err(|error| AppError::Io(format!("the memory bench cannot be started: {error}")))?;
    if status.success() { Ok(()) } else { Err(AppError::Differs("the memory bench failed".to_owned())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_scene_is_as_large_as_it_says() {
        let segments: usize = memory::SCENE.strip_prefix("teapot:").and_then(|n| n.parse().ok()).unwrap();
        assert_eq!(64 * segments * segments, LARGEST);
    }
}
