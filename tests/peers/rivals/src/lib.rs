//! obvhs and parry3d behind the C interface of the peers bench, `tests/peers/harness/peer.h`.

mod obvhs;
mod parry;

use std::ffi::{CStr, c_char, c_int, c_void};
use std::slice::{from_raw_parts, from_raw_parts_mut};

/// A ray of a ray file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PeerRay {
    origin: [f32; 3],
    tmin: f32,
    direction: [f32; 3],
    tmax: f32,
}

/// An answer; a miss has the greatest triangle number.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PeerHit {
    t: f32,
    triangle: u32,
    u: f32,
    v: f32,
}

const MISS: PeerHit = PeerHit { t: f32::INFINITY, triangle: u32::MAX, u: 0.0, v: 0.0 };

trait Rival: Send + Sync {
    fn closest(&self, ray: &PeerRay) -> PeerHit;
    fn any(&self, ray: &PeerRay) -> bool;
    fn bytes(&self) -> usize;

    // Loops inside of the trait, so that the call of each ray is not a virtual one.
    fn closest_of_all(&self, rays: &[PeerRay], hits: &mut [PeerHit]) {
        rays.iter().zip(hits).for_each(|(ray, hit)| *hit = self.closest(ray));
    }

    fn any_of_all(&self, rays: &[PeerRay], occluded: &mut [u8]) {
        rays.iter().zip(occluded).for_each(|(ray, occluded)| *occluded = u8::from(self.any(ray)));
    }
}

fn build(variant: &str, vertices: &[[f32; 3]], indices: &[[u32; 3]], threads: usize) -> Option<Box<dyn Rival>> {
    // Wide stacks: one of the builders recurses deeply.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(64 << 20).build().ok()?;
    pool.install(|| -> Option<Box<dyn Rival>> {
        match variant {
            "parry3d" => Some(Box::new(parry::Parry::new(vertices, indices)?)),
            _ => Some(Box::new(obvhs::Obvhs::new(variant, vertices, indices)?)),
        }
    })
}

/// See peer.h, as for all below.
#[unsafe(no_mangle)]
pub extern "C" fn peer_variants() -> *const c_char {
    c"obvhs-cw-vslow obvhs-cw-medium obvhs-bvh2-vslow obvhs-bvh2-medium parry3d".as_ptr()
}

/// # Safety
///
/// As peer.h has it: a C string, and arrays of the lengths given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_build(
    variant: *const c_char,
    vertices: *const f32,
    vertex_count: u32,
    indices: *const u32,
    triangle_count: u32,
    threads: c_int,
) -> *mut c_void {
    // SAFETY: the caller's promise.
    let variant = unsafe { CStr::from_ptr(variant) }.to_string_lossy();
    // SAFETY: the caller's promise; a mesh of the bench is not empty.
    let vertices = unsafe { from_raw_parts(vertices.cast(), vertex_count as usize) };
    // SAFETY: as above.
    let indices = unsafe { from_raw_parts(indices.cast(), triangle_count as usize) };
    match build(&variant, vertices, indices, usize::try_from(threads).unwrap_or(1)) {
        Some(rival) => Box::into_raw(Box::new(rival)).cast(),
        None => std::ptr::null_mut(),
    }
}

/// # Safety
///
/// `peer` comes from [`peer_build`]; there are `n` rays and room for `n` hits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_closest(peer: *mut c_void, rays: *const PeerRay, n: usize, hits: *mut PeerHit) {
    // SAFETY: the caller's promise; it asks about at least one ray.
    unsafe { (*peer.cast::<Box<dyn Rival>>()).closest_of_all(from_raw_parts(rays, n), from_raw_parts_mut(hits, n)) }
}

/// # Safety
///
/// As [`peer_closest`], with `n` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_any(peer: *mut c_void, rays: *const PeerRay, n: usize, occluded: *mut u8) {
    // SAFETY: the caller's promise; it asks about at least one ray.
    unsafe { (*peer.cast::<Box<dyn Rival>>()).any_of_all(from_raw_parts(rays, n), from_raw_parts_mut(occluded, n)) }
}

/// # Safety
///
/// `peer` comes from [`peer_build`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_bytes(peer: *mut c_void) -> usize {
    // SAFETY: the caller's promise.
    unsafe { (*peer.cast::<Box<dyn Rival>>()).bytes() }
}

/// # Safety
///
/// `peer` comes from [`peer_build`] and is used by nobody afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_free(peer: *mut c_void) {
    // SAFETY: the caller's promise.
    drop(unsafe { Box::from_raw(peer.cast::<Box<dyn Rival>>()) });
}
