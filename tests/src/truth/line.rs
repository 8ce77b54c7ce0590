//! A ray as the truth sees it.

use super::exact::{ExactLine, ExactPoint};
use super::interval::Interval;
use std::cell::OnceCell;

/// A ray as it is stored: an f64 origin, an f32 direction, hits at `tmin < t < tmax`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where t = 0 is.
    pub origin: [f64; 3],
    /// The step from t to t + 1.
    pub direction: [f32; 3],
    /// Hits at or before this t do not count.
    pub tmin: f32,
    /// Hits at or beyond this t do not count.
    pub tmax: f32,
}

/// A line with a start and an open interval of t in which hits count. It can hit something.
#[derive(Clone, Debug)]
pub struct Line {
    /// Where it starts, as near as f64 comes.
    pub(super) start: [Interval; 3],
    pub(super) direction: [f64; 3],
    pub(super) tmin: f64,
    pub(super) tmax: f64,
    from: Start,
    exact: OnceCell<ExactLine>,
}

/// Where a line starts.
#[derive(Clone, Debug)]
enum Start {
    Number([f64; 3]),
    Exact(ExactPoint),
}

impl Ray {
    /// Its line; `None` when it hits nothing whatever there is: a NaN anywhere, an infinite origin or direction, a zero direction, an
    /// origin coordinate that is neither 0 nor of magnitude 2^-150 to 2^128, or no t between the ends.
    pub fn line(&self) -> Option<Line> {
        let least = 2f64.powi(-150);
        let greatest = 2f64.powi(128);
        for x in self.origin {
            let size = x.abs();
            if size.is_nan() || size > greatest || (size < least && size != 0.0) {
                return None;
            }
        }
        if self.direction.iter().any(|x| x.is_nan() || x.is_infinite()) {
            return None;
        }
        Line::between(Start::Number(self.origin), self.direction, self.tmin, self.tmax)
    }
}

impl Line {
    /// From a point that need not be a number: with t above 0 and below `tmax`. `None` when it can hit nothing. `direction` is finite.
    pub fn from_point(point: ExactPoint, direction: [f32; 3], tmax: f32) -> Option<Self> {
        Self::between(Start::Exact(point), direction, 0.0, tmax)
    }

    fn between(from: Start, direction: [f32; 3], tmin: f32, tmax: f32) -> Option<Self> {
        let is_empty = tmin.is_nan() || tmax.is_nan() || tmin >= tmax;
        if is_empty || direction == [0.0; 3] {
            return None;
        }
        let start = match &from {
            Start::Number(origin) => origin.map(Interval::point),
            Start::Exact(point) => point.near(),
        };
        let (tmin, tmax) = (f64::from(tmin), f64::from(tmax));
        Some(Self { start, direction: direction.map(f64::from), tmin, tmax, from, exact: OnceCell::new() })
    }

    /// The start as a number, where it is one.
    pub(super) fn number(&self) -> Option<[f64; 3]> {
        match self.from {
            Start::Number(origin) => Some(origin),
            Start::Exact(_) => None,
        }
    }

    /// It in integers.
    pub(super) fn exact(&self) -> &ExactLine {
        self.exact.get_or_init(|| match &self.from {
            Start::Number(origin) => ExactLine::new(&ExactPoint::of(*origin), self.direction),
            Start::Exact(point) => ExactLine::new(point, self.direction),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_that_hit_nothing_have_no_line() {
        let good = Ray { origin: [0.0; 3], direction: [0.0, 0.0, 1.0], tmin: 0.0, tmax: f32::INFINITY };
        assert!(good.line().is_some());
        let (inf, nan) = (f32::INFINITY, f32::NAN);
        assert!(Ray { tmin: -inf, tmax: inf, ..good }.line().is_some());
        assert!(Ray { origin: [2f64.powi(-150), -(2f64.powi(128)), -0.0], ..good }.line().is_some());
        assert!(Ray { direction: [f32::from_bits(1), 0.0, 0.0], ..good }.line().is_some());
        for bad in [
            Ray { origin: [f64::NAN, 0.0, 0.0], ..good },
            Ray { origin: [0.0, f64::INFINITY, 0.0], ..good },
            Ray { origin: [0.0, 0.0, 2f64.powi(-151)], ..good },
            Ray { origin: [2f64.powi(129), 0.0, 0.0], ..good },
            Ray { direction: [0.0, nan, 1.0], ..good },
            Ray { direction: [0.0, inf, 1.0], ..good },
            Ray { direction: [0.0, -0.0, 0.0], ..good },
            Ray { tmin: nan, ..good },
            Ray { tmax: nan, ..good },
            Ray { tmin: 1.0, tmax: 1.0, ..good },
            Ray { tmin: 2.0, tmax: 1.0, ..good },
            Ray { tmin: inf, ..good },
        ] {
            assert!(bad.line().is_none(), "{bad:?}");
        }
    }
}
