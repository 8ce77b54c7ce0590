//! The paper's failures (its sections 2.4 and 3.3.2), put back into a twin of its tree: the twin must go wrong where the product does
//! not, and the twin without the mistake must not.

use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::glam::DVec3;
use gz_core::kernel::is_hit;
use gz_core::{BruteForce, GzCoord, GzRay, Hit, RayQuery, TriBuffer, TriId, leave_surface};
use gz_tests::plain_trees::{Ending, Insert, PlainMidpoint, PlainRules};

/// Rays on which the twin has another answer than brute force.
fn twin_errors(tris: &TriBuffer, rays: &[GzRay], truth: &[Hit], insert: Insert, ending: Ending) -> usize {
    let twin = PlainMidpoint::build(tris, PlainRules { insert, ending, ..PlainRules::default() });
    rays.iter().zip(truth).filter(|(ray, truth)| twin.closest_hit(ray) != **truth).count()
}

/// Rays on which the product's trees differ from brute force.
fn product_errors(tris: &TriBuffer, rays: &[GzRay], truth: &[Hit]) -> usize {
    let tuned = BspTree::build(tris);
    let paper = MidpointTree::build(tris, Midpoint::default()).expect("within budget");
    rays.iter().zip(truth).filter(|(ray, truth)| tuned.closest_hit(ray) != **truth || paper.closest_hit(ray) != **truth).count()
}

/// Every twentieth ray of the paper's scene, and the answers to them.
fn paper_rays() -> (TriBuffer, Vec<GzRay>, Vec<Hit>) {
    let (tris, rays) = super::paper_scene();
    let rays: Vec<GzRay> = rays.sample(10_000).rays().map(|(ray, _)| ray).collect();
    let brute = BruteForce::new(&tris);
    let truth = rays.iter().map(|ray| brute.closest_hit(ray)).collect();
    (tris, rays, truth)
}

#[test]
fn listing_a_triangle_only_where_a_corner_lies_leaves_holes() {
    let (tris, rays, truth) = paper_rays();
    assert_eq!(twin_errors(&tris, &rays, &truth, Insert::BoxTouches, Ending::Padded), 0);
    let wrong = twin_errors(&tris, &rays, &truth, Insert::CornerInside, Ending::Padded);
    println!("corner in box: {wrong} of {} rays wrong", rays.len());
    assert!(wrong > rays.len() / 100, "{wrong} of {}", rays.len());
    assert_eq!(product_errors(&tris, &rays, &truth), 0);
}

#[test]
fn accepting_the_first_hit_found_in_a_leaf_hides_nearer_ones() {
    let (tris, rays, truth) = paper_rays();
    let wrong = twin_errors(&tris, &rays, &truth, Insert::BoxTouches, Ending::FirstInLeaf);
    println!("first hit found: {wrong} of {} rays wrong", rays.len());
    assert!(wrong > 0, "{wrong} of {}", rays.len());
    assert_eq!(product_errors(&tris, &rays, &truth), 0);
}

/// What the paper's program asks: whether a ray from the f32 hit point is blocked by any triangle but the one it leaves.
fn blocked_for_all_but(tris: &TriBuffer, ray: &GzRay, own: TriId) -> bool {
    (0..).zip(tris.positions()).any(|(tri, corners)| tri != own && is_hit(ray, corners))
}

#[test]
fn skipping_the_own_triangle_by_its_number_alone_leaves_stipple() {
    // On the paper's own coarse scene this costs nothing: 0 of 49 989 shadow rays change. Planes cut into triangles show it.
    // A parallelogram with integer corners, so exactly in one plane, cut along its diagonal. Nothing else is there: whatever blocks a
    // ray that leaves it is its other half, which lies in the plane that the ray has left.
    let (a, e1, e2) = (GzCoord::new(3.0, -7.0, 11.0), GzCoord::new(13.0, 5.0, -3.0), GzCoord::new(-4.0, 11.0, 6.0));
    let tris = super::buffer([[a, a + e1, a + e1 + e2], [a, a + e1 + e2, a + e2]]);
    let tree = BspTree::build(&tris);
    let brute = BruteForce::new(&tris);
    let normal = e1.cross(e2).normalize();
    let (mut stipple, mut rays) = (0, 0);
    for k in 0..4000u32 {
        // Points of the first triangle near the diagonal, directions towards it at a small angle to the plane.
        let along = (k % 200) as f32 / 200.0;
        let to_diagonal = 1e-6 * (1 + k / 200) as f32;
        let weights = [1.0 - along - to_diagonal, to_diagonal, along].map(|w: f32| f64::from(w.max(0.0)));
        let direction = ((e2 - e1).normalize() + normal * 1e-3).normalize();
        let point: DVec3 = (0..3).map(|c| tris.position(0)[c].as_dvec3() * weights[c]).sum();
        // The product's start, and the paper's: the hit in f32.
        let origin = leave_surface(tris.position(0), weights, direction).expect("the direction leaves the plane");
        let ray = GzRay::from_f64(origin, direction);
        assert!(!tree.any_hit(&ray) && !brute.any_hit(&ray), "{ray:?}");
        stipple += usize::from(blocked_for_all_but(&tris, &GzRay::new(point.as_vec3(), direction), 0));
        rays += 1;
    }
    println!("own triangle skipped by number: {stipple} of {rays} rays from a plane are blocked by the plane, 0 when leaving it");
    assert!(stipple > rays / 50, "{stipple} of {rays}");
}
