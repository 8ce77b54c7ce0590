//! Quotients of exact numbers, rounded.

use super::dyadic::Dyadic;
use std::cmp::Ordering;

/// The quotient `m / d` in f64, to a relative error below 2^-50. `d` is not 0. Beyond the range of f64: infinite or 0.
pub(crate) fn quotient_near(m: &Dyadic, d: &Dyadic) -> f64 {
    if m.sign() == 0 {
        return 0.0;
    }
    let ((m_top, m_exp), (d_top, d_exp)) = (m.leading(), d.leading());
    // Both tops are in [2^63, 2^64): cut-off, conversion and division each cost at most 2^-52.
    let quotient = libm::ldexp(m_top as f64 / d_top as f64, m_exp - d_exp);
    if m.sign() == d.sign() { quotient } else { -quotient }
}

/// The quotient `m / d` rounded once to f32: to nearest, ties to even, infinite on overflow. `d` is not 0.
pub(crate) fn quotient_f32(m: &Dyadic, d: &Dyadic) -> f32 {
    if m.sign() == 0 {
        return 0.0;
    }
    let (abs_m, abs_d) = (m.clone().abs(), d.clone().abs());
    let mut nearest = quotient_near(&abs_m, &abs_d) as f32;
    // The guess is at most one step away; each pass of a loop compares exactly with the boundary to the next number.
    while nearest != f32::INFINITY && beyond(&abs_m, &abs_d, nearest, nearest.next_up()) {
        nearest = nearest.next_up();
    }
    while nearest != 0.0 && !beyond(&abs_m, &abs_d, nearest.next_down(), nearest) {
        nearest = nearest.next_down();
    }
    if m.sign() == d.sign() { nearest } else { -nearest }
}

/// Whether `m / d` rounds to `upper` rather than to `lower`, two neighbouring f32 numbers, `m` and `d` positive.
fn beyond(m: &Dyadic, d: &Dyadic, lower: f32, upper: f32) -> bool {
    // Halfway to infinity counts as halfway to 2^128. Both ends have 24 bits, so their mean is exact in f64.
    let upper_value = if upper == f32::INFINITY { 2.0 * f64::from(2f32.powi(127)) } else { f64::from(upper) };
    let boundary = Dyadic::new((f64::from(lower) + upper_value) / 2.0);
    match m.order(&boundary.times(d)) {
        Ordering::Less => false,
        Ordering::Greater => true,
        Ordering::Equal => upper.to_bits() & 1 == 0,
    }
}

#[cfg(test)]
mod tests {
    use super::super::dyadic::tests::Lcg;
    use super::*;

    fn d(x: f64) -> Dyadic {
        Dyadic::new(x)
    }

    #[test]
    fn quotients_round_like_f64_division_where_that_is_exact_enough() {
        let mut lcg = Lcg(2);
        for _ in 0..20_000 {
            let (m, q) = (lcg.integer(24), lcg.integer(24));
            if q == 0 {
                continue;
            }
            // A quotient of two 24-bit integers is never within 2^-49 of a rounding boundary unless it is on one, so rounding
            // twice is rounding once.
            assert_eq!(quotient_f32(&d(m as f64), &d(q as f64)), (m as f64 / q as f64) as f32, "{m} / {q}");
        }
    }

    #[test]
    fn quotients_round_to_nearest_even_at_every_kind_of_boundary() {
        let ulp = f64::from(f32::EPSILON);
        let tiny = d(2f64.powi(-300));
        let half_way = d(1.0 + ulp / 2.0);
        assert_eq!(quotient_f32(&half_way, &d(1.0)), 1.0);
        assert_eq!(quotient_f32(&half_way.plus(&tiny), &d(1.0)), 1.0f32.next_up());
        assert_eq!(quotient_f32(&d(1.0 + 1.5 * ulp), &d(1.0)), 1.0f32.next_up().next_up());
        assert_eq!(quotient_f32(&d(1.0 + 1.5 * ulp).minus(&tiny), &d(1.0)), 1.0f32.next_up());
        assert_eq!(quotient_f32(&half_way.plus(&tiny).negated(), &d(1.0)), -1.0f32.next_up());
        let top = 2.0 * f64::from(2f32.powi(127));
        let overflow = d(top - 2f64.powi(103));
        assert_eq!(quotient_f32(&overflow, &d(1.0)), f32::INFINITY);
        assert_eq!(quotient_f32(&overflow.minus(&tiny), &d(1.0)), f32::MAX);
        assert_eq!(quotient_f32(&d(2f64.powi(200)), &d(2f64.powi(-200))), f32::INFINITY);
        assert_eq!(quotient_f32(&d(2f64.powi(-150)), &d(1.0)), 0.0);
        assert_eq!(quotient_f32(&d(2f64.powi(-150)).plus(&tiny), &d(1.0)), f32::from_bits(1));
        assert_eq!(quotient_f32(&d(2f64.powi(-600)), &d(2f64.powi(600))), 0.0);
        assert_eq!(quotient_near(&d(0.0), &d(-3.0)), 0.0);
        assert!((quotient_near(&d(-1.0), &d(3.0)) + 1.0 / 3.0).abs() < 1e-15);
    }
}
