//! Points and hits as arrays of numbers.

use crate::{GzCoord, GzRay32, Hit, TriId};
use glam::DVec3;

const _: () = assert!(size_of::<GzCoord>() == 12 && align_of::<GzCoord>() == 4);
const _: () = assert!(size_of::<Hit>() == 16 && align_of::<Hit>() == 4);
const _: () = assert!(size_of::<GzRay32>() == 32 && align_of::<GzRay32>() == 4);
const _: () = assert!(size_of::<DVec3>() == 24 && align_of::<DVec3>() == 8);

/// The points' coordinates.
#[inline(always)]
pub fn coordinates(points: &[GzCoord]) -> &[[f32; 3]] {
    // SAFETY: `GzCoord` is `repr(C)` with the fields x, y, z of f32 and nothing else.
    unsafe { std::slice::from_raw_parts(points.as_ptr().cast(), points.len()) }
}

/// The points' coordinates.
#[inline(always)]
pub fn coordinates_f64(points: &[DVec3]) -> &[[f64; 3]] {
    // SAFETY: `DVec3` is `repr(C)` with the fields x, y, z of f64 and nothing else.
    unsafe { std::slice::from_raw_parts(points.as_ptr().cast(), points.len()) }
}

/// The rays' numbers: origin, tmin, direction, tmax.
#[inline(always)]
pub fn numbers_of_rays(rays: &[GzRay32]) -> &[[f32; 8]] {
    // SAFETY: `GzRay32` is `repr(C)`: three f32, one, three and one, and nothing else.
    unsafe { std::slice::from_raw_parts(rays.as_ptr().cast(), rays.len()) }
}

/// The coordinates of three corners one after the other.
#[inline(always)]
pub fn nine(corners: &[GzCoord; 3]) -> &[f32; 9] {
    // SAFETY: as above, three times.
    unsafe { &*std::ptr::from_ref(corners).cast() }
}

/// Triangle numbers as the f32 numbers of equal bits, only to be moved about.
#[inline(always)]
pub fn numbers_of(ids: &[TriId; 8]) -> &[f32; 8] {
    // SAFETY: both are eight times four bytes, of which any are a number.
    unsafe { &*std::ptr::from_ref(ids).cast() }
}

/// Hits as rows of t, the triangle's bits, u and v.
#[inline(always)]
pub(super) fn rows_of(hits: &mut [Hit; 8]) -> &mut [[f32; 4]; 8] {
    // SAFETY: `Hit` is `repr(C)`: an f32, a u32 and two f32 of four bytes each, for all of which any bytes are a value.
    unsafe { &mut *std::ptr::from_mut(hits).cast() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_come_in_order() {
        let points = [GzCoord::new(1.0, 2.0, 3.0), GzCoord::new(4.0, 5.0, 6.0), GzCoord::new(7.0, 8.0, 9.0)];
        assert_eq!(coordinates(&points), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
        assert_eq!(coordinates_f64(&points.map(|p| p.as_dvec3()))[2], [7.0, 8.0, 9.0]);
        let ray = GzRay32 { origin: points[0], tmin: 0.5, direction: points[1], tmax: 9.0 };
        assert_eq!(numbers_of_rays(&[ray; 2])[1], [1.0, 2.0, 3.0, 0.5, 4.0, 5.0, 6.0, 9.0]);
        assert_eq!(*nine(&points), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
    }
}
