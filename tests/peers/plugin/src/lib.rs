//! The tree of gz behind the C interface of the peers bench, `tests/peers/harness/peer.h`.
//!
//! The only unsafe code beside `gz_core::simd`: what a caller in C promises, taken at its word in one place and made into slices.

mod rays;

use gz_bsp::BspTree;
use gz_core::{ClassMask, GzCoord, GzRay32, Hit, RayQuery, TriBuffer, with_default_float_control};
use rays::{Given, PeerRay64, Scratch};
use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::mem::ManuallyDrop;
use std::slice::{from_raw_parts, from_raw_parts_mut};

/// A tree and the buffer that it borrows.
struct Peer {
    tree: ManuallyDrop<BspTree<'static>>,
    /// Made by [`Box::into_raw`]; nothing but `tree` refers to it.
    tris: *mut TriBuffer,
}

// SAFETY: the pointer stands for a box of a `TriBuffer`, which may be sent, and so may the tree.
unsafe impl Send for Peer {}

const _: () =
    assert!(size_of::<Hit>() == 16 && size_of::<GzRay32>() == 32 && size_of::<PeerRay64>() == 48, "the interface says so");

impl Peer {
    fn new(tris: TriBuffer) -> Self {
        let tris = Box::into_raw(Box::new(tris));
        // SAFETY: `tris` comes from a box, which `drop` frees only after the tree, its only user; until then it is only read.
        let tree = BspTree::build(unsafe { &*tris });
        Self { tree: ManuallyDrop::new(tree), tris }
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // SAFETY: dropped here and nowhere else; not used afterwards.
        unsafe { ManuallyDrop::drop(&mut self.tree) };
        // SAFETY: made by `Box::into_raw`, and with the tree its last user has gone.
        drop(unsafe { Box::from_raw(self.tris) });
    }
}

thread_local! {
    /// Memory for rays, kept from call to call as a render keeps it from tile to tile.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// The variants: `default` is the tree that tunes itself.
#[unsafe(no_mangle)]
pub extern "C" fn peer_variants() -> *const c_char {
    c"default".as_ptr()
}

/// Builds the tree of an indexed mesh on `threads` threads. Null, with a line on standard error, for a variant that is none or a mesh
/// that is none.
///
/// # Safety
///
/// `variant` is a C string; `vertices` points to three floats for each of `vertex_count` and `indices` to three numbers for each of
/// `triangle_count`, both readable during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_build(
    variant: *const c_char,
    vertices: *const f32,
    vertex_count: u32,
    indices: *const u32,
    triangle_count: u32,
    threads: c_int,
) -> *mut c_void {
    // SAFETY: the caller's promises, each as it stands in `# Safety`.
    let (variant, vertices, indices) = unsafe {
        (CStr::from_ptr(variant), slice(vertices.cast(), vertex_count as usize), slice(indices.cast(), triangle_count as usize))
    };
    match build(variant, vertices, indices, threads) {
        Ok(peer) => Box::into_raw(Box::new(peer)).cast(),
        Err(reason) => {
            eprintln!("gz: {reason}");
            std::ptr::null_mut()
        }
    }
}

fn build(variant: &CStr, vertices: &[[f32; 3]], indices: &[[u32; 3]], threads: c_int) -> Result<Peer, String> {
    if variant != c"default" {
        return Err(format!("there is no variant {}", variant.to_string_lossy()));
    }
    // The caller's threads may flush subnormals, which threads that they start inherit.
    let start = |thread: rayon::ThreadBuilder| {
        std::thread::Builder::new().spawn(|| with_default_float_control(|| thread.run())).map(|_| ())
    };
    let threads = usize::try_from(threads).unwrap_or(1).max(1);
    let pool =
        rayon::ThreadPoolBuilder::new().num_threads(threads).spawn_handler(start).build().map_err(|error| error.to_string())?;
    pool.install(|| {
        let vertices: Vec<GzCoord> = vertices.iter().copied().map(GzCoord::from_array).collect();
        let tris = TriBuffer::from_indexed(&vertices, indices).map_err(|error| error.to_string())?;
        drop(vertices);
        Ok(Peer::new(tris))
    })
}

/// The front-most hits of `n` rays.
///
/// # Safety
///
/// `peer` comes from [`peer_build`] and is not freed yet; `rays` points to `n` rays to be read and `hits` to `n` hits to be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_closest(peer: *mut c_void, rays: *const GzRay32, n: usize, hits: *mut Hit) {
    // SAFETY: the caller's promises.
    unsafe { closest(peer, rays, n, hits) }
}

/// The same for rays with f64 origins that name the triangles they leave.
///
/// # Safety
///
/// As [`peer_closest`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_closest64(peer: *mut c_void, rays: *const PeerRay64, n: usize, hits: *mut Hit) {
    // SAFETY: the caller's promises.
    unsafe { closest(peer, rays, n, hits) }
}

/// Whether each of `n` rays hits anything: 1 or 0.
///
/// # Safety
///
/// As [`peer_closest`], with `n` bytes to be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_any(peer: *mut c_void, rays: *const GzRay32, n: usize, occluded: *mut u8) {
    // SAFETY: the caller's promises.
    unsafe { any(peer, rays, n, occluded) }
}

/// The same for rays with f64 origins that name the triangles they leave.
///
/// # Safety
///
/// As [`peer_any`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_any64(peer: *mut c_void, rays: *const PeerRay64, n: usize, occluded: *mut u8) {
    // SAFETY: the caller's promises.
    unsafe { any(peer, rays, n, occluded) }
}

/// # Safety
///
/// As [`peer_closest`].
unsafe fn closest<R: Given>(peer: *mut c_void, rays: *const R, n: usize, hits: *mut Hit) {
    // SAFETY: the caller's promises. `Hit` is the 16 bytes of the interface's `PeerHit`, for any of which it is valid, so memory with
    // anything in it may be seen as hits.
    let (peer, rays, hits) = unsafe { (&*peer.cast::<Peer>(), slice(rays, n), slice_mut(hits, n)) };
    SCRATCH.with_borrow_mut(|scratch| {
        for (rays, hits) in rays.chunks(R::BATCH).zip(hits.chunks_mut(R::BATCH)) {
            peer.tree.closest_hits(&R::batch(scratch, rays), ClassMask::ALL, hits);
        }
    });
}

/// # Safety
///
/// As [`peer_any`].
unsafe fn any<R: Given>(peer: *mut c_void, rays: *const R, n: usize, occluded: *mut u8) {
    // SAFETY: the caller's promises.
    let (peer, rays, bytes) = unsafe { (&*peer.cast::<Peer>(), slice(rays, n), slice_mut(occluded, n)) };
    bytes.fill(0);
    // SAFETY: the same memory, not used as `bytes` while `occluded` lives; a 0 is a `bool`, and a `bool` is a byte of 0 or 1.
    let occluded = unsafe { slice_mut(bytes.as_mut_ptr().cast::<bool>(), n) };
    SCRATCH.with_borrow_mut(|scratch| {
        for (rays, occluded) in rays.chunks(R::BATCH).zip(occluded.chunks_mut(R::BATCH)) {
            peer.tree.any_hits(&R::batch(scratch, rays), ClassMask::ALL, occluded);
        }
    });
}

/// Bytes beyond the triangle buffer.
///
/// # Safety
///
/// `peer` comes from [`peer_build`] and is not freed yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_bytes(peer: *mut c_void) -> usize {
    // SAFETY: the caller's promise.
    unsafe { &*peer.cast::<Peer>() }.tree.bytes()
}

/// Frees the tree and its triangles.
///
/// # Safety
///
/// `peer` comes from [`peer_build`] and is used by nobody afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_free(peer: *mut c_void) {
    // SAFETY: the caller's promise: the box of `peer_build`, freed once.
    drop(unsafe { Box::from_raw(peer.cast::<Peer>()) });
}

/// A slice of `n` elements, whatever the pointer for none.
///
/// # Safety
///
/// `first` points to `n` elements that are readable, and not written to, for as long as the slice is used.
unsafe fn slice<'a, T>(first: *const T, n: usize) -> &'a [T] {
    // SAFETY: the caller's promise.
    if n == 0 { &[] } else { unsafe { from_raw_parts(first, n) } }
}

/// The same to write into.
///
/// # Safety
///
/// `first` points to `n` elements that nobody else touches for as long as the slice is used.
unsafe fn slice_mut<'a, T>(first: *mut T, n: usize) -> &'a mut [T] {
    // SAFETY: the caller's promise.
    if n == 0 { &mut [] } else { unsafe { from_raw_parts_mut(first, n) } }
}
