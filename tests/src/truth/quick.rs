//! Several triangles in f64 with one bound each: which of them a line surely misses.
//!
//! u = 2^-53. With m at least every coordinate of A, B, C and e at least every component of d, each of the six terms of d.(B x C) is at
//! most e m^2 and passes seven roundings: two differences, a product, the subtraction, the product with d and two sums. So U, V and W are
//! each off by at most 6 ((1 + u)^7 - 1) e m^2 < 42.1 u e m^2; m is itself rounded, hence 48 u. No product underflows: differences are 0 or at
//! least 2^-202, components 0 or at least 2^-149.

use super::{Line, Triangle};

/// 48 u.
const BOUND: f64 = 24.0 * f64::EPSILON;

/// As many triangles as are looked at together.
pub(super) const LANES: usize = 8;

/// Eight triangles, coordinate by coordinate; unused places repeat the first.
#[derive(Clone, Debug)]
pub(super) struct Pack {
    /// `corners[3 * corner + axis][lane]`.
    corners: [[f64; LANES]; 9],
}

impl Pack {
    /// Of 1 to 8 triangles.
    pub(super) fn new(triangles: &[Triangle]) -> Self {
        let of = |lane: usize| &triangles[if lane < triangles.len() { lane } else { 0 }];
        Self { corners: std::array::from_fn(|k| std::array::from_fn(|lane| f64::from(of(lane)[k / 3][k % 3]))) }
    }

    /// Whether the line from `origin` along `line`'s direction surely misses each triangle.
    pub(super) fn misses(&self, origin: [f64; 3], line: &Line) -> [bool; LANES] {
        let d = line.direction;
        let reach = d[0].abs().max(d[1].abs()).max(d[2].abs()) * BOUND;
        let mut misses = [false; LANES];
        for (lane, misses) in misses.iter_mut().enumerate() {
            let [ax, ay, az, bx, by, bz, cx, cy, cz]: [f64; 9] = std::array::from_fn(|k| self.corners[k][lane] - origin[k % 3]);
            let u = d[0] * (by * cz - bz * cy) + d[1] * (bz * cx - bx * cz) + d[2] * (bx * cy - by * cx);
            let v = d[0] * (cy * az - cz * ay) + d[1] * (cz * ax - cx * az) + d[2] * (cx * ay - cy * ax);
            let w = d[0] * (ay * bz - az * by) + d[1] * (az * bx - ax * bz) + d[2] * (ax * by - ay * bx);
            let m = ax.abs().max(ay.abs()).max(az.abs());
            let m = m.max(bx.abs()).max(by.abs()).max(bz.abs());
            let m = m.max(cx.abs()).max(cy.abs()).max(cz.abs());
            let bound = reach * m * m;
            *misses = u.min(v).min(w) < -bound && u.max(v).max(w) > bound;
        }
        misses
    }
}
