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

/// Rays in a batch: those of a tile of `gz render`, 64 by 64 pixels.
pub const BATCH: usize = 4096;

/// Room for the rays of one batch, property by property. Nothing in it outlives a batch but its memory.
#[derive(Default)]
pub struct Scratch {
    origins: Vec<DVec3>,
    directions: Vec<GzCoord>,
    tmins: Vec<f32>,
    tmaxs: Vec<f32>,
}

impl Scratch {
    /// The batch of `rays`. What they share is told once, as a camera, a directional light or an unbounded ray has it; finding that out
    /// is part of the work that the bench times.
    pub fn batch(&mut self, rays: &[PeerRay]) -> RayBatch<'_> {
        RayBatch::new(
            rays.len(),
            property(rays, &mut self.origins, |ray| ray.origin, |origin| GzCoord::from_array(origin).as_dvec3()),
            property(rays, &mut self.directions, |ray| ray.direction, GzCoord::from_array),
            property(rays, &mut self.tmins, |ray| ray.tmin, |tmin| tmin),
            property(rays, &mut self.tmaxs, |ray| ray.tmax, |tmax| tmax),
        )
    }
}

/// One value when all rays have it (a NaN never counts as shared), else a copy of each.
fn property<'s, P: PartialEq + Copy, T: Copy>(
    rays: &[PeerRay],
    room: &'s mut Vec<T>,
    of: impl Fn(&PeerRay) -> P,
    as_stored: impl Fn(P) -> T,
) -> PerRay<'s, T> {
    if let Some(first) = rays.first().map(&of)
        && rays.iter().all(|ray| of(ray) == first)
    {
        return PerRay::One(as_stored(first));
    }
    room.clear();
    room.extend(rays.iter().map(|ray| as_stored(of(ray))));
    PerRay::Each(room)
}
