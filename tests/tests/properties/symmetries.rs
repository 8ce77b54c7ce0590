//! P4 to P9: the same scene written, placed, turned or scaled in another way.

use super::inputs::{Corners, plain_point, rays, shots, shots_from, triangles, triangles_over};
use gz_bsp::BspTree;
use gz_core::glam::DVec3;
use gz_core::{BruteForce, GzCoord, GzRay, Hit, RayQuery};
use gz_tests::judge::buffer;
use proptest::prelude::*;

/// What brute force and the tree answer; they agree.
fn answers(triangles: &[Corners], rays: &[GzRay]) -> Vec<Hit> {
    let tris = buffer(triangles.iter().copied());
    let (brute, tree) = (BruteForce::new(&tris), BspTree::build(&tris));
    let answer = |ray: &GzRay| {
        let hit = brute.closest_hit(ray);
        assert_eq!(tree.closest_hit(ray), hit, "{ray:?}");
        hit
    };
    rays.iter().map(answer).collect()
}

/// Whole numbers, where moving by whole numbers is exact.
fn whole_point() -> BoxedStrategy<GzCoord> {
    [-9i8..=9, -9i8..=9, -9i8..=9].prop_map(|p| GzCoord::from_array(p.map(f32::from))).boxed()
}

proptest! {
    #[test]
    fn p04_the_order_of_triangles(triangles in triangles(), shots in shots(), seed in any::<u64>()) {
        let rays = rays(&shots, &triangles);
        let mut order: Vec<usize> = (0..triangles.len()).collect();
        let mut dice = gz_tests::hard::Dice::new(seed);
        for i in (1..order.len()).rev() {
            order.swap(i, dice.below(i + 1));
        }
        let mixed: Vec<Corners> = order.iter().map(|&k| triangles[k]).collect();
        let (hits, other) = (answers(&triangles, &rays), answers(&mixed, &rays));
        for ((ray, hit), other) in rays.iter().zip(&hits).zip(&other) {
            prop_assert_eq!((hit.t.to_bits(), hit.is_hit()), (other.t.to_bits(), other.is_hit()));
            if hit.is_hit() {
                // Of several at one t the lowest number is the answer, and numbers have moved: the triangle found ties with the first.
                let pair = [triangles[hit.tri as usize], mixed[other.tri as usize]];
                prop_assert_eq!(answers(&pair, &[*ray])[0].tri, 0);
                prop_assert_eq!(answers(&[pair[1], pair[0]], &[*ray])[0].tri, 0);
            }
        }
    }

    #[test]
    fn p05_the_order_of_corners(triangles in triangles(), shots in shots()) {
        let rays = rays(&shots, &triangles);
        let hits = answers(&triangles, &rays);
        for turn in [|[a, b, c]: Corners| [b, c, a], |[a, b, c]: Corners| [a, c, b], |[a, b, c]: Corners| [c, b, a]] {
            let turned: Vec<Corners> = triangles.iter().map(|corners| turn(*corners)).collect();
            for (hit, turned) in hits.iter().zip(answers(&turned, &rays)) {
                prop_assert_eq!((hit.tri, hit.t.to_bits()), (turned.tri, turned.t.to_bits()));
            }
        }
    }

    #[test]
    fn p06_scaling_by_powers_of_two(triangles in triangles_over(plain_point()), shots in shots_from(plain_point()), k in -60i32..60) {
        let (s, rays) = (2f32.powi(k), rays(&shots, &triangles));
        let scaled: Vec<Corners> = triangles.iter().map(|corners| corners.map(|p| p * s)).collect();
        // A coordinate that loses bits makes another scene.
        prop_assume!(scaled.iter().flatten().zip(triangles.iter().flatten()).all(|(x, y)| *x * (1.0 / s) == *y));
        let unbounded = |ray: &GzRay| GzRay { tmin: 0.0, tmax: f32::INFINITY, ..*ray };
        let rays: Vec<GzRay> = rays.iter().map(unbounded).filter(GzRay::is_valid).collect();
        let moved: Vec<GzRay> = rays.iter().map(|ray| GzRay { origin: ray.origin * f64::from(s), ..*ray }).collect();
        for ((hit, moved), ray) in answers(&triangles, &rays).iter().zip(answers(&scaled, &moved)).zip(&moved) {
            if ray.is_valid() && (hit.t * s).is_normal() {
                prop_assert_eq!((moved.tri, moved.t, moved.u, moved.v), (hit.tri, hit.t * s, hit.u, hit.v));
            }
        }
    }

    #[test]
    fn p07_axes_permuted_and_mirrored(triangles in triangles(), shots in shots(), turn in 0usize..3, swap in any::<bool>(), mirror in 0u8..8) {
        let change = |p: [f64; 3]| {
            let mut q: [f64; 3] = std::array::from_fn(|k| p[(k + turn) % 3] * if mirror >> k & 1 == 0 { 1.0 } else { -1.0 });
            if swap {
                q.swap(0, 1);
            }
            q
        };
        let corner = |p: GzCoord| DVec3::from_array(change(p.as_dvec3().to_array())).as_vec3();
        let rays = rays(&shots, &triangles);
        let turned: Vec<Corners> = triangles.iter().map(|corners| corners.map(corner)).collect();
        let turned_rays: Vec<GzRay> = rays
            .iter()
            .map(|ray| GzRay { origin: DVec3::from_array(change(ray.origin.to_array())), direction: corner(ray.direction), ..*ray })
            .collect();
        for (hit, turned) in answers(&triangles, &rays).iter().zip(answers(&turned, &turned_rays)) {
            prop_assert_eq!((hit.tri, hit.t.to_bits()), (turned.tri, turned.t.to_bits()));
        }
    }

    #[test]
    fn p08_whole_scenes_moved_by_whole_numbers(
        triangles in triangles_over(whole_point()),
        shots in shots_from(whole_point()),
        by in [-100_000i32..100_000, -100_000i32..100_000, -100_000i32..100_000],
    ) {
        // Only what is whole: needles are not.
        let triangles: Vec<Corners> = triangles.into_iter().filter(|t| t.iter().all(|p| p.fract() == GzCoord::ZERO)).collect();
        let rays: Vec<GzRay> = rays(&shots, &triangles).into_iter().filter(|ray| ray.origin.fract() == DVec3::ZERO).collect();
        let by = GzCoord::from_array(by.map(|x| x as f32));
        let moved: Vec<Corners> = triangles.iter().map(|corners| corners.map(|p| p + by)).collect();
        let moved_rays: Vec<GzRay> = rays.iter().map(|ray| GzRay { origin: ray.origin + by.as_dvec3(), ..*ray }).collect();
        prop_assert_eq!(answers(&triangles, &rays), answers(&moved, &moved_rays));
    }

    #[test]
    fn p09_signs_of_zero(triangles in triangles(), shots in shots(), signs in any::<u64>()) {
        let mut signs = gz_tests::hard::Dice::new(signs);
        let mut flip = |p: GzCoord| GzCoord::from_array(p.to_array().map(|x| if x == 0.0 && signs.sign() < 0.0 { -x } else { x }));
        let rays = rays(&shots, &triangles);
        let flipped: Vec<Corners> = triangles.iter().map(|corners| corners.map(&mut flip)).collect();
        let flipped_rays: Vec<GzRay> = rays
            .iter()
            .map(|ray| {
                let origin = DVec3::from_array(ray.origin.to_array().map(|x| if x == 0.0 { -x } else { x }));
                GzRay { origin, direction: flip(ray.direction), ..*ray }
            })
            .collect();
        let bits = |hits: Vec<Hit>| gz_tests::scenes::hit_bits(&hits);
        prop_assert_eq!(bits(answers(&triangles, &rays)), bits(answers(&flipped, &flipped_rays)));
    }
}
