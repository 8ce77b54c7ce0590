//! Numbers and vectors of eight hits side by side.
//!
//! Rows hold one number of each hit, lane `i` for hit `i`; bits tell lanes, bit `i` for hit `i`. Operations round as those of one hit do and
//! come in the same order, so that eight hits at a time give the bits of one at a time.

use glam::DVec3;
use gz_core::GzCoord;
use gz_core::simd::{Doubles, EightDoubles, Simd};

/// Eight vectors: a row for each axis.
pub(crate) type Rows = [[f64; 8]; 3];

/// The lanes whose bits are set.
pub(crate) fn lanes(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (bits != 0).then_some(bits.trailing_zeros() as usize);
        bits &= bits.wrapping_sub(1);
        lane
    })
}

/// The vector of lane `k`.
pub(crate) fn vector(rows: &Rows, k: usize) -> DVec3 {
    DVec3::new(rows[0][k], rows[1][k], rows[2][k])
}

/// The vector of lane `k`.
pub(crate) fn coord(rows: &[[f32; 8]; 3], k: usize) -> GzCoord {
    GzCoord::new(rows[0][k], rows[1][k], rows[2][k])
}

/// Makes `v` the vector of lane `k`.
pub(crate) fn set(rows: &mut Rows, k: usize, v: DVec3) {
    (rows[0][k], rows[1][k], rows[2][k]) = (v.x, v.y, v.z);
}

#[inline(always)]
pub(crate) fn load<D: EightDoubles>(rows: &Rows) -> [D; 3] {
    [D::load(&rows[0]), D::load(&rows[1]), D::load(&rows[2])]
}

#[inline(always)]
pub(crate) fn arrays<D: EightDoubles>(v: &[D; 3]) -> Rows {
    [v[0].array(), v[1].array(), v[2].array()]
}

#[inline(always)]
pub(crate) fn widen<S: Simd>(v: &[S::Eight; 3]) -> [S::Doubles; 3] {
    [S::widen(v[0]), S::widen(v[1]), S::widen(v[2])]
}

#[inline(always)]
pub(crate) fn narrow<S: Simd>(v: &[S::Doubles; 3]) -> [S::Eight; 3] {
    [S::narrow(v[0]), S::narrow(v[1]), S::narrow(v[2])]
}

#[inline(always)]
pub(crate) fn dot<D: Doubles>(a: &[D; 3], b: &[D; 3]) -> D {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

#[inline(always)]
pub(crate) fn plus<D: Doubles>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    [a[0].plus(b[0]), a[1].plus(b[1]), a[2].plus(b[2])]
}

#[inline(always)]
pub(crate) fn minus<D: Doubles>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    [a[0].minus(b[0]), a[1].minus(b[1]), a[2].minus(b[2])]
}

#[inline(always)]
pub(crate) fn times<D: Doubles>(v: &[D; 3], factor: D) -> [D; 3] {
    [v[0].times(factor), v[1].times(factor), v[2].times(factor)]
}

/// `a` where the bit is set, `b` elsewhere.
#[inline(always)]
pub(crate) fn select<D: EightDoubles>(a: &[D; 3], bits: u32, b: &[D; 3]) -> [D; 3] {
    [a[0].select(bits, b[0]), a[1].select(bits, b[1]), a[2].select(bits, b[2])]
}

/// 1 where the bit is set, -1 elsewhere.
#[inline(always)]
pub(crate) fn signs<D: EightDoubles>(bits: u32) -> D {
    D::splat(1.0).select(bits, D::splat(-1.0))
}

/// Where `x` is above `y`; clear for NaN.
#[inline(always)]
pub(crate) fn above<D: EightDoubles>(x: D, y: D) -> u32 {
    y.at_most(x) & !x.at_most(y)
}

/// `x` brought to 0 to 1; 0 for NaN.
#[inline(always)]
pub(crate) fn unit_range<D: Doubles>(x: D) -> D {
    x.or_more(D::splat(0.0)).or_less(D::splat(1.0))
}
