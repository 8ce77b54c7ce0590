//! D12 to D16, D20, D21: inputs and settings that are hard on the build.

use super::{Lcg, agree, both_happen, buffer, cube, turned, v};
use gz_bsp::{BspTree, BuildError, CostStats, Midpoint, MidpointTree, TreeStats};
use gz_core::{BruteForce, GzCoord, GzRay, Hit, RayQuery, TriBuffer};

#[test]
fn d12_flat_scene_on_any_axis() {
    let mut lcg = Lcg(12);
    for k in 0..3 {
        let flat: Vec<_> = lcg.soup(400, 0.1).into_iter().map(|t| t.map(|p| turned(k, 0.0, p.x, p.y))).collect();
        let tris = buffer(flat);
        let mut rays = Vec::new();
        for _ in 0..300 {
            let (b, c) = (lcg.unit(), lcg.unit());
            rays.push(GzRay::new(turned(k, 1.0, b, c), turned(k, -1.0, 0.0, 0.0)));
            rays.push(GzRay::new(turned(k, -1.0, b, c), turned(k, 1.0, lcg.unit() * 0.1, -0.1)));
            // In the plane: nothing is hit.
            rays.push(GzRay::new(turned(k, 0.0, -1.0, c), turned(k, 0.0, 1.0, 0.0)));
        }
        both_happen(&agree("D12", &tris, &rays), true);
        assert!(CostStats::of(&BspTree::build(&tris)).references <= 5 * tris.len());
    }
}

#[test]
fn d13_none_one_all_identical_all_coplanar_and_one_giant_among_tiny_ones() {
    let mut lcg = Lcg(13);
    let one = [v(0.1, 0.2, 0.3), v(0.9, 0.1, 0.5), v(0.3, 0.8, 0.6)];
    let giant = [v(-1e3, -1e3, -1e3), v(1e3, -1e3, 1e3), v(0.0, 1e3, 0.0)];
    let tiny = (0..20_000).map(|_| {
        let p = lcg.point() * 1e-2;
        [p, p + GzCoord::X * 1e-5, p + GzCoord::Y * 1e-5]
    });
    let mixed: Vec<_> = tiny.chain([giant]).collect();
    let scenes = [
        ("none", TriBuffer::new()),
        ("one", buffer([one])),
        ("identical", buffer(vec![one; 200])),
        ("coplanar", buffer(Lcg(1).soup(300, 0.2).into_iter().map(|t| t.map(|p| p.with_z(0.5 * p.x))))),
        ("one giant", buffer(mixed)),
    ];
    for (name, tris) in &scenes {
        let rays = if tris.is_empty() { vec![GzRay::new(GzCoord::ZERO, GzCoord::ONE)] } else { lcg.rays(tris, 40) };
        let hits = agree(name, tris, &rays);
        assert_eq!(hits.iter().any(Hit::is_hit), !tris.is_empty(), "{name}");
        // Of identical triangles the first is the answer.
        assert!(*name != "identical" || hits.iter().all(|hit| !hit.is_hit() || hit.tri == 0));
    }
}

#[test]
fn d14_middle_of_neighbouring_numbers() {
    // Boxes one step of f32 thick on an axis: the middle is one of the ends.
    for k in 0..3 {
        let (lo, hi) = (1.0f32, 1.0f32.next_up());
        let mut triangles = Vec::new();
        for i in 0..30 {
            let (b, x) = (0.1 * i as f32, if i % 2 == 0 { lo } else { hi });
            triangles.push([
                turned(k, x, b, 0.0),
                turned(k, x, b + 0.2, 0.0),
                turned(k, if i % 3 == 0 { lo } else { hi }, b, 1.0),
            ]);
        }
        let tris = buffer(triangles);
        let rays: Vec<_> = (0..60)
            .flat_map(|i| {
                let b = 0.05 * i as f32;
                [
                    GzRay::new(turned(k, 0.0, b, 0.2), turned(k, 1.0, 0.0, 0.0)),
                    GzRay::new(turned(k, 2.0, b, 0.2), turned(k, -1.0, 0.0, 0.0)),
                ]
            })
            .collect();
        both_happen(&agree("D14", &tris, &rays), false);
    }
}

#[test]
fn d15_middle_that_would_overflow() {
    let far = 3e38f32;
    let tris = buffer([
        [v(far, far, far), v(far, far, -far), v(far, -far, far)],
        [v(-far, far, far), v(-far, far, -far), v(-far, -far, far)],
        [v(-1.0, -1.0, 5.0), v(1.0, -1.0, 5.0), v(0.0, 1.0, 5.0)],
        [v(far, far, far), v(far, far, far), v(far, far, far)],
    ]);
    let rays = [
        GzRay::new(GzCoord::ZERO, GzCoord::Z),
        GzRay::new(v(1.0, 1.0, 1.0), GzCoord::X),
        GzRay::new(v(1.0, 1.0, 1.0), GzCoord::NEG_X),
        GzRay::new(v(0.0, 0.0, 9.0), v(0.0, 0.0, -1e-30)),
        GzRay::new(v(0.0, 0.0, 0.0), v(1e30, 1e30, 1e30)),
    ];
    let hits = agree("D15", &tris, &rays);
    assert_eq!((hits[0].tri, hits[1].tri, hits[2].tri, hits[3].tri), (2, 0, 1, 2));
}

#[test]
fn d16_triangles_within_a_step_of_a_plane_are_counted_and_parted_alike() {
    // Slender triangles along one axis whose ends lie at a plane of a cut or one step beside it.
    let mut triangles = cube();
    for k in 0..3 {
        for plane in [6.0f32, 3.0, 9.0] {
            for a in [plane.next_down(), plane, plane.next_up()] {
                for b in [plane.next_down(), plane, plane.next_up()] {
                    let at = 1.0 + triangles.len() as f32 % 10.0;
                    triangles.push([turned(k, a, at, 2.0), turned(k, b, at + 1.0, 3.0), turned(k, a, at, 4.0)]);
                }
            }
        }
    }
    let tris = buffer(triangles);
    let mut lcg = Lcg(16);
    let mut rays = lcg.rays(&tris, 400);
    for k in 0..3 {
        for plane in [6.0f32, 3.0, 9.0] {
            for i in 0..20 {
                rays.push(GzRay::new(turned(k, plane - 1.0, 0.6 * i as f32, 3.0), turned(k, 1.0, 0.0, 0.0)));
                rays.push(GzRay::new(turned(k, plane, 0.6 * i as f32, 1.0), turned(k, 0.0, 0.1, 1.0)));
            }
        }
    }
    both_happen(&agree("D16", &tris, &rays), true);
}

#[test]
fn d20_any_depth_and_size_gives_the_same_bits() {
    let mut lcg = Lcg(20);
    let tris = buffer(lcg.soup(300, 0.15));
    let rays = lcg.rays(&tris, 300);
    let brute = BruteForce::new(&tris);
    let truth: Vec<Hit> = rays.iter().map(|ray| brute.closest_hit(ray)).collect();
    let (mut built, mut refused) = (0, Vec::new());
    for max_depth in [1, 2, 64] {
        for min_size in [0, 1, tris.len(), tris.len() + 1] {
            let setting = Midpoint { max_depth, min_size, node_budget: 1 << 16 };
            match MidpointTree::build(&tris, setting) {
                Ok(tree) => {
                    built += 1;
                    assert!(TreeStats::of(&tree).depth <= max_depth + 1);
                    let same = rays.iter().zip(&truth).all(|(ray, truth)| tree.closest_hit(ray) == *truth);
                    assert!(same, "({max_depth}, {min_size})");
                }
                Err(error) => {
                    assert_eq!(error, BuildError::OverBudget(setting));
                    refused.push((max_depth, min_size));
                }
            }
        }
    }
    println!("D20: {built} settings, {} rays each, 0 differ; refused {refused:?}", rays.len());
    // What no budget holds is refused, never built forever.
    assert_eq!(refused, [(64, 0), (64, 1)]);
}

#[test]
fn d21_order_of_triangles_does_not_show() {
    let mut lcg = Lcg(21);
    let triangles = lcg.soup(500, 0.2);
    let tris = buffer(triangles.iter().copied());
    let rays = lcg.rays(&tris, 600);
    let hits = agree("D21", &tris, &rays);
    // Another order: number i of it is number order[i] of the first.
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, (lcg.unit() * (i + 1) as f32) as usize);
    }
    let other = buffer(order.iter().map(|&i| triangles[i]));
    let found = agree("D21, another order", &other, &rays);
    let mut shared = 0;
    for ((ray, hit), found) in rays.iter().zip(&hits).zip(&found) {
        if !hit.is_hit() {
            assert!(!found.is_hit(), "{ray:?}");
            continue;
        }
        let mapped = order[found.tri as usize] as u32;
        // Rays aimed at a corner that triangles share could tie; in a soup none do.
        assert_eq!((found.t, mapped, found.u, found.v), (hit.t, hit.tri, hit.u, hit.v), "{ray:?}");
        shared += 1;
    }
    assert!(shared > 100, "{shared}");
}
