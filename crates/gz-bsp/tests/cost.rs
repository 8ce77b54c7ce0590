//! The default tree answers as brute force does, on any input, at every SIMD level, and is the same for any number of threads.

mod common;

use common::{Lcg, buffer, grid, rays, slivers, soup};
use gz_bsp::{BspTree, CostStats, VisitCount};
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, Hit, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer};

fn agree(tris: &TriBuffer, rays: &[GzRay]) -> u64 {
    let brute = BruteForce::new(tris);
    let expected: Vec<_> = rays.iter().map(|ray| brute.closest_hit(ray)).collect();
    for &level in SimdLevel::available() {
        let tree = BspTree::build(tris).with_simd(level);
        tree.assert_well_formed();
        for (ray, expected) in rays.iter().zip(&expected) {
            assert_eq!(tree.closest_hit(ray), *expected, "{level:?} {ray:?}");
            assert_eq!(tree.any_hit(ray), expected.is_hit(), "{level:?} {ray:?}");
        }
    }
    (rays.len() * SimdLevel::available().len()) as u64
}

#[test]
fn hits_equal_those_of_brute_force() {
    let mut lcg = Lcg(1);
    let scenes = [
        soup(&mut lcg, 1, 1.0),
        soup(&mut lcg, 9, 1.0),
        soup(&mut lcg, 300, 0.2),
        soup(&mut lcg, 5000, 0.03),
        grid(&mut lcg, 20),
        slivers(&mut lcg, 200),
    ];
    let compared: u64 = scenes.iter().map(|tris| agree(tris, &rays(&mut lcg, tris, 3000))).sum();
    println!("{compared} rays, 0 differ");
    assert_eq!(agree(&TriBuffer::new(), &[GzRay::new(GzCoord::ZERO, GzCoord::ONE)]), SimdLevel::available().len() as u64);
}

#[test]
fn rays_that_go_together_are_answered_like_rays_alone() {
    let mut lcg = Lcg(8);
    let mut compared = 0;
    for tris in [soup(&mut lcg, 2000, 0.05), grid(&mut lcg, 20), slivers(&mut lcg, 100), soup(&mut lcg, 20, 1.0)] {
        let brute = BruteForce::new(&tris);
        let bounds = tris.bounds();
        let mut batches: Vec<Vec<GzRay>> = Vec::new();
        for k in 0..120 {
            // Beams from one point, side by side, from surfaces, and in the plane of a cut; tight and wide; some with ends.
            let eye = bounds.centre() + (lcg.point() - 0.5) * bounds.size() * 3.0;
            let aim = bounds.min + lcg.point() * bounds.size() - eye;
            let spread = [1e-4, 0.01, 0.3][k % 3] * aim.length();
            let beam = (0..37).map(|_| {
                let mut direction = aim + (lcg.point() - 0.5) * spread;
                let mut origin = eye;
                match k % 5 {
                    1 => origin += (lcg.point() - 0.5) * spread,
                    2 => direction[k % 3] = [0.0, -0.0][(lcg.unit() * 2.0) as usize],
                    3 => origin = bounds.centre(),
                    4 => origin = tris.position((k % tris.len()) as u32)[0],
                    _ => {}
                }
                let tmax = if k % 7 == 0 { lcg.unit() * 2.0 } else { f32::INFINITY };
                GzRay { tmax, ..GzRay::new(origin, direction) }
            });
            batches.push(beam.collect());
        }
        for rays in &batches {
            let column = |of: fn(&GzRay) -> f32| rays.iter().map(of).collect::<Vec<_>>();
            let (origins, directions): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.origin, ray.direction)).unzip();
            let (tmin, tmax) = (column(|ray| ray.tmin), column(|ray| ray.tmax));
            let batch = RayBatch::new(
                rays.len(),
                PerRay::Each(&origins),
                PerRay::Each(&directions),
                PerRay::Each(&tmin),
                PerRay::Each(&tmax),
            );
            let (mut expected, mut blocked) = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
            brute.closest_hits(&batch, ClassMask::ALL, &mut expected);
            for &level in SimdLevel::available() {
                let tree = BspTree::build(&tris).with_simd(level);
                let mut hits = expected.clone();
                hits.fill(Hit::MISS);
                tree.closest_hits(&batch, ClassMask::ALL, &mut hits);
                tree.any_hits(&batch, ClassMask::ALL, &mut blocked);
                for (k, ray) in rays.iter().enumerate() {
                    assert_eq!(hits[k], expected[k], "{level:?} {ray:?}");
                    assert_eq!(blocked[k], expected[k].is_hit(), "{level:?} {ray:?}");
                    compared += 1;
                }
            }
        }
    }
    println!("{compared} rays, 0 differ");
    assert!(compared > 15_000);
}

#[test]
fn scenes_far_away_tiny_and_huge_are_answered_alike() {
    let mut lcg = Lcg(2);
    for (scale, offset) in [(1.0, 1e3), (1.0, 1e6), (1e-20, 0.0), (1e-38, 0.0), (1e15, 0.0), (1e25, 0.0), (1e37, 0.0)] {
        let base = soup(&mut lcg, 200, 0.1);
        let tris = buffer(base.positions().iter().map(|t| t.map(|p| p * scale + offset)));
        let mut rays = rays(&mut lcg, &tris, 600);
        for (k, ray) in rays.iter_mut().enumerate() {
            // Directions of every length, and origins that f32 does not hold.
            ray.direction *= [1.0, 1e-6, 1e6, 1e-12][k % 4] / ray.direction.abs().max_element().max(f32::MIN_POSITIVE);
            ray.origin *= 1.0 + 1e-12;
        }
        agree(&tris, &rays);
    }
}

#[test]
fn no_input_makes_the_build_blow_up() {
    let mut lcg = Lcg(3);
    let one = [GzCoord::new(0.0, 0.0, 1.0), GzCoord::new(1.0, 0.1, 1.2), GzCoord::new(0.3, 0.9, 0.8)];
    let point = GzCoord::new(0.3, 0.2, 0.1);
    let tiny = (0..100_000).map(|_| {
        let p = lcg.point() * 1e-3;
        [p, p + GzCoord::X * 1e-6, p + GzCoord::Y * 1e-6]
    });
    let giant = [GzCoord::splat(-1e3), GzCoord::new(1e3, -1e3, 1e3), GzCoord::new(0.0, 1e3, 0.0)];
    let one_giant: Vec<_> = tiny.chain([giant]).collect();
    let scenes = [
        ("copies", buffer(vec![one; 100_000])),
        ("one point", buffer(vec![[point; 3]; 50_000])),
        ("coplanar", {
            let flat = soup(&mut lcg, 50_000, 0.1);
            buffer(flat.positions().iter().map(|t| t.map(|p| p.with_z(0.5))))
        }),
        ("one giant", buffer(one_giant)),
        ("slivers", slivers(&mut lcg, 50_000)),
    ];
    for (name, tris) in &scenes {
        let tree = BspTree::build(tris);
        let stats = CostStats::of(&tree);
        println!("{name}: {} triangles, {stats:?}", tris.len());
        assert!(stats.references <= 5 * tris.len() + 64, "{name}: {stats:?}");
        assert!(stats.bytes <= 400 * tris.len(), "{name}: {stats:?}");
        tree.assert_well_formed();
        let brute = BruteForce::new(tris);
        for ray in rays(&mut lcg, tris, 12) {
            assert_eq!(tree.closest_hit(&ray), brute.closest_hit(&ray), "{name} {ray:?}");
        }
    }
}

#[test]
fn rays_in_planes_and_through_corners_of_cells_find_what_lies_there() {
    // A closed box of integer squares: every cut falls on edges, rays run in walls, along edges and through corners.
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [0.0, 12.0] {
            for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (2.0 * i as f32, 2.0 * j as f32))) {
                let at = |u: f32, v: f32| {
                    let mut p = GzCoord::ZERO;
                    p[axis] = side;
                    p[(axis + 1) % 3] = i + u;
                    p[(axis + 2) % 3] = j + v;
                    p
                };
                triangles.push([at(0.0, 0.0), at(2.0, 0.0), at(0.0, 2.0)]);
                triangles.push([at(2.0, 2.0), at(0.0, 2.0), at(2.0, 0.0)]);
            }
        }
    }
    // And a wall in the middle plane.
    triangles.push([GzCoord::new(6.0, 0.0, 0.0), GzCoord::new(6.0, 12.0, 0.0), GzCoord::new(6.0, 0.0, 12.0)]);
    let tris = buffer(triangles);
    let mut rays = Vec::new();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            for zero in [0.0, -0.0] {
                for (u, v) in (0..=12).flat_map(|u| (0..=12).map(move |v| (u as f32, v as f32))) {
                    let (mut origin, mut direction) = (GzCoord::ZERO, GzCoord::splat(zero));
                    origin[axis] = 6.0 - 9.0 * sign;
                    origin[(axis + 1) % 3] = u;
                    origin[(axis + 2) % 3] = v;
                    direction[axis] = sign;
                    rays.push(GzRay::new(origin, direction));
                    direction[(axis + 1) % 3] = 0.25;
                    rays.push(GzRay::new(origin, direction));
                    // Subnormal components, whose reciprocals are infinite in f32.
                    direction[(axis + 1) % 3] = 1e-40;
                    direction[(axis + 2) % 3] = -1e-40;
                    rays.push(GzRay::new(origin, direction));
                    // From the inside, and with the whole line asked for.
                    origin[axis] = 6.0;
                    rays.push(GzRay { tmin: f32::NEG_INFINITY, ..GzRay::new(origin, direction) });
                }
            }
        }
    }
    println!("{} rays, 0 differ", agree(&tris, &rays));
}

#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    let mut lcg = Lcg(6);
    let tris = soup(&mut lcg, 150_000, 0.01);
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| BspTree::build(&tris))
    };
    let one = of(1);
    for threads in [2, 7] {
        assert!(one.same_bytes(&of(threads)), "{threads} threads");
    }
    assert!(!one.same_bytes(&BspTree::build(&soup(&mut lcg, 10, 0.1))));
}

#[test]
fn a_ray_visits_few_cells() {
    let mut lcg = Lcg(7);
    let tris = soup(&mut lcg, 20_000, 0.02);
    let tree = BspTree::build(&tris);
    let mut visits = VisitCount::default();
    let n = 1000;
    for ray in rays(&mut lcg, &tris, n) {
        tree.closest_hit_counted(&ray, ClassMask::ALL, &mut visits);
    }
    println!(
        "a ray: {:.1} nodes, {:.1} groups, {:.2} f64 tests",
        visits.nodes as f64 / n as f64,
        visits.groups as f64 / n as f64,
        visits.tests as f64 / n as f64
    );
    assert!(visits.nodes < 60 * n as u64 && visits.groups < 60 * n as u64 && visits.tests < 20 * n as u64, "{visits:?}");
}

#[test]
fn a_scene_that_is_long_in_one_direction_is_not_walked_whole() {
    // As in screen space, where z runs to 2^31 and x and y over a picture.
    let mut lcg = Lcg(9);
    let base = soup(&mut lcg, 20_000, 0.02);
    let stretch = GzCoord::new(256.0, 256.0, 2e9);
    let tris = buffer(base.positions().iter().map(|t| t.map(|p| p * stretch)));
    let tree = BspTree::build(&tris);
    let brute = BruteForce::new(&tris);
    let mut visits = VisitCount::default();
    let n = 400;
    for k in 0..n {
        let origin = GzCoord::new((k % 20) as f32 * 12.0, (k / 20) as f32 * 12.0, 0.0);
        let ray = GzRay::new(origin, GzCoord::Z);
        let hit = tree.closest_hit_counted(&ray, ClassMask::ALL, &mut visits);
        if k % 20 == 0 {
            assert_eq!(hit, brute.closest_hit(&ray));
        }
    }
    println!("{visits:?} for {n} rays");
    // Cuts across z do not help rays along z, but most of the tree is left out, and of what is asked almost nothing reaches f64.
    assert!(visits.groups < n * CostStats::of(&tree).groups as u64 / 10 && visits.tests < 4 * n, "{visits:?}");
}

#[test]
fn an_origin_too_near_zero_is_refused_on_stretched_axes_too() {
    // Along z the scene is thin, so z is stretched.
    let least = 1e-30;
    let corners = [[-9.0, 0.0, -least], [9.0, 0.0, -least], [0.0, 0.0, least]].map(GzCoord::from_array);
    let tris = buffer([corners, corners.map(|p| p + GzCoord::Y * 3e7)]);
    let (tree, brute) = (BspTree::build(&tris), BruteForce::new(&tris));
    for z in [4.8e-46, -4.8e-46] {
        let down = |z| GzRay::from_f64(gz_core::glam::DVec3::new(0.1, 3.1e7, z), -GzCoord::Y);
        assert!(!down(z).is_valid() && down(0.0).is_valid());
        assert_eq!(tree.closest_hit(&down(z)), gz_core::Hit::MISS);
        assert_eq!(brute.closest_hit(&down(z)), gz_core::Hit::MISS);
        assert_eq!(tree.closest_hit(&down(0.0)), brute.closest_hit(&down(0.0)));
        assert!(tree.closest_hit(&down(0.0)).is_hit() && tree.any_hit(&down(0.0)) && !tree.any_hit(&down(z)));
    }
}
