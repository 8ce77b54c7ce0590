//! How high a point lies over a triangle's plane, in pairs of f64: close enough to tell the side of a point that lies one rounding off it.
//!
//! u = 2^-53. Numbers are sums of two f64 without overlap (T. J. Dekker 1971; J. R. Shewchuk 1997 has the sums), so that what is left out is
//! of the order of u^2. Inputs are as for `solution.rs`, so no product or part of one under- or overflows. No operation is fused but where
//! the result is exact: one triangle and eight give equal bits.
// Axes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::solution::Bounded;
use crate::GzCoord;
use crate::simd::Doubles;

const U: f64 = f64::EPSILON / 2.0;

/// With P = |first product| + |second product| of a component of the normal and q a component of p - a: the component is known to 4 u^2 P;
/// the product with q passes 20 u^2 P |q| with what it leaves out; the sum of three and their rests adds 50 u^2 of the permanent, the sum of
/// all P |q|. 256 u^2 covers these and the roundings of the permanent.
const BOUND: f64 = 256.0 * U * U;

/// The same where edges round, as those of a triangle with very large and very small coordinates: as in `solution.rs`.
const ROUNDED_BOUND: f64 = 8.0 * U;

/// A triangle's plane.
#[derive(Clone, Copy)]
pub(crate) struct Plane<F> {
    a: [F; 3],
    /// (b - a) x (c - a), rounded.
    pub(crate) normal: [F; 3],
    /// What rounding took from it.
    rest: [F; 3],
    /// Magnitudes of the two products of each component, added.
    products: [F; 3],
    /// The bound that holds.
    bound: F,
}

impl<F: Doubles> Plane<F> {
    /// Of corners that are f32 numbers.
    #[inline(always)]
    pub(crate) fn of(corners: &[[F; 3]; 3]) -> Self {
        let [a, b, c] = *corners;
        let (mut e1, mut e2, mut lost) = (a, a, F::splat(0.0));
        for axis in 0..3 {
            let (to_b, to_c) = (difference(b[axis], a[axis]), difference(c[axis], a[axis]));
            (e1[axis], e2[axis]) = (to_b.0, to_c.0);
            lost = lost.plus(to_b.1.abs()).plus(to_c.1.abs());
        }
        // Nothing lost is 0; what is lost is at least the last bit of an f32, and more than 1 when scaled.
        let rounded = lost.times(F::splat(LARGE)).or_less(F::splat(1.0));
        let bound = F::splat(BOUND).plus(rounded.times(F::splat(ROUNDED_BOUND)));
        let zero = [F::splat(0.0); 3];
        let mut plane = Self { a, normal: zero, rest: zero, products: zero, bound };
        for axis in 0..3 {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            let (first, second) = (e1[next].times(e2[last]), e1[last].times(e2[next]));
            let errors = e1[next].product_error(e2[last], first).minus(e1[last].product_error(e2[next], second));
            let (normal, rest) = difference(first, second);
            plane.normal[axis] = normal;
            plane.rest[axis] = rest.plus(errors);
            plane.products[axis] = first.abs().plus(second.abs());
        }
        plane
    }

    /// How much a component of the normal may be off, rounded as it is.
    #[inline(always)]
    pub(crate) fn normal_error(&self, axis: usize) -> F {
        F::splat(ROUNDED_BOUND).times(self.products[axis])
    }

    /// The normal at length 1, and how much its product with a direction may be off for each unit of the direction's coordinates, added.
    /// Neither is a number where the normal is 0.
    #[inline(always)]
    pub(crate) fn unit(&self) -> ([F; 3], F) {
        let [x, y, z] = self.normal;
        let inverse = F::splat(1.0).over(x.times(x).plus(y.times(y)).plus(z.times(z)).sqrt());
        let error = self.normal_error(0).or_more(self.normal_error(1)).or_more(self.normal_error(2));
        // Scaling and the product add three roundings each, of components that are at most 1.
        let lean = error.times(inverse).plus(F::splat(16.0 * U));
        ([x.times(inverse), y.times(inverse), z.times(inverse)], lean)
    }

    /// (p - a) . N: above 0 on the side to which the winding's normal points. Proved 0 where value and error are 0.
    #[inline(always)]
    pub(super) fn height(&self, p: [F; 3]) -> Bounded<F> {
        let (mut sum, mut rests, mut permanent) = (F::splat(0.0), F::splat(0.0), F::splat(0.0));
        for axis in 0..3 {
            let (q, q_rest) = difference(p[axis], self.a[axis]);
            let product = q.times(self.normal[axis]);
            let crossed = q.times(self.rest[axis]).plus(q_rest.times(self.normal[axis]));
            rests = rests.plus(q.product_error(self.normal[axis], product).plus(crossed));
            let (total, rest) = add(sum, product);
            sum = total;
            rests = rests.plus(rest);
            permanent = permanent.plus(q.abs().times(self.products[axis]));
        }
        Bounded { value: sum.plus(rests), error: self.bound.times(permanent) }
    }
}

impl Plane<f64> {
    /// The side on which a point lies, exactly: 1 where the winding's normal points, -1 on the other, 0 in the plane.
    #[inline(always)]
    pub(crate) fn side(&self, corners: &[GzCoord; 3], p: [f64; 3]) -> i32 {
        let Bounded { value, error } = self.height(p);
        if value > error {
            1
        } else if value < -error {
            -1
        } else {
            exact_side(corners, p)
        }
    }
}

#[cold]
#[inline(never)]
fn exact_side(corners: &[GzCoord; 3], [x, y, z]: [f64; 3]) -> i32 {
    let [a, b, c] = corners.map(|p| p.as_dvec3()).map(|p| robust::Coord3D { x: p.x, y: p.y, z: p.z });
    // Positive where the winding's normal points away from the point.
    let volume = robust::orient3d(a, b, c, robust::Coord3D { x, y, z });
    if volume < 0.0 { 1 } else { -i32::from(volume > 0.0) }
}

/// 2^500.
const LARGE: f64 = f64::from_bits((1023 + 500) << 52);

/// a + b, rounded, and the rest.
#[inline(always)]
fn add<F: Doubles>(a: F, b: F) -> (F, F) {
    let sum = a.plus(b);
    let of_b = sum.minus(a);
    let of_a = sum.minus(of_b);
    (sum, a.minus(of_a).plus(b.minus(of_b)))
}

/// a - b, rounded, and the rest.
#[inline(always)]
fn difference<F: Doubles>(a: F, b: F) -> (F, F) {
    let difference = a.minus(b);
    let of_b = a.minus(difference);
    let of_a = difference.plus(of_b);
    (difference, a.minus(of_a).plus(of_b.minus(b)))
}

#[cfg(test)]
mod tests {
    use super::super::dyadic::Dyadic;
    use super::super::dyadic::tests::Lcg;
    use super::*;

    /// The sign by whole numbers.
    fn true_side(corners: &[GzCoord; 3], p: [f64; 3]) -> i32 {
        let at = |p: [f64; 3]| p.map(Dyadic::new);
        let a = at(corners[0].as_dvec3().to_array());
        let from_a = |p: [f64; 3]| -> [Dyadic; 3] {
            let p = at(p);
            std::array::from_fn(|k| p[k].minus(&a[k]))
        };
        let [e1, e2] = [corners[1], corners[2]].map(|p| from_a(p.as_dvec3().to_array()));
        let q = from_a(p);
        let part = |i: usize, j: usize| e1[i].times(&e2[j]).minus(&e1[j].times(&e2[i]));
        q[0].times(&part(1, 2)).plus(&q[1].times(&part(2, 0))).plus(&q[2].times(&part(0, 1))).sign()
    }

    #[test]
    fn the_side_of_points_within_a_rounding_of_a_plane_is_that_of_whole_numbers() {
        let (mut lcg, mut settled, mut count) = (Lcg(5), 0, 0);
        for scale in [1.0, 1e-3, 1e4, 1e-20, 1e30] {
            for k in 0..4000 {
                // Every fourth triangle has one coordinate that is tiny beside the others, so that edges round.
                let mut coordinate = || lcg.integer(24) as f32 * scale / 16_777_216.0;
                let mut corners: [GzCoord; 3] = std::array::from_fn(|_| GzCoord::new(coordinate(), coordinate(), coordinate()));
                if k % 4 == 0 {
                    corners[k % 3].x *= 1e-15;
                }
                let [a, b, c] = corners.map(|p| p.as_dvec3());
                let (s, t) = (f64::from(k as u32 % 7) / 8.0, f64::from(k as u32 % 5) / 9.0);
                let mut p = (a + (b - a) * s + (c - a) * t).to_array();
                if k % 3 == 0 {
                    p[k % 2] = p[k % 2].next_up();
                }
                let numbers = corners.map(|p| p.as_dvec3().to_array());
                let plane = Plane::of(&numbers);
                let Bounded { value, error } = plane.height(p);
                let side = true_side(&corners, p);
                if value.abs() > error {
                    assert_eq!(if value > 0.0 { 1 } else { -1 }, side, "{corners:?} {p:?}");
                    settled += 1;
                } else if error == 0.0 {
                    assert_eq!(side, 0, "{corners:?} {p:?}");
                }
                assert_eq!(plane.side(&corners, p), side, "{corners:?} {p:?}");
                count += 1;
            }
        }
        assert_eq!(count, 20_000);
        // Of the rest most have edges that round, others lie in the plane.
        assert!(settled > 12_000, "{settled}");
    }
}
