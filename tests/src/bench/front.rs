//! Bytes, build time and speed of the self-tuned tree under other prices of a cut, and of the paper's best: what the default gives up,
//! and for what.

use super::grid::{check, heats};
use super::options::Options;
use super::paper::timed;
use super::rays::{RaySet, answers, differing};
use super::scenes::{BenchScene, DEFAULT, bench_scene};
use super::table::lines;
use super::timing::{Ratio, median, take_turns};
use crate::row;
use gz_app::error::AppError;
use gz_bsp::{BspTree, CostModel, Midpoint, MidpointTree, TreeStats};
use gz_core::{RayQuery, TriBuffer};

/// The scenes, unless the options name others: the default one, a teapot of 65 thousand triangles, and very uneven triangles.
const SCENES: [&str; 3] = [DEFAULT, "teapot:32", "uneven"];
/// Prices of a cut beside the default's.
const CUTS: [f32; 4] = [0.3, 0.5, 1.3, 2.0];
/// Rounds, unless the options say otherwise.
const ROUNDS: usize = 7;
/// Rays of a kind, unless the options say otherwise.
const RAYS: usize = 65_536;
/// Rays of a kind that choose the paper's best.
const HEAT_RAYS: usize = 4096;
/// Seconds that a turn of the paper's best may take: it meets fewer rays of a kind, evenly spaced, where all would take longer.
const TURN: f64 = 0.5;

/// `cargo xtask bench front`.
///
/// # Errors
///
/// If a scene cannot be loaded or an answer differs.
pub fn run(options: &Options) -> Result<(), AppError> {
    let scenes = match options.scenes.is_empty() {
        true => SCENES.map(str::to_owned).to_vec(),
        false => options.scenes.clone(),
    };
    let mut wrong = 0;
    for name in &scenes {
        let scene = bench_scene(name)?;
        wrong += front(&scene, options.rays.unwrap_or(RAYS), options.rounds.unwrap_or(ROUNDS))?;
    }
    match wrong {
        0 => Ok(()),
        n => Err(AppError::Differs(format!("{n} answers differ"))),
    }
}

/// How a tree is built.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Setting {
    Cut(f32),
    Paper(Midpoint),
}

impl Setting {
    fn name(self) -> String {
        match self {
            Self::Cut(cut) if cut == CostModel::default().cut => format!("cut {cut:?} (default)"),
            Self::Cut(cut) => format!("cut {cut:?}"),
            Self::Paper(Midpoint { max_depth, min_size, .. }) => format!("paper's best ({max_depth}, {min_size})"),
        }
    }

    /// The tree and its bytes; `None` when it is beyond its budget.
    fn build(self, tris: &TriBuffer) -> Option<(Box<dyn RayQuery + '_>, usize)> {
        match self {
            Self::Cut(cut) => {
                let tree = BspTree::with_cost(tris, CostModel { cut });
                let bytes = tree.bytes();
                Some((Box::new(tree), bytes))
            }
            Self::Paper(setting) => {
                let tree = MidpointTree::build(tris, setting).ok()?;
                let bytes = TreeStats::of(&tree).bytes;
                Some((Box::new(tree), bytes))
            }
        }
    }
}

/// A setting's figures. Less is better in all of them.
#[derive(Clone, Debug, PartialEq)]
struct Place {
    bytes: f64,
    build: f64,
    /// Seconds for each kind of rays.
    trace: Vec<f64>,
}

impl Place {
    /// Whether `other` is at least as good in everything and better in something.
    fn is_beaten_by(&self, other: &Self) -> bool {
        let all = |place: &Self| [&[place.bytes, place.build], &place.trace[..]].concat();
        let (mine, theirs) = (all(self), all(other));
        theirs.iter().zip(&mine).all(|(a, b)| a <= b) && theirs != mine
    }
}

/// Measures one scene and prints it; returns how many answers differ.
fn front(scene: &BenchScene, most: usize, rounds: usize) -> Result<u64, AppError> {
    let BenchScene { name, tris, rays } = scene;
    println!("\n{name}: {} triangles", tris.len());
    let random = RaySet::random(&tris.bounds(), most);
    let kinds = [("primary", rays.primary()), ("shadow", rays.shadow()), ("bounced", rays.bounced()), ("random", random)];
    let kinds: Vec<(&str, RaySet)> =
        kinds.into_iter().filter(|(_, rays)| !rays.is_empty()).map(|(kind, rays)| (kind, rays.sample(most))).collect();

    // Answers: the default's by brute force, all others' by the default.
    let default = BspTree::build(tris);
    let mut wrong = kinds.iter().map(|(_, rays)| check(tris, rays, &default)).sum::<u64>();
    let sample = RaySet { batches: kinds.iter().flat_map(|(_, rays)| rays.sample(HEAT_RAYS).batches).collect() };
    let paper = heats(tris, &sample, &default);
    wrong += paper.differing;

    let mut cuts = [&CUTS[..], &[CostModel::default().cut]].concat();
    cuts.sort_by(f32::total_cmp);
    let mut settings: Vec<Setting> = cuts.into_iter().map(Setting::Cut).collect();
    let affordable = paper.finalists.first().map_or(usize::MAX, |best| (TURN / best.per_ray) as usize);
    settings.extend(paper.finalists.first().map(|best| Setting::Paper(best.setting)));
    drop(paper);
    let built: Vec<_> = settings.iter().filter_map(|setting| setting.build(tris)).collect();
    if built.len() != settings.len() {
        return Err(AppError::Usage("a setting that was built once is beyond its budget".to_owned()));
    }
    let part = |setting: &Setting, rays: &RaySet| match setting {
        Setting::Cut(_) => rays.clone(),
        Setting::Paper(_) => rays.sample(affordable),
    };
    let parts: Vec<Vec<RaySet>> = kinds.iter().map(|(_, rays)| settings.iter().map(|s| part(s, rays)).collect()).collect();
    let mut compared = 0;
    for parts in &parts {
        for ((tree, _), rays) in built.iter().zip(parts) {
            wrong += differing(&answers(&default, rays), &answers(&**tree, rays));
            compared += rays.len();
        }
    }
    println!("{compared} answers of {} trees compared, {wrong} differ", built.len());

    // Times, in turns.
    let mut builds: Vec<Box<dyn FnMut() + '_>> = Vec::new();
    for &setting in &settings {
        builds.push(Box::new(move || {
            std::hint::black_box(setting.build(tris));
        }));
    }
    let builds = take_turns(rounds, &mut builds);
    // Seconds for all rays of a kind, by kind, setting and round; from a part of them where not all were traced.
    let traces: Vec<Vec<Vec<f64>>> = kinds
        .iter()
        .zip(&parts)
        .map(|((_, rays), parts)| {
            let mut contenders: Vec<Box<dyn FnMut() + '_>> =
                built.iter().zip(parts).map(|((tree, _), part)| timed(&**tree, part)).collect();
            let times = take_turns(rounds, &mut contenders);
            let scale = |part: &RaySet| rays.len() as f64 / part.len() as f64;
            times.iter().zip(parts).map(|(times, part)| times.iter().map(|t| t * scale(part)).collect()).collect()
        })
        .collect();

    let places: Vec<Place> = (0..settings.len())
        .map(|k| Place {
            bytes: built[k].1 as f64 / tris.len().max(1) as f64,
            build: median(&builds[k]),
            trace: traces.iter().map(|times| median(&times[k])).collect(),
        })
        .collect();
    print_table(&settings, &places, &kinds, &traces);
    Ok(wrong)
}

fn print_table(settings: &[Setting], places: &[Place], kinds: &[(&str, RaySet)], traces: &[Vec<Vec<f64>>]) {
    let default = settings.iter().position(|setting| *setting == Setting::Cut(CostModel::default().cut));
    let mut head = row!["setting", "front", "bytes/triangle", "build s"];
    head.extend(kinds.iter().flat_map(|(kind, _)| row![format!("{kind} Mrays/s"), "of default [95%]"]));
    let mut rows = vec![head];
    for (k, (setting, place)) in settings.iter().zip(places).enumerate() {
        let on_front = !places.iter().any(|other| place.is_beaten_by(other));
        let mut row = row![setting.name(), if on_front { "*" } else { "" }];
        row.extend(row![format!("{:.1}", place.bytes), format!("{:.4}", place.build)]);
        for (((_, rays), time), times) in kinds.iter().zip(&place.trace).zip(traces) {
            row.push(format!("{:.3}", rays.len() as f64 / time / 1e6));
            row.push(default.map_or_else(String::new, |of| Ratio::of(&times[of], &times[k]).to_string()));
        }
        rows.push(row);
    }
    print!("{}", lines(&rows));
    let asked: Vec<String> = kinds.iter().map(|(kind, rays)| format!("{} {kind}", rays.len())).collect();
    println!("*: no other setting is at least as good in every column (by medians); rays: {}", asked.join(", "));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_beaten_by_one_that_is_nowhere_worse() {
        let place = |bytes, build, trace: [f64; 2]| Place { bytes, build, trace: trace.to_vec() };
        let one = place(10.0, 1.0, [2.0, 2.0]);
        assert!(one.is_beaten_by(&place(10.0, 1.0, [2.0, 1.9])) && one.is_beaten_by(&place(9.0, 0.5, [1.0, 1.0])));
        assert!(!one.is_beaten_by(&one) && !one.is_beaten_by(&place(1.0, 0.1, [0.1, 2.1])));
    }

    #[test]
    fn the_default_is_named_and_every_setting_answers_alike() {
        assert_eq!(Setting::Cut(CostModel::default().cut).name(), format!("cut {:?} (default)", CostModel::default().cut));
        assert!(!CUTS.contains(&CostModel::default().cut));
        let scene = bench_scene("teapot:2").unwrap();
        assert_eq!(front(&scene, 500, 2).unwrap(), 0);
    }
}
