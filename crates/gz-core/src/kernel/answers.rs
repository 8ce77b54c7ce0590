//! The answers of a bundle's rays, eight at a time.
//!
//! Where rays have one origin and few triangles, as those of a camera do, what the formulas of `solution.rs` take from origin and triangle is
//! formed once for each triangle, eight triangles side by side, and looked up by each ray: the same steps, so the same bits.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::answer::{EightPairs, corners_of, widen3, write_answers};
use super::bundle::RayBundle;
use super::packets::{LANES, PACKETS, count, eight, first, is_none};
use super::plain_f32::plain_hits;
use super::solution::Facing;
use crate::simd::{EightDoubles, Lanes, Simd};
use crate::{GzCoord, Hit, RayBatch, TriId};

/// So many triangles are looked for before it is asked whether the rays have few.
const SAMPLE: usize = 4;

/// The triangles that a bundle's rays hit, where they are few.
struct Few {
    /// Of those, in the order of the rays; unused places repeat the first.
    tris: [TriId; 8],
    /// The place of its triangle for each ray that has one.
    places: [[u32; LANES]; PACKETS],
}

impl RayBundle {
    /// The answers of the first `hits.len()` rays.
    #[inline(always)]
    pub fn hits<S: Simd>(&self, rays: &RayBatch<'_>, positions: &[[GzCoord; 3]], hits: &mut [Hit]) {
        let few = if S::CERTIFIED && self.common_origin { self.few::<S>() } else { None };
        match few {
            Some(few) => self.hits_of_few::<S>(&few, rays, positions, hits),
            None => self.hits_of_each::<S>(rays, positions, hits),
        }
    }

    /// The triangles, when there are at least one and at most eight.
    #[inline(always)]
    fn few<S: Simd>(&self) -> Option<Few> {
        let mut few = Few { tris: [0; 8], places: [[0; LANES]; PACKETS] };
        let mut left = self.found;
        for k in 0..8 {
            let Some((p, lane)) = first(&left) else { break };
            let tri = self.tris[p][lane];
            few.tris[k] = tri;
            for q in p..PACKETS {
                let same = <S::Sixteen>::same(&self.tris[q], tri) & left[q];
                <S::Sixteen>::set_some(k as u32, same, &mut few.places[q]);
                left[q] &= !same;
            }
            if k == 0 {
                few.tris = [tri; 8];
            }
            if k + 1 == SAMPLE && 2 * count(&left) > count(&self.found) {
                return None;
            }
        }
        (is_none(&left) && !is_none(&self.found)).then_some(few)
    }

    #[inline(always)]
    fn hits_of_few<S: Simd>(&self, few: &Few, rays: &RayBatch<'_>, positions: &[[GzCoord; 3]], hits: &mut [Hit]) {
        let [t0, t1, t2, t3, t4, t5, t6, t7] = few.tris;
        let [a, b, c] = corners_of::<S>(&[
            &positions[t0 as usize],
            &positions[t1 as usize],
            &positions[t2 as usize],
            &positions[t3 as usize],
            &positions[t4 as usize],
            &positions[t5 as usize],
            &positions[t6 as usize],
            &positions[t7 as usize],
        ]);
        let facing = Facing::of(self.exact_origins::<S>(0, 0), &[widen3::<S>(a), widen3::<S>(b), widen3::<S>(c)]);
        let table = Table::of(&facing);
        for (k, hits) in hits.chunks_mut(8).enumerate() {
            let (p, half) = (k / 2, k % 2);
            let found = self.found[p] >> (8 * half) & 0xff;
            if found == 0 {
                hits.fill(Hit::MISS);
                continue;
            }
            let facing = table.look_up::<S::Doubles>(eight(&few.places[p], half));
            let tris = eight(&self.tris[p], half);
            let solution = facing.quick(self.exact_directions::<S>(p, half));
            let pair = |lane| (rays.ray(self.place(p, 8 * half + lane)), &positions[tris[lane] as usize]);
            write_answers::<S>(&solution, found, tris, pair, hits);
        }
    }

    #[inline(always)]
    fn hits_of_each<S: Simd>(&self, rays: &RayBatch<'_>, positions: &[[GzCoord; 3]], hits: &mut [Hit]) {
        for (k, hits) in hits.chunks_mut(8).enumerate() {
            let (p, half) = (k / 2, k % 2);
            let found = self.found[p] >> (8 * half) & 0xff;
            if found == 0 {
                hits.fill(Hit::MISS);
                continue;
            }
            let tris = eight(&self.tris[p], half);
            let any = tris[found.trailing_zeros() as usize];
            let corners = std::array::from_fn(|lane| {
                let tri = if found >> lane & 1 != 0 { tris[lane] } else { any };
                &positions[tri as usize]
            });
            if !S::CERTIFIED {
                let [o, d] = [&self.origin, &self.direction];
                let origin = [eight(&o[0][p], half), eight(&o[1][p], half), eight(&o[2][p], half)];
                let direction = [eight(&d[0][p], half), eight(&d[1][p], half), eight(&d[2][p], half)];
                plain_hits::<S>(origin, direction, self.scale, &corners, found, tris, hits);
                continue;
            }
            let (origin, direction) = (self.exact_origins::<S>(p, half), self.exact_directions::<S>(p, half));
            let pairs = EightPairs::<S> { origin, direction, corners };
            pairs.hits(found, tris, |lane| rays.ray(self.place(p, 8 * half + lane)), hits);
        }
    }
}

/// Eight triangles' [`Facing`], number by number.
#[repr(C, align(64))]
struct Table([[f64; 8]; 12]);

impl Table {
    #[inline(always)]
    fn of<D: EightDoubles>(facing: &Facing<D>) -> Self {
        let Facing { p, q, normal: n, m, size, away } = facing;
        Self([
            p[0].array(),
            p[1].array(),
            p[2].array(),
            q[0].array(),
            q[1].array(),
            q[2].array(),
            n[0].array(),
            n[1].array(),
            n[2].array(),
            m.array(),
            size.array(),
            away.array(),
        ])
    }

    /// For each lane that of the triangle in one of the places.
    #[inline(always)]
    fn look_up<D: EightDoubles>(&self, places: &[u32; 8]) -> Facing<D> {
        let [px, py, pz, qx, qy, qz, nx, ny, nz, m, size, away] = &self.0;
        Facing {
            p: [D::pick(px, places), D::pick(py, places), D::pick(pz, places)],
            q: [D::pick(qx, places), D::pick(qy, places), D::pick(qz, places)],
            normal: [D::pick(nx, places), D::pick(ny, places), D::pick(nz, places)],
            m: D::pick(m, places),
            size: D::pick(size, places),
            away: D::pick(away, places),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BUNDLE, FilterSpace, Spans, TriGroup};
    use super::*;
    use crate::simd::{SimdLevel, Task, dispatch};
    use crate::{BruteForce, ClassMask, PerRay, RayQuery, Targets, TriBuffer};
    use glam::DVec3;

    /// The hits of a bundle, and whether its triangles were few.
    struct Ask<'a>(&'a RayBatch<'a>, &'a TriBuffer);

    impl Task for Ask<'_> {
        type Output = (Vec<Hit>, bool);

        #[inline(always)]
        fn run<S: Simd>(self) -> Self::Output {
            let Self(rays, tris) = self;
            let (space, targets) = (FilterSpace::new(tris.bounds().reaches()), Targets::new(tris, ClassMask::ALL));
            let mut bundle = RayBundle::empty();
            let company = bundle.gather::<S>(rays, 0, rays.len(), &space);
            let spans = Spans::of::<S>(&bundle, &company);
            let ids: Vec<TriId> = (0..tris.len() as u32).collect();
            for ids in ids.chunks(8) {
                let group = TriGroup::new(ids, tris.positions(), &space);
                bundle.closest::<S>(rays, &group, &company, &spans, &targets);
            }
            let mut hits = vec![Hit::MISS; rays.len()];
            bundle.hits::<S>(rays, tris.positions(), &mut hits);
            (hits, bundle.few::<S>().is_some())
        }
    }

    /// A fan of slices of a square, more or less tilted, before the eye.
    fn fan(slices: usize) -> TriBuffer {
        let corner = |k: usize| {
            let (along, tilt) = (2.0 * k as f32 / slices as f32 - 1.0, 0.1 * (k % 3) as f32);
            [GzCoord::new(along, -1.0, 3.0 + tilt), GzCoord::new(along, 1.0, 3.0 - tilt)]
        };
        let corners: Vec<_> = (0..=slices).flat_map(corner).collect();
        let faces: Vec<_> = (0..slices as u32).map(|k| [2 * k, 2 * k + 1, 2 * k + 3]).collect();
        TriBuffer::from_indexed(&corners, &faces).unwrap()
    }

    #[test]
    fn rays_from_one_origin_get_the_bits_of_one_ray_whether_their_triangles_are_few_or_not() {
        let (mut few, mut many) = (0, 0);
        for slices in 1..=12 {
            let tris = fan(slices);
            let brute = BruteForce::new(&tris);
            for len in [1, 7, 8, 9, 33, BUNDLE] {
                let at = |k: usize| GzCoord::new((k % 8) as f32 / 4.0 - 0.9, (k / 8) as f32 / 4.0 - 1.1, 3.0);
                let directions: Vec<_> = (0..len).map(at).collect();
                let origin = DVec3::new(0.01, -0.02, 1e-3 / 3.0);
                let rays = RayBatch::unbounded(len, PerRay::One(origin), PerRay::Each(&directions));
                let truth: Vec<_> = (0..len).map(|k| brute.closest_hit(&rays.ray(k))).collect();
                assert!(truth.iter().any(Hit::is_hit) || len < BUNDLE, "{slices} slices");
                for &level in SimdLevel::available() {
                    let (hits, are_few) = dispatch(level, Ask(&rays, &tris));
                    assert_eq!(hits, truth, "{level:?}, {slices} slices, {len} rays");
                    few += u32::from(are_few);
                    many += u32::from(!are_few);
                }
            }
        }
        assert!(few > 30 && many > 3, "{few} few, {many} not");
    }
}
