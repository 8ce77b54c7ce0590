//! A line and a triangle by intervals of f64: an answer where all numbers within the intervals give the same one.

use super::interval::Interval;
use super::{Line, Triangle};

type Vector = [Interval; 3];

/// What intervals say of a line and a triangle.
pub(super) enum Verdict {
    /// Surely no hit.
    Miss,
    /// Surely a hit.
    Hit(Bounded),
    /// It takes integers.
    Unsure,
}

/// Intervals around the numbers of a hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounded {
    pub(super) t: Interval,
    v: Interval,
    w: Interval,
    whole: Interval,
}

impl Bounded {
    /// The second corner's weight.
    pub(super) fn u(&self) -> Interval {
        self.v.divided_by(self.whole)
    }

    /// The third corner's weight.
    pub(super) fn v(&self) -> Interval {
        self.w.divided_by(self.whole)
    }
}

/// Asks about the hit of `line` on a triangle.
pub(super) fn ask(line: &Line, corners: &Triangle) -> Verdict {
    let [a, b, c] = corners.map(|corner| from_start(line, corner));
    let d = line.direction.map(Interval::point);
    let bc = cross(&b, &c);
    let volumes @ [u, v, w] = [dot(&d, &bc), dot(&d, &cross(&c, &a)), dot(&d, &cross(&a, &b))];
    let (any_above, any_below) = (volumes.iter().any(|x| x.is_positive()), volumes.iter().any(|x| x.is_negative()));
    if any_above && any_below {
        return Verdict::Miss;
    }
    let whole = u + v + w;
    let none_below = whole.is_positive() && volumes.iter().all(|x| x.lo >= 0.0);
    let none_above = whole.is_negative() && volumes.iter().all(|x| x.hi <= 0.0);
    if !(none_below || none_above) {
        return Verdict::Unsure;
    }
    let t = dot(&a, &bc).divided_by(whole);
    if t.hi <= line.tmin || t.lo >= line.tmax {
        Verdict::Miss
    } else if t.lo > line.tmin && t.hi < line.tmax {
        Verdict::Hit(Bounded { t, v, w, whole })
    } else {
        Verdict::Unsure
    }
}

fn from_start(line: &Line, corner: [f32; 3]) -> Vector {
    let corner = corner.map(f64::from);
    match line.number() {
        Some(origin) => [0, 1, 2].map(|k| Interval::difference(corner[k], origin[k])),
        None => [0, 1, 2].map(|k| Interval::point(corner[k]) - line.start[k]),
    }
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let part = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

fn dot(a: &Vector, b: &Vector) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
