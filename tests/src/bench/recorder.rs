//! A ray query that keeps what it is asked.

use super::rays::{Asked, Values};
use gz_core::{ClassMask, Given, Hit, RayBatch, RayQuery, TriBuffer};
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
        let (origin, direction, tmin, tmax) = match rays.given() {
            Given::Properties { origin, direction, tmin, tmax } => {
                (Values::of(origin), Values::of(direction), Values::of(tmin), Values::of(tmax))
            }
            Given::Rays(rays) => (
                Values::each(rays, |ray| ray.origin),
                Values::each(rays, |ray| ray.direction),
                Values::each(rays, |ray| ray.tmin),
                Values::each(rays, |ray| ray.tmax),
            ),
        };
        let asked = Asked {
            len: rays.len(),
            origin,
            direction,
            tmin,
            tmax,
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
    use gz_core::{BruteForce, GzCoord, GzRay, GzRay32};

    #[test]
    fn questions_are_kept_and_answered() {
        let corners = [[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [0.0, 4.0, 5.0]].map(GzCoord::from_array);
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2]]).unwrap();
        let brute = BruteForce::new(&tris);
        let recorder = Recorder::of(&brute);
        let ray = GzRay::new(GzCoord::new(1.0, 1.0, 0.0), GzCoord::Z);
        assert_eq!(recorder.closest_hit(&ray), brute.closest_hit(&ray));
        assert!(recorder.any_hit(&ray));
        let in_memory = [GzRay32 { origin: ray.origin.as_vec3(), tmin: 0.5, direction: ray.direction, tmax: 7.0 }];
        let mut hits = [Hit::MISS];
        recorder.closest_hits(&RayBatch::of_rays(&in_memory), ClassMask::ALL, &mut hits);
        assert_eq!(hits[0], brute.closest_hit(&ray));
        let taken = recorder.taken();
        let expected = [(false, ray), (true, ray), (false, in_memory[0].into())];
        assert_eq!(taken.iter().map(|asked| (asked.any, asked.batch().ray(0))).collect::<Vec<_>>(), expected);
    }
}
