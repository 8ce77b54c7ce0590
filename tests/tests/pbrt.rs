//! Two experiments of pbrt's tests, made again and switched on: `Triangle.Watertight` and `Triangle.Reintersect`.
//!
//! Theirs are in pbrt-v4's shapes_test.cpp; the first is switched off there, the second passes over triangles that are nearly degenerate.

use gz_bsp::BspTree;
use gz_core::glam::DVec3;
use gz_core::kernel::hit_weights;
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, Hit, PerRay, RayBatch, RayQuery, leave_surface};
use gz_tests::hard::{Dice, meshes};
use gz_tests::judge::buffer;

/// From a point within 0.5 of the middle of a closed sphere whose corners are 1 to 6 away, every ray hits.
#[test]
fn watertight() {
    const EACH: usize = 100_000;
    let mut dice = Dice::new(1);
    let mesh = meshes::jittered_sphere(&mut dice, 16, DVec3::ZERO);
    let tris = buffer(mesh.triangles());
    let (brute, tree) = (BruteForce::new(&tris), BspTree::build(&tris));
    let mut asked = 0;
    for at_corners in [false, true] {
        let (origins, directions): (Vec<DVec3>, Vec<GzCoord>) = (0..EACH)
            .map(|k| {
                let origin = dice.point(0.5).as_vec3();
                let aim = mesh.points[k % mesh.points.len()] - origin;
                (origin.as_dvec3(), if at_corners { aim } else { dice.direction().as_vec3() })
            })
            .unzip();
        let rays = RayBatch::unbounded(EACH, PerRay::Each(&origins), PerRay::Each(&directions));
        let (mut by_tree, mut by_brute) = (vec![Hit::MISS; EACH], vec![Hit::MISS; EACH]);
        tree.closest_hits(&rays, ClassMask::ALL, &mut by_tree);
        brute.closest_hits(&rays, ClassMask::ALL, &mut by_brute);
        assert!(by_tree == by_brute);
        assert!(by_tree.iter().all(Hit::is_hit), "{} of {EACH} leak", by_tree.iter().filter(|hit| !hit.is_hit()).count());
        asked += EACH;
    }
    println!("watertight: 0 of {asked} rays leak");
}

/// A ray that leaves a triangle does not meet it again: 1000 triangles with coordinates of 1e-8 to 1e8, 1000 rays each. None is passed over
/// for its shape; one is drawn anew only when none of 40 rays at it hits.
#[test]
fn reintersect() {
    let mut dice = Dice::new(2);
    let coordinate = |dice: &mut Dice| (dice.magnitude(-8.0, 8.0) * dice.sign()) as f32;
    let point = |dice: &mut Dice| GzCoord::new(coordinate(dice), coordinate(dice), coordinate(dice));
    let (mut triangles, mut left, mut no_way) = (0, 0u64, 0u64);
    while triangles < 1000 {
        let corners: [GzCoord; 3] = std::array::from_fn(|_| point(&mut dice));
        let tris = buffer([corners]);
        let tree = BspTree::build(&tris);
        let mut rays: Vec<(DVec3, GzCoord)> = Vec::new();
        for _ in 0..40 {
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let [wa, wb, wc] = dice.weights();
            let origin = point(&mut dice);
            let ray = GzRay::new(origin, (a * wa + b * wb + c * wc - origin.as_dvec3()).as_vec3());
            // A rounded direction may pass a needle by; the next one does not.
            if !tree.closest_hit(&ray).is_hit() {
                continue;
            }
            let weights = hit_weights(&ray, &corners);
            for _ in 0..100 {
                let direction = dice.direction().as_vec3();
                match leave_surface(&corners, weights, direction) {
                    Some(origin) => rays.push((origin, direction)),
                    None => no_way += 1,
                }
            }
            if rays.len() >= 1000 {
                break;
            }
        }
        if rays.is_empty() {
            continue; // so thin that 40 rays at it pass it by
        }
        let (origins, directions): (Vec<DVec3>, Vec<GzCoord>) = rays.into_iter().unzip();
        let batch = RayBatch::unbounded(origins.len(), PerRay::Each(&origins), PerRay::Each(&directions));
        let mut met = vec![false; origins.len()];
        tree.any_hits(&batch, ClassMask::ALL, &mut met);
        assert!(
            !met.contains(&true),
            "{corners:?} is met again by {} of {} rays",
            met.iter().filter(|met| **met).count(),
            met.len()
        );
        triangles += 1;
        left += origins.len() as u64;
    }
    println!("reintersect: 0 of {left} rays meet the triangle that they leave; {no_way} directions lay in its plane");
    assert!(left > 900_000, "{left}");
}
