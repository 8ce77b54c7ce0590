//! The f64 test with its error bound: it answers when the bound proves the answer, else it says so.
//!
//! u = 2^-53 is the unit roundoff of f64. Inputs are f32 vertices and an origin within [2^-150, 2^128] or 0, so no product of this
//! file under- or overflows, and each operation errs by at most a factor 1 + u.

use super::exact::ExactHit;
use crate::{GzCoord, GzRay};
use glam::DVec3;

const U: f64 = f64::EPSILON / 2.0;

/// A triple product d.(b x c) of differences b and c, each rounded once: a term d_x b_y c_z passes 2 differences, the product b_y c_z,
/// the subtraction, the product with d_x and at most 2 additions, 7 roundings, so it errs by at most ((1 + u)^7 - 1) times the
/// permanent (the sum of the terms' magnitudes). The computed permanent is itself at least (1 - 7u) of the true one. 8u covers both.
const VOLUME_BOUND: f64 = 8.0 * U;

/// The same for N . A: one more rounded difference in each term.
const DISTANCE_BOUND: f64 = 9.0 * U;

/// A number and how far from it the true one may be.
#[derive(Clone, Copy)]
struct Bounded {
    value: f64,
    error: f64,
}

impl Bounded {
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

/// d.(b x c) with its error, for rounded differences b, c.
fn volume(d: DVec3, b: DVec3, c: DVec3, bound: f64) -> Bounded {
    let (px, qx) = (b.y * c.z, b.z * c.y);
    let (py, qy) = (b.z * c.x, b.x * c.z);
    let (pz, qz) = (b.x * c.y, b.y * c.x);
    let value = d.x * (px - qx) + d.y * (py - qy) + d.z * (pz - qz);
    let permanent = d.x.abs() * (px.abs() + qx.abs()) + d.y.abs() * (py.abs() + qy.abs()) + d.z.abs() * (pz.abs() + qz.abs());
    Bounded { value, error: bound * permanent }
}

/// All that f64 knows of a ray and a triangle, from edges e1 = b - a, e2 = c - a and A = a - o.
///
/// V = d.(e2 x A), W = d.(A x e1), D = d.(e1 x e2) and M = A.(e1 x e2) equal the volumes of the definition, but their permanents, and so
/// their errors, are smaller by the triangle's size over its distance. U = D - V - W takes over the errors of all three.
struct Solution {
    u: Bounded,
    v: Bounded,
    w: Bounded,
    d: Bounded,
    m: Bounded,
}

impl Solution {
    #[inline(always)]
    fn of(ray: &GzRay, corners: &[GzCoord; 3]) -> Self {
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let (e1, e2, from_origin, direction) = (b - a, c - a, a - ray.origin, ray.direction.as_dvec3());
        let v = volume(direction, e2, from_origin, VOLUME_BOUND);
        let w = volume(direction, from_origin, e1, VOLUME_BOUND);
        let d = volume(direction, e1, e2, VOLUME_BOUND);
        let m = volume(from_origin, e1, e2, DISTANCE_BOUND);
        // Two subtractions, each off by at most u times the magnitudes that go in.
        let rounding = 2.0 * U * (d.value.abs() + v.value.abs() + w.value.abs());
        let u = Bounded { value: d.value - v.value - w.value, error: 1.01 * (d.error + v.error + w.error + rounding) };
        Self { u, v, w, d, m }
    }

    /// An interval that holds t = M / D, or `None` when D is not proved to differ from 0.
    fn t(&self) -> Option<(f64, f64)> {
        let magnitude = self.d.value.abs();
        // |M/D - m/d| <= (error of M + |m/d| error of D) / (|d| - error of D); a quarter of |d| caps the denominator's loss at 4/3,
        // 1.5 leaves room for the roundings of this line and 2u |t| for that of the quotient.
        if magnitude <= 4.0 * self.d.error {
            return None;
        }
        let t = self.m.value / self.d.value;
        let error = 1.5 * ((self.m.error + t.abs() * self.d.error) / magnitude) + 2.0 * U * t.abs();
        Some((t - error, t + error))
    }

    /// The weights cut to [0, 1], and a bound of how far each may be off; `None` when D is not proved to differ from 0.
    fn weights(&self) -> Option<Weights> {
        let magnitude = self.d.value.abs();
        if magnitude <= 4.0 * self.d.error {
            return None;
        }
        // As for t, with |V/D| at most 1, the same for W, and U with the errors of both; 4u for the quotients and the sum.
        let error = 1.5 * (self.v.error + self.w.error + 2.0 * self.d.error) / magnitude + 4.0 * U;
        let (v, w) = (self.v.value / self.d.value, self.w.value / self.d.value);
        Some(Weights { weights: [1.0 - v - w, v, w].map(|x| x.clamp(0.0, 1.0)), error })
    }
}

/// Weights of the three corners and a bound of how far each may be off.
#[derive(Clone, Copy)]
struct Weights {
    weights: [f64; 3],
    error: f64,
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
    let solution = Solution::of(ray, corners);
    let signs = [solution.u, solution.v, solution.w].map(Bounded::proved_sign);
    let (any_above, any_below) = (signs.contains(&1), signs.contains(&-1));
    if any_above && any_below {
        return Verdict::Miss;
    }
    if signs.contains(&0) {
        return Verdict::Unsure;
    }
    let Some((lo, hi)) = solution.t() else { return Verdict::Unsure };
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
#[cold]
fn is_ahead(ray: &GzRay, corners: &[GzCoord; 3], d_sign: i32) -> bool {
    let coord = |p: DVec3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
    let [a, b, c] = corners.map(|p| coord(p.as_dvec3()));
    // The predicate's determinant of a - o, b - o, c - o is M; its sign is exact.
    let m = robust::orient3d(a, b, c, coord(ray.origin));
    m * f64::from(d_sign) > 0.0
}

/// T, u and v of a hit, for a ray and a triangle that are known to meet.
///
/// T is the exact t rounded once: in f64 when both ends of its interval round alike, else by the exact stage. u = V/D and v = W/D are
/// within 1 ulp or 2^-40 of the true ones. A pure function of ray and triangle, so every query gives these bits.
pub(crate) fn t_u_v(ray: &GzRay, corners: &[GzCoord; 3]) -> (f32, f32, f32) {
    let solution = Solution::of(ray, corners);
    let t = match solution.t().map(|(lo, hi)| (lo as f32, hi as f32)) {
        // Equal bits, so that -0 and 0 are told apart.
        Some((lo, hi)) if lo.to_bits() == hi.to_bits() => Some(lo),
        _ => None,
    };
    // A weight is good to 1 ulp of f32 when it errs by less than a quarter of one, and to 2^-40 when by less than 2^-41.
    let weights = solution.weights().and_then(|Weights { weights: [_, u, v], error }| {
        let good = |w: f64| error <= (w * f64::from(f32::EPSILON) / 4.0).max(HALF_SMALLEST);
        (good(u) && good(v)).then_some((u as f32, v as f32))
    });
    if let (Some(t), Some((u, v))) = (t, weights) {
        return (t, u, v);
    }
    let Some(exact) = ExactHit::of(ray, corners) else { return (t.unwrap_or(0.0), 0.0, 0.0) };
    let (u, v) = weights.unwrap_or_else(|| (exact.weight(1), exact.weight(2)));
    (t.unwrap_or_else(|| exact.t()), u, v)
}

/// 2^-41.
const HALF_SMALLEST: f64 = 1.0 / (1u64 << 41) as f64;
/// 2^-36.
const WEIGHT_ERROR: f64 = 1.0 / (1u64 << 36) as f64;

/// Weights of the three corners where the line of `ray` meets the triangle, in f64.
///
/// Each is in [0, 1] and within 2^-36 of the true one; they sum to 1 up to rounding. Meaningful for a ray that hits the triangle; for
/// one that does not, (1, 0, 0).
pub fn hit_weights(ray: &GzRay, corners: &[GzCoord; 3]) -> [f64; 3] {
    let solution = Solution::of(ray, corners);
    solution
        .weights()
        .filter(|found| found.error <= WEIGHT_ERROR)
        .map(|found| found.weights)
        .or_else(|| ExactHit::of(ray, corners).map(|exact| exact.weights_near()))
        .unwrap_or([1.0, 0.0, 0.0])
}
