//! A ray against a box in f64, never too narrow.

use glam::DVec3;
use gz_core::{Bounds, GzRay};

/// A distance (plane - o) * (1 / d) passes three roundings, each at most a factor 1 + 2^-53 off, so it is within a relative 4 * 2^-53 of
/// the true one; eight times 2^-53 covers it.
const PAD: f64 = 4.0 * f64::EPSILON;

/// A ray with the reciprocal of its direction.
#[derive(Clone, Copy)]
pub(crate) struct Slabs<'r> {
    pub(crate) ray: &'r GzRay,
    inverse: DVec3,
}

/// Distances along the ray between which something is crossed: the paper's min and max.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    pub(crate) min: f64,
    pub(crate) max: f64,
}

impl<'r> Slabs<'r> {
    pub(crate) fn new(ray: &'r GzRay) -> Self {
        Self { ray, inverse: ray.direction.as_dvec3().recip() }
    }

    /// Bounds of the distance at which the ray crosses `axis = plane`; the direction is not 0 along `axis`.
    pub(crate) fn crossing(&self, axis: usize, plane: f32) -> (f64, f64) {
        let t = (f64::from(plane) - self.ray.origin[axis]) * self.inverse[axis];
        let pad = t.abs() * PAD;
        (t - pad, t + pad)
    }

    /// Where the ray crosses the box within its own interval; `None` when it surely does not.
    pub(crate) fn through(&self, bounds: &Bounds) -> Option<Span> {
        let mut span = Span { min: f64::from(self.ray.tmin), max: f64::from(self.ray.tmax) };
        for axis in 0..3 {
            let (low, high) = (bounds.min[axis], bounds.max[axis]);
            if self.ray.direction[axis] == 0.0 {
                let o = self.ray.origin[axis];
                if !(f64::from(low) <= o && o <= f64::from(high)) {
                    return None;
                }
                continue;
            }
            let (enter, leave) = if self.ray.direction[axis] > 0.0 { (low, high) } else { (high, low) };
            span.min = span.min.max(self.crossing(axis, enter).0);
            span.max = span.max.min(self.crossing(axis, leave).1);
        }
        (span.min <= span.max).then_some(span)
    }
}

/// Whether the ray may cross the box at or before `limit`.
pub(crate) fn crosses(ray: &GzRay, bounds: &Bounds, limit: f32) -> bool {
    Slabs::new(ray).through(bounds).is_some_and(|span| span.min <= f64::from(limit))
}
