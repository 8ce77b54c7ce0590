//! Brute force, the tree that tunes itself and the paper's tree give equal hits on the rays of every scene of assets.
//!
//! A sample of each scene's rays; `cargo xtask bench agree` takes all of them.

use gz_bsp::Midpoint;
use gz_tests::bench::agree::{Tally, compare, recorded, settings};
use gz_tests::bench::scenes::asset_scenes;

/// Nodes allowed for one tree of the grid: the largest ones are for the bench.
const BUDGET: usize = 1 << 14;

#[test]
fn every_scene_is_answered_alike_by_brute_force_and_trees() {
    let scenes = asset_scenes().expect("assets/scenes can be read");
    let mut all = Tally::default();
    for path in &scenes {
        let Some((tris, rays)) = recorded(path, 128).unwrap_or_else(|error| panic!("{error}")) else {
            println!("{}: left out, it needs course data (GZ_HW_DATA)", path.display());
            continue;
        };
        let rays = rays.as_closest();
        let deep = [(15, 5), (20, 10)].map(|(max_depth, min_size)| Midpoint { max_depth, min_size, ..Midpoint::default() });
        for tally in [compare(&tris, &rays.sample(2000), deep), compare(&tris, &rays.sample(40), settings(BUDGET))] {
            assert_eq!(tally.differing, 0, "{}: {tally:?}", path.display());
            assert!(tally.rays > 0 && tally.settings > 1, "{}: {tally:?}", path.display());
            all.rays += tally.rays;
            all.compared += tally.compared;
        }
    }
    println!("{} rays, {} answers compared with brute force, 0 differ", all.rays, all.compared);
    assert!(all.rays > 5_000, "{all:?}");
}

#[test]
fn what_a_frame_asks_is_answered_as_it_is_asked() {
    // Occlusion and classes of triangles, not only front-most hits.
    use gz_bsp::{BspTree, MidpointTree};
    use gz_core::BruteForce;
    use gz_tests::bench::rays::{answers, differing};
    let path = gz_tests::rendered::scene_path("refraction");
    let (tris, rays) = recorded(&path, 128).unwrap_or_else(|error| panic!("{error}")).expect("it needs no course data");
    let rays = rays.sample(4000);
    assert!(rays.batches.iter().any(|asked| asked.any) && rays.batches.iter().any(|asked| !asked.any));
    let truth = answers(&BruteForce::new(&tris), &rays);
    let paper = MidpointTree::build(&tris, Midpoint::default()).expect("within budget");
    assert_eq!(differing(&truth, &answers(&BspTree::build(&tris), &rays)), 0);
    assert_eq!(differing(&truth, &answers(&paper, &rays)), 0);
}
