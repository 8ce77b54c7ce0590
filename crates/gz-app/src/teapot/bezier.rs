//! Cubic Bezier curves and bicubic patches on a regular grid of parameters, the same bits from either side of a seam.

use super::patches::POINTS;
use glam::DVec3;

/// Weights of a cubic curve and of its derivative at the parameter `k` / `n`.
///
/// Built from the integers `k` and `n - k`, so the weights at `n - k` are those at `k` in reverse, to the bit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    point: [f64; 4],
    slope: [f64; 3],
    end: Option<usize>,
}

impl Weights {
    /// At `k` / `n`; 0 <= k <= n, n at least 1.
    pub(super) fn at(k: u32, n: u32) -> Self {
        let (a, b, n) = (f64::from(n - k), f64::from(k), f64::from(n));
        // Products of integers below 2^53 are exact: each weight is rounded once, by the division.
        let (cube, square) = (n * n * n, n * n);
        Self {
            point: [a * a * a / cube, 3.0 * a * a * b / cube, 3.0 * a * b * b / cube, b * b * b / cube],
            slope: [3.0 * a * a / square, 6.0 * a * b / square, 3.0 * b * b / square],
            end: if b == 0.0 {
                Some(0)
            } else if a == 0.0 {
                Some(3)
            } else {
                None
            },
        }
    }

    /// The point of the curve with control points `p`.
    ///
    /// The ends are control points untouched, and the sum is paired from outside in, so that a curve run backwards, or met as the
    /// border of another patch, gives the same bits.
    pub(super) fn point(&self, p: [DVec3; 4]) -> DVec3 {
        let w = &self.point;
        match self.end {
            Some(k) => p[k],
            None => (p[0] * w[0] + p[3] * w[3]) + (p[1] * w[1] + p[2] * w[2]),
        }
    }

    /// The derivative of the curve with control points `p`.
    pub(super) fn slope(&self, p: [DVec3; 4]) -> DVec3 {
        let w = &self.slope;
        (p[1] - p[0]) * w[0] + (p[2] - p[1]) * w[1] + (p[3] - p[2]) * w[2]
    }
}

/// A bicubic patch: four rows of control points, x right, y up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    rows: [[DVec3; 4]; 4],
}

impl Patch {
    /// The patch of these control points, turned from Newell's z up to y up.
    pub(super) fn new(indices: &[u16; 16]) -> Self {
        let point = |k: u16| {
            let [x, y, z] = POINTS[usize::from(k)];
            // 0 - y and not -y: a zero must not change its sign from one patch to the next.
            DVec3::new(x, z, 0.0 - y)
        };
        Self { rows: std::array::from_fn(|r| std::array::from_fn(|c| point(indices[4 * r + c]))) }
    }

    /// The curve down the rows at one place across them.
    pub(super) fn column(&self, across: &Weights) -> Column {
        Column { points: self.rows.map(|row| across.point(row)), slopes: self.rows.map(|row| across.slope(row)) }
    }
}

/// A patch at one parameter across its rows: control points of the curve down the rows, and of its derivative across.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    points: [DVec3; 4],
    slopes: [DVec3; 4],
}

impl Column {
    /// The point at one place down the rows.
    pub(super) fn point(&self, down: &Weights) -> DVec3 {
        down.point(self.points)
    }

    /// The unit normal at one place down the rows: across x down, which points outward on every part of the teapot.
    ///
    /// Where the patch runs together in one point the derivative across vanishes; just beside it that derivative is its own
    /// derivative down the rows times the distance, so the mixed derivative gives the limit. Zero only if that vanishes too, which
    /// no patch of the teapot does.
    pub(super) fn normal(&self, down: &Weights) -> DVec3 {
        let (across, along) = (down.point(self.slopes), down.slope(self.points));
        let normal = across.cross(along);
        // A thousandth of a unit is far below the slopes of any regular point and far above rounding.
        if across.length_squared() > 1e-6 {
            return normal.normalize_or_zero();
        }
        let mixed = down.slope(self.slopes);
        let inward = if down.end == Some(3) { -1.0 } else { 1.0 };
        (mixed * inward).cross(along).normalize_or_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_read_backwards_are_those_of_the_opposite_parameter() {
        for n in 1..=60 {
            for k in 0..=n {
                let (a, b) = (Weights::at(k, n), Weights::at(n - k, n));
                let reversed = [b.point[3], b.point[2], b.point[1], b.point[0]];
                assert_eq!(a.point, reversed, "{k} of {n}");
                assert!((a.point.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn slope_is_the_derivative_of_the_point() {
        let p = [[0.0, 0.0, 0.0], [1.0, 2.0, 0.5], [2.0, -1.0, 3.0], [4.0, 0.0, 1.0]].map(DVec3::from_array);
        let n = 100_000;
        for k in [1, 20_000, 50_000, 99_999] {
            let difference = (Weights::at(k + 1, n).point(p) - Weights::at(k - 1, n).point(p)) * (f64::from(n) / 2.0);
            assert!((difference - Weights::at(k, n).slope(p)).length() < 1e-6, "{k}");
        }
    }
}
