//! The f64 test with its error bound: it answers when the bound proves the answer, else it says so.

use super::height::Plane;
use super::solution::{Bounded, Solution};
use crate::{GzCoord, GzRay};

impl Bounded<f64> {
    /// -1 or 1 when proved, 0 when not.
    fn proved_sign(self) -> i32 {
        if self.value > self.error {
            1
        } else if self.value < -self.error {
            -1
        } else {
            0
        }
    }
}

impl Solution<f64> {
    /// The arithmetic of one ray and one triangle.
    #[inline(always)]
    pub(super) fn of_one(ray: &GzRay, corners: &[GzCoord; 3]) -> Self {
        let (origin, direction, corners) = in_doubles(ray, corners);
        Self::of(origin, direction, &corners)
    }

    /// The same with quick errors.
    #[inline(always)]
    pub(super) fn quick_of_one(ray: &GzRay, corners: &[GzCoord; 3]) -> Self {
        let (origin, direction, corners) = in_doubles(ray, corners);
        Self::quick(origin, direction, &corners)
    }
}

#[inline(always)]
fn in_doubles(ray: &GzRay, corners: &[GzCoord; 3]) -> ([f64; 3], [f64; 3], [[f64; 3]; 3]) {
    (ray.origin.to_array(), ray.direction.as_dvec3().to_array(), corners.map(|p| p.as_dvec3().to_array()))
}

/// What f64 can say of a ray and a triangle.
pub(crate) enum Verdict {
    /// Proved: no hit in the ray's interval.
    Miss,
    /// Proved: a hit in the ray's interval, its t between these.
    Hit {
        /// At most t.
        lo: f64,
        /// At least t.
        hi: f64,
    },
    /// Ask the exact stage.
    Unsure,
}

/// The f64 test of a valid ray against a triangle.
pub(crate) fn certify(ray: &GzRay, corners: &[GzCoord; 3]) -> Verdict {
    let solution = Solution::of_one(ray, corners);
    let signs = [solution.u(), solution.v, solution.w].map(Bounded::proved_sign);
    let (any_above, any_below) = (signs.contains(&1), signs.contains(&-1));
    if any_above && any_below {
        return Verdict::Miss;
    }
    if signs.contains(&0) || solution.certainty() <= 0.0 {
        return Verdict::Unsure;
    }
    let Bounded { value: t, error } = solution.t(solution.inverse());
    let (lo, hi) = (t - error, t + error);
    let (tmin, tmax) = (f64::from(ray.tmin), f64::from(ray.tmax));
    if hi <= tmin || lo >= tmax {
        Verdict::Miss
    } else if lo > tmin && hi < tmax {
        Verdict::Hit { lo, hi }
    } else if tmin == 0.0 && hi < tmax {
        // The plane that a ray leaves is at t = 0 but for rounding: common enough to be decided by the sign of M alone.
        match is_ahead(ray, corners, signs[0]) {
            true => Verdict::Hit { lo, hi },
            false => Verdict::Miss,
        }
    } else {
        Verdict::Unsure
    }
}

/// Whether t = M / D is above 0, exactly, for D of the sign `d_sign`.
fn is_ahead(ray: &GzRay, corners: &[GzCoord; 3], d_sign: i32) -> bool {
    // M is how far the plane lies ahead along the normal: the height of the origin, with the other sign.
    let plane = Plane::of(&corners.map(|p| p.as_dvec3().to_array()));
    plane.side(corners, ray.origin.to_array()) * d_sign < 0
}
