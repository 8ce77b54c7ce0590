//! Rays.

use crate::GzCoord;
use glam::DVec3;

/// A ray: origin, direction and the open interval of t in which a hit counts.
///
/// The origin is f64, so that a ray can leave a surface from a point that lies provably on one side of it; an f32 origin widens
/// exactly. The direction is f32 and need not be a unit vector; t counts in its lengths. Hits satisfy `tmin < t < tmax`, both
/// strict; either may be infinite or negative.
///
/// A ray with a NaN anywhere, an infinite origin or direction, a zero direction, or an origin coordinate that is neither 0 nor of
/// magnitude 2^-150 to 2^128 hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GzRay {
    /// Where t = 0 is, in trace space.
    pub origin: DVec3,
    /// The step from t to t + 1.
    pub direction: GzCoord,
    /// Hits at or before this t do not count.
    pub tmin: f32,
    /// Hits at or beyond this t do not count.
    pub tmax: f32,
}

impl GzRay {
    /// The ray from `origin` along `direction` with t in (0, infinity).
    pub fn new(origin: GzCoord, direction: GzCoord) -> Self {
        Self::from_f64(origin.as_dvec3(), direction)
    }

    /// The same for an origin in f64.
    pub fn from_f64(origin: DVec3, direction: GzCoord) -> Self {
        Self { origin, direction, tmin: 0.0, tmax: f32::INFINITY }
    }

    /// The point at parameter `t`, in f64 and not exact.
    pub fn at(&self, t: f32) -> DVec3 {
        self.origin + self.direction.as_dvec3() * f64::from(t)
    }

    /// Whether the ray can hit anything at all: see the type's own text.
    pub fn is_valid(&self) -> bool {
        let origin_ok = |x: f64| x == 0.0 || (x.abs() >= LEAST_ORIGIN && x.abs() <= GREATEST_ORIGIN);
        self.direction.is_finite()
            && self.direction != GzCoord::ZERO
            && origin_ok(self.origin.x)
            && origin_ok(self.origin.y)
            && origin_ok(self.origin.z)
            && self.tmin < self.tmax // false for NaN
    }
}

/// 2^-150, the least magnitude of an origin coordinate other than 0. Keeps every exact stage within a fixed number of bits.
pub(crate) const LEAST_ORIGIN: f64 = f64::from_bits((1023 - 150) << 52);
/// 2^128, the greatest.
pub(crate) const GREATEST_ORIGIN: f64 = f64::from_bits((1023 + 128) << 52);

/// A ray whose origin is f32 too: eight numbers in a row, 32 bytes, as files of rays and other ray tracers have it. It means the [`GzRay`] that
/// it widens to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct GzRay32 {
    /// Where t = 0 is, in trace space.
    pub origin: GzCoord,
    /// Hits at or before this t do not count.
    pub tmin: f32,
    /// The step from t to t + 1.
    pub direction: GzCoord,
    /// Hits at or beyond this t do not count.
    pub tmax: f32,
}

impl From<GzRay32> for GzRay {
    fn from(GzRay32 { origin, tmin, direction, tmax }: GzRay32) -> Self {
        Self { origin: origin.as_dvec3(), direction, tmin, tmax }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_rays_are_told_from_useless_ones() {
        let good = GzRay::new(GzCoord::ZERO, GzCoord::Z);
        assert!(good.is_valid());
        assert!(GzRay { tmin: f32::NEG_INFINITY, ..good }.is_valid());
        assert!(GzRay { direction: GzCoord::splat(f32::from_bits(1)), ..good }.is_valid());
        assert!(GzRay { origin: DVec3::splat(LEAST_ORIGIN), ..good }.is_valid());
        assert!(GzRay { origin: DVec3::splat(-GREATEST_ORIGIN), ..good }.is_valid());
        for bad in [
            GzRay { direction: GzCoord::ZERO, ..good },
            GzRay { direction: GzCoord::new(0.0, f32::NAN, 1.0), ..good },
            GzRay { direction: GzCoord::new(0.0, f32::INFINITY, 1.0), ..good },
            GzRay { origin: DVec3::new(f64::NAN, 0.0, 0.0), ..good },
            GzRay { origin: DVec3::new(0.0, f64::INFINITY, 0.0), ..good },
            GzRay { origin: DVec3::new(0.0, 0.0, LEAST_ORIGIN / 2.0), ..good },
            GzRay { origin: DVec3::new(0.0, 0.0, GREATEST_ORIGIN * 2.0), ..good },
            GzRay { tmin: f32::NAN, ..good },
            GzRay { tmax: f32::NAN, ..good },
            GzRay { tmax: 0.0, ..good },
        ] {
            assert!(!bad.is_valid(), "{bad:?}");
        }
    }
}
