//! The front-most hit of one ray, found mostly in f32.

use super::answer::t_u_v;
use super::group::Candidates;
use super::order::{closer, is_hit};
use crate::{GzCoord, GzRay, Hit, NO_TRI, RayBatch, TriId};

/// A ray of a batch, put together only where f32 does not decide.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'r> {
    rays: &'r RayBatch<'r>,
    place: usize,
}

impl<'r> Asked<'r> {
    /// Ray `place` of `rays`.
    #[inline(always)]
    pub fn new(rays: &'r RayBatch<'r>, place: usize) -> Self {
        Self { rays, place }
    }

    /// The ray.
    pub fn ray(&self) -> GzRay {
        self.rays.ray(self.place)
    }
}

/// The front-most hit of one ray so far.
///
/// Kept is an interval of t. A candidate that f32 is sure of and whose interval does not touch it is taken or dropped there; all
/// others are put in order by f64 and, where that is not enough, exactly.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// Of the best hit, or both the ray's tmax before there is one.
    pub(super) lo: f32,
    pub(super) hi: f32,
    /// The triangle of the best hit; before there is one, any that the ray does not hit.
    pub(super) tri: TriId,
    /// A triangle that the ray is known not to hit, or [`NO_TRI`].
    pub(super) leaves: TriId,
    pub(super) found: bool,
}

impl Nearest {
    /// Before anything is tested. `leaves` is a triangle that the ray is known not to hit, or [`NO_TRI`].
    pub fn before(ray: &GzRay, leaves: TriId) -> Self {
        Self { lo: ray.tmax, hi: ray.tmax, tri: NO_TRI, leaves, found: false }
    }

    /// At least the exact t of the best hit, or tmax. Nothing beyond it can be better.
    #[inline(always)]
    pub fn limit(&self) -> f32 {
        self.hi
    }

    /// Takes triangle `tri`, lane `lane` of `candidates`, into account for `ray`, whose t begins at `tmin`. Order of calls and repeated
    /// calls do not show in the result.
    #[inline(always)]
    pub fn take(
        &mut self,
        ray: Asked<'_>,
        tmin: f32,
        candidates: &Candidates,
        lane: usize,
        tri: TriId,
        positions: &[[GzCoord; 3]],
    ) {
        if tri == self.tri || tri == self.leaves {
            return;
        }
        let (lo, hi) = (candidates.lo[lane], candidates.hi[lane]);
        if candidates.sure >> lane & 1 != 0 {
            if lo > self.hi || hi < tmin {
                return;
            }
            if hi < self.lo && lo > tmin {
                *self = Self { lo, hi, tri, found: true, ..*self };
                return;
            }
        }
        self.settle_asked(ray, tri, positions);
    }

    #[cold]
    #[inline(never)]
    fn settle_asked(&mut self, ray: Asked<'_>, tri: TriId, positions: &[[GzCoord; 3]]) {
        self.settle(&ray.ray(), tri, positions);
    }

    /// The same by f64 or exactly.
    pub fn settle(&mut self, ray: &GzRay, tri: TriId, positions: &[[GzCoord; 3]]) {
        if let Some((lo, hi)) = closer(ray, self.found.then_some((self.tri, [self.lo, self.hi])), tri, positions) {
            *self = Self { lo, hi, tri, found: true, ..*self };
        }
    }

    /// The answer: T-value and weights are formed only now.
    pub fn hit(&self, ray: &GzRay, positions: &[[GzCoord; 3]]) -> Hit {
        if !self.found {
            return Hit::MISS;
        }
        let (t, u, v) = t_u_v(ray, &positions[self.tri as usize]);
        Hit { t, tri: self.tri, u, v }
    }
}

impl Candidates {
    /// Whether `ray`, whose t is between `tmin` and `tmax`, hits lane `lane`, a triangle with these corners.
    #[inline(always)]
    pub fn is_hit(&self, lane: usize, ray: Asked<'_>, [tmin, tmax]: [f32; 2], corners: &[GzCoord; 3]) -> bool {
        let (lo, hi) = (self.lo[lane], self.hi[lane]);
        if self.sure >> lane & 1 != 0 {
            if lo > tmin && hi < tmax {
                return true;
            }
            if lo > tmax || hi < tmin {
                return false;
            }
        }
        is_hit_asked(ray, corners)
    }
}

#[cold]
#[inline(never)]
fn is_hit_asked(ray: Asked<'_>, corners: &[GzCoord; 3]) -> bool {
    is_hit(&ray.ray(), corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{BUNDLE, FilterSpace, RayBundle, Spans, TriGroup};
    use crate::simd::{Simd, SimdLevel, Task, dispatch};
    use crate::{ClassMask, PerRay, Targets, TriBuffer};
    use glam::DVec3;

    /// What rays hit in two groups, one after the other: a bundle of them, and its first ray by itself.
    struct Ask<'a>(&'a RayBatch<'a>, &'a TriBuffer, [TriId; 2]);

    impl Task for Ask<'_> {
        type Output = [TriId; 2];

        #[inline(always)]
        fn run<S: Simd>(self) -> [TriId; 2] {
            let Self(rays, tris, order) = self;
            let space = FilterSpace::new(tris.bounds().reaches());
            let targets = Targets::new(tris, ClassMask::ALL);
            let mut bundle = RayBundle::empty();
            let company = bundle.gather::<S>(rays, 0, rays.len(), &space);
            let spans = Spans::of::<S>(&bundle, &company);
            let mut alone = bundle.nearest(0, 0);
            for tri in order {
                let group = TriGroup::new(&[tri], tris.positions(), &space);
                bundle.closest::<S>(rays, &group, &company, &spans, &targets);
                if let Some(found) = group.candidates::<S>(&bundle.filter_ray(0, 0)) {
                    alone.take(Asked::new(rays, 0), 0.0, &found, 0, tri, tris.positions());
                }
            }
            let mut hits = [Hit::MISS; BUNDLE];
            bundle.hits::<S>(rays, tris.positions(), &mut hits);
            assert!(hits.iter().all(|hit| hit.tri == hits[0].tri), "all rays are alike");
            [hits[0].tri, alone.hit(&rays.ray(0), tris.positions()).tri]
        }
    }

    #[test]
    fn a_triangle_that_a_ray_leaves_is_left_alone_before_and_after_another_is_hit() {
        let square = |z: f32| [[-1.0, -1.0, z], [3.0, -1.0, z], [-1.0, 3.0, z]].map(GzCoord::from_array);
        let corners = [square(1.0), square(2.0)].concat();
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [3, 4, 5]]).unwrap();
        let rays = RayBatch::unbounded(BUNDLE, PerRay::One(DVec3::ZERO), PerRay::One(GzCoord::Z));
        // With a promise that is wrong it shows whether the triangle was tested.
        for (leaves, hit) in [(NO_TRI, 0), (0, 1), (1, 0)] {
            let leaves = [leaves; BUNDLE];
            let rays = rays.leaving(&leaves);
            for &level in SimdLevel::available() {
                for order in [[0, 1], [1, 0]] {
                    assert_eq!(dispatch(level, Ask(&rays, &tris, order)), [hit; 2], "{level:?} {order:?}, leaving {}", leaves[0]);
                }
            }
        }
    }
}
