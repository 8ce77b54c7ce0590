//! The bounds of the f32 kernels: what they may reject, and what they may accept without asking f64.
//!
//! e = 2^-24 is the unit roundoff of f32; a, b, c are a triangle's corners, e1 = b - a and e2 = c - a its edges in f32, A = a - o, d the ray's
//! direction. With V = d.(e2 x A), W = d.(A x e1), D = d.(e1 x e2), U = D - V - W and M = A.(e1 x e2) the line meets the triangle when U, V
//! and W are of one sign or 0, and t = M / D. Magnitudes: |d| is the sum of the direction's, L the greatest of both edges', |A| the
//! greatest of A's components.
//!
//! **Volumes.** Every term d_i e_j A_k of V is at most its share of the permanent, 2 |d| L |A|. It passes the rounding of edge, A and both
//! products, one subtraction and two additions: 7, hence at most 14.1 e |d| L |A| (1 + e)^7 in all; W the same, D with L for |A|. Where many
//! rays share the work, A is taken from their centre c, and o - c = s enters through m = d x s as V = d.(e2 x A) + m.e2 and
//! W = d.(A x e1) - m.e1: one rounding more each, 16.1 e |d| L (|A| + |s|). An origin that is replaced by an f32 one, g away, adds
//! 2 |d| L g. U takes over the errors of D, V and W and two subtractions, e (2 |D| + 2 |V| + |W|) <= e |d| L (4 L + 6 (|A| + |s|)). Together
//! at most |d| L (18.2 e L + 38.3 e (|A| + |s|) + 4.1 g): the bound E has 20, 40 and 4.2, which leaves its own roundings room.
//!
//! **Distance.** M has 9 roundings and the permanent 6 L^2 (|A| + |s|), so it errs by at most L^2 (55 e (|A| + |s|) + 6.1 g); D by 14.1 e |d| L^2.
//! 58 and 14.5 leave room. For |D| above four times its error, M / D errs by at most 1.5 (error of M + |t| error of D) / |D|, and the
//! quotient and the ends of the interval round by less than 5 e |t|.
//!
//! **Range.** Coordinates are at most 2^40 and directions between 2^-40 and 2^40, so nothing overflows but t, and an interval that is not
//! finite decides nothing. A product that underflows loses at most 2^-150; through the factors that follow, less than 2^-126 (1 + |d| + L)
//! of a volume and 2^-126 (1 + |A| + |s|) of M. Fused multiply-adds only remove roundings.
//!
//! All of this is in stretched coordinates (`space.rs`).

use super::space::FilterSpace;
use crate::GzRay;
use crate::simd::Lanes;

const E: f32 = f32::EPSILON / 2.0;
/// 2^-126: a subnormal number would make the processor stumble at every use.
const FLOOR: f32 = f32::MIN_POSITIVE;
/// 2^40: the greatest coordinate.
pub(super) const GREATEST_REACH: f32 = (1u64 << 40) as f32;
/// 2^40: the greatest component of a direction; the largest one is at least its inverse.
pub(super) const GREATEST_DIRECTION: f32 = (1u64 << 40) as f32;

/// The bounds for rays with |d| up to one size, |s| up to one spread and g up to one loss.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Margin {
    /// Of E / L: by L, by |A|, and what does not depend on the triangle.
    by_size: f32,
    by_distance: f32,
    constant: f32,
    /// Of D's error, by L^2.
    along: f32,
    /// Of M's error / L^2, what does not depend on the triangle.
    depth: f32,
    /// What underflow may cost a volume, and M.
    floor: f32,
    depth_floor: f32,
}

impl Margin {
    #[inline(always)]
    pub(super) fn new(size: f32, spread: f32, lost: f32) -> Self {
        Self {
            by_size: 20.0 * E * size,
            by_distance: 40.0 * E * size,
            constant: 40.0 * E * size * spread + 4.2 * size * lost + FLOOR,
            along: 14.5 * E * size,
            depth: 58.0 * E * spread + 6.1 * lost,
            floor: FLOOR * (1.0 + size),
            depth_floor: FLOOR * (1.0 + spread),
        }
    }

    /// E for triangles of size `l` at distance `a`.
    #[inline(always)]
    pub(super) fn volume<const N: usize, L: Lanes<N>>(&self, l: L, a: L) -> L {
        let far = a.mul_add(L::splat(self.by_distance), L::splat(self.constant));
        l.mul_add(l.mul_add(L::splat(self.by_size), far), L::splat(self.floor))
    }

    /// The error of M.
    #[inline(always)]
    pub(super) fn depth<const N: usize, L: Lanes<N>>(&self, l: L, a: L) -> L {
        let far = a.mul_add(L::splat(58.0 * E), L::splat(self.depth));
        l.times(l).mul_add(far, a.mul_add(L::splat(FLOOR), L::splat(self.depth_floor)))
    }

    /// The error of D.
    #[inline(always)]
    pub(super) fn along<const N: usize, L: Lanes<N>>(&self, l: L) -> L {
        l.times(l).mul_add(L::splat(self.along), L::splat(self.floor))
    }
}

/// An interval of t = `m` / `d` from the errors of both, and where it can be trusted.
#[inline(always)]
pub(super) fn distance<const N: usize, L: Lanes<N>>(m: L, m_error: L, d: L, d_error: L) -> (L, L, u32) {
    let inverse = L::splat(1.0).over(d);
    let t = m.times(inverse);
    let size = t.abs();
    let from_both = size.mul_add(d_error, m_error).times(inverse.abs());
    let error = from_both.mul_add(L::splat(1.5), size.mul_add(L::splat(5.0 * E), L::splat(FLOOR)));
    (t.minus(error), t.plus(error), d_error.times(L::splat(4.0)).below(d.abs()))
}

/// Which lines surely miss, and which surely meet, from the least and the greatest of U, V, W and E.
#[inline(always)]
pub(super) fn judge<const N: usize, L: Lanes<N>>(u: L, v: L, w: L, bound: L) -> Judged<N, L> {
    Judged { least: u.min(v).min(w), most: u.max(v).max(w), bound }
}

/// Volumes as far as signs go.
pub(super) struct Judged<const N: usize, L> {
    least: L,
    most: L,
    bound: L,
}

impl<const N: usize, L: Lanes<N>> Judged<N, L> {
    /// Where a hit is not excluded; also for NaN.
    #[inline(always)]
    pub(super) fn possible(&self) -> u32 {
        let below = self.least.plus(self.bound).below(L::splat(0.0));
        let above = self.bound.below(self.most);
        !(below & above) & ((1 << N) - 1)
    }

    /// Where a hit would be reported by who does not ask for proof.
    #[inline(always)]
    pub(super) fn plain(&self) -> u32 {
        let zero = L::splat(0.0);
        zero.at_most(self.least) | self.most.at_most(zero)
    }

    /// Where the line meets the triangle's inside for certain.
    #[inline(always)]
    pub(super) fn sure(&self) -> u32 {
        self.bound.below(self.least) | self.most.plus(self.bound).below(L::splat(0.0))
    }
}

/// A ray as the f32 kernels see it.
#[derive(Clone, Copy, Debug, Default)]
pub struct FilterRay {
    pub(super) origin: [f32; 3],
    pub(super) direction: [f32; 3],
    pub(super) margin: Margin,
}

impl FilterRay {
    /// Prepares a valid `ray` for triangles in `space`; `None` when coordinates or direction are beyond the range of the bounds.
    pub fn new(ray: &GzRay, space: &FilterSpace) -> Option<Self> {
        let (origin, direction) = (ray.origin * space.scale.as_dvec3(), ray.direction * space.scale);
        let reach = f64::from(space.reach.max_element()) + origin.abs().max_element();
        let range = 1.0 / GREATEST_DIRECTION..=GREATEST_DIRECTION;
        if reach > f64::from(GREATEST_REACH) || !range.contains(&direction.abs().max_element()) {
            return None;
        }
        let rounded = origin.as_vec3();
        let lost = (origin - rounded.as_dvec3()).abs().max_element() as f32;
        let size = direction.x.abs() + direction.y.abs() + direction.z.abs();
        let margin = Margin::new(size, 0.0, lost * (1.0 + 2.0 * E));
        Some(Self { origin: rounded.to_array(), direction: direction.to_array(), margin })
    }
}
