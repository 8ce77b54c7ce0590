//! The front-most hit of one ray, found mostly in f32.

use super::answer::t_u_v;
use super::group::Candidates;
use super::order::{closer, is_hit};
use crate::{GzCoord, GzRay, Hit, TriId};

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

    /// Takes triangle `tri`, lane `lane` of `candidates`, into account. Order of calls and repeated calls do not show in the result.
    #[inline(always)]
    pub fn take(&mut self, ray: &GzRay, candidates: &Candidates, lane: usize, tri: TriId, positions: &[[GzCoord; 3]]) {
        if tri == self.tri {
            return;
        }
        let (lo, hi) = (candidates.lo[lane], candidates.hi[lane]);
        if candidates.sure >> lane & 1 != 0 {
            if lo > self.hi || hi < ray.tmin {
                return;
            }
            if hi < self.lo && lo > ray.tmin {
                *self = Self { lo, hi, tri, found: true };
                return;
            }
        }
        self.settle(ray, tri, positions);
    }

    /// The same by f64 or exactly.
    #[cold]
    #[inline(never)]
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
    /// Whether the ray hits lane `lane`, a triangle with these corners.
    #[inline(always)]
    pub fn is_hit(&self, lane: usize, ray: &GzRay, corners: &[GzCoord; 3]) -> bool {
        let (lo, hi) = (self.lo[lane], self.hi[lane]);
        if self.sure >> lane & 1 != 0 {
            if lo > ray.tmin && hi < ray.tmax {
                return true;
            }
            if lo > ray.tmax || hi < ray.tmin {
                return false;
            }
        }
        is_hit(ray, corners)
    }
}
