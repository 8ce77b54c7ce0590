//! The frame: tile by tile from T-value pixels to colours.

use crate::aa::{Sample, pixel_color, sample_value, samples};
use crate::local::Lighting;
use crate::tree::{Node, Tree};
use crate::{FrameStats, Scene, SceneNeeds};
use glam::{DVec2, DVec3};
use gz_core::{GzColor, GzPixel, RayQuery, Tile, TileGrid, TileScratch, trace_tile};
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

/// Room for the work on one tile, kept from tile to tile.
#[derive(Debug, Default)]
pub struct ShadeScratch {
    primary: TileScratch,
    pixels: Vec<GzPixel>,
    tree: Tree,
    lighting: Lighting,
    sums: Vec<DVec3>,
}

impl ShadeScratch {
    /// The nodes of the tile and sample worked on last.
    pub(crate) fn nodes(&self) -> &[Node] {
        &self.tree.nodes
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
        let roots = &scratch.tree.nodes[..tile.len()];
        stats.nan_pixels += roots.iter().filter(|root| root.color.is_nan()).count() as u64;
        if samples.len() == 1 {
            // No sum, no 12 bits of each sample: the colour itself.
            colors.extend(roots.iter().map(|root| root.color));
            return;
        }
        for (sum, root) in scratch.sums.iter_mut().zip(roots) {
            *sum += sample_value(code, root.color) * sample.weight;
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

/// One sample of each pixel of `tile`: the roots of the scratch's tree are its pixels, shaded.
pub(crate) fn trace_and_shade(
    scene: &Scene,
    needs: SceneNeeds,
    query: &dyn RayQuery,
    tile: &Tile,
    offset: DVec2,
    scratch: &mut ShadeScratch,
    stats: &mut FrameStats,
) {
    let ShadeScratch { primary, pixels, tree, lighting, .. } = scratch;
    // Primary rays -> T-value pixels: the roots.
    trace_tile(tile, offset, &scene.camera, query, primary, pixels);
    tree.clear();
    let rays = tile.in_squares().map(|(i, j)| scene.camera.ray(i, j, offset));
    tree.nodes.extend(rays.zip(pixels.iter()).map(|(ray, pixel)| Node::root(ray, pixel.hit)));
    stats.primary_rays += pixels.len() as u64;
    stats.primary_hits += pixels.iter().filter(|pixel| pixel.hit.is_hit()).count() as u64;
    // Mirror and glass rays: the branches.
    tree.grow(scene, needs, query, stats);
    // What each ray sees by itself.
    tree.show_background(scene, scene.up());
    lighting.shade(scene, needs, query, &mut tree.nodes, stats);
    // What that makes together.
    tree.combine(scene.rules.clamp_levels);
}
