//! A bundle's rays as the nodes see them.
//!
//! e = 2^-24. A cell's box is crossed between t = (p - o) / d for its planes p. It is computed in f32 as p r - (c -+ E) with r = 1 / d and
//! c = o r. Against the true t the product is off by at most 2 e |p/d| (r and the product), c by 3 e |o/d| (the origin, r and the product),
//! its sum with E by e (|o/d| + E) and the subtraction by e (|p/d| + |o/d| + E): in all by less than 5 e (|p| + |o|) / |d| + 3 e E. E is
//! 8 e (max |p| + |o|) / |d| along the axis, and a little for numbers below the normal range, so every entry is at most the true one and
//! every exit at least. A fused multiply-add only removes a rounding.

use super::wide::{Way, WideNode};
use gz_core::GzCoord;
use gz_core::kernel::{Each, LANES, PACKETS, RayBundle, Rays};
use gz_core::simd::{Lanes, Simd};

const E: f32 = f32::EPSILON / 2.0;
/// A direction component below 2^-40 of the largest counts as that. Within the scene |t| is at most twice the reach by the largest
/// component, so the ray then moves along the axis by at most 2^-39 of the reach, and a box widened by twice that is crossed at all such t.
const LEAST_COMPONENT: f32 = 1.0 / (1u64 << 40) as f32;
const STILL_PAD: f32 = 1.0 / (1u64 << 38) as f32;

/// Constants of the rays of a bundle, by axis. Made once and filled again and again.
#[repr(C, align(64))]
pub(super) struct BundleSlabs {
    pub(super) inverse: [Each; 3],
    pub(super) enter: [Each; 3],
    pub(super) leave: [Each; 3],
    /// Rays that go down along the axis.
    down: [Rays; 3],
}

const NOTHING: Each = [[0.0; LANES]; PACKETS];

impl BundleSlabs {
    pub(super) fn empty() -> Self {
        Self { inverse: [NOTHING; 3], enter: [NOTHING; 3], leave: [NOTHING; 3], down: [[0; PACKETS]; 3] }
    }

    /// Takes the rays of the first packets, fit for the f32 kernels, for boxes within `reach`.
    #[inline(always)]
    pub(super) fn gather<S: Simd>(&mut self, bundle: &RayBundle, packets: usize, reach: GzCoord) {
        for p in 0..packets {
            self.gather_packet::<S::Sixteen>(bundle, p, reach);
        }
    }

    #[inline(always)]
    fn gather_packet<L: Lanes<LANES>>(&mut self, bundle: &RayBundle, p: usize, reach: GzCoord) {
        let (d, o) = (&bundle.direction, &bundle.origin);
        let direction = [L::load(&d[0][p]), L::load(&d[1][p]), L::load(&d[2][p])];
        let origin = [L::load(&o[0][p]), L::load(&o[1][p]), L::load(&o[2][p])];
        let largest = direction[0].abs().max(direction[1].abs()).max(direction[2].abs());
        let least = largest.times(L::splat(LEAST_COMPONENT));
        for axis in 0..3 {
            let (mut d, o) = (direction[axis], origin[axis]);
            let scene = L::splat(reach[axis]);
            let mut pad = scene.plus(o.abs()).mul_add(L::splat(8.0 * E), L::splat(f32::MIN_POSITIVE));
            let still = d.abs().below(least);
            let down = d.below(L::splat(0.0));
            if still != 0 {
                let far = origin[0].abs().max(origin[1].abs()).max(origin[2].abs());
                let whole = far.plus(L::splat(reach.max_element()));
                pad = whole.mul_add(L::splat(STILL_PAD), pad).select(still, pad);
                d = L::splat(0.0).minus(least).select(down, least).select(still, d);
            }
            let known = p > 0 && bundle.common_direction;
            let inverse = if known { L::load(&self.inverse[axis][0]) } else { L::splat(1.0).over(d) };
            let (c, pad) = (o.times(inverse), pad.mul_add(inverse.abs(), L::splat(f32::MIN_POSITIVE)));
            inverse.store(&mut self.inverse[axis][p]);
            c.plus(pad).store(&mut self.enter[axis][p]);
            c.minus(pad).store(&mut self.leave[axis][p]);
            self.down[axis][p] = down;
        }
    }

    /// The rays of `among` that go the way of one ray along each axis.
    #[inline(always)]
    pub(super) fn company(&self, p: usize, lane: usize, among: &Rays) -> Rays {
        let mut company = *among;
        for down in &self.down {
            let flip = if down[p] >> lane & 1 != 0 { 0 } else { !0 };
            for (rays, down) in company.iter_mut().zip(down) {
                *rays &= down ^ flip;
            }
        }
        company
    }

    /// Which way a ray goes along each axis.
    #[inline(always)]
    pub(super) fn way(&self, p: usize, lane: usize) -> Way {
        let [x, y, z] = [self.down[0][p], self.down[1][p], self.down[2][p]];
        Way::new([x >> lane & 1 != 0, y >> lane & 1 != 0, z >> lane & 1 != 0])
    }

    /// One ray by itself.
    #[inline(always)]
    pub(super) fn alone(&self, p: usize, lane: usize, tmin: f32) -> Slabs {
        let (inverse, enter, leave) =
            (of_ray(&self.inverse, p, lane), of_ray(&self.enter, p, lane), of_ray(&self.leave, p, lane));
        Slabs { way: self.way(p, lane), inverse, enter, leave, tmin }
    }
}

#[inline(always)]
fn of_ray(rows: &[Each; 3], p: usize, lane: usize) -> [f32; 3] {
    [rows[0][p][lane], rows[1][p][lane], rows[2][p][lane]]
}

/// The same of one ray.
#[derive(Clone, Copy)]
pub(super) struct Slabs {
    way: Way,
    inverse: [f32; 3],
    enter: [f32; 3],
    leave: [f32; 3],
    tmin: f32,
}

impl Slabs {
    pub(super) const NONE: Self = Self { way: Way::UP, inverse: [0.0; 3], enter: [0.0; 3], leave: [0.0; 3], tmin: 0.0 };

    /// Entries of all cells, and a bit for each that is crossed before `limit`.
    #[inline(always)]
    pub(super) fn cross<L: Lanes<8>>(&self, node: &WideNode, limit: f32) -> (L, u32) {
        let (mut near, mut far) = (L::splat(self.tmin), L::splat(limit));
        for axis in 0..3 {
            let inverse = L::splat(self.inverse[axis]);
            let [first, last] = node.ends(&self.way, axis);
            near = near.max(L::load(first).mul_sub(inverse, L::splat(self.enter[axis])));
            far = far.min(L::load(last).mul_sub(inverse, L::splat(self.leave[axis])));
        }
        (near, near.at_most(far))
    }
}
