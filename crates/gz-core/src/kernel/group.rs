//! Eight triangles side by side, for the leaves of a tree.

use super::filter::{E, FLOOR, FilterRay};
use crate::simd::Lanes;
use crate::{GzCoord, NO_TRI, TriId};

/// Up to eight triangles, coordinate by coordinate, 320 bytes.
///
/// Unused lanes repeat the first triangle and have the number [`NO_TRI`].
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct TriGroup {
    /// `v[3 * corner + axis][lane]`.
    v: [[f32; 8]; 9],
    ids: [TriId; 8],
}

impl TriGroup {
    /// Groups the triangles `ids`, 1 to 8 of them, of `positions`; more are left out.
    ///
    /// # Panics
    ///
    /// If `ids` is empty or names a triangle that does not exist.
    pub fn new(ids: &[TriId], positions: &[[GzCoord; 3]]) -> Self {
        let corners = |lane: usize| &positions[ids[if lane < ids.len() { lane } else { 0 }] as usize];
        Self {
            v: std::array::from_fn(|k| std::array::from_fn(|lane| corners(lane)[k / 3].to_array()[k % 3])),
            ids: std::array::from_fn(|lane| ids.get(lane).copied().unwrap_or(NO_TRI)),
        }
    }

    /// The triangle of a lane, [`NO_TRI`] for an unused one.
    pub fn id(&self, lane: usize) -> TriId {
        self.ids[lane]
    }

    /// The triangles held.
    pub fn ids(&self) -> impl Iterator<Item = TriId> + '_ {
        self.ids.iter().copied().filter(|&id| id != NO_TRI)
    }

    /// Bit `i` is set unless the line of `ray` surely misses the triangle of lane `i`. Only the eight lowest bits are
    /// ever set; those of unused lanes mean nothing.
    ///
    /// The bound is derived in `filter.rs`.
    #[inline(always)]
    pub fn survivors<L: Lanes>(&self, ray: &FilterRay) -> u32 {
        let (x0, y0) = self.sheared::<L>(0, ray);
        let (x1, y1) = self.sheared::<L>(1, ray);
        let (x2, y2) = self.sheared::<L>(2, ray);
        // Both coordinates have the other sign, so products keep theirs.
        let u = x2.mul_sub(y1, y2.times(x1));
        let v = x0.mul_sub(y2, y0.times(x2));
        let w = x1.mul_sub(y0, y1.times(x0));
        let [dx, dy] = ray.delta;
        let mx = x0.abs().max(x1.abs()).max(x2.abs()).plus(L::splat(dx));
        let my = y0.abs().max(y1.abs()).max(y2.abs()).plus(L::splat(dy));
        let share = mx.mul_add(L::splat(5.0 * E), L::splat(2.1 * dx));
        let bound = my.mul_add(share, mx.mul_add(L::splat(2.1 * dy), L::splat(FLOOR)));
        let (least, most) = (u.min(v).min(w), u.max(v).max(w));
        let below = least.plus(bound).below(L::splat(0.0));
        let above = bound.below(most);
        !(below & above) & 0xff
    }

    /// S z - x and the same for y, for one corner of each triangle. Not a closure: those are not compiled for the caller's SIMD level.
    #[inline(always)]
    fn sheared<L: Lanes>(&self, corner: usize, ray: &FilterRay) -> (L, L) {
        let [kx, ky, kz] = ray.axes;
        let x = L::load(&self.v[3 * corner + kx]).minus(L::splat(ray.origin[0]));
        let y = L::load(&self.v[3 * corner + ky]).minus(L::splat(ray.origin[1]));
        let z = L::load(&self.v[3 * corner + kz]).minus(L::splat(ray.origin[2]));
        (L::splat(ray.slope[0]).mul_sub(z, x), L::splat(ray.slope[1]).mul_sub(z, y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::is_hit;
    use crate::simd::{SimdLevel, Task, dispatch};
    use crate::{Bounds, GzRay};

    struct Ask<'a>(&'a TriGroup, &'a FilterRay);

    impl Task for Ask<'_> {
        type Output = u32;

        #[inline(always)]
        fn run<L: Lanes>(self) -> u32 {
            self.0.survivors::<L>(self.1)
        }
    }

    #[test]
    fn no_triangle_that_is_hit_is_filtered_out_and_most_others_are() {
        let mut state = 9u64;
        let mut unit = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 24) as f32
        };
        let (mut hits, mut kept, mut asked) = (0, 0, 0);
        for round in 0..4000 {
            let offset = [0.0, 1.0, 30.0, 1e3][round % 4];
            let size = [1.0, 1e-2, 1e-4][round % 3];
            let mut point = |s: f32| GzCoord::new(unit(), unit(), unit()) * s + offset;
            let positions: Vec<[GzCoord; 3]> = (0..8)
                .map(|_| {
                    let p = point(1.0);
                    [p, p + (point(size) - offset), p + (point(size) - offset)]
                })
                .collect();
            let group = TriGroup::new(&[0, 1, 2, 3, 4, 5, 6, 7], &positions);
            let target = positions[round % 8];
            // At a corner, at the middle of an edge, inside.
            let at = [target[0], (target[0] + target[1]) * 0.5, (target[0] + target[1] + target[2]) / 3.0][round % 3];
            let origin = point(1.0) - GzCoord::Z * 2.0;
            let ray = GzRay::new(origin, at - origin);
            let filter = FilterRay::new(&ray, Bounds::of(positions.iter().flatten().copied()).reaches()).unwrap();
            for &level in SimdLevel::available() {
                let mask = dispatch(level, Ask(&group, &filter));
                for (lane, corners) in positions.iter().enumerate() {
                    let hit = is_hit(&ray, corners);
                    assert!(!hit || mask & (1 << lane) != 0, "{level:?} lane {lane} {ray:?} {corners:?}");
                    hits += u32::from(hit);
                    kept += mask >> lane & 1;
                    asked += 1;
                }
            }
        }
        assert!(hits > 2000 && kept < asked / 2, "{hits} hits, {kept} kept of {asked}");
    }
}
