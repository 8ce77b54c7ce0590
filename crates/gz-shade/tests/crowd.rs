//! Many panes of glass: more rays than a pixel may have.

mod common;

use common::*;
use gz_core::{BruteForce, ClassMask, GzColor, Hit, RayBatch, RayQuery, Tile, TileGrid, TriBuffer};
use gz_shade::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Remembers the largest batch that passes to brute force.
struct Largest<'a> {
    brute: BruteForce<'a>,
    batch: AtomicUsize,
}

impl RayQuery for Largest<'_> {
    fn tris(&self) -> &TriBuffer {
        self.brute.tris()
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        self.batch.fetch_max(rays.len(), Ordering::Relaxed);
        self.brute.closest_hits(rays, classes, hits);
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        self.batch.fetch_max(rays.len(), Ordering::Relaxed);
        self.brute.any_hits(rays, classes, occluded);
    }
}

/// `count` panes one behind the other that face to the front and to the back in turn, so that each is a wall of glass.
fn panes(count: usize) -> Made {
    let mut made = Made { background: Background::Plain(GzColor::ONE), ..Made::default() };
    made.rules.depth = 32;
    made.material(dark(MaterialKind::Glass { ior: 1.5 }));
    for k in 0..count {
        let (z, r) = (-(k as f32) * 0.25, 9.0);
        let mut corners = [[-r, -r, z], [r, -r, z], [r, r, z], [-r, r, z]];
        if k % 2 == 1 {
            corners.reverse();
        }
        made.quad(corners, [0.0, 0.0, if k % 2 == 0 { 1.0 } else { -1.0 }], 0);
    }
    made
}

/// The pixels of `grid`, and the largest batch of rays.
fn shade_in(scene: &Scene, grid: TileGrid) -> (Frame, usize) {
    let query = Largest { brute: BruteForce::new(&scene.tris), batch: AtomicUsize::new(0) };
    let frame = shade_frame(scene, SceneNeeds::of(scene), &query, &grid, &|_| {});
    (frame, query.batch.into_inner())
}

#[test]
fn twenty_panes_stay_within_bounds_and_look_alike_in_every_tile() {
    let scene = panes(20).scene(None);
    let (frame, largest) = shade_in(&scene, TileGrid::whole(SIZE, SIZE, 64));
    let stats = frame.stats;
    assert!(stats.crowded_branches > 0 && stats.crowded_weight > 0 && stats.nan_pixels == 0, "{stats:?}");
    assert!(stats.glass_rays <= u64::from(SIZE * SIZE) * 32 * 1024);
    // A tree of several pixels has at most 2^16 nodes.
    assert!(largest < 1 << 16, "{largest} rays in a batch");
    // The world is white, so that a pixel lacks what was cut and nothing else.
    let lost = (stats.crowded_weight + stats.weak_weight + stats.depth_cut_weight) as f64 * FrameStats::WEIGHT_UNIT;
    let missing: f64 = frame.colors.iter().map(|color| 1.0 - f64::from(color.x)).sum();
    assert!((lost - missing).abs() < 1e-2, "{lost} counted, {missing} missing");
    // A part of it, in other tiles: the same colours, and the same counts whatever the tiles.
    let crop = Tile { x0: 5, y0: 2, x1: 13, y1: 10 };
    let [small, large] = [1, 8].map(|size| shade_in(&scene, TileGrid::of(crop, size)).0);
    assert_eq!(small, large);
    for ((i, j), color) in crop.pixels().zip(&small.colors) {
        assert_eq!(*color, frame.colors[(j * SIZE + i) as usize], "pixel {i} {j}");
    }
}

#[test]
fn few_panes_are_not_thinned() {
    let (frame, _) = shade_in(&panes(4).scene(None), TileGrid::whole(SIZE, SIZE, 8));
    assert_eq!(frame.stats.crowded_branches, 0);
    assert!(frame.stats.glass_rays > 1000);
}
