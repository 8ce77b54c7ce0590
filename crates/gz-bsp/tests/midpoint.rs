//! The paper's tree answers as brute force does, at every setting, and keeps within its budget.

mod common;

use common::{Lcg, buffer, grid, rays, slivers, soup};
use gz_bsp::{BuildError, Midpoint, MidpointTree, TreeStats, VisitCount};
use gz_core::glam::DVec3;
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, RayQuery, TriBuffer};

#[test]
fn every_setting_gives_the_hits_of_brute_force() {
    let mut lcg = Lcg(1);
    let scenes = [soup(&mut lcg, 200, 0.2), grid(&mut lcg, 12), slivers(&mut lcg, 60), soup(&mut lcg, 3, 1.0), TriBuffer::new()];
    let (mut compared, mut refused) = (0u64, 0);
    for tris in &scenes {
        let rays = if tris.is_empty() { vec![GzRay::new(GzCoord::ZERO, GzCoord::ONE)] } else { rays(&mut lcg, tris, 240) };
        let brute = BruteForce::new(tris);
        let expected: Vec<_> = rays.iter().map(|ray| brute.closest_hit(ray)).collect();
        for max_depth in [1, 2, 5, 8, 10, 12, 15, 20] {
            for min_size in [0, 1, 3, 5, 10, 15, 20, 30, 100] {
                let Ok(tree) = MidpointTree::build(tris, Midpoint { max_depth, min_size, node_budget: 1 << 14 }) else {
                    refused += 1;
                    continue;
                };
                if max_depth <= 10 {
                    tree.assert_well_formed();
                }
                for (ray, expected) in rays.iter().zip(&expected) {
                    assert_eq!(tree.closest_hit(ray), *expected, "({max_depth}, {min_size}) {ray:?}");
                    assert_eq!(tree.any_hit(ray), expected.is_hit(), "({max_depth}, {min_size}) {ray:?}");
                    compared += 1;
                }
            }
        }
    }
    println!("{compared} rays, 0 differ; {refused} settings over the budget");
    assert!(compared > 40_000, "{compared}");
}

#[test]
fn settings_that_explode_are_refused_in_one_line() {
    let mut lcg = Lcg(2);
    let tris = soup(&mut lcg, 300, 0.3);
    for (max_depth, min_size) in [(40, 0), (64, 1)] {
        let params = Midpoint { max_depth, min_size, node_budget: 1 << 18 };
        let error = MidpointTree::build(&tris, params).unwrap_err();
        assert_eq!(error, BuildError::OverBudget(params));
        assert!(!error.to_string().contains('\n'));
    }
    let error = MidpointTree::build(&tris, Midpoint { max_depth: 65, ..Midpoint::default() }).unwrap_err();
    assert_eq!(error.to_string(), "MAX_DEPTH 65 is above 64");
}

#[test]
fn a_triangle_in_several_voxels_does_not_hide_a_nearer_one_in_the_next() {
    // A long triangle listed in the first voxel that its ray crosses, hit only beyond a small one in the voxel after it. Taking the
    // first hit found in a leaf gives the long one.
    let long = [GzCoord::new(0.0, -1.0, -10.0), GzCoord::new(0.0, 1.0, -10.0), GzCoord::new(8.0, 0.0, 10.0)];
    let near = [GzCoord::new(-1.0, -1.0, 0.5), GzCoord::new(9.0, -1.0, 0.5), GzCoord::new(4.0, 9.0, 0.5)];
    let tris = buffer([long, near]);
    let tree = MidpointTree::build(&tris, Midpoint { max_depth: 8, min_size: 1, ..Midpoint::default() }).unwrap();
    let ray = GzRay::new(GzCoord::new(6.0, 0.0, -9.0), GzCoord::Z);
    assert_eq!(tree.closest_hit(&ray).tri, 1);
    assert_eq!(tree.closest_hit(&GzRay { tmin: 9.6, ..ray }).tri, 0);
}

#[test]
fn a_triangle_without_a_corner_in_a_voxel_is_found_there() {
    // The paper's first insertion rule listed a triangle only where one of its corners lies, which left holes: here no corner lies in
    // the voxels through which the ray passes.
    let wall = [GzCoord::new(-100.0, -100.0, 0.0), GzCoord::new(100.0, -100.0, 0.0), GzCoord::new(0.0, 200.0, 0.0)];
    let mut lcg = Lcg(4);
    let mut triangles: Vec<_> = (0..40)
        .map(|_| {
            let p = lcg.point() * 10.0;
            [p, p + GzCoord::X * 0.1, p + GzCoord::Y * 0.1]
        })
        .collect();
    triangles.push(wall);
    let tris = buffer(triangles);
    let tree = MidpointTree::build(&tris, Midpoint { max_depth: 15, min_size: 3, ..Midpoint::default() }).unwrap();
    for k in 0..100 {
        let at = GzCoord::new(k as f32 * 0.1, 5.0 - k as f32 * 0.05, -3.0);
        assert_eq!(tree.closest_hit(&GzRay::new(at, GzCoord::Z)).tri, 40);
    }
}

#[test]
fn the_walk_visits_a_part_of_the_tree_and_counts_it() {
    let mut lcg = Lcg(5);
    let tris = soup(&mut lcg, 2000, 0.03);
    let tree = MidpointTree::build(&tris, Midpoint::default()).unwrap();
    let stats = TreeStats::of(&tree);
    assert_eq!(stats.nodes, 2 * stats.leaves - 1);
    let mut visits = VisitCount::default();
    let n = 200;
    for _ in 0..n {
        let ray = GzRay::from_f64(DVec3::new(0.5, 0.5, -1.0), lcg.point() - GzCoord::new(0.5, 0.5, -1.0));
        tree.closest_hit_counted(&ray, ClassMask::ALL, &mut visits);
    }
    assert!(visits.tests > 0 && visits.tests < n * 2000 / 20, "{visits:?}");
    assert!(visits.nodes + visits.leaves < n * stats.nodes as u64 / 4, "{visits:?} of {stats:?}");
}
