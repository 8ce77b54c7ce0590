//! Eight triangles side by side, for the leaves of a tree, and one ray against them.

use super::filter::{FilterRay, Judged, distance, judge};
use super::plain_f32::plain_distance;
use super::space::FilterSpace;
use crate::simd::{Lanes, Simd, load3, splat3};
use crate::{GzCoord, NO_TRI, TriId};

/// Up to eight triangles, number by number, 352 bytes.
///
/// Unused lanes repeat the first triangle and have the number [`NO_TRI`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct TriGroup {
    /// First corners: `a[axis][lane]`.
    pub(super) a: [[f32; 8]; 3],
    /// Edges from the first corner to the second, rounded.
    pub(super) e1: [[f32; 8]; 3],
    /// Edges from the first corner to the third.
    pub(super) e2: [[f32; 8]; 3],
    /// The greatest component of both edges.
    pub(super) size: [f32; 8],
    pub(super) ids: [TriId; 8],
}

impl TriGroup {
    /// Groups the triangles `ids`, 1 to 8 of them, of `positions`, in the coordinates of `space`; more are left out.
    ///
    /// # Panics
    ///
    /// If `ids` is empty or names a triangle that does not exist.
    pub fn new(ids: &[TriId], positions: &[[GzCoord; 3]], space: &FilterSpace) -> Self {
        let zero = [[0.0; 8]; 3];
        let mut group = Self { a: zero, e1: zero, e2: zero, size: [0.0; 8], ids: [NO_TRI; 8] };
        for lane in 0..8 {
            let [a, b, c] = positions[ids[if lane < ids.len() { lane } else { 0 }] as usize];
            let (a, e1, e2) = (a * space.scale, (b - a) * space.scale, (c - a) * space.scale);
            for axis in 0..3 {
                group.a[axis][lane] = a[axis];
                group.e1[axis][lane] = e1[axis];
                group.e2[axis][lane] = e2[axis];
            }
            group.size[lane] = e1.abs().max(e2.abs()).max_element();
            group.ids[lane] = ids.get(lane).copied().unwrap_or(NO_TRI);
        }
        group
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
    pub fn survivors<S: Simd>(&self, ray: &FilterRay) -> u32 {
        Lines::<S::Eight>::of(self, ray).judged.possible()
    }

    /// The triangles that the line of `ray` may meet, with where it meets them; `None` when there are none.
    #[inline(always)]
    pub fn candidates<S: Simd>(&self, ray: &FilterRay) -> Option<Candidates> {
        let lines = Lines::<S::Eight>::of(self, ray);
        if !S::CERTIFIED {
            return lines.plain(self);
        }
        match lines.judged.possible() {
            0 => None,
            possible => Some(lines.candidates(self, ray, possible)),
        }
    }

    /// The same without a branch, also where there are none.
    #[inline(always)]
    pub fn all_candidates<S: Simd>(&self, ray: &FilterRay) -> Candidates {
        let lines = Lines::<S::Eight>::of(self, ray);
        if !S::CERTIFIED {
            return lines.plain(self).unwrap_or(Candidates::NONE);
        }
        lines.candidates(self, ray, lines.judged.possible())
    }
}

/// What f32 knows of a ray and the triangles of a group that it may hit.
#[derive(Clone, Copy, Debug)]
pub struct Candidates {
    /// Lanes that are not excluded.
    pub possible: u32,
    /// Those of them that the ray's line surely meets, at t between `lo` and `hi`; an interval that is not finite means nothing.
    pub sure: u32,
    /// At most t.
    pub lo: [f32; 8],
    /// At least t.
    pub hi: [f32; 8],
}

impl Candidates {
    /// No triangle is possible.
    pub const NONE: Self = Self { possible: 0, sure: 0, lo: [0.0; 8], hi: [0.0; 8] };
}

/// One ray against eight triangles, by the scheme of Moller and Trumbore: P = d x e2 gives V = A.P and D = -e1.P, Q = A x e1 gives W = d.Q
/// and M = e2.Q, so the normal is not needed.
struct Lines<L> {
    judged: Judged<8, L>,
    q: [L; 3],
    along: L,
    away: L,
    size: L,
}

impl<L: Lanes<8>> Lines<L> {
    #[inline(always)]
    fn of(group: &TriGroup, ray: &FilterRay) -> Self {
        let d = splat3(ray.direction);
        let a = minus3(load3(&group.a), splat3(ray.origin));
        let e1 = load3(&group.e1);
        let p = cross(d, load3(&group.e2));
        let q = cross(a, e1);
        let v = dot(a, p);
        let w = dot(d, q);
        let along = L::splat(0.0).minus(dot(e1, p));
        let u = along.minus(v).minus(w);
        let (size, away) = (L::load(&group.size), a[0].abs().max(a[1].abs()).max(a[2].abs()));
        Self { judged: judge(u, v, w, ray.margin.volume(size, away)), q, along, away, size }
    }

    #[inline(always)]
    fn candidates(&self, group: &TriGroup, ray: &FilterRay, possible: u32) -> Candidates {
        let m = dot(load3(&group.e2), self.q);
        let (m_error, d_error) = (ray.margin.depth(self.size, self.away), ray.margin.along(self.size));
        let (lo, hi, known) = distance(m, m_error, self.along, d_error);
        Candidates { possible, sure: self.judged.sure() & known, lo: lo.array(), hi: hi.array() }
    }

    /// The triangles that plain f32 takes for hit, surely as it seems.
    #[inline(always)]
    fn plain(&self, group: &TriGroup) -> Option<Candidates> {
        let possible = self.judged.plain();
        if possible == 0 {
            return None;
        }
        let t = plain_distance(dot(load3(&group.e2), self.q), self.along).array();
        Some(Candidates { possible, sure: possible, lo: t, hi: t })
    }
}

#[inline(always)]
pub(super) fn cross<const N: usize, L: Lanes<N>>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    [a[1].mul_sub(b[2], a[2].times(b[1])), a[2].mul_sub(b[0], a[0].times(b[2])), a[0].mul_sub(b[1], a[1].times(b[0]))]
}

#[inline(always)]
pub(super) fn minus3<const N: usize, L: Lanes<N>>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    [a[0].minus(b[0]), a[1].minus(b[1]), a[2].minus(b[2])]
}

#[inline(always)]
pub(super) fn dot<const N: usize, L: Lanes<N>>(a: [L; 3], b: [L; 3]) -> L {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2].times(b[2])))
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
        fn run<S: Simd>(self) -> u32 {
            self.0.survivors::<S>(self.1)
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
            let space = FilterSpace::new(Bounds::of(positions.iter().flatten().copied()).reaches());
            let group = TriGroup::new(&[0, 1, 2, 3, 4, 5, 6, 7], &positions, &space);
            let target = positions[round % 8];
            // At a corner, at the middle of an edge, inside.
            let at = [target[0], (target[0] + target[1]) * 0.5, (target[0] + target[1] + target[2]) / 3.0][round % 3];
            let origin = point(1.0) - GzCoord::Z * 2.0;
            let ray = GzRay::new(origin, at - origin);
            let filter = FilterRay::new(&ray, &space).unwrap();
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
