//! A bundle's rays against a group's triangles: triangle by triangle for sixteen rays at a time, ray by ray where few are left.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::bundle::{LANES, PACKETS, RayBundle, Rays};
use super::filter::{Judged, distance, judge};
use super::group::{TriGroup, cross, dot, minus3};
use super::order::is_hit;
use crate::simd::{Lanes, Simd, arrays3, load3, splat3};
use crate::{GzCoord, GzRay, NO_TRI, RayBatch, Targets, TriId};

/// A packet with fewer rays left has them tested one by one.
const FEW: u32 = 4;

impl RayBundle {
    /// Takes the triangles of `group` into account for the rays of `active`, all fit.
    #[inline(always)]
    pub fn closest<S: Simd>(&mut self, rays: &RayBatch<'_>, group: &TriGroup, active: &Rays, targets: &Targets<'_>) {
        let mut together = *active;
        let mut many = 0;
        for p in 0..PACKETS {
            if active[p].count_ones() >= FEW {
                many |= active[p];
                continue;
            }
            together[p] = 0;
            let mut left = active[p];
            while left != 0 {
                self.closest_alone::<S>(rays, group, p, left.trailing_zeros() as usize, targets);
                left &= left - 1;
            }
        }
        if many == 0 {
            return;
        }
        let prepared = Prepared::of::<S>(group, self);
        for (k, &tri) in group.ids.iter().enumerate() {
            if tri == NO_TRI {
                break;
            }
            for p in 0..PACKETS {
                if together[p] == 0 {
                    continue;
                }
                let lines = self.lines::<S>(group, &prepared, k, p);
                let possible = lines.judged.possible() & together[p] & !<S::Sixteen>::same(&self.tris[p], tri);
                if possible == 0 || !targets.sees(tri) {
                    continue;
                }
                let (lo, hi, known) = self.distances::<S>(&prepared, k, p, lines.along);
                let tmin = <S::Sixteen>::load(&self.tmin[p]);
                let (near, limit) = (<S::Sixteen>::load(&self.near[p]), <S::Sixteen>::load(&self.limit[p]));
                let sure = lines.judged.sure() & known & possible;
                let better = sure & hi.below(near) & tmin.below(lo);
                let worse = sure & (limit.below(lo) | hi.below(tmin));
                if better != 0 {
                    lo.select(better, near).store(&mut self.near[p]);
                    hi.select(better, limit).store(&mut self.limit[p]);
                    <S::Sixteen>::set_some(tri, better, &mut self.tris[p]);
                    self.found[p] |= better;
                }
                let unsure = possible & !(better | worse);
                if unsure != 0 {
                    self.settle(rays, p, unsure, tri, targets.positions());
                }
            }
        }
    }

    /// Which rays of `active` hit a triangle of `group`.
    #[inline(always)]
    pub fn any<S: Simd>(&self, rays: &RayBatch<'_>, group: &TriGroup, active: &Rays, targets: &Targets<'_>) -> Rays {
        let mut open = *active;
        let mut together = [0; PACKETS];
        let mut many = 0;
        for p in 0..PACKETS {
            if active[p].count_ones() >= FEW {
                many |= active[p];
                together[p] = active[p];
                continue;
            }
            let mut left = active[p];
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                if self.any_alone::<S>(rays, group, p, lane, targets) {
                    open[p] &= !(1 << lane);
                }
            }
        }
        if many != 0 {
            let prepared = Prepared::of::<S>(group, self);
            for (k, &tri) in group.ids.iter().enumerate() {
                if tri == NO_TRI {
                    break;
                }
                for p in 0..PACKETS {
                    if together[p] == 0 {
                        continue;
                    }
                    let lines = self.lines::<S>(group, &prepared, k, p);
                    let possible = lines.judged.possible() & together[p] & !<S::Sixteen>::same(&self.tris[p], tri);
                    if possible == 0 || !targets.sees(tri) {
                        continue;
                    }
                    let (lo, hi, known) = self.distances::<S>(&prepared, k, p, lines.along);
                    let (tmin, limit) = (<S::Sixteen>::load(&self.tmin[p]), <S::Sixteen>::load(&self.limit[p]));
                    let sure = lines.judged.sure() & known & possible;
                    let hit = sure & hi.below(limit) & tmin.below(lo);
                    let missed = sure & (limit.below(lo) | hi.below(tmin));
                    let unsure = possible & !(hit | missed);
                    together[p] &= !hit;
                    if unsure != 0 {
                        together[p] &= !self.settle_any(rays, p, unsure, targets.position(tri));
                    }
                }
                if together == [0; PACKETS] {
                    break;
                }
            }
            for p in 0..PACKETS {
                if active[p].count_ones() >= FEW {
                    open[p] = together[p];
                }
            }
        }
        std::array::from_fn(|p| active[p] & !open[p])
    }

    /// One ray against the group's eight triangles.
    #[inline(always)]
    fn closest_alone<S: Simd>(&mut self, rays: &RayBatch<'_>, group: &TriGroup, p: usize, lane: usize, targets: &Targets<'_>) {
        let Some(found) = group.candidates::<S>(&self.filter_ray(p, lane)) else { return };
        let ray = rays.ray(self.place(p, lane));
        let mut best = self.nearest(p, lane);
        let mut possible = found.possible;
        while possible != 0 {
            let k = possible.trailing_zeros() as usize;
            possible &= possible - 1;
            let tri = group.ids[k];
            if tri == NO_TRI {
                break;
            }
            if targets.sees(tri) {
                best.take(&ray, &found, k, tri, targets.positions());
            }
        }
        self.set_nearest(p, lane, best);
    }

    #[inline(always)]
    fn any_alone<S: Simd>(&self, rays: &RayBatch<'_>, group: &TriGroup, p: usize, lane: usize, targets: &Targets<'_>) -> bool {
        let Some(found) = group.candidates::<S>(&self.filter_ray(p, lane)) else { return false };
        let ray = rays.ray(self.place(p, lane));
        let mut possible = found.possible;
        while possible != 0 {
            let k = possible.trailing_zeros() as usize;
            possible &= possible - 1;
            let tri = group.ids[k];
            if tri == NO_TRI {
                break;
            }
            if tri != self.tris[p][lane] && targets.sees(tri) && found.is_hit(k, &ray, targets.position(tri)) {
                return true;
            }
        }
        false
    }

    /// Volumes of the rays of packet `p` and triangle `k` of a group.
    #[inline(always)]
    fn lines<S: Simd>(&self, group: &TriGroup, prepared: &Prepared, k: usize, p: usize) -> Lines<S::Sixteen> {
        let d = self.packet_of::<S::Sixteen>(&self.direction, p);
        let mut v = dot(d, splat3(of_lane(&prepared.p, k)));
        let mut w = dot(d, splat3(of_lane(&prepared.q, k)));
        let along = dot(d, splat3(of_lane(&prepared.normal, k)));
        if !self.common_origin {
            let m = self.packet_of(&self.moment, p);
            v = v.plus(dot(m, splat3(of_lane(&group.e2, k))));
            w = w.minus(dot(m, splat3(of_lane(&group.e1, k))));
        }
        let u = along.minus(v).minus(w);
        Lines { judged: judge(u, v, w, <S::Sixteen>::splat(prepared.bound[k])), along }
    }

    /// Intervals of t where the lines meet the plane of triangle `k`, and where they can be trusted.
    #[inline(always)]
    fn distances<S: Simd>(&self, prepared: &Prepared, k: usize, p: usize, along: S::Sixteen) -> (S::Sixteen, S::Sixteen, u32) {
        let mut m = <S::Sixteen>::splat(prepared.depth[k]);
        if !self.common_origin {
            m = m.minus(dot(self.packet_of(&self.shift, p), splat3(of_lane(&prepared.normal, k))));
        }
        let (m_error, d_error) = (<S::Sixteen>::splat(prepared.depth_error[k]), <S::Sixteen>::splat(prepared.along_error[k]));
        distance(m, m_error, along, d_error)
    }

    #[cold]
    #[inline(never)]
    fn settle(&mut self, rays: &RayBatch<'_>, p: usize, unsure: u32, tri: TriId, positions: &[[GzCoord; 3]]) {
        for lane in (0..LANES).filter(|lane| unsure >> lane & 1 != 0) {
            let mut best = self.nearest(p, lane);
            best.settle(&rays.ray(self.place(p, lane)), tri, positions);
            self.set_nearest(p, lane, best);
        }
    }

    /// Which rays of `unsure` hit the triangle.
    #[cold]
    #[inline(never)]
    fn settle_any(&self, rays: &RayBatch<'_>, p: usize, unsure: u32, corners: &[GzCoord; 3]) -> u32 {
        let hits = |lane: &usize| unsure >> lane & 1 != 0 && is_hit(&self.ray(rays, p, *lane), corners);
        (0..LANES).filter(hits).fold(0, |hit, lane| hit | 1 << lane)
    }

    fn ray(&self, rays: &RayBatch<'_>, p: usize, lane: usize) -> GzRay {
        rays.ray(self.place(p, lane))
    }
}

#[inline(always)]
fn of_lane(rows: &[[f32; 8]; 3], k: usize) -> [f32; 3] {
    [rows[0][k], rows[1][k], rows[2][k]]
}

struct Lines<L> {
    judged: Judged<LANES, L>,
    along: L,
}

/// What a group's triangles have in common for all rays of a bundle: e2 x A, A x e1 and the normal for A seen from the centre.
struct Prepared {
    p: [[f32; 8]; 3],
    q: [[f32; 8]; 3],
    normal: [[f32; 8]; 3],
    /// A . normal.
    depth: [f32; 8],
    bound: [f32; 8],
    depth_error: [f32; 8],
    along_error: [f32; 8],
}

impl Prepared {
    #[inline(always)]
    fn of<S: Simd>(group: &TriGroup, bundle: &RayBundle) -> Self {
        let (e1, e2) = (load3::<8, S::Eight>(&group.e1), load3(&group.e2));
        let a: [S::Eight; 3] = minus3(load3(&group.a), splat3(bundle.centre));
        let (size, away) = (<S::Eight>::load(&group.size), a[0].abs().max(a[1].abs()).max(a[2].abs()));
        let normal = cross(e1, e2);
        Self {
            p: arrays3(cross(e2, a)),
            q: arrays3(cross(a, e1)),
            normal: arrays3(normal),
            depth: dot(a, normal).array(),
            bound: bundle.margin.volume(size, away).array(),
            depth_error: bundle.margin.depth(size, away).array(),
            along_error: bundle.margin.along(size).array(),
        }
    }
}
