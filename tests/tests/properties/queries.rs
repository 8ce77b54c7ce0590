//! P1 to P3, P9, P14, P15, P20, P24: what queries answer.

use super::inputs::{Corners, rays, shots, triangles};
use gz_bsp::{BspTree, Midpoint, MidpointTree, VisitCount};
use gz_core::kernel::{hit_weights, is_hit};
use gz_core::{BruteForce, ClassMask, GzRay, Hit, RayQuery, SimdLevel};
use gz_tests::judge::{Verdict, buffer, judge, settled, truth_ray, truth_triangle};
use gz_tests::truth::{Fraction, Meeting, plain};
use proptest::prelude::*;
use std::cmp::Ordering;

/// The exact hit of a ray on a triangle.
fn meeting(ray: &GzRay, corners: &Corners) -> Option<Meeting> {
    Meeting::of(&truth_ray(ray).line()?, &truth_triangle(corners))
}

proptest! {
    #[test]
    fn p01_the_filter_rejects_no_hit(triangles in triangles(), shots in shots()) {
        // One triangle alone: what answers is what the filter lets through.
        for (ray, corners) in rays(&shots, &triangles).iter().zip(triangles.iter().cycle()) {
            let (alone, expected) = (buffer([*corners]), meeting(ray, corners).is_some());
            for &level in SimdLevel::available() {
                prop_assert_eq!(BruteForce::new(&alone).with_simd(level).any_hit(ray), expected, "{:?}", level);
                prop_assert_eq!(BspTree::build(&alone).with_simd(level).closest_hit(ray).is_hit(), expected, "{:?}", level);
            }
        }
    }

    #[test]
    fn p02_the_certified_test_is_exact(triangles in triangles(), shots in shots()) {
        for (ray, corners) in rays(&shots, &triangles).iter().zip(triangles.iter().cycle()).filter(|(ray, _)| ray.is_valid()) {
            let exact = meeting(ray, corners);
            prop_assert_eq!(is_hit(ray, corners), exact.is_some());
            if let Some(exact) = exact {
                let weights = hit_weights(ray, corners);
                let off = |w: f64, exact: &Fraction| exact.minus(w).to_f64().abs();
                prop_assert!(off(weights[1], &exact.u) <= 2f64.powi(-36) && off(weights[2], &exact.v) <= 2f64.powi(-36));
            }
        }
    }

    #[test]
    fn p03_everyone_answers_truly(triangles in triangles(), shots in shots(), max_depth in 0u32..14, min_size in 0usize..14) {
        let (tris, rays) = (buffer(triangles.iter().copied()), rays(&shots, &triangles));
        let hits = settled("P3", &tris, &rays);
        // And plain integers say the same.
        let triangles: Vec<_> = triangles.iter().map(truth_triangle).collect();
        for (ray, hit) in rays.iter().zip(&hits) {
            prop_assert_eq!(judge(hit, plain::closest(&truth_ray(ray), &triangles)), Verdict::Right);
        }
        if let Ok(tree) = MidpointTree::build(&tris, Midpoint { max_depth, min_size, node_budget: 1 << 13 }) {
            for (ray, hit) in rays.iter().zip(&hits) {
                prop_assert_eq!(tree.closest_hit(ray), *hit);
            }
        }
    }

    #[test]
    fn p14_any_hit_is_some_closest_hit(triangles in triangles(), shots in shots()) {
        let tris = buffer(triangles.iter().copied());
        let (brute, tree) = (BruteForce::new(&tris), BspTree::build(&tris));
        for ray in rays(&shots, &triangles) {
            prop_assert_eq!(brute.any_hit(&ray), brute.closest_hit(&ray).is_hit());
            prop_assert_eq!(tree.any_hit(&ray), brute.closest_hit(&ray).is_hit());
        }
    }

    #[test]
    fn p15_the_end_of_a_ray_decides_at_its_hit(triangles in triangles(), shots in shots()) {
        let tris = buffer(triangles.iter().copied());
        let (brute, tree) = (BruteForce::new(&tris), BspTree::build(&tris));
        for ray in rays(&shots, &triangles) {
            let hit = brute.closest_hit(&ray);
            if !hit.is_hit() {
                continue;
            }
            // The exact t lies within half a step of T: one step beyond keeps the hit, one step before loses it.
            let (beyond, before) = (GzRay { tmax: hit.t.next_up().min(ray.tmax), ..ray }, GzRay { tmax: hit.t.next_down(), ..ray });
            if hit.t.is_finite() && beyond.tmax > hit.t {
                prop_assert_eq!(tree.closest_hit(&beyond), hit);
            }
            prop_assert!(!tree.closest_hit(&before).is_hit() && !tree.any_hit(&before));
            // At T itself the exact t decides.
            let at = GzRay { tmax: hit.t, ..ray };
            let is_before = meeting(&ray, tris.position(hit.tri)).is_some_and(|m| m.t.cmp_number(hit.t.into()) == Ordering::Less);
            prop_assert_eq!(tree.closest_hit(&at).is_hit(), is_before);
        }
    }

    #[test]
    fn p20_rays_that_are_no_rays_miss_at_once(
        triangles in triangles(),
        shots in shots(),
        spoil in 0usize..10,
        bad in prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(f32::NEG_INFINITY)],
    ) {
        let tris = buffer(triangles.iter().copied());
        let (tree, paper) = (BspTree::build(&tris), MidpointTree::build(&tris, Midpoint { max_depth: 6, ..Midpoint::default() }));
        for mut ray in rays(&shots, &triangles) {
            match spoil {
                axis @ 0..=2 => ray.origin[axis] = bad.into(),
                axis @ 3..=5 => ray.direction[axis - 3] = bad,
                6 => ray.tmin = f32::NAN,
                7 => ray.tmax = f32::NAN,
                8 => ray.direction = gz_core::GzCoord::ZERO,
                _ => ray.tmax = ray.tmin,
            }
            let mut visits = VisitCount::default();
            prop_assert_eq!(tree.closest_hit_counted(&ray, ClassMask::ALL, &mut visits), Hit::MISS);
            prop_assert!(visits.nodes + visits.leaves <= 1 && visits.tests == 0, "{:?}", visits);
            if let Ok(paper) = &paper {
                let mut visits = VisitCount::default();
                prop_assert_eq!(paper.closest_hit_counted(&ray, ClassMask::ALL, &mut visits), Hit::MISS);
                prop_assert!(visits.nodes + visits.leaves <= 1 && visits.tests == 0, "{:?}", visits);
            }
            prop_assert!(!BruteForce::new(&tris).any_hit(&ray));
        }
    }

    #[test]
    fn p24_the_order_of_hits_is_total(triangles in triangles(), shots in shots()) {
        // Which of two triangles comes first, asked in pairs, orders all that a ray hits: by exact t, then by number.
        let triangles = &triangles[..triangles.len().min(12)];
        for ray in rays(&shots, triangles).iter().take(6) {
            let Some(line) = truth_ray(ray).line() else { continue };
            let in_order: Vec<u32> =
                plain::hits(&line, &triangles.iter().map(truth_triangle).collect::<Vec<_>>()).iter().map(|(tri, _)| *tri).collect();
            for (i, &first) in in_order.iter().enumerate() {
                for &second in &in_order[i + 1..] {
                    // In a buffer of the two alone, numbers keep their order.
                    let (low, high) = (first.min(second), first.max(second));
                    let pair = buffer([triangles[low as usize], triangles[high as usize]]);
                    let expected = u32::from(first == high);
                    prop_assert_eq!(BruteForce::new(&pair).closest_hit(ray).tri, expected);
                    prop_assert_eq!(BspTree::build(&pair).closest_hit(ray).tri, expected);
                }
            }
        }
    }
}
