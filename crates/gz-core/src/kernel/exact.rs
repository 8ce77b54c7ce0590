//! The exact stage: ray against triangle without any rounding.

use super::dyadic::Dyadic;
use super::quotient::{quotient_f32, quotient_near};
use crate::{GzCoord, GzRay};
use std::cmp::Ordering;

type Vec3 = [Dyadic; 3];

/// The exact answer for a ray and a triangle that the line meets: T-value and weights as fractions over one denominator.
#[derive(Clone, Debug)]
pub(crate) struct ExactHit {
    /// t = m / d.
    m: Dyadic,
    /// U + V + W, made positive.
    d: Dyadic,
    /// Numerators of the weights of the three corners, each at least 0.
    weights: [Dyadic; 3],
}

impl ExactHit {
    /// The hit of a valid `ray` on a triangle, its interval of t included; `None` for a miss.
    ///
    /// With A = a - o and so on: U = d.(B x C), V = d.(C x A), W = d.(A x B), D = U + V + W, M = A.(B x C). The line meets the
    /// triangle when D is not 0 and no two of U, V, W have opposite signs.
    pub(crate) fn of(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<Self> {
        let origin = ray.origin.to_array().map(Dyadic::new);
        let direction = ray.direction.to_array().map(|x| Dyadic::new(f64::from(x)));
        let [a, b, c] = corners.map(|p| -> Vec3 {
            let p = p.to_array().map(|x| Dyadic::new(f64::from(x)));
            std::array::from_fn(|k| p[k].minus(&origin[k]))
        });
        let bc = cross(&b, &c);
        let volumes = [dot(&direction, &bc), dot(&direction, &cross(&c, &a)), dot(&direction, &cross(&a, &b))];
        let d = volumes[0].plus(&volumes[1]).plus(&volumes[2]);
        let sign = d.sign();
        if sign == 0 || volumes.iter().any(|x| x.sign() == -sign) {
            return None;
        }
        let m = dot(&a, &bc);
        let hit = if sign > 0 {
            Self { m, d, weights: volumes }
        } else {
            Self { m: m.negated(), d: d.negated(), weights: volumes.map(Dyadic::negated) }
        };
        let inside = hit.order_to(ray.tmin) == Ordering::Greater && hit.order_to(ray.tmax) == Ordering::Less;
        inside.then_some(hit)
    }

    /// The order of t and a number that is not NaN.
    fn order_to(&self, t: f32) -> Ordering {
        if t == f32::INFINITY {
            return Ordering::Less;
        }
        if t == f32::NEG_INFINITY {
            return Ordering::Greater;
        }
        self.m.order(&self.d.times(&Dyadic::new(f64::from(t))))
    }

    /// The order of two T-values on one ray.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        self.m.times(&other.d).order(&other.m.times(&self.d))
    }

    /// The T-value, rounded once.
    pub(crate) fn t(&self) -> f32 {
        quotient_f32(&self.m, &self.d)
    }

    /// t in f64 to a relative error below 2^-50.
    pub(crate) fn t_near(&self) -> f64 {
        quotient_near(&self.m, &self.d)
    }

    /// The weight of corner `k` in [0, 1], rounded once.
    pub(crate) fn weight(&self, k: usize) -> f32 {
        quotient_f32(&self.weights[k], &self.d)
    }

    /// The weights in f64, each to a relative error below 2^-50.
    pub(crate) fn weights_near(&self) -> [f64; 3] {
        std::array::from_fn(|k| quotient_near(&self.weights[k], &self.d))
    }
}

/// The sign of `direction . N` with N = (b - a) x (c - a): which side of its plane a direction points to.
pub(crate) fn side_sign(corners: &[GzCoord; 3], direction: GzCoord) -> i32 {
    let [a, b, c] = corners.map(|p| p.to_array().map(|x| Dyadic::new(f64::from(x))));
    let from_a = |p: &Vec3| -> Vec3 { std::array::from_fn(|k| p[k].minus(&a[k])) };
    dot(&direction.to_array().map(|x| Dyadic::new(f64::from(x))), &cross(&from_a(&b), &from_a(&c))).sign()
}

fn cross(a: &Vec3, b: &Vec3) -> Vec3 {
    let part = |i: usize, j: usize| a[i].times(&b[j]).minus(&a[j].times(&b[i]));
    [part(1, 2), part(2, 0), part(0, 1)]
}

fn dot(a: &Vec3, b: &Vec3) -> Dyadic {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}
