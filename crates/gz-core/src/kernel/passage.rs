//! Hits on triangles that let rays through, as they are found: in any order, and more than once where a triangle is in several leaves.
// Axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::answer::EightPairs;
use super::bundle::{LANES, Rays};
use super::order::{closer, is_hit};
use crate::simd::Simd;
use crate::{ClassMask, GzCoord, GzRay, Hit, RayBatch, Targets, TriId};

/// What becomes of rays that hit something.
pub trait OnHit {
    /// Hears that the rays of packet `p` whose bits are set hit triangle `tri`, for the first time or again; returns those that end there.
    fn ends(&mut self, tri: TriId, p: usize, rays: u32, targets: &Targets<'_>) -> u32;

    /// The rays of a bundle, which begins with ray `from` of `rays`, have hit all that they do; `blocked` ones have ended.
    fn settle<S: Simd>(&mut self, rays: &RayBatch<'_>, from: usize, blocked: &Rays, positions: &[[GzCoord; 3]]);
}

/// Every hit ends a ray.
#[derive(Clone, Copy, Debug)]
pub struct Stopped;

impl OnHit for Stopped {
    #[inline(always)]
    fn ends(&mut self, _tri: TriId, _p: usize, rays: u32, _targets: &Targets<'_>) -> u32 {
        rays
    }

    #[inline(always)]
    fn settle<S: Simd>(&mut self, _rays: &RayBatch<'_>, _from: usize, _blocked: &Rays, _positions: &[[GzCoord; 3]]) {}
}

/// Rays of a bundle go through triangles of some classes, which are written down, and are stopped by others.
#[derive(Debug)]
pub struct GoingThrough<'m> {
    through: ClassMask,
    /// Places in the bundle, and triangles.
    pairs: Vec<(u32, TriId)>,
    /// What the rays of bundles before met, as [`crate::Passages`] has it.
    met: &'m mut Vec<(u32, Hit)>,
}

impl OnHit for GoingThrough<'_> {
    #[inline(always)]
    fn ends(&mut self, tri: TriId, p: usize, rays: u32, targets: &Targets<'_>) -> u32 {
        if !targets.is_of(tri, self.through) {
            return rays;
        }
        let mut rest = rays;
        while rest != 0 {
            self.pairs.push(((p * LANES) as u32 + rest.trailing_zeros(), tri));
            rest &= rest - 1;
        }
        0
    }

    #[inline(always)]
    fn settle<S: Simd>(&mut self, rays: &RayBatch<'_>, from: usize, blocked: &Rays, positions: &[[GzCoord; 3]]) {
        if self.pairs.is_empty() {
            return;
        }
        self.sort(blocked);
        let first = self.met.len();
        for pairs in self.pairs.chunks(8) {
            let mut hits = [Hit::MISS; 8];
            hits_of::<S>(rays, from, pairs, positions, &mut hits[..pairs.len()]);
            for k in 0..pairs.len() {
                self.met.push((from as u32 + pairs[k].0, hits[k]));
            }
        }
        self.pairs.clear();
        in_order(rays, positions, self.met, first);
    }
}

impl<'m> GoingThrough<'m> {
    /// Nothing met yet; what is goes to `met`.
    pub fn new(through: ClassMask, met: &'m mut Vec<(u32, Hit)>) -> Self {
        Self { through, pairs: Vec::new(), met }
    }

    #[inline(never)]
    fn sort(&mut self, blocked: &Rays) {
        self.pairs.retain(|&(place, _)| blocked[place as usize / LANES] >> (place as usize % LANES) & 1 == 0);
        self.pairs.sort_unstable_by_key(|&(place, tri)| u64::from(place) << 32 | u64::from(tri));
        self.pairs.dedup();
    }
}

/// The hits of up to eight rays on triangles that they are known to hit.
#[inline(always)]
fn hits_of<S: Simd>(rays: &RayBatch<'_>, from: usize, pairs: &[(u32, TriId)], positions: &[[GzCoord; 3]], hits: &mut [Hit]) {
    // Lanes without a pair do the work of the first.
    let (mut of, mut ids) = ([0; 8], [pairs[0].1; 8]);
    for k in 0..8 {
        let (place, tri) = pairs[if k < pairs.len() { k } else { 0 }];
        (of[k], ids[k]) = (from + place as usize, tri);
    }
    let (mut origins, mut directions, mut corners) = ([[0.0; 3]; 8], [[0.0; 3]; 8], [&positions[0]; 8]);
    for k in 0..8 {
        origins[k] = rays.origin.get(of[k]).to_array();
        directions[k] = rays.direction.get(of[k]).to_array();
        corners[k] = &positions[ids[k] as usize];
    }
    let wanted = 0xff >> (8 - pairs.len());
    EightPairs::<S>::of(&origins, &directions, corners).hits(wanted, &ids, |lane| rays.ray(of[lane]), hits);
}

/// Puts the hits from number `first` on, ray by ray, in the order in which they are met, and drops those that do not count.
fn in_order(rays: &RayBatch<'_>, positions: &[[GzCoord; 3]], met: &mut Vec<(u32, Hit)>, first: usize) {
    met[first..].sort_unstable_by(|(ray, hit), (other_ray, other)| ray.cmp(other_ray).then(hit.t.total_cmp(&other.t)));
    let (mut kept, mut next) = (first, first);
    while next < met.len() {
        let (number, Hit { t, .. }) = met[next];
        let alike = met[next..].iter().take_while(|(ray, hit)| *ray == number && hit.t == t).count();
        let ray = rays.ray(number as usize);
        // Behind the hit that counted last.
        let tmin = if kept > first && met[kept - 1].0 == number { met[kept - 1].1.t.next_up() } else { ray.tmin };
        if let Some(hit) = foremost(&GzRay { tmin, ..ray }, &met[next..next + alike], positions) {
            met[kept] = (number, hit);
            kept += 1;
        }
        next += alike;
    }
    met.truncate(kept);
}

/// Of hits whose T-values round alike the first that counts for `ray`.
fn foremost(ray: &GzRay, alike: &[(u32, Hit)], positions: &[[GzCoord; 3]]) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    for (_, hit) in alike {
        // A T-value that rounds to above tmin is above it.
        let counts = hit.t > ray.tmin || hit.t == ray.tmin && is_hit(ray, &positions[hit.tri as usize]);
        if counts && best.is_none_or(|best| closer(ray, Some(best.tri), hit.tri, positions).is_some()) {
            best = Some(*hit);
        }
    }
    best
}
