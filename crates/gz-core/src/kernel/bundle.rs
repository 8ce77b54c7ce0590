//! Up to sixty-four rays that are asked together.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::filter::{FilterRay, Margin};
use super::nearest::Nearest;
use super::packets::{Each, LANES, PACKETS, Rays, eight};
use crate::simd::{Doubles, EightDoubles, Lanes, Simd};
use crate::{NO_TRI, TriId};

/// Up to sixty-four rays of a batch and the best hit of each so far. Made once and filled again and again.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct RayBundle {
    /// Origins in stretched coordinates, rounded.
    pub origin: [Each; 3],
    /// Directions in stretched coordinates.
    pub direction: [Each; 3],
    /// Lower ends of t.
    pub tmin: Each,
    /// At least the t of the best hit, tmax before there is one: a ray looks no further.
    pub limit: Each,
    /// At most the t of the best hit.
    pub(super) near: Each,
    /// The origin as seen from the centre, s, and d x s.
    pub(super) shift: [Each; 3],
    pub(super) moment: [Each; 3],
    /// Origins in stretched coordinates, unless `origin` has them exactly.
    pub(super) exact_origin: [[[f64; LANES]; PACKETS]; 3],
    pub(super) origins_are_f32: bool,
    /// Triangles of the best hits; before there is one, any that the ray does not hit.
    pub(super) tris: [[TriId; LANES]; PACKETS],
    /// Triangles that the rays leave, where `leaving` says that they do.
    pub(super) leaves: [[TriId; LANES]; PACKETS],
    pub(super) leaving: bool,
    /// Rays that have a hit.
    pub(super) found: Rays,
    pub(super) centre: [f32; 3],
    pub(super) margin: Margin,
    /// For a ray by itself, from its own origin, rounded.
    pub(super) alone: Margin,
    /// All origins are the centre.
    pub common_origin: bool,
    /// All directions are equal.
    pub common_direction: bool,
    /// The rays that the f32 kernels take, and the least and greatest of their directions.
    pub(super) fit: Rays,
    pub(super) span: [[f32; 3]; 2],
    pub(super) scale: [f32; 3],
    /// The first ray's number in its batch.
    pub(super) from: usize,
}

const NOTHING: Each = [[0.0; LANES]; PACKETS];

impl RayBundle {
    /// Without rays.
    pub fn empty() -> Self {
        Self {
            origin: [NOTHING; 3],
            direction: [NOTHING; 3],
            tmin: NOTHING,
            limit: NOTHING,
            near: NOTHING,
            shift: [NOTHING; 3],
            moment: [NOTHING; 3],
            exact_origin: [[[0.0; LANES]; PACKETS]; 3],
            origins_are_f32: false,
            tris: [[NO_TRI; LANES]; PACKETS],
            leaves: [[NO_TRI; LANES]; PACKETS],
            leaving: false,
            found: [0; PACKETS],
            centre: [0.0; 3],
            margin: Margin::default(),
            alone: Margin::default(),
            common_origin: false,
            common_direction: false,
            fit: [0; PACKETS],
            span: [[0.0; 3]; 2],
            scale: [1.0; 3],
            from: 0,
        }
    }

    /// Origins of eight rays in trace space.
    #[inline(always)]
    pub(super) fn exact_origins<S: Simd>(&self, p: usize, half: usize) -> [S::Doubles; 3] {
        let mut origin = [<S::Doubles>::splat(0.0); 3];
        for axis in 0..3 {
            let o = if self.origins_are_f32 {
                <S::Doubles>::widen(eight(&self.origin[axis][p], half))
            } else {
                <S::Doubles>::load(eight(&self.exact_origin[axis][p], half))
            };
            origin[axis] = o.times(<S::Doubles>::splat(1.0 / f64::from(self.scale[axis])));
        }
        origin
    }

    /// Directions of eight rays in trace space.
    #[inline(always)]
    pub(super) fn exact_directions<S: Simd>(&self, p: usize, half: usize) -> [S::Doubles; 3] {
        let mut direction = [<S::Doubles>::splat(0.0); 3];
        for axis in 0..3 {
            let d = <S::Doubles>::widen(eight(&self.direction[axis][p], half));
            direction[axis] = d.times(<S::Doubles>::splat(1.0 / f64::from(self.scale[axis])));
        }
        direction
    }

    /// Number of a ray in its batch.
    #[inline(always)]
    pub fn place(&self, p: usize, lane: usize) -> usize {
        self.from + p * LANES + lane
    }

    /// One ray by itself.
    #[inline(always)]
    pub fn filter_ray(&self, p: usize, lane: usize) -> FilterRay {
        let [o, d] = [&self.origin, &self.direction];
        FilterRay {
            origin: [o[0][p][lane], o[1][p][lane], o[2][p][lane]],
            direction: [d[0][p][lane], d[1][p][lane], d[2][p][lane]],
            margin: self.alone,
        }
    }

    /// The triangle that a ray leaves, or [`NO_TRI`].
    #[inline(always)]
    pub fn left_by(&self, p: usize, lane: usize) -> TriId {
        if self.leaving { self.leaves[p][lane] } else { NO_TRI }
    }

    /// The rays of a packet for which there is no need to ask about a triangle, as they leave it or as it is their best hit already.
    #[inline(always)]
    pub(super) fn know<S: Simd>(&self, p: usize, tri: TriId) -> u32 {
        let known = <S::Sixteen>::same(&self.tris[p], tri);
        if self.leaving { known | <S::Sixteen>::same(&self.leaves[p], tri) } else { known }
    }

    /// The best hit so far of one ray.
    #[inline(always)]
    pub fn nearest(&self, p: usize, lane: usize) -> Nearest {
        let found = self.found[p] >> lane & 1 != 0;
        Nearest { lo: self.near[p][lane], hi: self.limit[p][lane], tri: self.tris[p][lane], leaves: self.left_by(p, lane), found }
    }

    /// Takes over a better one.
    #[inline(always)]
    pub fn set_nearest(&mut self, p: usize, lane: usize, best: Nearest) {
        self.near[p][lane] = best.lo;
        self.limit[p][lane] = best.hi;
        self.tris[p][lane] = best.tri;
        self.found[p] |= u32::from(best.found) << lane;
    }
}
