//! Rays as the bench has them, made into batches as the product has them.

use gz_core::glam::DVec3;
use gz_core::{GzCoord, NO_TRI, PerRay, RayBatch, TriId};

/// A ray of a ray file: 32 bytes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PeerRay {
    origin: [f32; 3],
    tmin: f32,
    direction: [f32; 3],
    tmax: f32,
}

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

/// What both have.
pub trait Given {
    /// Whether rays name the triangle that they leave.
    const LEAVING: bool;

    /// The origin; an f32 widens exactly.
    fn origin(&self) -> DVec3;
    /// The direction.
    fn direction(&self) -> GzCoord;
    /// Both ends of t.
    fn ends(&self) -> (f32, f32);
    /// The triangle that it leaves.
    fn leaves(&self) -> TriId;
}

impl Given for PeerRay {
    const LEAVING: bool = false;

    #[inline(always)]
    fn origin(&self) -> DVec3 {
        let [x, y, z] = self.origin;
        DVec3::new(x.into(), y.into(), z.into())
    }
    #[inline(always)]
    fn direction(&self) -> GzCoord {
        GzCoord::from_array(self.direction)
    }
    #[inline(always)]
    fn ends(&self) -> (f32, f32) {
        (self.tmin, self.tmax)
    }
    #[inline(always)]
    fn leaves(&self) -> TriId {
        NO_TRI
    }
}

impl Given for PeerRay64 {
    const LEAVING: bool = true;

    #[inline(always)]
    fn origin(&self) -> DVec3 {
        DVec3::from_array(self.origin)
    }
    #[inline(always)]
    fn direction(&self) -> GzCoord {
        GzCoord::from_array(self.direction)
    }
    #[inline(always)]
    fn ends(&self) -> (f32, f32) {
        (self.tmin, self.tmax)
    }
    #[inline(always)]
    fn leaves(&self) -> TriId {
        self.leaves
    }
}

/// Rays in a batch: those of a tile of 16 by 16 pixels.
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
    /// The batch of `rays`, 1 to [`BATCH`]. What they share is told once, as a camera, a directional light or an unbounded ray has it;
    /// finding that out is part of the work that the bench times. A NaN never counts as shared.
    pub fn batch<R: Given>(&mut self, rays: &[R]) -> RayBatch<'_> {
        let first = &rays[0];
        let ((o0, d0), ends0) = ((first.origin(), first.direction()), first.ends());
        let (mut origin, mut direction, mut tmin, mut tmax) = (true, true, true, true);
        let places = self.origins.iter_mut().zip(&mut self.directions).zip(self.tmins.iter_mut().zip(&mut self.tmaxs));
        for ((ray, leaves), ((o, d), (t0, t1))) in rays.iter().zip(&mut self.leaves).zip(places) {
            ahead(ray);
            (*o, *d) = (ray.origin(), ray.direction());
            (*t0, *t1) = ray.ends();
            origin &= (o.x == o0.x) & (o.y == o0.y) & (o.z == o0.z);
            direction &= (d.x == d0.x) & (d.y == d0.y) & (d.z == d0.z);
            tmin &= *t0 == ends0.0;
            tmax &= *t1 == ends0.1;
            if R::LEAVING {
                *leaves = ray.leaves();
            }
        }
        let n = rays.len();
        let batch = RayBatch::new(
            n,
            if origin { PerRay::One(self.origins[0]) } else { PerRay::Each(&self.origins[..n]) },
            if direction { PerRay::One(self.directions[0]) } else { PerRay::Each(&self.directions[..n]) },
            if tmin { PerRay::One(ends0.0) } else { PerRay::Each(&self.tmins[..n]) },
            if tmax { PerRay::One(ends0.1) } else { PerRay::Each(&self.tmaxs[..n]) },
        );
        if R::LEAVING { batch.leaving(&self.leaves[..n]) } else { batch }
    }
}

/// Asks for the memory of the ray that is a batch behind `ray`, as it comes from far away: a caller's array, not the product's own.
#[inline(always)]
fn ahead<R>(ray: &R) {
    let next = std::ptr::from_ref(ray).wrapping_add(BATCH).cast::<i8>();
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch reads nothing and may be given any address. SSE is part of x86-64.
    unsafe {
        std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(next);
    }
}
