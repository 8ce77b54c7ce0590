//! T, u and v of hits: pure functions of ray and triangle, so every query gives these bits.
//!
//! T is the exact t rounded once: in f64 when both ends of its interval round alike, else by the exact stage. u = V/D and v = W/D are
//! within 1 ulp or 2^-40 of the true ones. The f64 numbers are tried with quick errors first and with closer ones where those settle nothing:
//! the same steps for one hit and for eight, so that the bits are the same.

use super::exact::ExactHit;
use super::leaving::combine;
use super::rung::Rung;
use super::solution::{Bounded, Solution};
use crate::simd::{Doubles, EightDoubles, Lanes, Simd, nine, numbers_of};
use crate::{GzCoord, GzRay, Hit, TriId};
use glam::DVec3;

/// What f64 says of hits: each number, and where it is not settled and the exact stage has it.
struct InDoubles<F> {
    /// Both ends of the interval of t.
    t: [F; 2],
    v: F,
    w: F,
    /// At least 0 where v and w are good enough.
    weights: F,
    /// Above 0 where there is anything at all.
    certainty: F,
}

impl<F: Doubles> InDoubles<F> {
    #[inline(always)]
    fn of(solution: &Solution<F>) -> Self {
        let inverse = solution.inverse();
        let (Bounded { value: t, error }, ([v, w], weight_error)) = (solution.t(inverse), solution.weights(inverse));
        let (v, w) = (cut(v), cut(w));
        // A weight is good to 1 ulp of f32 when it errs by less than a quarter of one, and to 2^-40 when by less than 2^-41.
        let may_err = v.or_less(w).times(F::splat(f64::from(f32::EPSILON) / 4.0)).or_more(F::splat(HALF_SMALLEST));
        Self { t: [t.minus(error), t.plus(error)], v, w, weights: may_err.minus(weight_error), certainty: solution.certainty() }
    }
}

/// A weight cut to [0, 1]; 0 has no sign.
#[inline(always)]
fn cut<F: Doubles>(weight: F) -> F {
    weight.or_more(F::splat(0.0)).or_less(F::splat(1.0))
}

/// T, u and v of a hit, for a ray and a triangle that are known to meet.
pub(crate) fn t_u_v(ray: &GzRay, corners: &[GzCoord; 3]) -> (f32, f32, f32) {
    let (t, weights) = in_doubles(ray, corners);
    if let (Some(t), Some((u, v))) = (t, weights) {
        return (t, u, v);
    }
    let Some(exact) = ExactHit::of(ray, corners) else { return (t.unwrap_or(0.0), 0.0, 0.0) };
    let (u, v) = weights.unwrap_or_else(|| (exact.weight(1), exact.weight(2)));
    (t.unwrap_or_else(|| exact.t()), u, v)
}

/// What T, u and v of a hit were formed with: f64, or whole numbers where it leaves their rounding open.
pub fn answer_rung(ray: &GzRay, corners: &[GzCoord; 3]) -> Rung {
    match in_doubles(ray, corners) {
        (Some(_), Some(_)) => Rung::F64,
        _ => Rung::Exact,
    }
}

/// T, and u and v, as far as f64 settles them.
fn in_doubles(ray: &GzRay, corners: &[GzCoord; 3]) -> (Option<f32>, Option<(f32, f32)>) {
    let quick = InDoubles::of(&Solution::quick_of_one(ray, corners));
    let [lo, hi] = quick.t.map(|t| t as f32);
    if quick.certainty > 0.0 && lo.to_bits() == hi.to_bits() && quick.weights >= 0.0 {
        return (Some(lo), Some((quick.v as f32, quick.w as f32)));
    }
    let found = InDoubles::of(&Solution::of_one(ray, corners));
    let certain = found.certainty > 0.0;
    let [lo, hi] = found.t.map(|t| t as f32);
    // Equal bits, so that -0 and 0 are told apart.
    let t = (certain && lo.to_bits() == hi.to_bits()).then_some(lo);
    (t, (certain && found.weights >= 0.0).then_some((found.v as f32, found.w as f32)))
}

/// Eight rays and the triangles that they hit.
pub(super) struct EightPairs<'p, S: Simd> {
    pub(super) origin: [S::Doubles; 3],
    pub(super) direction: [S::Doubles; 3],
    pub(super) corners: [&'p [GzCoord; 3]; 8],
}

impl<'p, S: Simd> EightPairs<'p, S> {
    /// Of rays with these origins and directions.
    #[inline(always)]
    pub(super) fn of(origins: &[[f64; 3]; 8], directions: &[[f32; 3]; 8], corners: [&'p [GzCoord; 3]; 8]) -> Self {
        let direction = widen3::<S>(<S::Eight>::unzip3(directions));
        Self { origin: <S::Doubles>::unzip3(origins), direction, corners }
    }

    /// The corners of the triangles.
    #[inline(always)]
    pub(super) fn wide_corners(&self) -> [[S::Doubles; 3]; 3] {
        let [a, b, c] = corners_of::<S>(&self.corners);
        [widen3::<S>(a), widen3::<S>(b), widen3::<S>(c)]
    }

    /// [`t_u_v`] of each lane whose bit is set, as the hit of triangle `ids[lane]`; of others a miss. `ray` gives a lane's ray.
    #[inline(always)]
    pub(super) fn hits(&self, hit: u32, ids: &[TriId; 8], ray: impl Fn(usize) -> GzRay, hits: &mut [Hit]) {
        let solution = Solution::quick(self.origin, self.direction, &self.wide_corners());
        write_answers::<S>(&solution, hit, ids, |lane| (ray(lane), self.corners[lane]), hits);
    }
}

/// [`EightPairs::hits`] from their quick solution; `pair` gives the ray and the triangle of a lane that it leaves open.
#[inline(always)]
pub(super) fn write_answers<'p, S: Simd>(
    solution: &Solution<S::Doubles>,
    hit: u32,
    ids: &[TriId; 8],
    pair: impl Fn(usize) -> (GzRay, &'p [GzCoord; 3]),
    hits: &mut [Hit],
) {
    let found = InDoubles::of(solution);
    let [lo, hi] = [found.t[0], found.t[1]];
    let (lo, hi, v, w) = (S::narrow(lo), S::narrow(hi), S::narrow(found.v), S::narrow(found.w));
    let zero = <S::Doubles>::splat(0.0);
    let settled = lo.same_bits(hi) & !found.certainty.at_most(zero) & zero.at_most(found.weights);
    write_hits::<S>(hit, ids, [lo, v, w], hits);
    let mut open = hit & !settled;
    while open != 0 {
        let lane = open.trailing_zeros() as usize;
        open &= open - 1;
        let (ray, corners) = pair(lane);
        hits[lane] = alone(&ray, ids[lane], corners);
    }
}

/// The corners of eight triangles, coordinate by coordinate.
#[inline(always)]
pub(super) fn corners_of<S: Simd>(c: &[&[GzCoord; 3]; 8]) -> [[S::Eight; 3]; 3] {
    let numbers = [nine(c[0]), nine(c[1]), nine(c[2]), nine(c[3]), nine(c[4]), nine(c[5]), nine(c[6]), nine(c[7])];
    let [ax, ay, az, bx, by, bz, cx, cy, cz] = S::corners(&numbers);
    [[ax, ay, az], [bx, by, bz], [cx, cy, cz]]
}

/// Writes t, u and v as hits of `ids` where the bit is set, elsewhere misses; to eight hits or fewer.
#[inline(always)]
pub(super) fn write_hits<S: Simd>(hit: u32, ids: &[TriId; 8], [t, u, v]: [S::Eight; 3], hits: &mut [Hit]) {
    let nothing = <S::Eight>::splat(0.0);
    let rows = [
        t.select(hit, <S::Eight>::splat(Hit::MISS.t)),
        <S::Eight>::load(numbers_of(ids)).select(hit, <S::Eight>::splat(f32::from_bits(Hit::MISS.tri))),
        u.select(hit, nothing),
        v.select(hit, nothing),
    ];
    match hits.first_chunk_mut() {
        Some(hits) => S::write_hits(rows, hits),
        None => {
            let mut eight = [Hit::MISS; 8];
            S::write_hits(rows, &mut eight);
            hits.copy_from_slice(&eight[..hits.len()]);
        }
    }
}

/// The hit of one ray and a triangle that are known to meet.
#[cold]
#[inline(never)]
fn alone(ray: &GzRay, tri: TriId, corners: &[GzCoord; 3]) -> Hit {
    let (t, u, v) = t_u_v(ray, corners);
    Hit { t, tri, u, v }
}

#[inline(always)]
pub(super) fn widen3<S: Simd>(rows: [S::Eight; 3]) -> [S::Doubles; 3] {
    [S::widen(rows[0]), S::widen(rows[1]), S::widen(rows[2])]
}

/// 2^-41.
const HALF_SMALLEST: f64 = 1.0 / (1u64 << 41) as f64;
/// 2^-36.
pub(super) const WEIGHT_ERROR: f64 = 1.0 / (1u64 << 36) as f64;

/// Weights of the three corners as f64 has them, cut to [0, 1].
pub(super) struct NearWeights<F> {
    pub(super) weights: [F; 3],
    /// They mean something where this is above 0 and `error` is at most [`WEIGHT_ERROR`].
    pub(super) certainty: F,
    pub(super) error: F,
}

impl<F: Doubles> NearWeights<F> {
    #[inline(always)]
    pub(super) fn of(solution: &Solution<F>) -> Self {
        let ([v, w], error) = solution.weights(solution.inverse());
        let u = F::splat(1.0).minus(v).minus(w);
        let weights = [cut(u), cut(v), cut(w)];
        Self { weights, certainty: solution.certainty(), error }
    }
}

/// Weights of the three corners where the line of `ray` meets the triangle, in f64.
///
/// Each is in [0, 1] and within 2^-36 of the true one; they sum to 1 up to rounding. Meaningful for a ray that hits the triangle; for
/// one that does not, (1, 0, 0).
pub fn hit_weights(ray: &GzRay, corners: &[GzCoord; 3]) -> [f64; 3] {
    let near = NearWeights::of(&Solution::of_one(ray, corners));
    if near.certainty > 0.0 && near.error <= WEIGHT_ERROR {
        return near.weights;
    }
    ExactHit::of(ray, corners).map_or([1.0, 0.0, 0.0], |exact| exact.weights_near())
}

/// The point of a triangle with these weights.
pub(crate) fn point_at(corners: &[GzCoord; 3], weights: [f64; 3]) -> DVec3 {
    combine(&corners.map(|p| p.as_dvec3().to_array()), weights).into()
}
