//! Rays that some triangles let through: what they meet on their way, and whether something stops them.

use crate::{ClassMask, Given, GzCoord, GzRay, Hit, PerRay, RayBatch, RayQuery, TriId};
use glam::DVec3;

/// The answer to [`RayQuery::passages`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Passages {
    /// Whether each ray hits a triangle that does not let it through.
    pub blocked: Vec<bool>,
    /// What the other rays meet among the triangles that do: the ray's number and the triangle, ray by ray, each ray's in the order in which
    /// it meets them.
    ///
    /// The first is that of its front-most hit, the next is the front-most beyond the least f32 above the T-value of the one before, and so on. Of
    /// several within one step of f32, such as two walls that coincide or the two triangles of an edge that is hit, the first counts for all.
    pub met: Vec<(u32, TriId)>,
}

impl Passages {
    /// Finds the passages of `rays` by the other questions of `query`: the specification of [`RayQuery::passages`].
    ///
    /// First whether there is anything in the way at all, as most rays meet nothing; where there is, whether it stops the ray; and then hit
    /// by hit.
    pub fn ask(&mut self, query: &(impl RayQuery + ?Sized), rays: &RayBatch<'_>, through: ClassMask) {
        let any = |rays: &RayBatch<'_>, classes, occluded: &mut [bool]| query.any_hits(rays, classes, occluded);
        self.ask_by(any, |rays, classes, hits| query.closest_hits(rays, classes, hits), rays, through);
    }

    /// The same by any two functions with the contracts of [`RayQuery::any_hits`] and [`RayQuery::closest_hits`].
    pub fn ask_by(
        &mut self,
        any_hits: impl Fn(&RayBatch<'_>, ClassMask, &mut [bool]),
        closest_hits: impl Fn(&RayBatch<'_>, ClassMask, &mut [Hit]),
        rays: &RayBatch<'_>,
        through: ClassMask,
    ) {
        let Self { blocked, met } = self;
        met.clear();
        blocked.clear();
        blocked.resize(rays.len(), false);
        any_hits(rays, ClassMask::ALL, blocked);

        let mut part = Part::default();
        (0..rays.len()).filter(|&i| blocked[i]).for_each(|i| part.push(i, rays));
        if part.numbers.is_empty() {
            return;
        }
        let mut stopped = vec![false; part.numbers.len()];
        any_hits(&part.batch(rays), through.others(), &mut stopped);
        for (&i, &stopped) in part.numbers.iter().zip(&stopped) {
            blocked[i as usize] = stopped;
        }
        part.keep(|k| !stopped[k]);

        let mut hits = Vec::new();
        while !part.numbers.is_empty() {
            hits.clear();
            hits.resize(part.numbers.len(), Hit::MISS);
            closest_hits(&part.batch(rays), through, &mut hits);
            // Rays that met something are asked about again behind it. The exact t rounds to hit.t, so it lies below the next f32: the
            // triangle is not met twice.
            for (k, hit) in hits.iter().enumerate().filter(|(_, hit)| hit.is_hit()) {
                met.push((part.numbers[k], hit.tri));
                part.tmin[k] = hit.t.next_up();
            }
            part.keep(|k| hits[k].is_hit());
        }
        met.sort_by_key(|&(ray, _)| ray);
    }

    /// What ray `ray` meets, if it is not blocked.
    pub fn of(&self, ray: u32) -> &[(u32, TriId)] {
        let first = self.met.partition_point(|&(other, _)| other < ray);
        let count = self.met[first..].partition_point(|&(other, _)| other == ray);
        &self.met[first..first + count]
    }
}

/// Some rays of a batch.
#[derive(Default)]
struct Part {
    numbers: Vec<u32>,
    origins: Vec<DVec3>,
    directions: Vec<GzCoord>,
    tmin: Vec<f32>,
    tmax: Vec<f32>,
    leaves: Vec<TriId>,
}

impl Part {
    fn push(&mut self, i: usize, rays: &RayBatch<'_>) {
        let GzRay { origin, direction, tmin, tmax } = rays.ray(i);
        self.numbers.push(i as u32);
        self.origins.push(origin);
        self.directions.push(direction);
        self.tmin.push(tmin);
        self.tmax.push(tmax);
        self.leaves.push(rays.left_by(i));
    }

    /// Forgets the rays, by their places here, of which `stays` says no.
    fn keep(&mut self, stays: impl Fn(usize) -> bool) {
        let mut kept = 0;
        for k in (0..self.numbers.len()).filter(|&k| stays(k)) {
            self.numbers[kept] = self.numbers[k];
            self.origins[kept] = self.origins[k];
            self.directions[kept] = self.directions[k];
            self.tmin[kept] = self.tmin[k];
            self.tmax[kept] = self.tmax[k];
            self.leaves[kept] = self.leaves[k];
            kept += 1;
        }
        self.numbers.truncate(kept);
        self.origins.truncate(kept);
        self.directions.truncate(kept);
        self.tmin.truncate(kept);
        self.tmax.truncate(kept);
        self.leaves.truncate(kept);
    }

    /// What all rays of `rays` have in common these have too.
    fn batch<'a>(&'a self, rays: &RayBatch<'a>) -> RayBatch<'a> {
        let (mut origin, mut direction) = (PerRay::Each(&self.origins[..]), PerRay::Each(&self.directions[..]));
        let mut tmax = PerRay::Each(&self.tmax[..]);
        if let Given::Properties { origin: all, direction: along, tmax: ends, .. } = *rays.given() {
            (origin, direction, tmax) = (all.or(origin), along.or(direction), ends.or(tmax));
        }
        let batch = RayBatch::new(self.numbers.len(), origin, direction, PerRay::Each(&self.tmin), tmax);
        if rays.leaves.is_some() { batch.leaving(&self.leaves) } else { batch }
    }
}
