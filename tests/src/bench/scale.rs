//! Build time, trace speed and memory of the self-tuned tree against the number of triangles.

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
const SEGMENTS: [u32; 8] = [4, 8, 16, 32, 64, 125, 250, 354];
/// Above this many triangles a build is timed once.
const ONCE: usize = 2_000_000;
/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 3;
/// Brute force checks so many triangle tests' worth of the rays.
const CHECKED_TESTS: f64 = 1e9;
/// Below this many triangles build time is mostly what every build takes, and is left out of the exponent.
const FITTED_FROM: usize = 4000;

/// `cargo xtask bench scale`: teapots up to `--limit` triangles.
///
/// # Errors
///
/// If an answer differs.
pub fn run(options: &Options) -> Result<(), AppError> {
    let limit = options.limit.unwrap_or(usize::MAX);
    let head = "triangles,build 1 thread s,build all threads s,Mtri/s,primary rays,Mrays/s,bytes/triangle,checked,differ";
    let mut rows = vec![head.split(',').map(str::to_owned).collect::<Vec<_>>()];
    let (mut sizes, mut single, mut shared, mut wrong) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for segments in SEGMENTS {
        // 64 triangles for every segment by segment of the 32 patches.
        if 64 * (segments * segments) as usize > limit {
            break;
        }
        let scene = bench_scene(&format!("teapot:{segments}"))?;
        let tris = &scene.tris;
        // Primary rays: those that leave the camera, which all start at one point and ask for hits.
        let mut rays = scene.rays.primary();
        if let Some(most) = options.rays {
            rays = rays.sample(most);
        }
        let rounds = if tris.len() > ONCE { 1 } else { options.rounds.unwrap_or(ROUNDS) };
        let (one, all): (Vec<f64>, Vec<f64>) = (0..rounds)
            .map(|_| -> Result<(f64, f64), AppError> {
                let build = || Ok(seconds(|| BspTree::build(tris)).0);
                Ok((gz_app::threads::with(1, build)?, gz_app::threads::with(0, build)?))
            })
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .unzip();
        let tree = BspTree::build(tris);
        let few = rays.sample((CHECKED_TESTS / tris.len() as f64) as usize);
        let differ = differing(&answers(&BruteForce::new(tris), &few), &answers(&tree, &few));
        wrong += differ;
        let mut found = room(&rays);
        let traces: Vec<f64> = (0..rounds.max(3)).map(|_| seconds(|| trace(&tree, &rays, &mut found)).0).collect();
        let (one, all) = (median(&one), median(&all));
        sizes.push(tris.len() as f64);
        single.push(one);
        shared.push(all);
        rows.push(row![
            tris.len(),
            format!("{one:.4}"),
            format!("{all:.4}"),
            format!("{:.2}", tris.len() as f64 / all / 1e6),
            rays.len(),
            format!("{:.2}", rays.len() as f64 / median(&traces) / 1e6),
            format!("{:.1}", tree.bytes() as f64 / tris.len() as f64),
            few.len(),
            differ,
        ]);
        println!("{} triangles: done", tris.len());
    }
    print!("{}", lines(&rows));
    let fitted = sizes.iter().position(|&n| n >= FITTED_FROM as f64).unwrap_or(0);
    match (exponent(&sizes[fitted..], &single[fitted..]), exponent(&sizes[fitted..], &shared[fitted..])) {
        (Some(one), Some(all)) => {
            println!("build time grows as n^{one:.3} on one thread, n^{all:.3} on all (from {FITTED_FROM} triangles)")
        }
        _ => println!("too few sizes for an exponent"),
    }
    match wrong {
        0 => Ok(()),
        n => Err(AppError::Differs(format!("{n} answers differ from those of brute force"))),
    }
}

/// The exponent e of the least-squares line of log y = e log x + c; `None` for fewer than two sizes.
fn exponent(x: &[f64], y: &[f64]) -> Option<f64> {
    let n = x.len() as f64;
    let mean = |values: &[f64]| values.iter().map(|v| v.ln()).sum::<f64>() / n;
    let (mx, my) = (mean(x), mean(y));
    let (over, under) = x.iter().zip(y).fold((0.0, 0.0), |(over, under), (x, y)| {
        let dx = x.ln() - mx;
        (over + dx * (y.ln() - my), under + dx * dx)
    });
    (x.len() >= 2 && under > 0.0).then(|| over / under)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponent_of_a_power_is_found() {
        let x = [1e3, 1e4, 1e6];
        let found = exponent(&x, &x.map(|x: f64| 3.0 * x.powf(1.1))).unwrap();
        assert!((found - 1.1).abs() < 1e-9, "{found}");
        assert_eq!(exponent(&x[..1], &x[..1]), None);
    }
}
