//! The paper's tree answers as brute force does, at every setting, and keeps within its budget.

use gz_bsp::{BuildError, Midpoint, MidpointTree, TreeStats, VisitCount};
use gz_core::glam::DVec3;
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, GzTri, RayQuery, TriBuffer};

struct Lcg(u64);

impl Lcg {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    fn point(&mut self) -> GzCoord {
        GzCoord::from_array(std::array::from_fn(|_| self.unit()))
    }
}

fn buffer(triangles: impl IntoIterator<Item = [GzCoord; 3]>) -> TriBuffer {
    let mut tris = TriBuffer::new();
    for positions in triangles {
        tris.push(&GzTri { positions, ..GzTri::default() }).unwrap();
    }
    tris
}

/// Small triangles anywhere in the unit cube.
fn soup(lcg: &mut Lcg, n: usize, size: f32) -> TriBuffer {
    buffer((0..n).map(|_| {
        let centre = lcg.point();
        std::array::from_fn(|_| centre + lcg.point() * size)
    }))
}

/// Two triangles for each cell of an integer grid at integer heights, and a copy of every tenth.
fn grid(lcg: &mut Lcg, n: i32) -> TriBuffer {
    let heights: Vec<f32> = (0..=n).flat_map(|_| (0..=n).map(|_| (lcg.unit() * 3.0).floor()).collect::<Vec<_>>()).collect();
    let at = |x: i32, y: i32| GzCoord::new(x as f32, y as f32, heights[(y * (n + 1) + x) as usize]);
    let mut triangles: Vec<[GzCoord; 3]> = (0..n)
        .flat_map(|y| (0..n).map(move |x| (x, y)))
        .flat_map(|(x, y)| [[at(x, y), at(x + 1, y), at(x, y + 1)], [at(x + 1, y + 1), at(x, y + 1), at(x + 1, y)]])
        .collect();
    let copies: Vec<_> = triangles.iter().step_by(10).copied().collect();
    triangles.extend(copies);
    buffer(triangles)
}

/// Needles from one corner of space to another.
fn slivers(lcg: &mut Lcg, n: usize) -> TriBuffer {
    buffer((0..n).map(|_| {
        let (a, b) = (lcg.point(), lcg.point());
        [a, b, b + lcg.point() * 1e-6]
    }))
}

/// Rays aimed at corners, at edge midpoints, along axes, in the planes of cuts, and anywhere.
fn rays(lcg: &mut Lcg, tris: &TriBuffer, n: usize) -> Vec<GzRay> {
    let bounds = tris.bounds();
    let (centre, size) = (bounds.centre(), bounds.size());
    (0..n)
        .map(|k| {
            let triangle = tris.position((lcg.unit() * tris.len() as f32) as u32 % tris.len() as u32);
            let origin = centre + (lcg.point() - 0.5) * size * 3.0;
            let axis = GzCoord::AXES[k % 3] * if k % 2 == 0 { 1.0 } else { -1.0 };
            match k % 6 {
                0 => GzRay::new(origin, triangle[0] - origin),
                1 => GzRay::new(origin, (triangle[0] + triangle[1]) * 0.5 - origin),
                2 => GzRay::new(triangle[1] - axis * 2.0, axis),
                3 => {
                    // In the plane of the first cut along an axis, straight and tilted.
                    let mut origin = origin;
                    origin[(k + 1) % 3] = centre[(k + 1) % 3];
                    let mut direction = triangle[2] - origin;
                    direction[(k + 1) % 3] = if k % 4 == 0 { 0.0 } else { -0.0 };
                    GzRay::new(origin, direction)
                }
                4 => GzRay { tmin: -1.0, tmax: 0.7, ..GzRay::new(triangle[0], lcg.point() - 0.5) },
                _ => GzRay::new(origin, lcg.point() - 0.5),
            }
        })
        .collect()
}

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
