//! Exact arithmetic on binary fractions: integers times a power of two.

use std::cmp::Ordering;

/// Limbs of 64 bits at most. The largest number that an exact stage forms is a product M1 D2 to compare two T-values:
/// origins are multiples of 2^-202 below 2^129 and vertices and directions are f32, so a difference has at most 331 bits, M at most
/// 996, D at most 944 and M1 D2 at most 1940; aligning two of them adds less than one limb each.
const MOST: usize = 34;

/// Limbs kept without allocating: enough for all but extreme ranges.
const FEW: usize = 9;

/// The exact number `(-1)^negative * limbs * 2^exponent`.
///
/// Every finite f64 is one, and sums and products of the sizes that ray and triangle produce fit; see [`MOST`].
#[derive(Clone, Debug)]
pub(crate) struct Dyadic {
    negative: bool,
    exponent: i32,
    /// Limbs in use; the uppermost is not 0. 0 for the number 0.
    len: usize,
    limbs: Limbs,
}

/// Room for limbs; those above the ones in use are 0.
#[derive(Clone, Debug)]
enum Limbs {
    Few([u64; FEW]),
    Many(Box<[u64; MOST]>),
}

impl Limbs {
    /// Zeros, with room for `len`.
    fn room_for(len: usize) -> Self {
        if len <= FEW {
            Self::Few([0; FEW])
        } else {
            debug_assert!(len <= MOST, "numbers of this size do not occur");
            Self::Many(Box::new([0; MOST]))
        }
    }

    fn all(&self) -> &[u64] {
        match self {
            Self::Few(limbs) => limbs,
            Self::Many(limbs) => &limbs[..],
        }
    }

    fn all_mut(&mut self) -> &mut [u64] {
        match self {
            Self::Few(limbs) => limbs,
            Self::Many(limbs) => &mut limbs[..],
        }
    }
}

impl Dyadic {
    pub(crate) const ZERO: Self = Self { negative: false, exponent: 0, len: 0, limbs: Limbs::Few([0; FEW]) };

    /// The value of a finite `x`, exactly.
    pub(crate) fn new(x: f64) -> Self {
        debug_assert!(x.is_finite(), "only finite numbers are binary fractions");
        let bits = x.to_bits();
        let (fraction, biased) = (bits & ((1 << 52) - 1), ((bits >> 52) & 0x7ff) as i32);
        let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        if mantissa == 0 {
            return Self::ZERO;
        }
        // Odd mantissas keep products short: most coordinates have few bits.
        let zeros = mantissa.trailing_zeros();
        let mut limbs = [0; FEW];
        limbs[0] = mantissa >> zeros;
        Self { negative: x < 0.0, exponent: exponent + zeros as i32, len: 1, limbs: Limbs::Few(limbs) }
    }

    fn limbs(&self) -> &[u64] {
        &self.limbs.all()[..self.len]
    }

    /// -1, 0 or 1.
    pub(crate) fn sign(&self) -> i32 {
        match (self.len, self.negative) {
            (0, _) => 0,
            (_, true) => -1,
            (_, false) => 1,
        }
    }

    pub(crate) fn negated(mut self) -> Self {
        self.negative = !self.negative;
        self
    }

    pub(crate) fn abs(mut self) -> Self {
        self.negative = false;
        self
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        let room = self.len + other.len;
        if self.len == 0 || other.len == 0 {
            return Self::ZERO;
        }
        let mut limbs = Limbs::room_for(room);
        let out = limbs.all_mut();
        for (i, &a) in self.limbs().iter().enumerate() {
            let mut carry = 0u128;
            for (j, &b) in other.limbs().iter().enumerate() {
                let sum = u128::from(a) * u128::from(b) + u128::from(out[i + j]) + carry;
                out[i + j] = sum as u64;
                carry = sum >> 64;
            }
            out[i + other.len] = carry as u64;
        }
        let len = used(out, room);
        Self { negative: self.negative != other.negative, exponent: self.exponent + other.exponent, len, limbs }
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        self.sum(other, other.negative)
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        self.sum(other, !other.negative)
    }

    /// The sum with what has the magnitude of `other` and this sign.
    fn sum(&self, other: &Self, negative: bool) -> Self {
        if self.len == 0 {
            return Self { negative, ..other.clone() };
        }
        if other.len == 0 {
            return self.clone();
        }
        // The number with the higher exponent is shifted left, with room for a carry, and the other is added or taken away in place.
        let swapped = self.exponent < other.exponent;
        let (high, low) = if swapped { (other, self) } else { (self, other) };
        let (mut sum, room) = high.shifted_to(low.exponent, low.len);
        let out = &mut sum.limbs.all_mut()[..room];
        let (sign, other_sign) = if swapped { (negative, self.negative) } else { (self.negative, negative) };
        sum.negative = sign;
        if sign == other_sign {
            add(out, low.limbs());
        } else if take_away(out, low.limbs()) {
            // What was taken away was the larger: the difference came out as its complement.
            negate(out);
            sum.negative = other_sign;
        }
        sum.len = used(out, room);
        if sum.len == 0 { Self::ZERO } else { sum }
    }

    /// The order of two numbers.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        self.minus(other).sign().cmp(&0)
    }

    /// The same number with a lower `exponent`, and room for at least `other` limbs and a carry: so many limbs are to be worked on.
    fn shifted_to(&self, exponent: i32, other: usize) -> (Self, usize) {
        let by = (self.exponent - exponent) as usize;
        let (whole, bits) = (by / 64, by % 64);
        let room = (self.len + whole + 1).max(other) + 1;
        let mut limbs = Limbs::room_for(room);
        let out = limbs.all_mut();
        for (i, &x) in self.limbs().iter().enumerate() {
            out[i + whole] |= x << bits;
            if bits != 0 {
                out[i + whole + 1] = x >> (64 - bits);
            }
        }
        (Self { negative: self.negative, exponent, len: room, limbs }, room)
    }

    /// The uppermost 64 bits as an integer, and the power of two to multiply it with. Cut off, not rounded.
    pub(super) fn leading(&self) -> (u64, i32) {
        let limbs = self.limbs();
        let top = limbs[self.len - 1];
        let free = top.leading_zeros();
        let below = if self.len > 1 && free > 0 { limbs[self.len - 2] >> (64 - free) } else { 0 };
        ((top << free) | below, self.exponent + 64 * (self.len as i32 - 1) - free as i32)
    }
}

/// Limbs in use among the first `len`.
fn used(limbs: &[u64], mut len: usize) -> usize {
    while len > 0 && limbs[len - 1] == 0 {
        len -= 1;
    }
    len
}

/// `a += b`; `a` has room for the carry.
fn add(a: &mut [u64], b: &[u64]) {
    let mut carry = false;
    for (i, x) in a.iter_mut().enumerate() {
        if i >= b.len() && !carry {
            break;
        }
        let (sum, c1) = x.overflowing_add(b.get(i).copied().unwrap_or(0));
        let (sum, c2) = sum.overflowing_add(u64::from(carry));
        *x = sum;
        carry = c1 || c2;
    }
}

/// `a -= b`, modulo the room of `a`; whether `b` was larger.
fn take_away(a: &mut [u64], b: &[u64]) -> bool {
    let mut borrow = false;
    for (i, x) in a.iter_mut().enumerate() {
        if i >= b.len() && !borrow {
            break;
        }
        let (difference, b1) = x.overflowing_sub(b.get(i).copied().unwrap_or(0));
        let (difference, b2) = difference.overflowing_sub(u64::from(borrow));
        *x = difference;
        borrow = b1 || b2;
    }
    borrow
}

/// `a = -a`, modulo the room of `a`.
fn negate(a: &mut [u64]) {
    let mut carry = true;
    for x in a {
        (*x, carry) = (!*x).overflowing_add(u64::from(carry));
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    fn d(x: f64) -> Dyadic {
        Dyadic::new(x)
    }

    /// A small generator, so that the figures below are the same on every run.
    pub(in crate::kernel) struct Lcg(pub(in crate::kernel) u64);

    impl Lcg {
        fn next(&mut self) -> u64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            self.0 >> 11
        }

        pub(in crate::kernel) fn integer(&mut self, bits: u32) -> i64 {
            (self.next() as i64 & ((1 << bits) - 1)) - (1 << (bits - 1))
        }
    }

    #[test]
    fn sums_and_products_equal_those_of_integers() {
        let mut lcg = Lcg(1);
        for _ in 0..20_000 {
            let [a, b, c] = [50, 50, 25].map(|bits| lcg.integer(bits));
            let shift = (lcg.next() % 20) as i32;
            // (a 2^shift + b) c against the same in i128.
            let ours = d(a as f64 * 2f64.powi(shift)).plus(&d(b as f64)).times(&d(c as f64));
            let theirs = ((i128::from(a) << shift) + i128::from(b)) * i128::from(c);
            let (high, low) = (theirs >> 50, theirs & ((1 << 50) - 1));
            let theirs_exact = d(high as f64).times(&d(2f64.powi(50))).plus(&d(low as f64));
            assert_eq!(ours.order(&theirs_exact), Ordering::Equal, "{a} {b} {c} {shift}");
            assert_eq!(ours.sign(), theirs.signum() as i32);
        }
    }

    #[test]
    fn the_widest_sum_keeps_its_last_bit() {
        let (large, small) = (d(2f64.powi(129)), d(2f64.powi(-202)));
        let sum = large.plus(&small);
        assert_eq!(sum.minus(&large).order(&small), Ordering::Equal);
        // And the widest product M1 D2.
        let cube = sum.times(&sum).times(&sum);
        let six = cube.times(&cube);
        assert_eq!(six.minus(&six).sign(), 0);
        assert_eq!(six.order(&six.plus(&d(2f64.powi(-1000)))), Ordering::Less);
    }
}
