//! Up to sixty-four rays that are asked together.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::filter::{FilterRay, GREATEST_DIRECTION, GREATEST_REACH, Margin};
use super::group::cross;
use super::nearest::Nearest;
use super::packets::{Each, LANES, PACKETS, Rays, Row, eight, eight_mut, first, is_none, packet_of, span};
use super::space::FilterSpace;
use crate::simd::{Doubles, EightDoubles, Lanes, Simd, arrays3, coordinates, coordinates_f64};
use crate::{GzCoord, NO_TRI, PerRay, RayBatch, TriId};

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
    /// Origins in stretched coordinates.
    exact_origin: [[[f64; LANES]; PACKETS]; 3],
    /// Triangles of the best hits; before there is one, any that the ray does not hit.
    pub(super) tris: [[TriId; LANES]; PACKETS],
    /// Triangles that the rays leave, where `leaving` says that they do.
    leaves: [[TriId; LANES]; PACKETS],
    leaving: bool,
    /// Rays that have a hit.
    pub(super) found: Rays,
    pub(super) centre: [f32; 3],
    pub(super) margin: Margin,
    /// For a ray by itself, from its own origin, rounded.
    alone: Margin,
    /// All origins are the centre.
    pub common_origin: bool,
    /// All directions are equal.
    pub common_direction: bool,
    /// The rays that the f32 kernels take, and the least and greatest of their directions.
    pub(super) fit: Rays,
    pub(super) span: [[f32; 3]; 2],
    pub(super) scale: [f32; 3],
    /// The first ray's number in its batch.
    from: usize,
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

    /// Takes rays `from..from + len` of a batch, 1 to [`super::BUNDLE`], and tells which of them the f32 kernels can take, for triangles in
    /// `space`.
    #[inline(always)]
    pub fn gather<S: Simd>(&mut self, rays: &RayBatch<'_>, from: usize, len: usize, space: &FilterSpace) -> Rays {
        self.from = from;
        self.scale = space.scale.to_array();
        self.found = [0; PACKETS];
        self.leaving = rays.leaves.is_some();
        self.common_origin = matches!(rays.origin, PerRay::One(_));
        self.common_direction = matches!(rays.direction, PerRay::One(_));
        let mut fit = [0; PACKETS];
        let packets = len.div_ceil(LANES);
        let mut tiny = 0;
        for (p, fit) in fit.iter_mut().enumerate().take(packets) {
            let (from, len) = (from + p * LANES, (len - p * LANES).min(LANES));
            self.take_directions::<S>(p, rays, from, len);
            self.take_origins::<S>(p, rays, from, len);
            take(&mut self.tmin[p], &rays.tmin, from, len);
            take(&mut self.limit[p], &rays.tmax, from, len);
            self.near[p] = self.limit[p];
            self.tris[p] = [NO_TRI; LANES];
            if let Some(leaves) = rays.leaves {
                match leaves[from..from + len].first_chunk() {
                    Some(all) => self.leaves[p] = *all,
                    None => self.leaves[p][..len].copy_from_slice(&leaves[from..from + len]),
                }
            }
            let (whole, near_zero) = self.fit::<S::Sixteen>(p, space.reach);
            *fit = whole & ((1u32 << len) - 1);
            tiny |= near_zero & *fit;
        }
        if tiny != 0 {
            drop_invalid(&mut fit, rays, from);
        }
        if !is_none(&fit) {
            self.settle_down::<S>(&fit, packets);
        }
        fit
    }

    #[inline(always)]
    fn take_directions<S: Simd>(&mut self, p: usize, rays: &RayBatch<'_>, from: usize, len: usize) {
        let scale = GzCoord::from_array(self.scale);
        match rays.direction {
            PerRay::One(d) => {
                for (axis, d) in (d * scale).to_array().into_iter().enumerate() {
                    self.direction[axis][p] = [d; LANES];
                }
            }
            PerRay::Each(all) => {
                let all = coordinates(&all[from..from + len]);
                let [x, y, z] = match all.first_chunk() {
                    Some(points) => <S::Sixteen>::unzip3(points),
                    None => <S::Sixteen>::unzip3(&padded(all)),
                };
                x.times(<S::Sixteen>::splat(scale.x)).store(&mut self.direction[0][p]);
                y.times(<S::Sixteen>::splat(scale.y)).store(&mut self.direction[1][p]);
                z.times(<S::Sixteen>::splat(scale.z)).store(&mut self.direction[2][p]);
            }
        }
    }

    #[inline(always)]
    fn take_origins<S: Simd>(&mut self, p: usize, rays: &RayBatch<'_>, from: usize, len: usize) {
        match rays.origin {
            PerRay::One(o) => {
                for (axis, o) in o.to_array().into_iter().enumerate() {
                    let o = o * f64::from(self.scale[axis]);
                    self.exact_origin[axis][p] = [o; LANES];
                    self.origin[axis][p] = [o as f32; LANES];
                }
            }
            PerRay::Each(all) => {
                let mut halves = [[<S::Eight>::splat(0.0); 2]; 3];
                for half in 0..2 {
                    let first = (half * 8).min(len - 1);
                    let eight = coordinates_f64(&all[from + first..from + len.min(first + 8)]);
                    let points = match eight.first_chunk() {
                        Some(points) => <S::Doubles>::unzip3(points),
                        None => <S::Doubles>::unzip3(&padded(eight)),
                    };
                    for axis in 0..3 {
                        let stretched = points[axis].times(<S::Doubles>::splat(f64::from(self.scale[axis])));
                        if S::CERTIFIED {
                            *eight_mut(&mut self.exact_origin[axis][p], half) = stretched.array();
                        }
                        halves[axis][half] = S::narrow(stretched);
                    }
                }
                // In one piece, as what is written in two stalls who reads it at once.
                for axis in 0..3 {
                    S::join(halves[axis][0], halves[axis][1]).store(&mut self.origin[axis][p]);
                }
            }
        }
    }

    /// Rays that are valid, but for origins near 0, and within the range of the bounds; and those with an origin so near 0 along an axis that
    /// f32 does not tell whether it is.
    #[inline(always)]
    fn fit<L: Lanes<LANES>>(&self, p: usize, reach: GzCoord) -> (u32, u32) {
        let ([x, y, z], [a, b, c]) = (abs3::<L>(packet_of(&self.origin, p)), abs3::<L>(packet_of(&self.direction, p)));
        let limit = L::splat(GREATEST_REACH - reach.max_element());
        // Sums, as a maximum may lose what is not a number.
        let fit = L::load(&self.tmin[p]).below(L::load(&self.limit[p]))
            & x.plus(y).plus(z).at_most(limit)
            & a.plus(b).plus(c).at_most(L::splat(GREATEST_DIRECTION))
            & L::splat(1.0 / GREATEST_DIRECTION).at_most(a.max(b).max(c));
        let greatest_scale = self.scale[0].max(self.scale[1]).max(self.scale[2]);
        (fit, x.min(y).min(z).below(L::splat(f32::MIN_POSITIVE * greatest_scale)))
    }

    /// Chooses the centre and forms what depends on it; only the rays of `fit` matter.
    #[inline(always)]
    fn settle_down<S: Simd>(&mut self, fit: &Rays, packets: usize) {
        let zero = <S::Sixteen>::splat(0.0);
        let mut spread = zero;
        // The greatest of each component rather than of their sums: that is what `spans.rs` needs.
        let [low, high] = span::<S>(&self.direction, self.common_direction, fit);
        (self.fit, self.span) = (*fit, [low, high]);
        let size = low[0].abs().max(high[0].abs()) + low[1].abs().max(high[1].abs()) + low[2].abs().max(high[2].abs());
        let size = size * (1.0 + 2.0 * f32::EPSILON);
        let (p, lane) = first(fit).unwrap_or_default();
        self.centre = [self.origin[0][p][lane], self.origin[1][p][lane], self.origin[2][p][lane]];
        let mut reach = self.centre[0].abs().max(self.centre[1].abs()).max(self.centre[2].abs());
        if !self.common_origin {
            let mut far = zero;
            for p in 0..packets {
                let o = packet_of::<S::Sixteen>(&self.origin, p);
                far = far.max(o[0].abs().max(o[1].abs()).max(o[2].abs()).select(fit[p], zero));
            }
            reach = far.greatest();
        }
        // Half a unit in the last place, and what the least numbers lose.
        let lost = reach * f32::EPSILON + f32::MIN_POSITIVE;
        self.alone = Margin::new(size, 0.0, lost);
        if self.common_origin {
            self.margin = self.alone;
            return;
        }
        for p in 0..packets {
            for axis in 0..3 {
                let shift = if S::CERTIFIED {
                    let centre = <S::Doubles>::splat(f64::from(self.centre[axis]));
                    let low = <S::Doubles>::load(eight(&self.exact_origin[axis][p], 0));
                    let high = <S::Doubles>::load(eight(&self.exact_origin[axis][p], 1));
                    S::join(S::narrow(low.minus(centre)), S::narrow(high.minus(centre)))
                } else {
                    <S::Sixteen>::load(&self.origin[axis][p]).minus(<S::Sixteen>::splat(self.centre[axis]))
                };
                shift.store(&mut self.shift[axis][p]);
                spread = spread.max(shift.abs().select(fit[p], zero));
            }
            let (d, s) = (packet_of::<S::Sixteen>(&self.direction, p), packet_of::<S::Sixteen>(&self.shift, p));
            let moment = arrays3(cross(d, s));
            for axis in 0..3 {
                self.moment[axis][p] = moment[axis];
            }
        }
        self.margin = Margin::new(size, spread.greatest(), 0.0);
    }

    /// Origins of eight rays in trace space.
    #[inline(always)]
    pub(super) fn exact_origins<S: Simd>(&self, p: usize, half: usize) -> [S::Doubles; 3] {
        let mut origin = [<S::Doubles>::splat(0.0); 3];
        for axis in 0..3 {
            let o = <S::Doubles>::load(eight(&self.exact_origin[axis][p], half));
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

/// Takes rays out of `fit` that are not valid after all.
#[cold]
#[inline(never)]
fn drop_invalid(fit: &mut Rays, rays: &RayBatch<'_>, from: usize) {
    for (p, fit) in fit.iter_mut().enumerate() {
        for lane in (0..LANES).filter(|lane| *fit >> lane & 1 != 0).collect::<Vec<_>>() {
            if !rays.ray(from + p * LANES + lane).is_valid() {
                *fit &= !(1 << lane);
            }
        }
    }
}

#[inline(always)]
fn abs3<L: Lanes<LANES>>([x, y, z]: [L; 3]) -> [L; 3] {
    [x.abs(), y.abs(), z.abs()]
}

#[inline(always)]
fn take(row: &mut Row, property: &PerRay<'_, f32>, from: usize, len: usize) {
    match property {
        PerRay::One(x) => *row = [*x; LANES],
        PerRay::Each(all) => match all[from..from + len].first_chunk() {
            Some(all) => *row = *all,
            None => row[..len].copy_from_slice(&all[from..from + len]),
        },
    }
}

/// The points, fewer than `N`, with the last one repeated.
#[cold]
#[inline(never)]
fn padded<T: Copy, const N: usize>(points: &[T]) -> [T; N] {
    std::array::from_fn(|k| points[k.min(points.len() - 1)])
}
