//! Where rays leave a triangle, for one point or eight; after the scheme of NUMERICS 4.4: pull in, form the point, step until the side is
//! proved.

use super::height::Plane;
use super::solution::{difference, extent};
use crate::ray::LEAST_ORIGIN;
use crate::simd::Doubles;

const U: f64 = f64::EPSILON / 2.0;

/// A point of a triangle, a few roundings within its edges, from which rays step off on either side.
#[derive(Clone, Copy)]
pub(crate) struct Leaving<F> {
    pub(crate) plane: Plane<F>,
    pub(crate) point: [F; 3],
    /// The first step: one rounding of the point, whose own coordinate may be near 0, where its ulp would never get away.
    pub(crate) step: F,
}

impl<F: Doubles> Leaving<F> {
    #[inline(always)]
    pub(crate) fn of(plane: Plane<F>, corners: &[[F; 3]; 3], weights: [F; 3]) -> Self {
        let reach = extent(corners[0]).or_more(extent(corners[1])).or_more(extent(corners[2]));
        let point = combine(corners, pulled_in(corners, weights, reach, length(plane.normal)));
        let step = F::splat(U).times(extent(point).or_more(reach.times(F::splat(LEAST_SHARE))));
        Self { plane, point, step }
    }
}

/// The least step in roundings of the largest corner coordinate, for a point at the origin of space: 2^-20.
const LEAST_SHARE: f64 = 1.0 / (1u64 << 20) as f64;

/// 2^-44, a few roundings of a weight.
const LEAST_WEIGHT: f64 = 1.0 / (1u64 << 44) as f64;

/// The weights moved at least a few roundings of the point away from each edge.
///
/// `reach` is the greatest coordinate of the corners: the sum that forms the point rounds in units of its largest addend, also where the
/// point itself is near the origin of space.
#[inline(always)]
fn pulled_in<F: Doubles>(corners: &[[F; 3]; 3], weights: [F; 3], reach: F, double_area: F) -> [F; 3] {
    let [a, b, c] = *corners;
    // The height over an edge is twice the area by its length; a weight of 1 is the whole height.
    let edges = [length(difference(c, b)), length(difference(a, c)), length(difference(b, a))];
    let mut pulled = weights;
    for k in 0..3 {
        let least = F::splat(16.0 * U).times(reach).times(edges[k]).over(double_area);
        pulled[k] = weights[k].or_more(least.or_more(F::splat(LEAST_WEIGHT)).or_less(F::splat(1.0 / 3.0)));
    }
    let sum = pulled[0].plus(pulled[1]).plus(pulled[2]);
    [pulled[0].over(sum), pulled[1].over(sum), pulled[2].over(sum)]
}

/// The point with these weights.
#[inline(always)]
pub(crate) fn combine<F: Doubles>(corners: &[[F; 3]; 3], weights: [F; 3]) -> [F; 3] {
    let ([a, b, c], [u, v, w]) = (*corners, weights);
    let mut point = a;
    for axis in 0..3 {
        point[axis] = a[axis].times(u).plus(b[axis].times(v)).plus(c[axis].times(w));
    }
    point
}

/// A coordinate that is too small for a ray's origin becomes 0.
#[inline(always)]
pub(crate) fn without_tiny(x: f64) -> f64 {
    if x.abs() < LEAST_ORIGIN { 0.0 } else { x }
}

#[inline(always)]
fn length<F: Doubles>(v: [F; 3]) -> F {
    v[0].times(v[0]).plus(v[1].times(v[1])).plus(v[2].times(v[2])).sqrt()
}
