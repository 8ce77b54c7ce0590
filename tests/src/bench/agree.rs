//! Brute force, the tree that tunes itself and the paper's tree at every setting: equal answers to every ray.

use super::options::Options;
use super::rays::{Answer, RaySet, TILE, answers, differing, frame_rays};
use super::scenes::{self, asset_scenes, loaded};
use super::table::lines;
use crate::row;
use gz_app::error::AppError;
use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{BruteForce, SimdLevel, TriBuffer};
use std::path::PathBuf;

/// MAX_DEPTH of the grid of settings.
pub const DEPTHS: [u32; 8] = [1, 2, 5, 8, 10, 12, 15, 20];
/// MIN_SIZE of the grid of settings.
pub const SIZES: [usize; 9] = [0, 1, 3, 5, 10, 15, 20, 30, 100];

/// Every setting of the grid.
pub fn settings(node_budget: usize) -> impl Iterator<Item = Midpoint> {
    let of = move |(max_depth, min_size)| Midpoint { max_depth, min_size, node_budget };
    DEPTHS.into_iter().flat_map(|max_depth| SIZES.map(|min_size| (max_depth, min_size))).map(of)
}

/// How many answers were compared with those of brute force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rays asked about.
    pub rays: u64,
    /// Answers compared: each ray once for every tree.
    pub compared: u64,
    /// Of these, how many differ.
    pub differing: u64,
    /// Settings of the paper's tree that were within the node budget.
    pub settings: usize,
    /// And those that were refused.
    pub refused: usize,
}

impl Tally {
    fn add(&mut self, truth: &[Answer], found: &[Answer], rays: u64) {
        self.compared += rays;
        self.differing += differing(truth, found);
    }
}

/// Compares the tree that tunes itself, at every SIMD level of this machine, and the paper's tree at each of `settings` within its node
/// budget, with brute force.
pub fn compare(tris: &TriBuffer, rays: &RaySet, settings: impl IntoIterator<Item = Midpoint>) -> Tally {
    let truth = answers(&BruteForce::new(tris), rays);
    let mut tally = Tally { rays: rays.len() as u64, ..Tally::default() };
    for &level in SimdLevel::available() {
        let tree = BspTree::build(tris).with_simd(level);
        tally.add(&truth, &answers(&tree, rays), tally.rays);
    }
    for setting in settings {
        match MidpointTree::build(tris, setting) {
            Ok(tree) => {
                tally.settings += 1;
                tally.add(&truth, &answers(&tree, rays), tally.rays);
            }
            Err(_) => tally.refused += 1,
        }
    }
    tally
}

/// The rays of a scene's render, `width` pixels wide, asked for their front-most hits; nothing when the scene needs course data that is
/// not there.
///
/// # Errors
///
/// If the scene cannot be loaded for any other reason.
pub fn recorded(path: &PathBuf, width: u32) -> Result<Option<(TriBuffer, RaySet)>, AppError> {
    let needs_course_data = || std::fs::read_to_string(path).is_ok_and(|text| text.contains("hw:"));
    let (scene, needs) = match loaded(path, width) {
        Ok(loaded) => loaded,
        Err(AppError::Load(_)) if !scenes::has_course_data() && needs_course_data() => return Ok(None),
        Err(error) => return Err(error),
    };
    let tree = BspTree::build(&scene.tris);
    let rays = frame_rays(&scene, needs, &tree, TILE)?;
    drop(tree);
    Ok(Some((scene.tris, rays)))
}

/// Nodes allowed for one tree of this bench.
const BUDGET: usize = 1 << 18;

/// `cargo xtask bench agree`: all rays of every scene of assets, or of the scenes named.
///
/// # Errors
///
/// If a scene cannot be loaded or an answer differs.
pub fn run(options: &Options) -> Result<(), AppError> {
    let paths = match options.scenes.is_empty() {
        true => asset_scenes()?,
        false => options.scenes.iter().map(PathBuf::from).collect(),
    };
    let mut rows = vec![row!["scene", "triangles", "rays", "settings", "over budget", "answers", "differ"]];
    let mut all = Tally::default();
    for path in &paths {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let Some((tris, rays)) = recorded(path, scenes::WIDTH)? else {
            println!("{stem}: left out, it needs course data (GZ_HW_DATA)");
            continue;
        };
        let rays = options.rays.map_or(rays.clone(), |most| rays.sample(most)).as_closest();
        let tally = compare(&tris, &rays, settings(BUDGET));
        rows.push(row![stem, tris.len(), tally.rays, tally.settings, tally.refused, tally.compared, tally.differing]);
        all.rays += tally.rays;
        all.compared += tally.compared;
        all.differing += tally.differing;
    }
    print!("{}", lines(&rows));
    println!("{} rays, {} answers compared with brute force, {} differ", all.rays, all.compared, all.differing);
    match all.differing {
        0 => Ok(()),
        n => Err(AppError::Differs(format!("{n} answers differ from those of brute force"))),
    }
}
