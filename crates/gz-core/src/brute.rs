//! Every ray against every triangle: the specification of [`RayQuery`].

use crate::kernel::{Closest, FilterRay, FilterSpace, TriGroup, is_hit, plain};
use crate::simd::{Simd, Task, dispatch, with_default_float_control};
use crate::{ClassMask, GzRay, Hit, Kernel, NO_TRI, RayBatch, RayQuery, SimdLevel, TriBuffer, TriId};

/// Every ray against every triangle.
///
/// With the default kernel a conservative filter looks at eight triangles at a time and an exact test at what it lets through, so
/// the answer is the exact one. Building copies the corners once, 44 bytes a triangle.
#[derive(Debug)]
pub struct BruteForce<'a> {
    tris: &'a TriBuffer,
    kernel: Kernel,
    level: SimdLevel,
    /// All triangles in order; none for a kernel that is not filtered.
    groups: Vec<TriGroup>,
    space: FilterSpace,
}

/// Groups worked on at a time, for all rays of a batch: 256 triangles, 11 KiB, stay in the first-level cache.
const AT_A_TIME: usize = 32;

impl<'a> BruteForce<'a> {
    /// Over `tris`, with the exact kernel.
    pub fn new(tris: &'a TriBuffer) -> Self {
        Self::with_kernel(tris, Kernel::Certified)
    }

    /// Over `tris`, with a kernel of choice.
    pub fn with_kernel(tris: &'a TriBuffer, kernel: Kernel) -> Self {
        let ids: Vec<TriId> = if kernel == Kernel::Certified { (0..tris.len() as TriId).collect() } else { Vec::new() };
        let space = FilterSpace::new(tris.bounds().reaches());
        let groups = ids.chunks(8).map(|ids| TriGroup::new(ids, tris.positions(), &space)).collect();
        Self { tris, kernel, level: SimdLevel::best(), groups, space }
    }

    /// The same with another set of vector instructions; where this machine lacks it, the best that it has. Answers stay equal.
    #[must_use]
    pub fn with_simd(self, level: SimdLevel) -> Self {
        Self { level: level.or_best(), ..self }
    }

    /// The kernel in use.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Bytes held beyond the triangle buffer.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.groups[..])
    }

    /// Calls `found(ray number, ray, triangle)` for every triangle of `classes` that the filter cannot exclude, part by part of
    /// the groups, so that all rays use a part while it is in the cache. `found` says whether the ray wants more.
    fn each_survivor(&self, rays: &RayBatch<'_>, classes: ClassMask, mut found: impl FnMut(usize, &GzRay, TriId) -> bool) {
        let mut open: Vec<(usize, GzRay, Option<FilterRay>)> = (0..rays.len())
            .map(|i| (i, rays.ray(i)))
            .filter(|(_, ray)| ray.is_valid())
            .map(|(i, ray)| (i, ray, FilterRay::new(&ray, &self.space)))
            .collect();
        let everything = classes == ClassMask::ALL;
        let mut survivors = Vec::new();
        for groups in self.groups.chunks(AT_A_TIME) {
            open.retain(|(i, ray, filter)| {
                survivors.clear();
                match filter {
                    Some(ray) => dispatch(self.level, Filter { groups, ray, survivors: &mut survivors }),
                    None => survivors.extend(groups.iter().flat_map(TriGroup::ids)),
                }
                survivors.iter().all(|&tri| !(everything || classes.has(self.tris.class(tri))) || found(*i, ray, tri))
            });
        }
    }

    /// The front-most hit by the plain f32 kernel: least (t, triangle number).
    fn plain_closest(&self, ray: &GzRay, classes: ClassMask) -> Hit {
        let mut best = Hit::MISS;
        for (tri, corners) in (0..).zip(self.tris.positions()) {
            if classes.has(self.tris.class(tri))
                && let Some((t, u, v)) = plain(self.kernel, ray, corners)
                && (!best.is_hit() || t < best.t)
            {
                best = Hit { t, tri, u, v };
            }
        }
        best
    }
}

/// Collects what the filter cannot exclude.
struct Filter<'f> {
    groups: &'f [TriGroup],
    ray: &'f FilterRay,
    survivors: &'f mut Vec<TriId>,
}

impl Task for Filter<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        for group in self.groups {
            let mut lanes = group.survivors::<S>(self.ray);
            while lanes != 0 {
                let tri = group.id(lanes.trailing_zeros() as usize);
                lanes &= lanes - 1;
                // Unused lanes are the last.
                if tri == NO_TRI {
                    break;
                }
                self.survivors.push(tri);
            }
        }
    }
}

impl RayQuery for BruteForce<'_> {
    fn tris(&self) -> &TriBuffer {
        self.tris
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        if self.kernel != Kernel::Certified {
            for (i, hit) in hits.iter_mut().enumerate() {
                *hit = Some(rays.ray(i)).filter(GzRay::is_valid).map_or(Hit::MISS, |ray| self.plain_closest(&ray, classes));
            }
            return;
        }
        with_default_float_control(|| {
            let positions = self.tris.positions();
            let mut closest = vec![Closest::default(); rays.len()];
            self.each_survivor(rays, classes, |i, ray, tri| {
                closest[i].consider(ray, tri, positions);
                true
            });
            for (i, (hit, closest)) in hits.iter_mut().zip(&closest).enumerate() {
                *hit = closest.hit(&rays.ray(i), positions);
            }
        });
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "one answer a ray");
        if self.kernel != Kernel::Certified {
            for (i, occluded) in occluded.iter_mut().enumerate() {
                *occluded =
                    Some(rays.ray(i)).filter(GzRay::is_valid).is_some_and(|ray| self.plain_closest(&ray, classes).is_hit());
            }
            return;
        }
        with_default_float_control(|| {
            occluded.fill(false);
            self.each_survivor(rays, classes, |i, ray, tri| {
                occluded[i] = is_hit(ray, self.tris.position(tri));
                !occluded[i]
            });
        });
    }
}
