//! Rays as the bench has them, made into batches as the product has them.

use gz_core::glam::DVec3;
use gz_core::{GzCoord, PerRay, RayBatch};

/// A ray of a ray file: 32 bytes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PeerRay {
    origin: [f32; 3],
    tmin: f32,
    direction: [f32; 3],
    tmax: f32,
}

/// Rays in a batch: those of a tile of `gz render`, 16 by 16 pixels.
pub const BATCH: usize = 256;

/// Room for the rays of one batch, property by property. Nothing in it outlives a batch but its memory.
pub struct Scratch {
    origins: [DVec3; BATCH],
    directions: [GzCoord; BATCH],
    tmins: [f32; BATCH],
    tmaxs: [f32; BATCH],
}

impl Default for Scratch {
    fn default() -> Self {
        Self { origins: [DVec3::ZERO; BATCH], directions: [GzCoord::ZERO; BATCH], tmins: [0.0; BATCH], tmaxs: [0.0; BATCH] }
    }
}

impl Scratch {
    /// The batch of `rays`, 1 to [`BATCH`]. What they share is told once, as a camera, a directional light or an unbounded ray has it;
    /// finding that out is part of the work that the bench times. A NaN never counts as shared.
    pub fn batch(&mut self, rays: &[PeerRay]) -> RayBatch<'_> {
        let first = rays[0];
        let (mut origin, mut direction, mut tmin, mut tmax) = (true, true, true, true);
        let places = self.origins.iter_mut().zip(&mut self.directions).zip(self.tmins.iter_mut().zip(&mut self.tmaxs));
        for (ray, ((o, d), (t0, t1))) in rays.iter().zip(places) {
            ahead(ray);
            let [x, y, z] = ray.origin;
            *o = DVec3::new(x.into(), y.into(), z.into());
            *d = GzCoord::from_array(ray.direction);
            (*t0, *t1) = (ray.tmin, ray.tmax);
            origin &= (x == first.origin[0]) & (y == first.origin[1]) & (z == first.origin[2]);
            direction &= (d.x == first.direction[0]) & (d.y == first.direction[1]) & (d.z == first.direction[2]);
            tmin &= *t0 == first.tmin;
            tmax &= *t1 == first.tmax;
        }
        let n = rays.len();
        RayBatch::new(
            n,
            if origin { PerRay::One(self.origins[0]) } else { PerRay::Each(&self.origins[..n]) },
            if direction { PerRay::One(self.directions[0]) } else { PerRay::Each(&self.directions[..n]) },
            if tmin { PerRay::One(first.tmin) } else { PerRay::Each(&self.tmins[..n]) },
            if tmax { PerRay::One(first.tmax) } else { PerRay::Each(&self.tmaxs[..n]) },
        )
    }
}

/// Asks for the memory of the ray that is a batch behind `ray`, as it comes from far away: a caller's array, not the product's own.
#[inline(always)]
fn ahead(ray: &PeerRay) {
    let next = std::ptr::from_ref(ray).wrapping_add(BATCH).cast::<i8>();
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch reads nothing and may be given any address. SSE is part of x86-64.
    unsafe {
        std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(next);
    }
}
