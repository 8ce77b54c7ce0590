//! f64 numbers that round alike everywhere: one, or eight side by side.

use super::lanes::columns;

/// One f64 or several side by side: the operations that round alike everywhere, so that answers may depend on them to the bit.
pub trait Doubles: Copy {
    /// `self + other`.
    fn plus(self, other: Self) -> Self;
    /// `self - other`.
    fn minus(self, other: Self) -> Self;
    /// `self * other`.
    fn times(self, other: Self) -> Self;
    /// `self / other`.
    fn over(self, other: Self) -> Self;
    /// `self` without its sign.
    fn abs(self) -> Self;
    /// `x` everywhere.
    fn splat(x: f64) -> Self;
    /// `self` where it is above `other`, else `other`.
    fn or_more(self, other: Self) -> Self;
    /// `self` where it is below `other`, else `other`.
    fn or_less(self, other: Self) -> Self;
    /// The square root, rounded once.
    fn sqrt(self) -> Self;
    /// `self * other - product` for their rounded `product`: a number of f64 again, hence exact. Neither is above 2^900 or, but for 0, so
    /// small that a part of the product lies below 2^-1000.
    fn product_error(self, other: Self, product: Self) -> Self;
}

/// Eight [`Doubles`].
pub trait EightDoubles: Doubles {
    /// Lane `i` is `x[i]`.
    fn load(x: &[f64; 8]) -> Self;
    /// Lane `i` is `x[i]`, widened.
    fn widen(x: &[f32; 8]) -> Self;
    /// Lane `i` is `x[places[i]]`, places counted from 0 again after 7.
    fn pick(x: &[f64; 8], places: &[u32; 8]) -> Self;
    /// The lanes as an array.
    fn array(self) -> [f64; 8];
    /// Where `self` is at most `other`; clear for NaN.
    fn at_most(self, other: Self) -> u32;
    /// `self` where the bit is set, `other` elsewhere.
    fn select(self, bits: u32, other: Self) -> Self;

    /// The coordinates of points: lane `i` of result `k` is `points[i][k]`.
    #[inline(always)]
    fn unzip3(points: &[[f64; 3]; 8]) -> [Self; 3] {
        let [x, y, z] = &columns(points);
        [Self::load(x), Self::load(y), Self::load(z)]
    }
}

impl Doubles for f64 {
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self - other
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        self * other
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        self / other
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn splat(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn or_more(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn or_less(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn product_error(self, other: Self, product: Self) -> Self {
        // T. J. Dekker 1971: halves of 26 bits have products without rounding. A fused multiply-add would do, but is a call where the build
        // target does not promise one.
        let ((a, a_low), (b, b_low)) = (in_halves(self), in_halves(other));
        a * b - product + a * b_low + a_low * b + a_low * b_low
    }
}

/// The upper half of a number's bits and the rest.
#[inline(always)]
fn in_halves(x: f64) -> (f64, f64) {
    /// 2^27 + 1.
    const SPLITTER: f64 = 134_217_729.0;
    let scaled = SPLITTER * x;
    let upper = scaled - (scaled - x);
    (upper, x - upper)
}
