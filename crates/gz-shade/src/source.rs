//! The triangle that a ray leaves: by proof it is not met again, by the paper's rule it is not looked at.
//!
//! The questions here are those of [`RayQuery`] for rays that each leave a triangle, `rays.leaves`, by a policy.

use gz_core::{ClassMask, Hit, LeavePolicy, Passages, PerRay, RayBatch, RayQuery, TriId};

/// The front-most hits.
pub(crate) fn closest_hits(query: &dyn RayQuery, policy: LeavePolicy, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
    let asked = promising(rays, policy);
    query.closest_hits(&asked, classes, hits);
    if let Some(leaves) = rays.leaves.filter(|_| policy.skips_source()) {
        skip_sources(query, &asked, classes, leaves, hits);
    }
}

/// Whether there are any.
pub(crate) fn any_hits(
    query: &dyn RayQuery,
    policy: LeavePolicy,
    rays: &RayBatch<'_>,
    classes: ClassMask,
    occluded: &mut [bool],
) {
    if !policy.skips_source() {
        return query.any_hits(&promising(rays, policy), classes, occluded);
    }
    // *That* something is hit is not enough: it may be the triangle left.
    let mut hits = vec![Hit::MISS; rays.len()];
    closest_hits(query, policy, rays, classes, &mut hits);
    occluded.iter_mut().zip(&hits).for_each(|(occluded, hit)| *occluded = hit.is_hit());
}

/// What rays meet that go through the triangles of `through`.
pub(crate) fn passages(
    query: &dyn RayQuery,
    policy: LeavePolicy,
    rays: &RayBatch<'_>,
    through: ClassMask,
    passages: &mut Passages,
) {
    if !policy.skips_source() {
        return query.passages(&promising(rays, policy), through, passages);
    }
    let any = |rays: &RayBatch<'_>, classes, occluded: &mut [bool]| any_hits(query, policy, rays, classes, occluded);
    passages.ask_by(any, |rays, classes, hits| closest_hits(query, policy, rays, classes, hits), rays, through);
}

/// `rays` with the promise that none meets the triangle that it leaves, where they leave in the way that makes it true. Other ways promise
/// nothing, and their rays may meet it.
fn promising<'a>(rays: &RayBatch<'a>, policy: LeavePolicy) -> RayBatch<'a> {
    let mut asked = *rays;
    asked.leaves = rays.leaves.filter(|_| policy == LeavePolicy::Exact);
    asked
}

/// Takes hits of `rays` on the triangles that they leave, `leaves[i]` for ray `i`, for misses of those: `hits`, the front-most ones among
/// `classes`, become the next ones.
///
/// A ray meets a flat triangle at most once, so asking again behind it is enough. What lies within one step of f32 behind it is lost.
fn skip_sources(query: &dyn RayQuery, rays: &RayBatch<'_>, classes: ClassMask, leaves: &[TriId], hits: &mut [Hit]) {
    for (i, (hit, &own)) in hits.iter_mut().zip(leaves).enumerate() {
        while hit.is_hit() && hit.tri == own {
            let ray = rays.ray(i);
            let (origin, direction) = (PerRay::One(ray.origin), PerRay::One(ray.direction));
            let behind = RayBatch::new(1, origin, direction, PerRay::One(hit.t.next_up()), PerRay::One(ray.tmax));
            query.closest_hits(&behind, classes, std::slice::from_mut(hit));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use gz_core::{BruteForce, GzCoord, TriBuffer};

    #[test]
    fn a_ray_sees_past_its_own_triangle_and_no_other() {
        let wall = |z: f32| [[-9.0, -9.0, z], [9.0, -9.0, z], [0.0, 9.0, z]].map(GzCoord::from_array);
        let tris = TriBuffer::from_indexed(&[wall(1.0), wall(2.0)].concat(), &[[0, 1, 2], [3, 4, 5]]).unwrap();
        let brute = BruteForce::new(&tris);
        let rays = RayBatch::unbounded(4, PerRay::One(DVec3::ZERO), PerRay::One(GzCoord::Z));
        let mut hits = [Hit::MISS; 4];
        brute.closest_hits(&rays, ClassMask::ALL, &mut hits);
        hits[3] = Hit::MISS;
        skip_sources(&brute, &rays, ClassMask::ALL, &[0, 1, 7, 0], &mut hits);
        assert_eq!(hits.map(|hit| hit.tri), [1, 0, 0, gz_core::NO_TRI]);
        let near = RayBatch::new(1, PerRay::One(DVec3::ZERO), PerRay::One(GzCoord::Z), PerRay::One(0.0), PerRay::One(1.5));
        skip_sources(&brute, &near, ClassMask::ALL, &[0], &mut hits[1..2]);
        assert_eq!(hits[1], Hit::MISS);
    }
}
