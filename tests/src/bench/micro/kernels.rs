//! Kernels: groups of triangles with rays towards each, and pairs that meet.

use super::Row;
use crate::bench::timing::take_turns;
use gz_app::error::AppError;
use gz_bsp::BspTree;
use gz_core::glam::DVec3;
use gz_core::kernel::{BUNDLE, Closest, FilterRay, FilterSpace, RayBundle, TriGroup, hit_weights, is_hit, plain};
use gz_core::simd::{Simd, Task, dispatch};
use gz_core::{ClassMask, GzCoord, GzRay, Hit, Kernel, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer, TriId};
use std::hint::black_box;

/// Groups of eight triangles that the kernels are given, evenly spaced over the scene.
const GROUPS: usize = 128;
/// Pairs of a ray and a triangle that it hits.
const PAIRS: usize = 4096;
/// The eye, in sizes of a group.
const AWAY: f32 = 3.0;

/// Groups of triangles with a bundle of rays towards each, and pairs that meet.
pub(super) struct Kernels<'t> {
    tris: &'t TriBuffer,
    space: FilterSpace,
    groups: Vec<TriGroup>,
    /// Where the rays of each group start.
    eyes: Vec<DVec3>,
    /// 64 directions for each group.
    directions: Vec<Vec<GzCoord>>,
    /// The same rays for the kernel of one ray and eight triangles.
    filters: Vec<Vec<FilterRay>>,
    pairs: Vec<(GzRay, TriId)>,
}

impl<'t> Kernels<'t> {
    pub(super) fn of(tris: &'t TriBuffer) -> Self {
        let space = FilterSpace::new(tris.bounds().reaches());
        let mut this = Self {
            tris,
            space,
            groups: Vec::new(),
            eyes: Vec::new(),
            directions: Vec::new(),
            filters: Vec::new(),
            pairs: Vec::new(),
        };
        let ids: Vec<TriId> = (0..tris.len() as TriId).collect();
        let eights = ids.len().div_ceil(8);
        for eight in ids.chunks(8).step_by(eights.div_ceil(GROUPS).max(1)) {
            this.add(eight);
        }
        this
    }

    /// A group with 64 rays from in front of it to points of its triangles, and beside them.
    fn add(&mut self, ids: &[TriId]) {
        let corners: Vec<GzCoord> = ids.iter().flat_map(|&tri| *self.tris.position(tri)).collect();
        let low = corners.iter().copied().fold(GzCoord::INFINITY, GzCoord::min);
        let high = corners.iter().copied().fold(GzCoord::NEG_INFINITY, GzCoord::max);
        let size = (high - low).length();
        let eye = (low + high) * 0.5 + GzCoord::new(0.4, 0.7, 0.6) * (AWAY * size);
        let towards = |k: usize| {
            let [a, b, c] = *self.tris.position(ids[k % ids.len()]);
            // Weights from the bits of k: seven rays in eight inside of the triangle, the others a little beside it.
            let (u, v) = ((k * 37 % 64) as f32 / 64.0, (k * 23 % 64) as f32 / 64.0);
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let beside = if k % 8 == 7 { 1.5 } else { 1.0 };
            a + (b - a) * (u * beside) + (c - a) * (v * beside)
        };
        let directions: Vec<GzCoord> = (0..BUNDLE).map(|k| (towards(k) - eye).normalize_or_zero()).collect();
        let rays = directions.iter().map(|&direction| GzRay::new(eye, direction));
        let filters: Option<Vec<FilterRay>> = rays.map(|ray| FilterRay::new(&ray, &self.space)).collect();
        // A group beyond the range of f32, or without extent, is no work for these kernels.
        let Some(filters) = filters.filter(|_| size > 0.0) else { return };
        let met = directions.iter().map(|&direction| GzRay::new(eye, direction));
        let met =
            met.flat_map(|ray| ids.iter().map(move |&tri| (ray, tri))).filter(|(ray, tri)| is_hit(ray, self.tris.position(*tri)));
        self.pairs.extend(met.take(PAIRS / GROUPS));
        self.groups.push(TriGroup::new(ids, self.tris.positions(), &self.space));
        self.eyes.push(eye.as_dvec3());
        self.directions.push(directions);
        self.filters.push(filters);
    }

    fn batch(&self, k: usize) -> RayBatch<'_> {
        RayBatch::unbounded(BUNDLE, PerRay::One(self.eyes[k]), PerRay::Each(&self.directions[k]))
    }

    /// The triangles of one group, as a mesh of their own.
    fn alone(&self, k: usize) -> Vec<TriId> {
        self.groups[k].ids().collect()
    }

    /// No kernel loses a hit, and none gives another answer than the exact one.
    pub(super) fn check(&self) -> Result<(), AppError> {
        let (mut pairs, mut lost, mut other) = (0u64, 0u64, 0u64);
        for (k, group) in self.groups.iter().enumerate() {
            let survivors = self.survivors(k);
            for (i, bits) in survivors.iter().enumerate() {
                let ray = self.batch(k).ray(i);
                for (lane, tri) in group.ids().enumerate() {
                    pairs += 1;
                    let corners = self.tris.position(tri);
                    let hit = is_hit(&ray, corners);
                    lost += u64::from(hit && bits >> lane & 1 == 0);
                    // Well inside or outside there is nothing to round.
                    let weights = if hit { hit_weights(&ray, corners) } else { [0.0; 3] };
                    let well_inside = weights.iter().all(|&w| w > 1e-3);
                    other += u64::from(well_inside && plain(Kernel::MoellerTrumbore, &ray, corners).is_none());
                }
            }
        }
        println!(
            "{} groups, {pairs} pairs of ray and triangle: {lost} hits lost by the f32 kernel, {other} by plain f32 well inside",
            self.groups.len()
        );
        if lost + other > 0 || self.pairs.is_empty() {
            return Err(AppError::Differs(format!("{lost} hits are lost by the f32 kernel, {other} by the plain test")));
        }
        Ok(())
    }

    fn survivors(&self, k: usize) -> Vec<u32> {
        let mut found = Vec::new();
        dispatch(SimdLevel::best(), Survivors { group: &self.groups[k], rays: &self.filters[k], found: &mut found });
        found
    }

    pub(super) fn time(&self, rounds: usize) -> Vec<Row> {
        let level = SimdLevel::best();
        let rays = (self.groups.len() * BUNDLE) as f64;
        let trees: Vec<TriBuffer> = (0..self.groups.len()).filter_map(|k| self.mesh(&self.alone(k))).collect();
        let trees: Vec<BspTree<'_>> = trees.iter().map(BspTree::build).collect();
        let (mut hits, mut found) = (vec![Hit::MISS; BUNDLE], Vec::with_capacity(BUNDLE));
        let mut bundle = RayBundle::empty();
        let positions = self.tris.positions();
        let mut contenders: Vec<Box<dyn FnMut() + '_>> = vec![
            Box::new(|| {
                for (k, group) in self.groups.iter().enumerate() {
                    for i in 0..BUNDLE {
                        let ray = self.batch(k).ray(i);
                        for tri in group.ids() {
                            black_box(plain(Kernel::MoellerTrumbore, &ray, &positions[tri as usize]));
                        }
                    }
                }
            }),
            Box::new(|| {
                for (group, rays) in self.groups.iter().zip(&self.filters) {
                    found.clear();
                    dispatch(level, Survivors { group, rays, found: &mut found });
                    black_box(&found);
                }
            }),
            Box::new(|| {
                for k in 0..self.groups.len() {
                    dispatch(level, Gather { bundle: &mut bundle, rays: &self.batch(k), space: &self.space });
                }
                black_box(&bundle);
            }),
            Box::new(|| {
                for (k, tree) in trees.iter().enumerate() {
                    tree.closest_hits(&self.batch(k), ClassMask::ALL, &mut hits);
                }
                black_box(&hits);
            }),
            Box::new(|| {
                for (ray, tri) in &self.pairs {
                    black_box(plain(Kernel::MoellerTrumbore, ray, &positions[*tri as usize]));
                }
            }),
            Box::new(|| {
                for (ray, tri) in &self.pairs {
                    black_box(is_hit(ray, &positions[*tri as usize]));
                }
            }),
            Box::new(|| {
                for (ray, tri) in &self.pairs {
                    let mut closest = Closest::default();
                    closest.consider(ray, *tri, positions);
                    black_box(closest.hit(ray, positions));
                }
            }),
        ];
        let times = take_turns(rounds, &mut contenders);
        drop(contenders);
        let row = |what: &str, unit, count: f64, k: usize, plain: Option<usize>| Row {
            what: what.to_owned(),
            unit,
            count,
            times: times[k].clone(),
            plain: plain.map_or_else(Vec::new, |plain| times[plain].clone()),
        };
        let (pairs, met) = (8.0 * rays, self.pairs.len() as f64);
        vec![
            row("plain f32, one ray and one triangle", "pair", pairs, 0, None),
            row("f32 filter, one ray against 8 triangles", "pair", pairs, 1, Some(0)),
            row("64 rays made into a bundle", "ray", rays, 2, None),
            row("64 rays against 8 triangles: bundle, filter, answers", "pair", pairs, 3, Some(0)),
            row("plain f32, a pair that meets", "pair", met, 4, None),
            row("certified in f64, a pair that meets", "pair", met, 5, Some(4)),
            row("certified in f64, and T, u and v", "pair", met, 6, Some(4)),
        ]
    }

    fn mesh(&self, ids: &[TriId]) -> Option<TriBuffer> {
        let corners: Vec<GzCoord> = ids.iter().flat_map(|&tri| *self.tris.position(tri)).collect();
        let triples: Vec<[u32; 3]> = (0..ids.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        TriBuffer::from_indexed(&corners, &triples).ok()
    }
}

/// One group against rays, one after the other.
struct Survivors<'k> {
    group: &'k TriGroup,
    rays: &'k [FilterRay],
    found: &'k mut Vec<u32>,
}

impl Task for Survivors<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        for ray in self.rays {
            self.found.push(self.group.survivors::<S>(ray));
        }
    }
}

/// Sixty-four rays made into a bundle.
struct Gather<'k> {
    bundle: &'k mut RayBundle,
    rays: &'k RayBatch<'k>,
    space: &'k FilterSpace,
}

impl Task for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        black_box(self.bundle.gather::<S>(self.rays, 0, BUNDLE, self.space));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::scenes::bench_scene;

    #[test]
    fn kernels_are_checked_before_they_are_timed() {
        let scene = bench_scene("teapot:2").unwrap();
        let kernels = Kernels::of(&scene.tris);
        kernels.check().unwrap();
        assert!(kernels.groups.len() > 10 && kernels.pairs.len() > 100);
        assert!(kernels.pairs.iter().all(|(ray, tri)| is_hit(ray, scene.tris.position(*tri))));
        let rows = kernels.time(2);
        assert_eq!(rows.len(), 7);
        assert!(rows.iter().all(|row| row.times.len() == 2 && row.count > 0.0));
    }
}
