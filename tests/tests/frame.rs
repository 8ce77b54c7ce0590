//! Threads, tiles, crops and what answers the rays cannot be seen in a picture or a T-buffer: bits are compared, on every scene.

use gz_app::load::Overrides;
use gz_app::threads;
use gz_app::view::trace_hits;
use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{BruteForce, RayQuery, SimdLevel, TBuffer, Tile, TileGrid};
use gz_shade::{Antialias, FrameStats, Scene, SceneNeeds, shade_frame};
use gz_tests::scenes;

const WIDTH: u32 = 96;
const HEIGHT: u32 = 72;

/// A picture of this size with one sample a pixel: further ones only repeat the work.
const fn sized(width: u32, height: u32) -> Overrides {
    Overrides { size: Some((width, height)), aa: Some(Antialias::None), ..Overrides::NONE }
}

const WHOLE: Tile = Tile { x0: 0, y0: 0, x1: WIDTH, y1: HEIGHT };

/// A part that begins and ends within tiles of either size.
const CROP: Tile = Tile { x0: 13, y0: 7, x1: 83, y1: 58 };

/// Everything that a render gives, as bits.
#[derive(Debug, PartialEq)]
struct Bits {
    colors: Vec<[u32; 3]>,
    hits: Vec<[u32; 4]>,
    stats: FrameStats,
}

impl Bits {
    /// The part `crop` of a whole picture, with the counts that only the part itself can tell.
    fn part(&self, crop: Tile, stats: FrameStats) -> Self {
        let at = |(i, j): (u32, u32)| (j * WIDTH + i) as usize;
        Self {
            colors: crop.pixels().map(|p| self.colors[at(p)]).collect(),
            hits: crop.pixels().map(|p| self.hits[at(p)]).collect(),
            stats,
        }
    }
}

fn bits(scene: &Scene, needs: SceneNeeds, query: &dyn RayQuery, area: Tile, tile: u32) -> Bits {
    let grid = TileGrid::of(area, tile);
    let frame = shade_frame(scene, needs, query, &grid, &|_| {});
    let hits = trace_hits(scene, query, &grid);
    Bits { colors: scenes::color_bits(&frame.colors), hits: scenes::hit_bits(&hits), stats: frame.stats }
}

fn with_threads(count: usize, work: impl FnOnce() -> Bits + Send) -> Bits {
    threads::with(count, || Ok(work())).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn threads_tiles_and_crops_cannot_be_seen_on_any_scene() {
    for name in scenes::usable() {
        let (scene, needs) = scenes::placed(&name, &sized(WIDTH, HEIGHT));
        let tree = BspTree::build(&scene.tris);
        let reference = with_threads(1, || bits(&scene, needs, &tree, WHOLE, 64));
        let hit = reference.stats.primary_hits;
        assert!(hit > 0 && reference.stats.nan_pixels == 0, "{name}: {hit} hits");
        // The T-buffer of the library is the same again.
        assert_eq!(reference.hits, scenes::hit_bits(&TBuffer::trace(&scene.camera, &tree).hits), "{name}");
        let part_alone = with_threads(1, || bits(&scene, needs, &tree, CROP, 64));
        assert!(part_alone == reference.part(CROP, part_alone.stats), "{name}: a crop, 1 thread, tiles of 64");
        for (threads, tile) in [(1, 8), (2, 8), (2, 64), (7, 8), (7, 64)] {
            let whole = with_threads(threads, || bits(&scene, needs, &tree, WHOLE, tile));
            assert!(whole == reference, "{name}: {threads} threads, tiles of {tile}");
            let part = with_threads(threads, || bits(&scene, needs, &tree, CROP, tile));
            assert!(part == part_alone, "{name}: a crop, {threads} threads, tiles of {tile}");
        }
    }
}

#[test]
fn brute_force_and_both_trees_give_the_same_bits_on_every_scene() {
    // Smaller still: brute force goes through all triangles for every ray.
    const PICTURE: Tile = Tile { x0: 0, y0: 0, x1: 56, y1: 42 };
    for name in scenes::usable() {
        let (scene, needs) = scenes::placed(&name, &sized(PICTURE.x1, PICTURE.y1));
        let brute = |level| bits(&scene, needs, &BruteForce::new(&scene.tris).with_simd(level), PICTURE, 32);
        let reference = brute(SimdLevel::Portable);
        for &level in SimdLevel::available() {
            assert!(level == SimdLevel::Portable || brute(level) == reference, "{name}: brute force by {level:?}");
            let tree = BspTree::build(&scene.tris).with_simd(level);
            assert!(bits(&scene, needs, &tree, PICTURE, 32) == reference, "{name}: the tree by {level:?}");
        }
        for (max_depth, min_size) in [(15, 10), (5, 3)] {
            let params = Midpoint { max_depth, min_size, ..Midpoint::default() };
            let tree = MidpointTree::build(&scene.tris, params).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(bits(&scene, needs, &tree, PICTURE, 32) == reference, "{name}: the paper's tree {max_depth}, {min_size}");
        }
    }
}
