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

use super::bundle::{Each, PACKETS, RayBundle, Rays, some};
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
        for axis in 0..3 {
            let d = &bundle.direction[axis];
            spans.direction[axis] = if bundle.common_direction { Span::new(d[0][0], d[0][0]) } else { span::<S>(d, company) };
            if !bundle.common_origin {
                spans.moment[axis] = span::<S>(&bundle.moment[axis], company);
            }
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

/// The interval of one number of the rays of `company`.
#[inline(always)]
fn span<S: Simd>(each: &Each, company: &Rays) -> Span {
    let mut least = <S::Sixteen>::splat(f32::INFINITY);
    let mut greatest = <S::Sixteen>::splat(f32::NEG_INFINITY);
    for p in 0..PACKETS {
        if company[p] != 0 {
            let x = <S::Sixteen>::load(&each[p]);
            least = some(x, company[p], least).min(least);
            greatest = some(x, company[p], greatest).max(greatest);
        }
    }
    Span::new(least.least(), greatest.greatest())
}
