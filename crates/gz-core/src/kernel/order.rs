//! The one order of hits: exact t first, then the lower triangle number.

use super::answer::t_u_v;
use super::certify::{Verdict, certify};
use super::exact::ExactHit;
use crate::{GzCoord, GzRay, Hit, TriId};
use std::cmp::Ordering;

/// The front-most hit of one ray so far.
///
/// Only an interval of t is kept: two hits are told apart in f64 as long as their intervals do not touch, exactly otherwise.
#[derive(Clone, Copy, Debug, Default)]
pub struct Closest {
    best: Option<Candidate>,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    tri: TriId,
    lo: f64,
    hi: f64,
}

impl Closest {
    /// Takes triangle `tri` of `positions` into account for a valid `ray`. Order of calls and repeated calls do not show in the result.
    pub fn consider(&mut self, ray: &GzRay, tri: TriId, positions: &[[GzCoord; 3]]) {
        if self.best.is_some_and(|best| best.tri == tri) {
            return;
        }
        let corners = &positions[tri as usize];
        let (lo, hi) = match certify(ray, corners) {
            Verdict::Miss => return,
            Verdict::Hit { lo, hi } => (lo, hi),
            Verdict::Unsure => match exact_interval(ray, corners) {
                Some(interval) => interval,
                None => return,
            },
        };
        let found = Candidate { tri, lo, hi };
        let better = self.best.is_none_or(|best| {
            if hi < best.lo {
                true
            } else if lo > best.hi {
                false
            } else {
                let order = exact_order(ray, corners, &positions[best.tri as usize]);
                order.then(tri.cmp(&best.tri)) == Ordering::Less
            }
        });
        if better {
            self.best = Some(found);
        }
    }

    /// At least the exact t of the best hit so far; infinite when there is none. Nothing beyond it can be better.
    pub fn distance(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |best| best.hi)
    }

    /// The answer to `ray`, the same as in all calls before: T-value and weights are formed only now.
    pub fn hit(&self, ray: &GzRay, positions: &[[GzCoord; 3]]) -> Hit {
        self.best.map_or(Hit::MISS, |best| {
            let (t, u, v) = t_u_v(ray, &positions[best.tri as usize]);
            Hit { t, tri: best.tri, u, v }
        })
    }
}

/// Whether triangle `tri` is hit by a valid ray before `best`, a triangle that it hits too, at t between two numbers; if so, an interval of
/// f32 around its t.
pub(crate) fn closer(ray: &GzRay, best: Option<(TriId, [f32; 2])>, tri: TriId, positions: &[[GzCoord; 3]]) -> Option<(f32, f32)> {
    let mut closest = Closest::default();
    closest.consider(ray, tri, positions);
    let Candidate { lo, hi, .. } = closest.best?;
    if let Some((best, [best_lo, best_hi])) = best {
        if lo > f64::from(best_hi) {
            return None;
        }
        // Most are told apart by what is known of the other.
        if hi >= f64::from(best_lo) {
            closest.consider(ray, best, positions);
            closest.best.filter(|best| best.tri == tri)?;
        }
    }
    Some(((lo as f32).next_down(), (hi as f32).next_up()))
}

/// Whether a valid ray hits a triangle.
pub fn is_hit(ray: &GzRay, corners: &[GzCoord; 3]) -> bool {
    match certify(ray, corners) {
        Verdict::Miss => false,
        Verdict::Hit { .. } => true,
        Verdict::Unsure => ExactHit::of(ray, corners).is_some(),
    }
}

/// An interval around the exact t of a hit; `None` for a miss.
fn exact_interval(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f64, f64)> {
    let t = ExactHit::of(ray, corners)?.t_near();
    // `t_near` errs by at most 2^-50 |t|; below the normal range of f64 by the least number.
    let error = t.abs() * (4.0 * f64::EPSILON) + f64::MIN_POSITIVE;
    Some((t - error, t + error))
}

/// The exact order of the T-values of two triangles that the ray hits.
fn exact_order(ray: &GzRay, one: &[GzCoord; 3], other: &[GzCoord; 3]) -> Ordering {
    // Copies of a triangle are common enough to be told at once.
    if one == other {
        return Ordering::Equal;
    }
    match (ExactHit::of(ray, one), ExactHit::of(ray, other)) {
        (Some(one), Some(other)) => one.order(&other),
        // Candidates are proved hits; a miss here would be a fault of the bound.
        (one, other) => {
            debug_assert!(false, "the exact stage misses what f64 proved to be hit");
            one.is_none().cmp(&other.is_none())
        }
    }
}
