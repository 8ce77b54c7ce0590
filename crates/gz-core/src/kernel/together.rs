//! A bundle's rays against a group's triangles: triangle by triangle for sixteen rays at a time, ray by ray where few are left.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::bundle::RayBundle;
use super::filter::{Judged, distance, judge};
use super::group::{TriGroup, cross, dot, minus3};
use super::nearest::Asked;
use super::order::is_hit;
use super::packets::{LANES, PACKETS, Rays, is_none, packet_of};
use super::passage::OnHit;
use super::plain_f32::plain_distance;
use super::spans::{BOUND, Spans};
use crate::simd::{Lanes, Simd, arrays3, load3, splat3};
use crate::{GzCoord, GzRay, NO_TRI, RayBatch, Targets, TriId};

/// A packet with fewer rays left has them tested one by one.
const FEW: u32 = 4;

impl RayBundle {
    /// Takes the triangles of `group` into account for the rays of `active`, all fit and of those that `spans` is of.
    #[inline(always)]
    pub fn closest<S: Simd>(
        &mut self,
        rays: &RayBatch<'_>,
        group: &TriGroup,
        active: &Rays,
        spans: &Spans,
        targets: &Targets<'_>,
    ) {
        let prepared = Prepared::of::<S>(group, self, spans);
        let mut worth = prepared.worth;
        if worth == 0 {
            return;
        }
        let together = self.split(active, worth);
        for p in 0..PACKETS {
            let mut alone = active[p] & !together[p];
            while alone != 0 {
                self.closest_alone::<S>(rays, group, p, alone.trailing_zeros() as usize, targets);
                alone &= alone - 1;
            }
        }
        while worth != 0 {
            let k = worth.trailing_zeros() as usize & 7;
            worth &= worth - 1;
            let tri = group.ids[k];
            if !targets.sees(tri) {
                continue;
            }
            for p in 0..PACKETS {
                if together[p] == 0 {
                    continue;
                }
                let lines = self.lines::<S>(group, &prepared, k, p);
                let possible = lines.possible::<S>() & together[p] & !self.know::<S>(p, tri);
                if possible == 0 {
                    continue;
                }
                let (lo, hi, known) = self.distances::<S>(&prepared, k, p, lines.along);
                let tmin = <S::Sixteen>::load(&self.tmin[p]);
                let (near, limit) = (<S::Sixteen>::load(&self.near[p]), <S::Sixteen>::load(&self.limit[p]));
                let sure = lines.sure::<S>(known) & possible;
                let better = sure & hi.below(near) & tmin.below(lo);
                let worse = sure & (limit.below(lo) | hi.below(tmin));
                if better != 0 {
                    // For the answer, which is formed from the corners.
                    S::prefetch(targets.position(tri));
                    lo.select(better, near).store(&mut self.near[p]);
                    hi.select(better, limit).store(&mut self.limit[p]);
                    <S::Sixteen>::set_some(tri, better, &mut self.tris[p]);
                    self.found[p] |= better;
                }
                let unsure = possible & !(better | worse);
                if S::CERTIFIED && unsure != 0 {
                    self.settle(rays, p, unsure, tri, targets.positions());
                }
            }
        }
    }

    /// The rays of `active` that meet the triangles of a group one at a time with the others of their packet, when `worth` of them are left:
    /// a ray by itself meets all eight at once.
    #[inline(always)]
    fn split(&self, active: &Rays, worth: u32) -> Rays {
        let most = worth.count_ones();
        let mut together = *active;
        for rays in &mut together {
            if rays.count_ones() < most.min(FEW) {
                *rays = 0;
            }
        }
        together
    }

    /// Which rays of `active`, fit and of those that `spans` is of, end at a triangle of `group` that they hit.
    #[inline(always)]
    pub fn any<S: Simd>(
        &self,
        rays: &RayBatch<'_>,
        group: &TriGroup,
        active: &Rays,
        spans: &Spans,
        targets: &Targets<'_>,
        on_hit: &mut impl OnHit,
    ) -> Rays {
        let prepared = Prepared::of::<S>(group, self, spans);
        let mut worth = prepared.worth;
        let mut hits = [0; PACKETS];
        if worth == 0 {
            return hits;
        }
        let mut together = self.split(active, worth);
        for p in 0..PACKETS {
            let mut alone = active[p] & !together[p];
            while alone != 0 {
                let lane = alone.trailing_zeros() as usize;
                alone &= alone - 1;
                hits[p] |= u32::from(self.any_alone::<S>(rays, group, p, lane, targets, on_hit)) << lane;
            }
        }
        while worth != 0 {
            let k = worth.trailing_zeros() as usize & 7;
            worth &= worth - 1;
            let tri = group.ids[k];
            if !targets.sees(tri) {
                continue;
            }
            for p in 0..PACKETS {
                if together[p] == 0 {
                    continue;
                }
                let lines = self.lines::<S>(group, &prepared, k, p);
                let possible = lines.possible::<S>() & together[p] & !self.know::<S>(p, tri);
                if possible == 0 {
                    continue;
                }
                let (lo, hi, known) = self.distances::<S>(&prepared, k, p, lines.along);
                let (tmin, limit) = (<S::Sixteen>::load(&self.tmin[p]), <S::Sixteen>::load(&self.limit[p]));
                let sure = lines.sure::<S>(known) & possible;
                let mut hit = sure & hi.below(limit) & tmin.below(lo);
                let missed = sure & (limit.below(lo) | hi.below(tmin));
                let unsure = possible & !(hit | missed);
                if S::CERTIFIED && unsure != 0 {
                    hit |= self.settle_any(rays, p, unsure, targets.position(tri));
                }
                if hit == 0 {
                    continue;
                }
                hit = on_hit.ends(tri, p, hit, targets);
                together[p] &= !hit;
                hits[p] |= hit;
            }
            if is_none(&together) {
                break;
            }
        }
        hits
    }

    /// One ray against the group's eight triangles.
    #[inline(always)]
    fn closest_alone<S: Simd>(&mut self, rays: &RayBatch<'_>, group: &TriGroup, p: usize, lane: usize, targets: &Targets<'_>) {
        let Some(found) = group.candidates::<S>(&self.filter_ray(p, lane)) else { return };
        let (ray, tmin) = (Asked::new(rays, self.place(p, lane)), self.tmin[p][lane]);
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
                best.take(ray, tmin, &found, k, tri, targets.positions());
            }
        }
        self.set_nearest(p, lane, best);
    }

    #[inline(always)]
    fn any_alone<S: Simd>(
        &self,
        rays: &RayBatch<'_>,
        group: &TriGroup,
        p: usize,
        lane: usize,
        targets: &Targets<'_>,
        on_hit: &mut impl OnHit,
    ) -> bool {
        let Some(found) = group.candidates::<S>(&self.filter_ray(p, lane)) else { return false };
        let (ray, ends) = (Asked::new(rays, self.place(p, lane)), [self.tmin[p][lane], self.limit[p][lane]]);
        let mut possible = found.possible;
        while possible != 0 {
            let k = possible.trailing_zeros() as usize;
            possible &= possible - 1;
            let tri = group.ids[k];
            if tri == NO_TRI {
                break;
            }
            if tri != self.left_by(p, lane)
                && targets.sees(tri)
                && found.is_hit(k, ray, ends, targets.position(tri))
                && on_hit.ends(tri, p, 1 << lane, targets) != 0
            {
                return true;
            }
        }
        false
    }

    /// Volumes of the rays of packet `p` and triangle `k` of a group.
    #[inline(always)]
    fn lines<S: Simd>(&self, group: &TriGroup, prepared: &Prepared, k: usize, p: usize) -> Lines<S::Sixteen> {
        let [mut v, mut w, along] = if self.common_direction {
            splat3(of_lane(&prepared.of_direction, k))
        } else {
            let d = packet_of::<S::Sixteen>(&self.direction, p);
            let [v, w, along] = [&prepared.p, &prepared.q, &prepared.normal];
            [dot(d, splat3(of_lane(v, k))), dot(d, splat3(of_lane(w, k))), dot(d, splat3(of_lane(along, k)))]
        };
        if !self.common_origin {
            let m = packet_of(&self.moment, p);
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
            m = m.minus(dot(packet_of(&self.shift, p), splat3(of_lane(&prepared.normal, k))));
        }
        if !S::CERTIFIED {
            let t = plain_distance(m, along);
            return (t, t, !0);
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
pub(super) fn of_lane<T: Copy>(rows: &[[T; 8]; 3], k: usize) -> [T; 3] {
    [rows[0][k], rows[1][k], rows[2][k]]
}

struct Lines<L> {
    judged: Judged<LANES, L>,
    along: L,
}

impl<L: Lanes<LANES>> Lines<L> {
    #[inline(always)]
    fn possible<S: Simd>(&self) -> u32 {
        if S::CERTIFIED { self.judged.possible() } else { self.judged.plain() }
    }

    /// Of those that are possible, where `known` says that the distance can be trusted.
    #[inline(always)]
    fn sure<S: Simd>(&self, known: u32) -> u32 {
        if S::CERTIFIED { self.judged.sure() & known } else { !0 }
    }
}

/// What a group's triangles have in common for all rays of a bundle: e2 x A, A x e1 and the normal for A seen from the centre.
pub(super) struct Prepared {
    p: [[f32; 8]; 3],
    q: [[f32; 8]; 3],
    normal: [[f32; 8]; 3],
    /// Their products with the rays' direction, where they have one.
    of_direction: [[f32; 8]; 3],
    /// A . normal.
    depth: [f32; 8],
    bound: [f32; 8],
    depth_error: [f32; 8],
    along_error: [f32; 8],
    /// Triangles that not all rays of the set surely miss.
    pub(super) worth: u32,
}

impl Prepared {
    #[inline(always)]
    pub(super) fn of<S: Simd>(group: &TriGroup, bundle: &RayBundle, spans: &Spans) -> Self {
        let (e1, e2) = (load3::<8, S::Eight>(&group.e1), load3(&group.e2));
        let a: [S::Eight; 3] = minus3(load3(&group.a), splat3(bundle.centre));
        let (size, away) = (<S::Eight>::load(&group.size), a[0].abs().max(a[1].abs()).max(a[2].abs()));
        let (p, q, normal) = (cross(e2, a), cross(a, e1), cross(e1, e2));
        let bound = bundle.margin.volume(size, away);
        let (v, v_radius) = spans.interval(bundle, p, e2);
        let (w, w_radius) = spans.interval(bundle, q, minus3(splat3([0.0; 3]), e1));
        let (u, u_radius) = spans.interval(bundle, minus3(minus3(normal, p), q), minus3(e1, e2));
        let mut most = u.plus(u_radius).min(v.plus(v_radius)).min(w.plus(w_radius));
        let mut least = u.minus(u_radius).max(v.minus(v_radius)).max(w.minus(w_radius));
        if S::CERTIFIED {
            let bound_of_all = bound.times(<S::Eight>::splat(BOUND));
            (most, least) = (most.plus(bound_of_all), least.minus(bound_of_all));
        }
        let zero = <S::Eight>::splat(0.0);
        let mut of_direction = [[0.0; 8]; 3];
        if bundle.common_direction {
            let [x, y, z] = &bundle.direction;
            let d = splat3::<8, S::Eight>([x[0][0], y[0][0], z[0][0]]);
            of_direction = arrays3([dot(d, p), dot(d, q), dot(d, normal)]);
        }
        // NaN proves nothing.
        let missed = most.below(zero) & zero.below(least);
        Self {
            p: arrays3(p),
            q: arrays3(q),
            normal: arrays3(normal),
            of_direction,
            depth: dot(a, normal).array(),
            bound: bound.array(),
            depth_error: bundle.margin.depth(size, away).array(),
            along_error: bundle.margin.along(size).array(),
            worth: !(missed | <S::Eight>::same(&group.ids, NO_TRI)) & 0xff,
        }
    }
}
