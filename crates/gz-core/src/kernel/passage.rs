//! Hits on triangles that let rays through, as they are found: in any order, and more than once where a triangle is in several leaves.
// Axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::answer::EightPairs;
use super::order::{closer, is_hit};
use super::packets::{BUNDLE, LANES, Rays};
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
    /// Triangles, packets of the bundle, and which of their rays hit them.
    found: Vec<(TriId, usize, u32)>,
    /// Room for the same, by places in the bundle: the triangles of each, and each with its place.
    tris: Vec<TriId>,
    pairs: Vec<(u32, TriId)>,
    /// Of the pairs those of rays that have several, and their hits.
    several: Vec<(u32, TriId)>,
    hits: Vec<Hit>,
    /// What the rays of bundles before met, as [`crate::Passages`] has it.
    met: &'m mut Vec<(u32, TriId)>,
}

impl OnHit for GoingThrough<'_> {
    #[inline(always)]
    fn ends(&mut self, tri: TriId, p: usize, rays: u32, targets: &Targets<'_>) -> u32 {
        if !targets.is_of(tri, self.through) {
            return rays;
        }
        self.found.push((tri, p, rays));
        0
    }

    #[inline(always)]
    fn settle<S: Simd>(&mut self, rays: &RayBatch<'_>, from: usize, blocked: &Rays, positions: &[[GzCoord; 3]]) {
        if self.found.is_empty() {
            return;
        }
        self.sort(blocked);
        self.found.clear();
        let Self { pairs, several, hits, met, .. } = self;
        keep_several(pairs, several, hits);
        let mut first = 0;
        while first < several.len() {
            let end = several.len().min(first + 8);
            hits_of::<S>(rays, from, &several[first..end], positions, &mut hits[first..end]);
            first = end;
        }
        in_order(rays, from, positions, pairs, hits, met);
    }
}

/// Keeps the pairs of rays that have several, with room for their hits: a single one counts, wherever it lies.
#[inline(never)]
fn keep_several(pairs: &[(u32, TriId)], several: &mut Vec<(u32, TriId)>, hits: &mut Vec<Hit>) {
    several.clear();
    several.extend(of_each_ray(pairs).filter(|of_ray| of_ray.len() > 1).flatten());
    hits.clear();
    hits.resize(several.len(), Hit::MISS);
}

/// The pairs of each ray.
fn of_each_ray(pairs: &[(u32, TriId)]) -> impl Iterator<Item = &[(u32, TriId)]> {
    pairs.chunk_by(|(place, _), (other, _)| place == other)
}

impl<'m> GoingThrough<'m> {
    /// Nothing met yet; what is goes to `met`.
    pub fn new(through: ClassMask, met: &'m mut Vec<(u32, TriId)>) -> Self {
        Self { through, found: Vec::new(), tris: Vec::new(), pairs: Vec::new(), several: Vec::new(), hits: Vec::new(), met }
    }

    /// Makes pairs of what was found, in the order of their places, each once, without blocked rays. By counting: a ray has few.
    #[inline(never)]
    fn sort(&mut self, blocked: &Rays) {
        let Self { found, tris, pairs, .. } = self;
        let mut ends = [0; BUNDLE];
        for (_, p, rays) in &mut *found {
            *rays &= !blocked[*p];
            for_each(*rays, |lane| ends[*p * LANES + lane] += 1);
        }
        let mut end = 0;
        for count in &mut ends {
            end += std::mem::replace(count, end);
        }
        tris.clear();
        tris.resize(end, 0);
        for &(tri, p, rays) in &*found {
            for_each(rays, |lane| {
                let next = &mut ends[p * LANES + lane];
                tris[*next] = tri;
                *next += 1;
            });
        }
        pairs.clear();
        let mut first = 0;
        for (place, &end) in ends.iter().enumerate() {
            let of_ray = &mut tris[first..end];
            of_ray.sort_unstable();
            pairs.extend(of_ray.chunk_by(|tri, other| tri == other).map(|alike| (place as u32, alike[0])));
            first = end;
        }
    }
}

/// Calls `act` with each lane whose bit is set.
#[inline(always)]
fn for_each(mut bits: u32, mut act: impl FnMut(usize)) {
    while bits != 0 {
        act(bits.trailing_zeros() as usize);
        bits &= bits - 1;
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
        let ray = rays.ray(of[k]);
        (origins[k], directions[k]) = (ray.origin.to_array(), ray.direction.to_array());
        corners[k] = &positions[ids[k] as usize];
    }
    let wanted = 0xff >> (8 - pairs.len());
    EightPairs::<S>::of(&origins, &directions, corners).hits(wanted, &ids, |lane| rays.ray(of[lane]), hits);
}

/// Adds to `met` what each ray of `pairs` meets in the order in which it does, without what does not count; `hits` are those of rays that have
/// several.
fn in_order(
    rays: &RayBatch<'_>,
    from: usize,
    positions: &[[GzCoord; 3]],
    pairs: &[(u32, TriId)],
    mut hits: &mut [Hit],
    met: &mut Vec<(u32, TriId)>,
) {
    for of_ray in of_each_ray(pairs) {
        let number = from as u32 + of_ray[0].0;
        if let [(_, tri)] = of_ray {
            met.push((number, *tri));
            continue;
        }
        let (own, others) = hits.split_at_mut(of_ray.len());
        hits = others;
        own.sort_unstable_by(|hit, other| hit.t.total_cmp(&other.t));
        // Behind the hit that counted last.
        let mut tmin = rays.ray(number as usize).tmin;
        for alike in own.chunk_by(|hit, other| hit.t == other.t) {
            // Most are by themselves, and surely there: a T-value that rounds to above tmin is above it.
            let counts = match alike {
                [hit] if hit.t > tmin => Some(*hit),
                _ => foremost(&GzRay { tmin, ..rays.ray(number as usize) }, alike, positions),
            };
            if let Some(hit) = counts {
                met.push((number, hit.tri));
                tmin = hit.t.next_up();
            }
        }
    }
}

/// Of hits whose T-values round alike the first that counts for `ray`.
fn foremost(ray: &GzRay, alike: &[Hit], positions: &[[GzCoord; 3]]) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    for hit in alike {
        let counts = hit.t > ray.tmin || hit.t == ray.tmin && is_hit(ray, &positions[hit.tri as usize]);
        let about = [hit.t.next_down(), hit.t.next_up()];
        if counts && best.is_none_or(|best| closer(ray, Some((best.tri, about)), hit.tri, positions).is_some()) {
            best = Some(*hit);
        }
    }
    best
}
