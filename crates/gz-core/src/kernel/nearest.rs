//! The front-most hit of one ray, found mostly in f32.

use super::answer::t_u_v;
use super::group::Candidates;
use super::order::{closer, is_hit};
use crate::{GzCoord, GzRay, Hit, RayBatch, TriId};

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
    /// The triangle of the best hit; before there is one, the triangle that the ray leaves.
    pub(super) tri: TriId,
    pub(super) found: bool,
}

impl Nearest {
    /// Before anything is tested. `leaves` is a triangle that the ray is known not to hit, or [`crate::NO_TRI`].
    pub fn before(ray: &GzRay, leaves: TriId) -> Self {
        Self { lo: ray.tmax, hi: ray.tmax, tri: leaves, found: false }
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
        if tri == self.tri {
            return;
        }
        let (lo, hi) = (candidates.lo[lane], candidates.hi[lane]);
        if candidates.sure >> lane & 1 != 0 {
            if lo > self.hi || hi < tmin {
                return;
            }
            if hi < self.lo && lo > tmin {
                *self = Self { lo, hi, tri, found: true };
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
        if let Some((lo, hi)) = closer(ray, self.found.then_some(self.tri), tri, positions) {
            *self = Self { lo, hi, tri, found: true };
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
