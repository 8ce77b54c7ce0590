//! The f64 arithmetic of a ray and a triangle with its error bounds, for one pair or eight.
//!
//! u = 2^-53 is the unit roundoff of f64. Inputs are f32 vertices and an origin within [2^-150, 2^128] or 0, so no product of this
//! file under- or overflows, and each operation errs by at most a factor 1 + u. No multiply-add is fused: one pair and eight give equal
//! bits.

use crate::simd::Doubles;

const U: f64 = f64::EPSILON / 2.0;

/// A triple product d.(b x c) of differences b and c, each rounded once: a term d_x b_y c_z passes 2 differences, the product b_y c_z,
/// the subtraction, the product with d_x and at most 2 additions, 7 roundings, so it errs by at most ((1 + u)^7 - 1) times the
/// permanent (the sum of the terms' magnitudes). The computed permanent is itself at least (1 - 7u) of the true one. 8u covers both.
const VOLUME_BOUND: f64 = 8.0 * U;

/// The same for N . A: one more rounded difference in each term.
const DISTANCE_BOUND: f64 = 9.0 * U;

/// A number and how far from it the true one may be.
#[derive(Clone, Copy)]
pub(super) struct Bounded<F> {
    pub(super) value: F,
    pub(super) error: F,
}

/// The products of b x c, for rounded differences b, c: what is added and what is subtracted along each axis.
#[inline(always)]
fn products<F: Doubles>(b: [F; 3], c: [F; 3]) -> [[F; 2]; 3] {
    [[b[1].times(c[2]), b[2].times(c[1])], [b[2].times(c[0]), b[0].times(c[2])], [b[0].times(c[1]), b[1].times(c[0])]]
}

/// b x c from [`products`].
#[inline(always)]
fn combined<F: Doubles>([x, y, z]: [[F; 2]; 3]) -> [F; 3] {
    [x[0].minus(x[1]), y[0].minus(y[1]), z[0].minus(z[1])]
}

#[inline(always)]
fn dot<F: Doubles>(a: [F; 3], b: [F; 3]) -> F {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

/// d.(b x c) with its error.
#[inline(always)]
fn volume<F: Doubles>(d: [F; 3], b: [F; 3], c: [F; 3], bound: f64) -> Bounded<F> {
    let products = products(b, c);
    let permanent = share(d[0], products[0]).plus(share(d[1], products[1])).plus(share(d[2], products[2]));
    Bounded { value: dot(d, combined(products)), error: F::splat(bound).times(permanent) }
}

#[inline(always)]
fn share<F: Doubles>(d: F, [p, q]: [F; 2]) -> F {
    d.abs().times(p.abs().plus(q.abs()))
}

/// The greatest magnitude of a component.
#[inline(always)]
pub(super) fn extent<F: Doubles>(x: [F; 3]) -> F {
    x[0].abs().or_more(x[1].abs()).or_more(x[2].abs())
}

/// What a triangle has in common for all rays from one origin: P = e2 x A, Q = A x e1 and N = e1 x e2, so that V = d.P, W = d.Q, D = d.N and
/// M = A.N.
pub(super) struct Facing<F> {
    pub(super) p: [F; 3],
    pub(super) q: [F; 3],
    pub(super) normal: [F; 3],
    pub(super) m: F,
    /// The greatest component of both edges.
    pub(super) size: F,
    /// The greatest component of A.
    pub(super) away: F,
}

impl<F: Doubles> Facing<F> {
    #[inline(always)]
    pub(super) fn of(origin: [F; 3], corners: &[[F; 3]; 3]) -> Self {
        let [a, b, c] = *corners;
        let (e1, e2, from_origin) = (difference(b, a), difference(c, a), difference(a, origin));
        let normal = combined(products(e1, e2));
        Self {
            p: combined(products(e2, from_origin)),
            q: combined(products(from_origin, e1)),
            normal,
            m: dot(from_origin, normal),
            size: extent(e1).or_more(extent(e2)),
            away: extent(from_origin),
        }
    }

    /// For a direction d: no permanent is above 2 |d| |b| |c|, with the sum of d's components and the greatest of b's and c's; the roundings
    /// of that are within what the bounds have to spare.
    #[inline(always)]
    pub(super) fn quick(&self, d: [F; 3]) -> Solution<F> {
        let area = self.size.times(self.size);
        let speed = d[0].abs().plus(d[1].abs()).plus(d[2].abs());
        let per_volume = speed.times(F::splat(2.0 * VOLUME_BOUND));
        let error = per_volume.times(self.size).times(self.away);
        Solution {
            v: Bounded { value: dot(d, self.p), error },
            w: Bounded { value: dot(d, self.q), error },
            d: Bounded { value: dot(d, self.normal), error: per_volume.times(area) },
            m: Bounded { value: self.m, error: F::splat(6.0 * DISTANCE_BOUND).times(self.away).times(area) },
        }
    }
}

/// All that f64 knows of a ray and a triangle, from edges e1 = b - a, e2 = c - a and A = a - o.
///
/// V = d.(e2 x A), W = d.(A x e1), D = d.(e1 x e2) and M = A.(e1 x e2) equal the volumes of the definition, but their permanents, and so
/// their errors, are smaller by the triangle's size over its distance. U = D - V - W takes over the errors of all three.
pub(super) struct Solution<F> {
    pub(super) v: Bounded<F>,
    pub(super) w: Bounded<F>,
    pub(super) d: Bounded<F>,
    m: Bounded<F>,
}

impl<F: Doubles> Solution<F> {
    #[inline(always)]
    pub(super) fn of(origin: [F; 3], direction: [F; 3], corners: &[[F; 3]; 3]) -> Self {
        let [a, b, c] = *corners;
        let (e1, e2, from_origin) = (difference(b, a), difference(c, a), difference(a, origin));
        Self {
            v: volume(direction, e2, from_origin, VOLUME_BOUND),
            w: volume(direction, from_origin, e1, VOLUME_BOUND),
            d: volume(direction, e1, e2, VOLUME_BOUND),
            m: volume(from_origin, e1, e2, DISTANCE_BOUND),
        }
    }

    /// The same numbers with errors that are larger and quickly had.
    #[inline(always)]
    pub(super) fn quick(origin: [F; 3], direction: [F; 3], corners: &[[F; 3]; 3]) -> Self {
        Facing::of(origin, corners).quick(direction)
    }

    /// U = D - V - W.
    #[inline(always)]
    pub(super) fn u(&self) -> Bounded<F> {
        let (v, w, d) = (self.v, self.w, self.d);
        // Two subtractions, each off by at most u times the magnitudes that go in.
        let rounding = F::splat(2.0 * U).times(d.value.abs().plus(v.value.abs()).plus(w.value.abs()));
        let error = F::splat(1.01).times(d.error.plus(v.error).plus(w.error).plus(rounding));
        Bounded { value: d.value.minus(v.value).minus(w.value), error }
    }

    /// At least 0 where D is proved to differ from 0, by enough for the quotients below.
    ///
    /// |M/D - m/d| <= (error of M + |m/d| error of D) / (|d| - error of D); a quarter of |d| caps the denominator's loss at 4/3.
    #[inline(always)]
    pub(super) fn certainty(&self) -> F {
        self.d.value.abs().minus(F::splat(4.0).times(self.d.error))
    }

    /// 1 / D, where D is certain.
    #[inline(always)]
    pub(super) fn inverse(&self) -> F {
        F::splat(1.0).over(self.d.value)
    }

    /// t = M / D and how far it may be off, where D is certain: 1.5 leaves room for the roundings of the bound and 3u |t| for those of the
    /// reciprocal and the product.
    #[inline(always)]
    pub(super) fn t(&self, inverse: F) -> Bounded<F> {
        let t = self.m.value.times(inverse);
        let from_both = self.m.error.plus(t.abs().times(self.d.error)).times(inverse.abs());
        Bounded { value: t, error: F::splat(1.5).times(from_both).plus(F::splat(3.0 * U).times(t.abs())) }
    }

    /// V / D and W / D, before they are cut to [0, 1], and how far each and their sum may be off, where D is certain.
    #[inline(always)]
    pub(super) fn weights(&self, inverse: F) -> ([F; 2], F) {
        // As for t, with |V/D| at most 1, the same for W, and U with the errors of both; 6u for the quotients and the sum.
        let errors = self.v.error.plus(self.w.error).plus(F::splat(2.0).times(self.d.error));
        let error = F::splat(1.5).times(errors).times(inverse.abs()).plus(F::splat(6.0 * U));
        ([self.v.value.times(inverse), self.w.value.times(inverse)], error)
    }
}

#[inline(always)]
pub(super) fn difference<F: Doubles>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[0].minus(b[0]), a[1].minus(b[1]), a[2].minus(b[2])]
}
