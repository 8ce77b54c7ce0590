//! The frame: tile by tile from T-value pixels to colours.

use crate::aa::{Sample, pixel_color, sample_value, samples};
use crate::local::Lighting;
use crate::tree::{MAX_NODES, TooLarge, Tree};
use crate::{FrameStats, Scene, SceneNeeds};
use glam::{DVec2, DVec3};
use gz_core::{GzColor, RayQuery, Tile, TileGrid, TileScratch, tile_hits};
use rayon::prelude::*;

/// A shaded picture or part of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Which pixels these are.
    pub area: Tile,
    /// `area.len()` linear colours, row by row. They may exceed 1, except where the rules clamp.
    pub colors: Vec<GzColor>,
    /// What it took.
    pub stats: FrameStats,
}

/// The most pixels of a tile that are shaded at a time: their rays, a few hundred bytes each and a few for each pixel, are gone over several
/// times and stay in the cache of one processor core.
const MOST_AT_A_TIME: usize = 1 << 9;

/// Room for the work on one tile, kept from tile to tile.
///
/// Beside a few dozen bytes a pixel of the tile it is bounded, whatever the scene: pixels whose rays branch often are shaded few at a
/// time.
#[derive(Debug, Default)]
pub struct ShadeScratch {
    primary: TileScratch,
    /// How many pixels were shaded at a time last; 0 before the first.
    at_a_time: usize,
    /// The colours of a sample.
    shaded: Vec<GzColor>,
    tree: Tree,
    lighting: Lighting,
    sums: Vec<DVec3>,
}

impl ShadeScratch {
    /// The rays of the pixels and the sample worked on last: of all, if the tile is a pixel.
    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }
}

/// Shades all tiles of `grid`, on rayon's current pool; `on_tile` hears of each one that is done, from any thread.
///
/// `query` answers for `scene.tris`. Neither colours nor counts depend on threads, on the size of tiles, or on how much of the
/// picture the grid covers.
pub fn shade_frame(
    scene: &Scene,
    needs: SceneNeeds,
    query: &dyn RayQuery,
    grid: &TileGrid,
    on_tile: &(dyn Fn(&Tile) + Sync),
) -> Frame {
    let tiles: Vec<(Tile, Vec<GzColor>, FrameStats)> = (0..grid.len())
        .into_par_iter()
        .map_init(ShadeScratch::default, |scratch, k| {
            let (tile, mut colors, mut stats) = (grid.tile(k), Vec::new(), FrameStats::default());
            shade_tile(scene, needs, query, &tile, scratch, &mut colors, &mut stats);
            on_tile(&tile);
            (tile, colors, stats)
        })
        .collect();

    let area = grid.area();
    let mut frame = Frame { area, colors: vec![GzColor::ZERO; area.len()], stats: FrameStats::default() };
    for (tile, colors, stats) in tiles {
        for ((x, y), color) in tile.in_squares().zip(colors) {
            frame.colors[(y - area.y0) as usize * area.width() as usize + (x - area.x0) as usize] = color;
        }
        frame.stats += stats;
    }
    frame
}

/// Shades the pixels of `tile` into `colors`, in the order of [`Tile::in_squares`], and adds what it took to `stats`.
pub fn shade_tile(
    scene: &Scene,
    needs: SceneNeeds,
    query: &dyn RayQuery,
    tile: &Tile,
    scratch: &mut ShadeScratch,
    colors: &mut Vec<GzColor>,
    stats: &mut FrameStats,
) {
    let samples = samples_of(scene, needs);
    let code = scene.rules.color_code;
    scratch.sums.clear();
    scratch.sums.resize(tile.len(), DVec3::ZERO);
    colors.clear();
    for sample in &samples {
        trace_and_shade(scene, needs, query, tile, sample.offset, scratch, stats);
        stats.nan_pixels += scratch.shaded.iter().filter(|color| color.is_nan()).count() as u64;
        if samples.len() == 1 {
            // No sum, no 12 bits of each sample: the colour itself.
            colors.extend_from_slice(&scratch.shaded);
            return;
        }
        for (sum, &color) in scratch.sums.iter_mut().zip(&scratch.shaded) {
            *sum += sample_value(code, color) * sample.weight;
        }
    }
    colors.extend(scratch.sums.iter().map(|&sum| pixel_color(code, sum)));
}

/// The samples of each pixel.
pub(crate) fn samples_of(scene: &Scene, needs: SceneNeeds) -> Vec<Sample> {
    let mut samples = samples(scene.rules.antialias);
    if !needs.antialiasing {
        samples.truncate(1);
    }
    samples
}

/// One sample of each pixel of `tile`, into the scratch's `shaded`.
///
/// Pixels are shaded together as far as the tree of their rays stays small; that does not show in colours or counts.
pub(crate) fn trace_and_shade(
    scene: &Scene,
    needs: SceneNeeds,
    query: &dyn RayQuery,
    tile: &Tile,
    offset: DVec2,
    scratch: &mut ShadeScratch,
    stats: &mut FrameStats,
) {
    let ShadeScratch { primary, at_a_time, shaded, tree, lighting, .. } = scratch;
    // Primary rays -> T-values.
    let (rays, hits) = tile_hits(tile, offset, &scene.camera, query, primary);
    stats.primary_rays += hits.len() as u64;
    stats.primary_hits += hits.iter().filter(|hit| hit.is_hit()).count() as u64;
    shaded.clear();
    if *at_a_time == 0 {
        *at_a_time = MOST_AT_A_TIME;
    }
    while shaded.len() < hits.len() {
        let part = shaded.len()..hits.len().min(shaded.len() + *at_a_time);
        // The pixels: the roots.
        tree.plant(&rays, hits, part.clone());
        tree.meet(scene, needs);
        // Mirror and glass rays: the branches.
        let mut counted = FrameStats::default();
        if tree.grow(scene, needs, query, &mut counted) == Err(TooLarge) {
            *at_a_time = part.len() / 2; // not 0: one pixel is never too large
            continue;
        }
        // What each ray sees by itself.
        tree.show_background(scene, scene.up());
        lighting.shade(scene, needs, query, tree, &mut counted);
        // What that makes together.
        tree.combine(scene.rules.clamp_levels);
        shaded.extend(tree.nodes[..part.len()].iter().map(|root| root.color));
        *stats += counted;
        if tree.nodes.len() <= MAX_NODES / 4 {
            *at_a_time = (*at_a_time * 2).min(MOST_AT_A_TIME);
        }
    }
}
