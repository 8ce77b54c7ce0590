//! Intervals of f64 that hold a number, their ends rounded outward after each operation.

use std::ops::{Add, Mul, Sub};

/// `lo <= x <= hi` for the number x that it stands for; ends may be infinite, never NaN for the numbers that occur here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub(super) lo: f64,
    pub(super) hi: f64,
}

impl Interval {
    /// A number that f64 holds.
    pub(super) fn point(x: f64) -> Self {
        Self { lo: x, hi: x }
    }

    /// `a - b` of two numbers that f64 holds: no wider than a point when nothing is rounded.
    pub(super) fn difference(a: f64, b: f64) -> Self {
        let x = a - b;
        // Knuth's two-sum: what was lost, exactly. It is 0 for most f32 coordinates.
        let back = x + b;
        let lost = (a - back) + ((back - x) - b);
        if lost == 0.0 { Self::point(x) } else { Self::outward(x, x) }
    }

    /// The interval whose ends were each rounded to the nearest f64.
    fn outward(lo: f64, hi: f64) -> Self {
        Self { lo: lo.next_down(), hi: hi.next_up() }
    }

    /// The quotient; `divisor` does not hold 0.
    pub(super) fn divided_by(self, divisor: Self) -> Self {
        debug_assert!(divisor.is_positive() || divisor.is_negative());
        Self::around([self.lo / divisor.lo, self.lo / divisor.hi, self.hi / divisor.lo, self.hi / divisor.hi])
    }

    fn around(ends: [f64; 4]) -> Self {
        let [a, b, c, d] = ends;
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }

    /// Surely above 0.
    pub(super) fn is_positive(self) -> bool {
        self.lo > 0.0
    }

    /// Surely below 0.
    pub(super) fn is_negative(self) -> bool {
        self.hi < 0.0
    }

    /// The number rounded to f32, when both ends round alike. Bits are compared, so that 0 and -0 differ.
    pub(super) fn rounded(self) -> Option<f32> {
        let (lo, hi) = (self.lo as f32, self.hi as f32);
        (lo.to_bits() == hi.to_bits()).then_some(lo)
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::outward(self.lo + other.lo, self.hi + other.hi)
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::outward(self.lo - other.hi, self.hi - other.lo)
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self::around([self.lo * other.lo, self.lo * other.hi, self.hi * other.lo, self.hi * other.hi])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_lie_between_the_ends() {
        let (third, tenth) = (Interval::point(1.0).divided_by(Interval::point(3.0)), Interval::point(0.1));
        assert!(third.lo < third.hi && third.lo <= 1.0 / 3.0 && 1.0 / 3.0 <= third.hi);
        // A tenth and 0.3 are rounded themselves: their difference may be 0 as far as intervals can tell, ten times it plus a bit is not.
        let rest = tenth + tenth + tenth - Interval::point(0.3);
        assert!(!rest.is_positive() && !rest.is_negative() && rest.lo < 0.0 && rest.hi > 0.0);
        assert!((rest + Interval::point(1e-15)).is_positive() && (rest - Interval::point(1e-15)).is_negative());
        let product = Interval { lo: -1.0, hi: 2.0 } * Interval { lo: -3.0, hi: 5.0 };
        assert!(product.lo <= -6.0 && product.lo > -6.1 && product.hi >= 10.0 && product.hi < 10.1);
        let product = Interval { lo: -1.0, hi: -0.5 } * Interval { lo: 2.0, hi: 4.0 };
        assert!(product.is_negative() && product.lo <= -4.0 && product.hi >= -1.0);
    }

    #[test]
    fn a_difference_is_a_point_only_when_it_is_exact() {
        assert_eq!(Interval::difference(0.3, 0.1f32.into()).lo, Interval::difference(0.3, 0.1f32.into()).hi);
        let rounded = Interval::difference(1.0, 1e-30);
        assert!(rounded.lo < 1.0 && rounded.hi > 1.0);
        assert_eq!(Interval::difference(-0.0, 0.0), Interval::point(0.0));
    }

    #[test]
    fn a_number_that_could_round_two_ways_is_not_rounded() {
        let boundary = 1.0 + f64::from(f32::EPSILON) / 2.0;
        assert_eq!(Interval { lo: boundary, hi: boundary }.rounded(), Some(1.0));
        assert_eq!(Interval { lo: boundary, hi: boundary.next_up() }.rounded(), None);
        assert_eq!(Interval { lo: -1e-60, hi: 1e-60 }.rounded(), None);
        assert_eq!(Interval { lo: 1e39, hi: 1e40 }.rounded(), Some(f32::INFINITY));
    }
}
