//! Fractions of integers of any length, and their rounding to floating point.

use super::interval::Interval;
use dashu_int::IBig;
use dashu_int::ops::{Abs, BitTest, DivRem, UnsignedAbs};
use std::cmp::Ordering;

/// `numerator / denominator * 2^exponent` with a denominator above 0.
#[derive(Clone, Debug)]
pub struct Fraction {
    numerator: IBig,
    denominator: IBig,
    exponent: i32,
}

impl Fraction {
    /// The fraction of these parts; `denominator` is not 0.
    pub(super) fn new(numerator: IBig, denominator: IBig, exponent: i32) -> Self {
        debug_assert!(denominator != IBig::ZERO);
        match denominator < IBig::ZERO {
            true => Self { numerator: -numerator, denominator: -denominator, exponent },
            false => Self { numerator, denominator, exponent },
        }
    }

    /// The number that an f64 stands for. It is finite.
    pub fn of(x: f64) -> Self {
        let (numerator, exponent) = parts(x);
        Self { numerator: numerator.into(), denominator: IBig::ONE, exponent }
    }

    /// -1, 0 or 1.
    pub fn sign(&self) -> i32 {
        match self.numerator.cmp(&IBig::ZERO) {
            Ordering::Less => -1,
            Ordering::Equal => 0,
            Ordering::Greater => 1,
        }
    }

    /// The order to a number that is not NaN.
    pub fn cmp_number(&self, x: f64) -> Ordering {
        if x.is_infinite() {
            return if x > 0.0 { Ordering::Less } else { Ordering::Greater };
        }
        self.cmp(&Self::of(x))
    }

    /// The same with the other sign.
    #[must_use]
    pub fn negated(&self) -> Self {
        Self { numerator: -self.numerator.clone(), ..self.clone() }
    }

    /// The difference to a finite number.
    #[must_use]
    pub fn minus(&self, x: f64) -> Self {
        let (m, e) = parts(x);
        let exponent = self.exponent.min(e);
        let up = |n: IBig, from: i32| n << (from - exponent) as usize;
        let numerator = up(self.numerator.clone(), self.exponent) - up(IBig::from(m), e) * &self.denominator;
        Self { numerator, denominator: self.denominator.clone(), exponent }
    }

    /// Rounded once to f32: to nearest, ties to even, infinite beyond the range. A 0 has no sign, a negative number that rounds to 0
    /// keeps its.
    pub fn to_f32(&self) -> f32 {
        let (mantissa, exponent) = self.rounded(24, -149);
        // At most 2^24 times a power of two of at least 2^-149: exact in f64, and in f32 unless it is beyond the range.
        let x = (mantissa as f64 * power(exponent.min(200))) as f32;
        if self.sign() < 0 { -x } else { x }
    }

    /// Rounded once to f64, for numbers within its normal range.
    pub fn to_f64(&self) -> f64 {
        let (mantissa, exponent) = self.rounded(53, -1074);
        let half = exponent.clamp(-1000, 1000) / 2;
        let x = mantissa as f64 * power(half) * power(exponent.clamp(-1000, 1000) - half);
        if self.sign() < 0 { -x } else { x }
    }

    /// An interval that holds it.
    pub(super) fn near(&self) -> Interval {
        let x = self.to_f64();
        Interval { lo: x.next_down(), hi: x.next_up() }
    }

    /// The magnitude as `mantissa * 2^exponent` with at most `bits` bits, ties to even, `exponent` at least `least`.
    fn rounded(&self, bits: usize, least: i32) -> (u64, i32) {
        if self.sign() == 0 {
            return (0, least);
        }
        let (n, d) = ((&self.numerator).abs(), &self.denominator);
        // The quotient lies between 2^(length - 1) and 2^(length + 1).
        let length = bit_len(&n) as i32 - bit_len(d) as i32 + self.exponent;
        let mut exponent = (length - bits as i32).max(least);
        loop {
            let shift = self.exponent - exponent;
            let (n, d) = if shift >= 0 { (&n << shift as usize, d.clone()) } else { (n.clone(), d << -shift as usize) };
            let (quotient, rest) = n.div_rem(&d);
            if bit_len(&quotient) > bits {
                exponent += 1;
                continue;
            }
            let quotient = u64::try_from(&quotient).unwrap_or_else(|_| unreachable!("{bits} bits fit"));
            let up = match (rest << 1usize).cmp(&d) {
                Ordering::Less => 0,
                Ordering::Equal => quotient & 1,
                Ordering::Greater => 1,
            };
            return (quotient + up, exponent);
        }
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Fraction {}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        let (left, right) = (&self.numerator * &other.denominator, &other.numerator * &self.denominator);
        match self.exponent - other.exponent {
            up if up >= 0 => (left << up as usize).cmp(&right),
            down => left.cmp(&(right << -down as usize)),
        }
    }
}

/// A finite number as an odd integer, or 0, times a power of two.
pub(super) fn parts(x: f64) -> (i64, i32) {
    debug_assert!(x.is_finite());
    let bits = x.to_bits();
    let (field, fraction) = ((bits >> 52 & 0x7ff) as i32, (bits & ((1 << 52) - 1)) as i64);
    let (magnitude, exponent) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    if magnitude == 0 {
        return (0, 0);
    }
    let zeros = magnitude.trailing_zeros();
    let odd = magnitude >> zeros;
    (if x < 0.0 { -odd } else { odd }, exponent + zeros as i32)
}

fn bit_len(x: &IBig) -> usize {
    x.unsigned_abs().bit_len()
}

/// 2^k for k from -1022 to 1023.
fn power(k: i32) -> f64 {
    f64::from_bits(((1023 + k) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fraction(n: i64, d: i64, exponent: i32) -> Fraction {
        Fraction::new(n.into(), d.into(), exponent)
    }

    #[test]
    fn numbers_come_apart_into_odd_integers_and_powers_of_two() {
        assert_eq!((parts(0.0), parts(-0.0), parts(1.0), parts(-12.0)), ((0, 0), (0, 0), (1, 0), (-3, 2)));
        assert_eq!((parts(f64::from_bits(1)), parts(f64::MIN_POSITIVE)), ((1, -1074), (1, -1022)));
        assert_eq!(parts(f64::from(f32::from_bits(3))), (3, -149));
        for x in [0.1, -1e300, 3e-320, 123_456.789] {
            assert_eq!(Fraction::of(x).cmp_number(x), Ordering::Equal);
            assert_eq!(Fraction::of(x).cmp_number(x.next_up()), Ordering::Less);
        }
        assert_eq!(Fraction::of(0.1).to_f64().to_bits(), 0.1f64.to_bits());
    }

    #[test]
    fn rounding_is_to_nearest_with_ties_to_even() {
        // 2^24 + 1 lies between two f32 numbers, the even one is below; 2^24 + 3 has it above.
        assert_eq!(fraction((1 << 24) + 1, 1, 0).to_f32(), 16_777_216.0);
        assert_eq!(fraction((1 << 24) + 3, 1, 0).to_f32(), 16_777_220.0);
        // A hair beyond the tie goes up.
        assert_eq!(fraction(3 * ((1 << 24) + 1) + 1, 3, 0).to_f32(), 16_777_218.0);
        assert_eq!(fraction(1, 3, 0).to_f32(), 1.0 / 3.0);
        assert_eq!(fraction(-2, 3, 0).to_f32(), -2.0 / 3.0);
        assert_eq!(fraction(1, -3, 1).to_f32(), -2.0 / 3.0);
        assert_eq!(fraction(1, 3, 0).to_f64(), 1.0 / 3.0);
        assert_eq!(fraction(-22, 7, -40).to_f64(), -22.0 / 7.0 / 2f64.powi(40));
    }

    #[test]
    fn the_ends_of_the_range_round_as_ieee_says() {
        assert_eq!(fraction(1, 1, 128).to_f32(), f32::INFINITY);
        assert_eq!(fraction(-1, 1, 5000).to_f32(), f32::NEG_INFINITY);
        // Halfway between the greatest number and 2^128 is infinite, anything less is not.
        assert_eq!(fraction((1 << 25) - 1, 1, 103).to_f32(), f32::INFINITY);
        assert_eq!(fraction(3 * ((1 << 25) - 1) - 1, 3, 103).to_f32(), f32::MAX);
        assert_eq!(fraction(1, 1, -149).to_f32(), f32::from_bits(1));
        assert_eq!(fraction(1, 1, -150).to_f32().to_bits(), 0);
        assert_eq!(fraction(-1, 1, -150).to_f32().to_bits(), (-0.0f32).to_bits());
        assert_eq!(fraction(3, 1, -151).to_f32(), f32::from_bits(1));
        assert_eq!(fraction(3, 1, -150).to_f32(), f32::from_bits(2));
        assert_eq!(fraction(0, -7, 3).to_f32().to_bits(), 0);
    }

    #[test]
    fn order_and_differences_are_exact() {
        assert!(fraction(1, 3, 0) < fraction(333_334, 1_000_000, 0) && fraction(1, 3, 0) > fraction(333_333, 1_000_000, 0));
        assert_eq!(fraction(2, 6, 0), fraction(4, 3, -2));
        assert!(fraction(-1, 3, 100) < fraction(-1, 3, 99) && fraction(1, 3, 0).cmp_number(f64::INFINITY) == Ordering::Less);
        assert_eq!(fraction(7, 2, 0).minus(0.5), fraction(3, 1, 0));
        assert_eq!(fraction(1, 3, 0).minus(1.0 / 3.0).sign(), 1);
        assert_eq!(fraction(0, 5, 0).minus(-1e-300).sign(), 1);
    }

    #[test]
    fn rounding_agrees_with_f64_division_wherever_that_decides() {
        // A quotient of two 24-bit integers is never within 2^-49 of a boundary of f32 unless it lies on it, so that rounding twice, to
        // f64 and then to f32, is rounding once.
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as i64 - (1 << 23)
        };
        for _ in 0..20_000 {
            let (n, d) = (next(), next());
            if d != 0 {
                assert_eq!(fraction(n, d, 0).to_f32(), (n as f64 / d as f64) as f32, "{n} / {d}");
                assert_eq!(fraction(n, d, 0).to_f64(), n as f64 / d as f64, "{n} / {d}");
            }
        }
    }
}
