//! B: degenerate and ill-shaped triangles.

use super::{by_plain, leaks, v};
use gz_bsp::{BspTree, CostStats};
use gz_core::glam::DVec3;
use gz_core::kernel::plain;
use gz_core::{GzCoord, GzRay, Hit, Kernel, NO_TRI};
use gz_tests::folder::Folder;
use gz_tests::hard::{Dice, meshes};
use gz_tests::judge::{buffer, settled};

/// Rays at corners, middles of edges and insides of `triangles`, from around.
fn aimed(dice: &mut Dice, triangles: &[[GzCoord; 3]], n: usize, away: f64) -> Vec<GzRay> {
    (0..n)
        .map(|k| {
            let corners = dice.pick(triangles);
            let [wa, wb, wc] = match k % 3 {
                0 => [1.0, 0.0, 0.0],
                1 => [0.5, 0.5, 0.0],
                _ => dice.weights(),
            };
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let aim = a * wa + b * wb + c * wc;
            let origin = (aim + dice.direction() * away).as_vec3();
            GzRay::new(origin, (aim - origin.as_dvec3()).as_vec3())
        })
        .collect()
}

#[test]
fn b01_zero_area() {
    let (p, q) = (v(0.5, 0.25, 1.0), v(-1.0, 2.0, 0.5));
    let flat = [[p, p, q], [p, p, p], [v(0.0, 0.0, 0.0), v(1.0, 1.0, 1.0), v(2.0, 2.0, 2.0)]];
    let behind = [v(-9.0, -9.0, -5.0), v(9.0, -9.0, -5.0), v(0.0, 9.0, -5.0)];
    let triangles = [flat[0], flat[1], flat[2], behind];
    let mut dice = Dice::new(1);
    let mut rays = aimed(&mut dice, &flat, 60, 3.0);
    rays.push(GzRay::new(v(0.5, 0.25, 9.0), GzCoord::NEG_Z));
    let hits = settled("B1", &buffer(triangles), &rays);
    // Never hit, and counted: the triangle behind them is number 3.
    assert!(hits.iter().all(|hit| hit.tri == 3 || !hit.is_hit()) && hits[60].tri == 3);
    // A loader keeps them and says so once.
    let folder = Folder::new("b01");
    let path = folder.write("flat.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 0 1 0\nf 1 2 3\nf 1 1 2\nf 1 2 4\n");
    let mesh = gz_app::load::obj::load(&path).expect("it can be used");
    let warnings: Vec<_> = mesh.warnings.iter().filter(|text| text.contains("without area")).collect();
    assert!(mesh.triangles.len() == 3 && warnings.len() == 1 && warnings[0].contains("2 triangles"), "{warnings:?}");
}

#[test]
fn b02_collinear_only_after_rounding() {
    // 2e-30 is stored as twice 1e-30, so the three corners lie on one line exactly.
    let flat = [v(0.0, 0.0, 0.0), v(1.0, 1e-30, 0.0), v(2.0, 2e-30, 0.0)];
    let rays = [
        GzRay::new(v(0.5, -1.0, 0.0), GzCoord::Y),
        GzRay::new(v(1.0, 1e-30, 1.0), GzCoord::NEG_Z),
        GzRay::new(v(-1.0, 0.0, 0.0), GzCoord::X),
        GzRay::new(v(0.5, -1.0, 0.0), v(1e-30, 1.0, 0.0)),
    ];
    assert!(settled("B2", &buffer([flat]), &rays).iter().all(|hit| !hit.is_hit()));
    // One step of the last corner makes an area, and a hit.
    let bent = [flat[0], flat[1], v(2.0, 2e-30f32.next_up(), 0.0)];
    let hit = settled("B2, bent", &buffer([bent]), &[GzRay::new(v(1.0, 1e-30, 1.0), GzCoord::NEG_Z)])[0];
    assert_eq!((hit.tri, hit.t), (0, 1.0));
}

#[test]
fn b03_needles() {
    let mut dice = Dice::new(3);
    let kernels = [Kernel::Plane, Kernel::MoellerTrumbore, Kernel::Pluecker, Kernel::Woop];
    for aspect in [1e2, 1e3, 1e4, 1e5, 1e6, 1e7] {
        let (mut true_hits, mut missed) = (0, [0; 4]);
        for _ in 0..40 {
            let triangles = meshes::needles(&mut dice, aspect, DVec3::ZERO);
            let mut rays = Vec::new();
            for k in 0..20 {
                let [a, b, c] = triangles[k % 2].map(|p| p.as_dvec3());
                let [wa, wb, wc] = dice.weights();
                let aim = a * wa + b * wb + c * wc;
                let origin = (aim + dice.direction() * 8.0).as_vec3();
                rays.push(GzRay::new(origin, (aim - origin.as_dvec3()).normalize().as_vec3()));
            }
            let hits = settled("B3", &buffer(triangles), &rays);
            for (ray, _) in rays.iter().zip(&hits).filter(|(_, hit)| hit.is_hit()) {
                true_hits += 1;
                for (missed, kernel) in missed.iter_mut().zip(kernels) {
                    *missed += usize::from(by_plain(kernel, &triangles, ray).is_none());
                }
            }
        }
        println!("B3, aspect {aspect:e}: {true_hits} hits of 800 rays, 0 missed; {kernels:?} miss {missed:?}");
        assert!(true_hits > 100, "{aspect}: {true_hits}");
        if aspect == 1e6 {
            // The plane and its rounded point are no way to find a needle.
            assert!(missed[0] > true_hits / 2 && missed[1] > 0, "{missed:?}");
        }
    }
}

#[test]
fn b04_slivers_with_an_obtuse_apex() {
    // A closed strip of 1000: each shares its long edge, or its apex's, with the next.
    let mut triangles = Vec::new();
    for k in 0..500 {
        let x = k as f32;
        triangles.push([v(x, 0.0, 0.0), v(x + 1.0, 0.0, 0.0), v(x + 0.5, 1e-7, 0.0)]);
        triangles.push([v(x + 1.0, 0.0, 0.0), v(x, 0.0, 0.0), v(x + 0.5, -1e-7, 0.0)]);
    }
    let mut dice = Dice::new(4);
    let mut rays: Vec<GzRay> = (0..400)
        .map(|k| {
            let along = DVec3::X * (500.0 * dice.unit());
            let origin = (along + dice.direction() * 3.0).as_vec3();
            // At the common line, or past it by about a sliver's height.
            let off = if k % 2 == 0 { 0.0 } else { dice.between(-2e-7, 2e-7) };
            GzRay::new(origin, (along + DVec3::Y * f64::from(off)).as_vec3() - origin)
        })
        .collect();
    rays.extend((0..400).map(|k| GzRay::new(v(k as f32 + 0.5, 0.0, 1.0), GzCoord::NEG_Z)));
    let hits = settled("B4", &buffer(triangles), &rays);
    assert!(hits[400..].iter().all(Hit::is_hit) && hits[..400].iter().any(|hit| !hit.is_hit()));
    assert!(hits[..400].iter().any(Hit::is_hit));
}

/// A right triangle with legs `s` at `at`, and the ray through its inside along z.
fn small(s: f32, at: f32) -> ([GzCoord; 3], GzRay) {
    let corner = v(at, at, at);
    let inside = corner + v(s / 3.0, s / 3.0, 0.0);
    ([corner, corner + GzCoord::X * s, corner + GzCoord::Y * s], GzRay::new(inside - GzCoord::Z, GzCoord::Z))
}

#[test]
fn b05_tiny_triangle() {
    for s in [2e-4, 1e-6, 1e-12, 1e-20, 1e-38, 1e-44] {
        let (corners, ray) = small(s, 0.0);
        let hit = settled("B5", &buffer([corners]), &[ray])[0];
        assert_eq!((hit.tri, hit.t), (0, 1.0), "{s}");
    }
    // Products of two such legs underflow in f32: every test that forms them dies there.
    let (corners, ray) = small(1e-38, 0.0);
    for kernel in [Kernel::Plane, Kernel::MoellerTrumbore, Kernel::Pluecker, Kernel::BaldwinWeber] {
        assert_eq!(plain(kernel, &ray, &corners), None, "{kernel:?}");
    }
    assert!(plain(Kernel::MoellerTrumboreF64, &ray, &corners).is_some());
}

#[test]
fn b06_tiny_triangle_far_away() {
    for s in [1e-3, 1e-6, 2e-7, 6e-8, 5e-8, 1e-12] {
        let (corners, ray) = small(s, 1.0);
        let hit = settled("B6", &buffer([corners]), &[ray])[0];
        // Legs of less than half a step of f32 at 1 are rounded away: a triangle without area. Between, the rounded corners decide.
        let is_flat = corners[0] == corners[1];
        assert_eq!(is_flat, s < 5.9e-8, "{s}");
        assert!(!is_flat || !hit.is_hit());
    }
}

#[test]
fn b07_huge_triangle() {
    // Loading refuses no size: beyond 2^60 the filter lets everything through and f64 or the exact stage answers.
    let mut dice = Dice::new(7);
    for size in [1e18f32, 1e20, 1e30, 3e38] {
        let triangles = [
            [v(-size, -size, 1.0), v(size, -size, 1.0), v(0.0, size, 1.0)],
            [v(-size, -size, 2.0), v(size, -size, 2.0), v(0.0, size, 2.0)],
        ];
        let mut rays = vec![GzRay::new(GzCoord::ZERO, GzCoord::Z), GzRay::new(v(0.3, -0.7, 0.0), v(0.1, 0.2, 1.0))];
        rays.extend((0..40).map(|_| GzRay::new(dice.point(1.0).as_vec3(), dice.direction().as_vec3())));
        let hits = settled("B7", &buffer(triangles), &rays);
        assert_eq!((hits[0].tri, hits[0].t, hits[1].tri, hits[1].t), (0, 1.0, 0, 1.0));
    }
    let huge = [v(-1e20, -1e20, 1.0), v(1e20, -1e20, 1.0), v(0.0, 1e20, 1.0)];
    let down = GzRay::new(v(0.3, 0.1, 0.0), GzCoord::Z);
    for kernel in [Kernel::Plane, Kernel::MoellerTrumbore, Kernel::Pluecker] {
        // 1e20 times 1e20 is infinite in f32, and their difference no number.
        assert_eq!(plain(kernel, &down, &huge), None, "{kernel:?}");
    }
}

#[test]
fn b08_one_corner_far_away() {
    let mut dice = Dice::new(8);
    for _ in 0..20 {
        let far = (dice.direction() * 1e8).as_vec3();
        let near = dice.point(1.0).as_vec3();
        let corners = [near, near + dice.point(1e-3).as_vec3(), far];
        let rays: Vec<GzRay> = (0..60)
            .map(|k| {
                let along = if k % 2 == 0 { dice.unit() } else { dice.magnitude(-9.0, -4.0) };
                let aim = (near + (far - near) * along as f32) + dice.point(3e-4).as_vec3();
                let origin = near + dice.point(2.0).as_vec3();
                GzRay::new(origin, aim - origin)
            })
            .collect();
        let hits = settled("B8", &buffer([corners]), &rays);
        for (ray, hit) in rays.iter().zip(&hits).filter(|(_, hit)| hit.is_hit()) {
            // T stays between those of the corners.
            let d = ray.direction.as_dvec3();
            let at = corners.map(|p| (p.as_dvec3() - ray.origin).dot(d) / d.length_squared());
            let (least, most) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
            let slack = 1e-6 * least.abs().max(most.abs());
            assert!(f64::from(hit.t) >= least - slack && f64::from(hit.t) <= most + slack, "{ray:?} {corners:?}");
        }
    }
}

#[test]
fn b09_exact_duplicates() {
    let mut dice = Dice::new(9);
    let once = meshes::soup(&mut dice, 40, 0.4);
    let mut triangles = once.clone();
    (0..3).for_each(|_| triangles.extend_from_slice(&once));
    let rays = aimed(&mut dice, &once, 600, 2.0);
    let hits = settled("B9", &buffer(triangles), &rays);
    assert!(
        hits.iter().filter(|hit| hit.is_hit()).all(|hit| hit.tri < 40) && hits.iter().filter(|hit| hit.is_hit()).count() > 300
    );
}

#[test]
fn b10_coplanar_overlapping() {
    // Triangles of sixteenths in the planes z = 1 and z = x / 2 + y + 1: all that a ray meets in one plane are at one t.
    let mut dice = Dice::new(10);
    for slope in [0.0, 1.0] {
        let point = |dice: &mut Dice, n: i32| {
            let (x, y) = (dice.whole(n) as f32 / 16.0, dice.whole(n) as f32 / 16.0);
            v(x, y, slope * (0.5 * x + y) + 1.0)
        };
        let triangles: Vec<[GzCoord; 3]> = (0..120).map(|_| std::array::from_fn(|_| point(&mut dice, 32))).collect();
        let rays: Vec<GzRay> = (0..400)
            .map(|_| {
                let aim = point(&mut dice, 24);
                let origin = dice.point(1.0).as_vec3() - GzCoord::Z * 3.0;
                GzRay::new(origin, aim - origin)
            })
            .collect();
        let hits = settled("B10", &buffer(triangles.iter().copied()), &rays);
        // The first triangle that the ray meets at all is the answer.
        for (ray, hit) in rays.iter().zip(&hits) {
            let first = (0..).zip(&triangles).find(|(_, corners)| gz_core::kernel::is_hit(ray, corners));
            assert_eq!(hit.tri, first.map_or(NO_TRI, |(tri, _)| tri));
        }
        // Rounded T-values of coplanar triangles differ in their last bits, and the order with them.
        let confused =
            rays.iter().zip(&hits).filter(|(ray, hit)| by_plain(Kernel::MoellerTrumbore, &triangles, ray) != Some(hit.tri));
        assert!(hits.iter().filter(|hit| hit.is_hit()).count() > 200 && confused.count() > 20);
    }
}

#[test]
fn b11_near_duplicates() {
    // The second copy is one step of f32 nearer, or the first one is.
    let mut dice = Dice::new(11);
    for nearer in [0, 1] {
        let mut triangles = Vec::new();
        for _ in 0..30 {
            let corners = meshes::soup(&mut dice, 1, 0.5)[0].map(|p| p + GzCoord::Z * 4.0);
            let closer = corners.map(|p| p.with_z(p.z.next_down()));
            triangles.extend(if nearer == 0 { [closer, corners] } else { [corners, closer] });
        }
        let rays: Vec<GzRay> = (0..600)
            .map(|_| {
                let [a, b, c] = dice.pick(&triangles).map(|p| p.as_dvec3());
                let [wa, wb, wc] = dice.weights();
                GzRay::new(GzCoord::ZERO, (a * wa + b * wb + c * wc).as_vec3())
            })
            .collect();
        let hits = settled("B11", &buffer(triangles), &rays);
        // All corners moved against z alone: where the ray meets both, it meets the nearer first. Near an edge it may meet only one.
        let right = hits.iter().filter(|hit| hit.is_hit() && hit.tri % 2 == nearer).count();
        assert!(right > 550, "{right} of 600");
    }
}

#[test]
fn b12_many_copies_of_one_triangle() {
    const COPIES: usize = 100_000;
    let one = [v(0.1, 0.2, 0.3), v(0.9, 0.1, 0.5), v(0.3, 0.8, 0.6)];
    let tris = buffer(vec![one; COPIES]);
    // Nothing is gained by cutting them apart, so the tree stops.
    let stats = CostStats::of(&BspTree::build(&tris));
    assert!(stats.references <= 2 * COPIES, "{stats:?}");
    let rays = [GzRay::new(v(0.4, 0.3, -1.0), GzCoord::Z), GzRay::new(v(0.0, 0.0, -1.0), GzCoord::Z)];
    let hits = settled("B12", &tris, &rays);
    assert_eq!((hits[0].tri, hits[1].is_hit()), (0, false));
}

#[test]
fn b13_reversed_winding() {
    let mut dice = Dice::new(13);
    let triangles = meshes::soup(&mut dice, 60, 0.4);
    let rays = aimed(&mut dice, &triangles, 600, 2.0);
    let hits = settled("B13", &buffer(triangles.iter().copied()), &rays);
    let reversed = settled("B13, reversed", &buffer(triangles.iter().map(|&[a, b, c]| [a, c, b])), &rays);
    for (hit, reversed) in hits.iter().zip(&reversed) {
        assert_eq!((hit.t.to_bits(), hit.tri), (reversed.t.to_bits(), reversed.tri));
        // The weights go with their corners.
        assert!(gz_tests::judge::steps(hit.u, reversed.v) <= 1 || (hit.u - reversed.v).abs() < 1e-12);
        assert!(gz_tests::judge::steps(hit.v, reversed.u) <= 1 || (hit.v - reversed.u).abs() < 1e-12);
    }
}

#[test]
fn b14_corners_in_another_order() {
    // T is the exact t rounded once, so that no order of corners can show.
    let mut dice = Dice::new(14);
    let triangles = meshes::soup(&mut dice, 60, 0.4);
    let rays = aimed(&mut dice, &triangles, 600, 2.0);
    let hits = settled("B14", &buffer(triangles.iter().copied()), &rays);
    let turned = settled("B14, turned", &buffer(triangles.iter().map(|&[a, b, c]| [b, c, a])), &rays);
    for (hit, turned) in hits.iter().zip(&turned) {
        assert_eq!((hit.t.to_bits(), hit.tri), (turned.t.to_bits(), turned.tri));
    }
    // A rounded test computes something else from another order.
    let t = |corners: &[GzCoord; 3], ray: &GzRay| plain(Kernel::MoellerTrumbore, ray, corners).map(|(t, ..)| t.to_bits());
    let differ = rays.iter().filter(|ray| {
        triangles.iter().any(|&[a, b, c]| t(&[a, b, c], ray).zip(t(&[b, c, a], ray)).is_some_and(|(one, other)| one != other))
    });
    assert!(differ.count() > 100);
}

#[test]
fn b15_fold_of_almost_half_a_turn() {
    // Back to back over a common edge, 1e-6 apart at the far corners.
    let triangles =
        [[v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.5, 1.0, 0.0)], [v(1.0, 0.0, 0.0), v(0.0, 0.0, 0.0), v(0.5, 1.0, 1e-6)]];
    let mut dice = Dice::new(15);
    let mut rays = Vec::new();
    for k in 0..600 {
        let (x, y) = (dice.between(0.3, 0.7), dice.magnitude(-7.0, -0.5) as f32);
        let from = if k % 2 == 0 { 1.0 } else { -1.0 };
        rays.push(GzRay::new(v(x, y, from), v(0.0, 0.0, -from)));
    }
    let hits = settled("B15", &buffer(triangles), &rays);
    // From above the lifted one is in front, from below the flat one.
    for (k, hit) in hits.iter().enumerate() {
        assert_eq!(hit.tri, if k % 2 == 0 { 1 } else { 0 }, "{:?}", rays[k]);
    }
    assert!(leaks(Kernel::MoellerTrumboreF64, &triangles, &rays) == 0);
}

#[test]
#[allow(clippy::excessive_precision)] // the numbers as pbrt prints them
fn b16_bad_cases_of_pbrt() {
    let corners = [
        v(-1113.45459, -79.049614, -56.2431908),
        v(-1113.45459, -87.0922699, -56.2431908),
        v(-1113.45459, -79.2090149, -56.2431908),
    ];
    let ray = GzRay::new(v(-1081.47925, 99.9999542, 87.7701111), v(-32.1072998, -183.355865, -144.607635));
    assert!(!settled("B16", &buffer([corners]), &[ray])[0].is_hit(), "three points of a line");
}
