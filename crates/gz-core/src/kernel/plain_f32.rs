//! The kernels without their proof, to be measured against: what exactness costs is the time of the certified kernels over that of these.
//!
//! The walk and the arithmetic are the same; left out are bounds, intervals of t, f64 and the exact stage, and answers are formed in f32
//! from rounded origins. That is the test of Möller and Trumbore as `moeller_trumbore.rs` has it, for many rays and triangles at a time.

use super::answer::{corners_of, write_hits};
use super::group::{cross, dot, minus3};
use crate::simd::{Lanes, Simd, Task, splat3};
use crate::{GzCoord, Hit, TriId};
use std::marker::PhantomData;

/// A task done without proof: answers may be wrong.
///
/// Two hits of a single ray at equal t are put in order exactly all the same: that is rare, and costs nothing where it does not happen.
pub struct InPlainF32<T>(pub T);

impl<T: Task> Task for InPlainF32<T> {
    type Output = T::Output;

    #[inline(always)]
    fn run<S: Simd>(self) -> T::Output {
        self.0.run::<PlainF32<S>>()
    }
}

/// The instructions of `S`, for answers that are not proved.
struct PlainF32<S>(PhantomData<S>);

impl<S: Simd> Simd for PlainF32<S> {
    const CERTIFIED: bool = false;

    type Doubles = S::Doubles;
    type Eight = S::Eight;
    type Sixteen = S::Sixteen;

    #[inline(always)]
    fn apart<T: Task>(task: T) -> T::Output {
        S::apart(InPlainF32(task))
    }

    #[inline(always)]
    fn join(low: S::Eight, high: S::Eight) -> S::Sixteen {
        S::join(low, high)
    }

    #[inline(always)]
    fn widen(x: S::Eight) -> S::Doubles {
        S::widen(x)
    }

    #[inline(always)]
    fn corners(corners: &[&[f32; 9]; 8]) -> [S::Eight; 9] {
        S::corners(corners)
    }

    #[inline(always)]
    fn narrow(x: S::Doubles) -> S::Eight {
        S::narrow(x)
    }

    #[inline(always)]
    fn write_hits(rows: [S::Eight; 4], hits: &mut [Hit; 8]) {
        S::write_hits(rows, hits);
    }

    #[inline(always)]
    fn prefetch<T>(what: &T) {
        S::prefetch(what);
    }
}

/// t = `m` / `d`, whatever it is.
#[inline(always)]
pub(super) fn plain_distance<const N: usize, L: Lanes<N>>(m: L, d: L) -> L {
    m.times(L::splat(1.0).over(d))
}

/// Hits of eight rays, given in coordinates stretched by `scale`, with the triangles that they are taken to hit.
#[inline(always)]
pub(super) fn plain_hits<S: Simd>(
    origin: [&[f32; 8]; 3],
    direction: [&[f32; 8]; 3],
    scale: [f32; 3],
    corners: &[&[GzCoord; 3]; 8],
    hit: u32,
    ids: &[TriId; 8],
    hits: &mut [Hit],
) {
    let back = splat3::<8, S::Eight>(scale.map(f32::recip));
    let (o, d) = (of_rows::<S>(origin, back), of_rows::<S>(direction, back));
    let [a, b, c] = corners_of::<S>(corners);
    let (e1, e2, s) = (minus3(b, a), minus3(c, a), minus3(o, a));
    let (p, q) = (cross(d, e2), cross(s, e1));
    let inverse = <S::Eight>::splat(1.0).over(dot(e1, p));
    let t_u_v = [dot(e2, q).times(inverse), dot(s, p).times(inverse), dot(d, q).times(inverse)];
    write_hits::<S>(hit, ids, t_u_v, hits);
}

#[inline(always)]
fn of_rows<S: Simd>(rows: [&[f32; 8]; 3], factor: [S::Eight; 3]) -> [S::Eight; 3] {
    [
        <S::Eight>::load(rows[0]).times(factor[0]),
        <S::Eight>::load(rows[1]).times(factor[1]),
        <S::Eight>::load(rows[2]).times(factor[2]),
    ]
}
