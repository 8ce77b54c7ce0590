//! What rays that go together span, and which triangles all of them miss.
//!
//! Of each component of the direction d and of the moment m = d x s (`filter.rs` has the letters) the rays span an interval of centre c and
//! radius r, rounded up. With P = e2 x A, Q = A x e1 and N = e1 x e2 the volumes are linear in d and m:
//!
//! V = d.P + m.e2, W = d.Q - m.e1, U = d.(N - P - Q) + m.(e1 - e2),
//!
//! so V of every ray lies within sum r_i |P_i| + sum r'_i |e2_i| of sum c_i P_i + sum c'_i e2_i, and so on. When for one of U, V, W that is
//! surely below 0 and for another surely above, no ray of the set meets the triangle.
//!
//! **Bound.** Let |d| be the sum of the greatest magnitude of each component over the rays, and T = 2 |d| L (|A| + |s|), which is at least the
//! sum of all terms' magnitudes of V. Its inputs err by at most 4.1 e T (edges, A or s, two products, a subtraction), centre and radius by
//! 7 e T each (products and five additions), their sum by 2 e T: at most 20.1 e T. U has T' = |d| L (2 L + 4 (|A| + |s|)) for T and two
//! subtractions more: 22.2 e T', at most |d| L (44.4 e L + 88.8 e (|A| + |s|)). An origin that is replaced by one g away adds 4.2 |d| L g.
//! All of that is below 2.25 times the bound E of one ray, when that is formed with this |d|.
// Axes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::bundle::RayBundle;
use super::packets::{Rays, span};
use crate::simd::{Lanes, Simd};

const E: f32 = f32::EPSILON / 2.0;
/// Times the bound of one ray.
pub(super) const BOUND: f32 = 2.25;

/// An interval.
#[derive(Clone, Copy, Debug, Default)]
struct Span {
    centre: f32,
    radius: f32,
}

impl Span {
    fn new(least: f32, greatest: f32) -> Self {
        let centre = least * 0.5 + greatest * 0.5;
        let radius = (greatest - centre).max(centre - least);
        Self { centre, radius: radius * (1.0 + 4.0 * E) }
    }
}

/// The intervals that a set of rays of a bundle spans, by axis.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spans {
    direction: [Span; 3],
    moment: [Span; 3],
}

impl Spans {
    /// Of the rays of `company`, all fit and at least one.
    #[inline(always)]
    pub fn of<S: Simd>(bundle: &RayBundle, company: &Rays) -> Self {
        let mut spans = Self::default();
        let known = bundle.common_direction || *company == bundle.fit;
        spans.direction = between(if known { bundle.span } else { span::<S>(&bundle.direction, false, company) });
        if !bundle.common_origin {
            spans.moment = between(span::<S>(&bundle.moment, false, company));
        }
        spans
    }

    /// Centre and radius of x.d + y.m.
    #[inline(always)]
    pub(super) fn interval<L: Lanes<8>>(&self, bundle: &RayBundle, x: [L; 3], y: [L; 3]) -> (L, L) {
        let (mut centre, mut radius) = (L::splat(0.0), L::splat(0.0));
        for axis in 0..3 {
            let Span { centre: c, radius: r } = self.direction[axis];
            centre = x[axis].mul_add(L::splat(c), centre);
            if !bundle.common_direction {
                radius = x[axis].abs().mul_add(L::splat(r), radius);
            }
        }
        if !bundle.common_origin {
            for axis in 0..3 {
                let Span { centre: c, radius: r } = self.moment[axis];
                centre = y[axis].mul_add(L::splat(c), centre);
                radius = y[axis].abs().mul_add(L::splat(r), radius);
            }
        }
        (centre, radius)
    }
}

/// Intervals by their ends.
#[inline(always)]
fn between([least, greatest]: [[f32; 3]; 2]) -> [Span; 3] {
    [Span::new(least[0], greatest[0]), Span::new(least[1], greatest[1]), Span::new(least[2], greatest[2])]
}

#[cfg(test)]
mod tests {
    use super::super::together::Prepared;
    use super::super::{BUNDLE, FilterSpace, LANES, TriGroup, is_hit};
    use super::*;
    use crate::simd::{SimdLevel, Task, dispatch};
    use crate::{Bounds, GzCoord, PerRay, RayBatch};
    use glam::DVec3;

    /// The triangles of `group` that rays of `batch` may hit, for its rays at even places or for all.
    struct Ask<'a>(&'a RayBatch<'a>, &'a TriGroup, &'a FilterSpace, bool);

    impl Task for Ask<'_> {
        type Output = u32;

        #[inline(always)]
        fn run<S: Simd>(self) -> u32 {
            let Self(batch, group, space, half) = self;
            let mut bundle = RayBundle::empty();
            let mut company = bundle.gather::<S>(batch, 0, batch.len(), space);
            for rays in &mut company {
                *rays &= if half { 0x5555 } else { !0 };
            }
            let spans = Spans::of::<S>(&bundle, &company);
            Prepared::of::<S>(group, &bundle, &spans).worth
        }
    }

    #[test]
    fn no_triangle_that_a_ray_of_the_set_hits_is_left_out_and_most_others_are() {
        let mut state = 5u64;
        let mut unit = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 24) as f32
        };
        let (mut hit, mut kept, mut asked) = (0, 0, 0);
        for round in 0..600 {
            let offset = [0.0, 30.0, 1e4][round % 3];
            let size = [0.5, 1e-1, 1e-3][round / 3 % 3];
            // How far the rays are apart where they arrive: not at all, a little, as far as anything.
            let spread = [0.0, 1e-3, 0.05, 1.0][round % 4];
            let mut point = |s: f32| GzCoord::new(unit(), unit(), unit()) * s + offset;
            let positions: Vec<[GzCoord; 3]> = (0..8)
                .map(|_| {
                    let p = point(1.0);
                    [p, p + (point(size) - offset), p + (point(size) - offset)]
                })
                .collect();
            let space = FilterSpace::new(Bounds::of(positions.iter().flatten().copied()).reaches());
            let group = TriGroup::new(&[0, 1, 2, 3, 4, 5, 6, 7], &positions, &space);
            let [a, b, c] = positions[round % 8];
            // A corner, the middle of an edge, the middle.
            let target = [a, (a + b) * 0.5, (a + b + c) / 3.0][round % 3];
            let from = (point(1.0) - GzCoord::Z * 2.0).as_dvec3();
            let one = target - from.as_vec3();
            let mut origins = [from; BUNDLE];
            let mut directions = [one; BUNDLE];
            for (o, d) in origins.iter_mut().zip(&mut directions) {
                *d = one + (point(spread) - offset);
                *o = from + (point(spread) - offset).as_dvec3() * 1e-3;
            }
            let origin: PerRay<DVec3> = if round % 5 == 0 { PerRay::One(from) } else { PerRay::Each(&origins) };
            let direction: PerRay<GzCoord> = if round % 5 == 1 { PerRay::One(one) } else { PerRay::Each(&directions) };
            let batch = RayBatch::unbounded(BUNDLE, origin, direction);
            for &level in SimdLevel::available() {
                for half in [false, true] {
                    let worth = dispatch(level, Ask(&batch, &group, &space, half));
                    for (lane, corners) in positions.iter().enumerate() {
                        let any = (0..BUNDLE).any(|i| !(half && i % LANES % 2 == 1) && is_hit(&batch.ray(i), corners));
                        assert!(!any || worth >> lane & 1 != 0, "{level:?} round {round} lane {lane} half {half}");
                        hit += u32::from(any);
                        kept += worth >> lane & 1;
                        asked += 1;
                    }
                }
            }
        }
        assert!(hit > 1500 && kept < asked / 2, "{hit} hit, {kept} kept of {asked}");
    }
}
