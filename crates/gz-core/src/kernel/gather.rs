//! Rays of a batch become a bundle.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::bundle::RayBundle;
use super::filter::{GREATEST_DIRECTION, GREATEST_REACH, Margin};
use super::group::cross;
use super::packets::{Each, LANES, PACKETS, Rays, Row, eight, eight_mut, first, is_none, packet_of, span};
use super::space::FilterSpace;
use crate::simd::{Doubles, EightDoubles, Lanes, Simd, arrays3, coordinates, coordinates_f64, numbers_of_rays};
use crate::{Given, GzCoord, GzRay32, NO_TRI, PerRay, RayBatch};
use glam::DVec3;

/// Rays in the caller's memory are asked for so many ahead: a bundle and a half, and no whole number of 4 KiB, as the first-level cache has few
/// places for what lies those apart.
const AHEAD: usize = 96;

impl RayBundle {
    /// Takes rays `from..from + len` of a batch, 1 to [`super::BUNDLE`], and tells which of them the f32 kernels can take, for triangles in
    /// `space`.
    #[inline(always)]
    pub fn gather<S: Simd>(&mut self, rays: &RayBatch<'_>, from: usize, len: usize, space: &FilterSpace) -> Rays {
        self.from = from;
        self.scale = space.scale.to_array();
        self.found = [0; PACKETS];
        self.leaving = rays.leaves.is_some();
        self.origins_are_f32 = matches!(rays.given(), Given::Rays(_));
        let mut fit = [0; PACKETS];
        let packets = len.div_ceil(LANES);
        let mut tiny = 0;
        match rays.given() {
            Given::Properties { origin, direction, tmin, tmax } => {
                (self.common_origin, self.common_direction) = (origin.is_one(), direction.is_one());
                for p in 0..packets {
                    let (from, len) = (from + p * LANES, (len - p * LANES).min(LANES));
                    self.take_directions::<S>(p, direction, from, len);
                    self.take_origins::<S>(p, origin, from, len);
                    take(&mut self.tmin[p], tmin, from, len);
                    take(&mut self.limit[p], tmax, from, len);
                    let (whole, near_zero) = self.complete::<S>(p, rays, from, len, space);
                    fit[p] = whole;
                    tiny |= near_zero & whole;
                }
            }
            Given::Rays(all) => {
                for (p, of_packet) in all[from..from + len].chunks(LANES).enumerate() {
                    for ray in all.iter().skip(from + p * LANES + AHEAD).take(LANES).step_by(2) {
                        S::prefetch(ray);
                    }
                    self.take_rays::<S>(p, of_packet);
                    // All origins of f32 are valid, and are here what they are.
                    (fit[p], _) = self.complete::<S>(p, rays, from + p * LANES, of_packet.len(), space);
                }
                self.common_origin = are_alike::<S>(&self.origin, packets);
                self.common_direction = are_alike::<S>(&self.direction, packets);
            }
        }
        if tiny != 0 {
            drop_invalid(&mut fit, rays, from);
        }
        if !is_none(&fit) {
            self.settle_down::<S>(&fit, packets);
        }
        fit
    }

    /// What else there is of a packet, rays `from..from + len` of a batch, and [`Self::fit`] of those.
    #[inline(always)]
    fn complete<S: Simd>(&mut self, p: usize, rays: &RayBatch<'_>, from: usize, len: usize, space: &FilterSpace) -> (u32, u32) {
        self.near[p] = self.limit[p];
        self.tris[p] = [NO_TRI; LANES];
        if let Some(leaves) = rays.leaves {
            match leaves[from..from + len].first_chunk() {
                Some(all) => self.leaves[p] = *all,
                None => self.leaves[p][..len].copy_from_slice(&leaves[from..from + len]),
            }
        }
        let (fit, near_zero) = self.fit::<S::Sixteen>(p, space.reach);
        (fit & ((1u32 << len) - 1), near_zero)
    }

    #[inline(always)]
    fn take_rays<S: Simd>(&mut self, p: usize, rays: &[GzRay32]) {
        let rays = numbers_of_rays(rays);
        let [x, y, z, tmin, dx, dy, dz, tmax] = match rays.first_chunk() {
            Some(rays) => <S::Sixteen>::unzip8(rays),
            None => <S::Sixteen>::unzip8(&padded(rays)),
        };
        tmin.store(&mut self.tmin[p]);
        tmax.store(&mut self.limit[p]);
        let (o, d) = ([x, y, z], [dx, dy, dz]);
        for axis in 0..3 {
            let scale = <S::Sixteen>::splat(self.scale[axis]);
            o[axis].times(scale).store(&mut self.origin[axis][p]);
            d[axis].times(scale).store(&mut self.direction[axis][p]);
        }
    }

    #[inline(always)]
    fn take_directions<S: Simd>(&mut self, p: usize, given: &PerRay<'_, GzCoord>, from: usize, len: usize) {
        let scale = GzCoord::from_array(self.scale);
        match given {
            PerRay::One(d) => {
                for (axis, d) in (*d * scale).to_array().into_iter().enumerate() {
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
    fn take_origins<S: Simd>(&mut self, p: usize, given: &PerRay<'_, DVec3>, from: usize, len: usize) {
        match given {
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

    /// How far the origins of `fit` may be from the f32 ones: half a unit in the last place, and what the least numbers lose.
    #[inline(always)]
    fn lost<S: Simd>(&self, fit: &Rays, packets: usize) -> f32 {
        let mut reach = self.centre[0].abs().max(self.centre[1].abs()).max(self.centre[2].abs());
        if !self.common_origin {
            let mut far = <S::Sixteen>::splat(0.0);
            for p in 0..packets {
                let o = packet_of::<S::Sixteen>(&self.origin, p);
                far = far.max(o[0].abs().max(o[1].abs()).max(o[2].abs()).select(fit[p], far));
            }
            reach = far.greatest();
        }
        reach * f32::EPSILON + f32::MIN_POSITIVE
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
        let lost = if self.origins_are_f32 { 0.0 } else { self.lost::<S>(fit, packets) };
        self.alone = Margin::new(size, 0.0, lost);
        if self.common_origin {
            self.margin = self.alone;
            return;
        }
        for p in 0..packets {
            for axis in 0..3 {
                let shift = if S::CERTIFIED && !self.origins_are_f32 {
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
}

/// Whether all rays of some packets, and all of whatever fills the last, have the same three numbers.
#[inline(always)]
fn are_alike<S: Simd>(rows: &[Each; 3], packets: usize) -> bool {
    let first = [rows[0][0][0], rows[1][0][0], rows[2][0][0]];
    for p in 0..packets {
        for axis in 0..3 {
            let row = <S::Sixteen>::load(&rows[axis][p]);
            if row.same_bits(<S::Sixteen>::splat(first[axis])) != 0xffff {
                return false;
            }
        }
    }
    true
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
