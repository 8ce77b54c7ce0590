//! A ray query that keeps what it is asked.

use super::rays::{Asked, Values};
use gz_core::{ClassMask, Hit, RayBatch, RayQuery, TriBuffer};
use std::sync::{Mutex, PoisonError};

/// Passes every question on to another query and keeps a copy of it.
pub struct Recorder<'q> {
    inner: &'q dyn RayQuery,
    asked: Mutex<Vec<Asked>>,
}

impl<'q> Recorder<'q> {
    /// One that asks `inner`.
    pub fn of(inner: &'q dyn RayQuery) -> Self {
        Self { inner, asked: Mutex::new(Vec::new()) }
    }

    /// What was asked so far, in order.
    pub fn taken(self) -> Vec<Asked> {
        self.asked.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    fn keep(&self, rays: &RayBatch<'_>, classes: ClassMask, any: bool) {
        if rays.is_empty() {
            return;
        }
        let asked = Asked {
            len: rays.len(),
            origin: Values::of(&rays.origin),
            direction: Values::of(&rays.direction),
            tmin: Values::of(&rays.tmin),
            tmax: Values::of(&rays.tmax),
            classes,
            any,
            leaves: rays.leaves.map(<[_]>::to_vec).unwrap_or_default(),
        };
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).push(asked);
    }
}

impl RayQuery for Recorder<'_> {
    fn tris(&self) -> &TriBuffer {
        self.inner.tris()
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        self.keep(rays, classes, false);
        self.inner.closest_hits(rays, classes, hits);
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        self.keep(rays, classes, true);
        self.inner.any_hits(rays, classes, occluded);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::{BruteForce, GzCoord, GzRay};

    #[test]
    fn questions_are_kept_and_answered() {
        let corners = [[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [0.0, 4.0, 5.0]].map(GzCoord::from_array);
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2]]).unwrap();
        let brute = BruteForce::new(&tris);
        let recorder = Recorder::of(&brute);
        let ray = GzRay::new(GzCoord::new(1.0, 1.0, 0.0), GzCoord::Z);
        assert_eq!(recorder.closest_hit(&ray), brute.closest_hit(&ray));
        assert!(recorder.any_hit(&ray));
        let taken = recorder.taken();
        assert_eq!(taken.iter().map(|asked| (asked.any, asked.batch().ray(0))).collect::<Vec<_>>(), [(false, ray), (true, ray)]);
    }
}
