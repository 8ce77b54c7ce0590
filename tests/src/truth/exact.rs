//! Lines and triangles in integers of any length.

use super::fraction::{Fraction, parts};
use super::interval::Interval;
use super::{Line, Triangle};
use dashu_int::IBig;
use std::cmp::Ordering;

type Vector = [IBig; 3];

/// A point with rational coordinates: `coordinates / weight * 2^exponent`, the weight above 0.
#[derive(Clone, Debug)]
pub struct ExactPoint {
    coordinates: Vector,
    weight: IBig,
    exponent: i32,
}

impl ExactPoint {
    /// The point that three finite numbers stand for.
    pub fn of(point: [f64; 3]) -> Self {
        let (coordinates, exponent) = integers(point);
        Self { coordinates, weight: IBig::ONE, exponent }
    }

    /// Coordinate `k`.
    pub fn coordinate(&self, k: usize) -> Fraction {
        Fraction::new(self.coordinates[k].clone(), self.weight.clone(), self.exponent)
    }

    /// A box of f64 intervals that holds it.
    pub(super) fn near(&self) -> [Interval; 3] {
        [0, 1, 2].map(|k| self.coordinate(k).near())
    }
}

/// A line: a start and a direction, whose coordinates are integers times a power of two.
#[derive(Clone, Debug)]
pub(super) struct ExactLine {
    start: ExactPoint,
    direction: Vector,
    direction_exponent: i32,
}

impl ExactLine {
    pub(super) fn new(start: &ExactPoint, direction: [f64; 3]) -> Self {
        let (direction, direction_exponent) = integers(direction);
        Self { start: start.clone(), direction, direction_exponent }
    }
}

/// The numbers of the definition for a line and a triangle, each times a power of two and of the start's weight.
struct Volumes<'a> {
    line: &'a ExactLine,
    exponent: i32,
    origin: Vector,
    u: IBig,
    v: IBig,
    w: IBig,
    whole: IBig,
    m: IBig,
}

impl<'a> Volumes<'a> {
    fn of(line: &'a Line, corners: &Triangle) -> Self {
        let line = line.exact();
        let (start, d) = (&line.start, &line.direction);
        // One power of two for corners and start. With w the start's weight all differences are w times as long as they should be.
        let shared: Vec<(Vector, i32)> = corners.iter().map(|corner| integers(corner.map(f64::from))).collect();
        let exponent = shared.iter().map(|(_, e)| *e).min().unwrap_or(0).min(start.exponent);
        let origin = start.coordinates.each_ref().map(|x| x << (start.exponent - exponent) as usize);
        let from_origin = |k: usize| -> Vector {
            let (corner, e) = &shared[k];
            [0, 1, 2].map(|axis| (&corner[axis] << (e - exponent) as usize) * &start.weight - &origin[axis])
        };
        let [a, b, c] = [from_origin(0), from_origin(1), from_origin(2)];
        let bc = cross(&b, &c);
        let [u, v, w] = [dot(d, &bc), dot(d, &cross(&c, &a)), dot(d, &cross(&a, &b))];
        let whole = &u + &v + &w;
        let m = dot(&a, &bc);
        Self { line, exponent, origin, u, v, w, whole, m }
    }
}

/// Where the line of `line` meets the plane of a triangle; `None` when it runs along it, or the triangle has no area.
pub fn plane_t(line: &Line, corners: &Triangle) -> Option<Fraction> {
    let Volumes { line, exponent, whole, m, .. } = Volumes::of(line, corners);
    (whole != IBig::ZERO).then(|| Fraction::new(m, whole * &line.start.weight, exponent - line.direction_exponent))
}

/// Where a line hits a triangle, without rounding.
#[derive(Clone, Debug)]
pub struct Meeting {
    /// How far along the line.
    pub t: Fraction,
    /// Weight of the second corner.
    pub u: Fraction,
    /// Weight of the third corner.
    pub v: Fraction,
    /// Where.
    pub point: ExactPoint,
}

impl Meeting {
    /// The hit of `line` on a triangle; `None` for a miss.
    pub fn of(line: &Line, corners: &Triangle) -> Option<Self> {
        let meeting = Self::of_whole_line(line, corners)?;
        let inside = meeting.t.cmp_number(line.tmin) == Ordering::Greater && meeting.t.cmp_number(line.tmax) == Ordering::Less;
        inside.then_some(meeting)
    }

    /// The same for any t.
    fn of_whole_line(line: &Line, corners: &Triangle) -> Option<Self> {
        let Volumes { line, exponent, origin, u, v, w, whole, m } = Volumes::of(line, corners);
        let (start, d) = (&line.start, &line.direction);
        let agrees = |x: &IBig| match whole.cmp(&IBig::ZERO) {
            Ordering::Greater => *x >= IBig::ZERO,
            Ordering::Less => *x <= IBig::ZERO,
            Ordering::Equal => false,
        };
        if ![&u, &v, &w].into_iter().all(agrees) {
            return None;
        }
        // M has three factors of the start's weight, D two.
        let t = Fraction::new(m.clone(), &whole * &start.weight, exponent - line.direction_exponent);
        // o + t d with t = m / (D w) over the common denominator D w; both terms are multiples of 2^exponent then.
        let sign = if whole < IBig::ZERO { -IBig::ONE } else { IBig::ONE };
        let coordinates = [0, 1, 2].map(|k| (&origin[k] * &whole + &m * &d[k]) * &sign);
        let point = ExactPoint { coordinates, weight: &whole * &start.weight * &sign, exponent };
        let weight = |x: IBig| Fraction::new(x, whole.clone(), 0);
        Some(Self { t, u: weight(v), v: weight(w), point })
    }
}

/// The sign of d.((b - a) x (c - a)): the side of its plane that a direction points to.
pub fn side(corners: &Triangle, direction: [f32; 3]) -> i32 {
    let all: Vec<f64> = corners.iter().flatten().map(|&x| f64::from(x)).collect();
    let exponent = all.iter().map(|&x| parts(x)).filter(|(m, _)| *m != 0).map(|(_, e)| e).min().unwrap_or(0);
    let integer = |x: f64| {
        let (m, e) = parts(x);
        if m == 0 { IBig::ZERO } else { IBig::from(m) << (e - exponent) as usize }
    };
    let corner = |k: usize| -> Vector { [0, 1, 2].map(|axis| integer(all[3 * k + axis])) };
    let minus = |p: Vector, q: &Vector| -> Vector { [&p[0] - &q[0], &p[1] - &q[1], &p[2] - &q[2]] };
    let [a, b, c] = [corner(0), corner(1), corner(2)];
    let normal = cross(&minus(b, &a), &minus(c, &a));
    Fraction::new(dot(&integers(direction.map(f64::from)).0, &normal), IBig::ONE, 0).sign()
}

/// Finite numbers as integers times one power of two.
fn integers(numbers: [f64; 3]) -> (Vector, i32) {
    let apart = numbers.map(parts);
    let exponent = apart.iter().filter(|(m, _)| *m != 0).map(|(_, e)| *e).min().unwrap_or(0);
    (apart.map(|(m, e)| if m == 0 { IBig::ZERO } else { IBig::from(m) << (e - exponent) as usize }), exponent)
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let part = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

fn dot(a: &Vector, b: &Vector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}
