//! Rays as the bench has them, made into batches as the product has them.

use gz_core::glam::DVec3;
use gz_core::{GzCoord, GzRay32, NO_TRI, PerRay, RayBatch, TriId};

/// A ray as the product has it: 48 bytes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PeerRay64 {
    origin: [f64; 3],
    tmin: f32,
    direction: [f32; 3],
    tmax: f32,
    leaves: TriId,
}

/// Rays of either kind.
pub trait Given: Copy {
    /// Rays in a batch.
    const BATCH: usize;

    /// The batch of `rays`, 1 to [`Self::BATCH`].
    fn batch<'s>(scratch: &'s mut Scratch, rays: &'s [Self]) -> RayBatch<'s>;
}

/// As they lie in a file of rays.
impl Given for GzRay32 {
    const BATCH: usize = usize::MAX;

    fn batch<'s>(_: &'s mut Scratch, rays: &'s [Self]) -> RayBatch<'s> {
        RayBatch::of_rays(rays)
    }
}

impl Given for PeerRay64 {
    const BATCH: usize = BATCH;

    fn batch<'s>(scratch: &'s mut Scratch, rays: &'s [Self]) -> RayBatch<'s> {
        scratch.batch(rays)
    }
}

/// Rays in a batch: those of a tile of `gz render`, 16 by 16 pixels.
pub const BATCH: usize = 256;

/// Room for the rays of one batch, property by property. Nothing in it outlives a batch but its memory.
pub struct Scratch {
    origins: [DVec3; BATCH],
    directions: [GzCoord; BATCH],
    tmins: [f32; BATCH],
    tmaxs: [f32; BATCH],
    leaves: [TriId; BATCH],
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            origins: [DVec3::ZERO; BATCH],
            directions: [GzCoord::ZERO; BATCH],
            tmins: [0.0; BATCH],
            tmaxs: [0.0; BATCH],
            leaves: [NO_TRI; BATCH],
        }
    }
}

impl Scratch {
    /// The batch of `rays`, 1 to [`BATCH`]. Ends are told once where they are equal, and so is a direction; origins differ. Finding that out is
    /// part of the work that the bench times.
    fn batch(&mut self, rays: &[PeerRay64]) -> RayBatch<'_> {
        let first = rays[0];
        let bits = |ray: &PeerRay64| {
            let [x, y, z] = ray.direction;
            [ray.tmin, x, y, z, ray.tmax].map(f32::to_bits)
        };
        let mut other = [0; 5];
        for ((ray, o), leaves) in rays.iter().zip(&mut self.origins).zip(&mut self.leaves) {
            ahead(ray);
            (*o, *leaves) = (DVec3::from_array(ray.origin), ray.leaves);
            for ((other, bits), first) in other.iter_mut().zip(bits(ray)).zip(bits(&first)) {
                *other |= bits ^ first;
            }
        }
        let [tmin, direction, tmax] = [&other[..1], &other[1..4], &other[4..]].map(|bits| bits.iter().all(|&b| b == 0));
        if !direction {
            for (ray, d) in rays.iter().zip(&mut self.directions) {
                *d = GzCoord::from_array(ray.direction);
            }
        }
        if !tmin || !tmax {
            for (ray, (t0, t1)) in rays.iter().zip(self.tmins.iter_mut().zip(&mut self.tmaxs)) {
                (*t0, *t1) = (ray.tmin, ray.tmax);
            }
        }
        let n = rays.len();
        let batch = RayBatch::new(
            n,
            PerRay::Each(&self.origins[..n]),
            if direction { PerRay::One(GzCoord::from_array(first.direction)) } else { PerRay::Each(&self.directions[..n]) },
            if tmin { PerRay::One(first.tmin) } else { PerRay::Each(&self.tmins[..n]) },
            if tmax { PerRay::One(first.tmax) } else { PerRay::Each(&self.tmaxs[..n]) },
        );
        batch.leaving(&self.leaves[..n])
    }
}

/// Asks for the memory of the ray that is a batch behind `ray`, as it comes from far away: a caller's array, not the product's own.
#[inline(always)]
fn ahead<R>(ray: &R) {
    let next = std::ptr::from_ref(ray).wrapping_add(110).cast::<i8>();
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch reads nothing and may be given any address. SSE is part of x86-64.
    unsafe {
        std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(next);
    }
}
