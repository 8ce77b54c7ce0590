//! Every ray against every triangle: the specification of [`RayQuery`].

use crate::kernel::plain;
use crate::{ClassMask, Hit, Kernel, RayBatch, RayQuery, TriBuffer};

/// Every ray against every triangle.
#[derive(Debug)]
pub struct BruteForce<'a> {
    tris: &'a TriBuffer,
    kernel: Kernel,
}

impl<'a> BruteForce<'a> {
    /// Over `tris`, with the exact kernel.
    pub fn new(tris: &'a TriBuffer) -> Self {
        Self::with_kernel(tris, Kernel::Certified)
    }

    /// Over `tris`, with a kernel of choice.
    pub fn with_kernel(tris: &'a TriBuffer, kernel: Kernel) -> Self {
        Self { tris, kernel }
    }

    /// The kernel in use.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }
}

impl RayQuery for BruteForce<'_> {
    fn tris(&self) -> &TriBuffer {
        self.tris
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        for (i, hit) in hits.iter_mut().enumerate() {
            let ray = rays.ray(i);
            *hit = Hit::MISS;
            for (id, corners) in self.tris.positions().iter().enumerate() {
                if classes.has(self.tris.class(id as u32))
                    && let Some(found) = plain(&ray, corners)
                    && found.t < hit.t
                {
                    *hit = Hit { tri: id as u32, ..found };
                }
            }
        }
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "one answer a ray");
        let mut hits = vec![Hit::MISS; rays.len()];
        self.closest_hits(rays, classes, &mut hits);
        for (occluded, hit) in occluded.iter_mut().zip(&hits) {
            *occluded = hit.is_hit();
        }
    }
}
