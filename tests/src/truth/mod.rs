//! The true answer to a ray, found without any code of the product.
//!
//! The definition and nothing else: with A = a - o, B = b - o, C = c - o and U = d.(B x C), V = d.(C x A), W = d.(A x B), D = U + V + W,
//! M = A.(B x C), the line of a ray meets a triangle when D is not 0 and no two of U, V, W have opposite signs; it is hit when t = M / D lies
//! strictly between the ray's ends; the answer is the least (t, triangle number), with T, u = V / D and v = W / D rounded once to f32.
//!
//! Three steps lead there, each of which only passes on what it cannot prove:
//!
//! 1. `quick`: f64 with one bound for all of a triangle says that a line surely misses it;
//! 2. `bounded`: intervals whose ends are rounded outward decide signs, order and roundings;
//! 3. `exact`: integers of any length, of the crate dashu-int, decide the rest.
//!
//! Before them `boxes` leave out triangles whose box the line surely misses. [`plain`] does without all of this: integers alone, every
//! triangle. It is what [`Truth`] is tested against.
//!
//! The types are plain arrays, so that nothing of the product can come in with them.

mod bounded;
mod boxes;
mod exact;
mod fraction;
mod interval;
mod line;
pub mod plain;
mod quick;
#[cfg(test)]
mod tests;

pub use exact::{ExactPoint, Meeting, plane_t, side};
pub use fraction::Fraction;
pub use line::{Line, Ray};

use bounded::{Bounded, Verdict};
use boxes::Boxes;
use interval::Interval;
use std::cmp::Ordering;

/// Three corners of three coordinates.
pub type Triangle = [[f32; 3]; 3];

/// The front-most hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The triangle; of several at equal t, the lowest number.
    pub tri: u32,
    /// t rounded once to f32.
    pub t: f32,
    /// Weight of the second corner, rounded once.
    pub u: f32,
    /// Weight of the third corner, rounded once.
    pub v: f32,
}

/// How far down the three steps questions had to go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steps {
    /// Triangles looked at in f64.
    pub quick: u64,
    /// Of these, triangles asked about with intervals.
    pub bounded: u64,
    /// Triangles, orders and roundings settled with integers.
    pub exact: u64,
}

impl std::ops::AddAssign for Steps {
    fn add_assign(&mut self, other: Self) {
        self.quick += other.quick;
        self.bounded += other.bounded;
        self.exact += other.exact;
    }
}

/// Triangles to be asked about.
#[derive(Clone, Debug)]
pub struct Truth {
    boxes: Boxes,
}

/// A proved hit.
struct Candidate {
    tri: u32,
    corners: Triangle,
    t: Interval,
    bounded: Option<Bounded>,
    exact: Option<Meeting>,
}

impl Truth {
    /// Over all of `triangles`.
    pub fn new(triangles: &[Triangle]) -> Self {
        Self::of_some(triangles, |_| true)
    }

    /// Over those of `triangles` whose number is `wanted`; they keep their numbers.
    ///
    /// # Panics
    ///
    /// If a corner is not finite.
    pub fn of_some(triangles: &[Triangle], wanted: impl Fn(u32) -> bool) -> Self {
        let all = (0..).zip(triangles).filter(|(tri, _)| wanted(*tri)).map(|(tri, corners)| (tri, *corners));
        Self { boxes: Boxes::new(all.collect()) }
    }

    /// The front-most hit of a ray.
    pub fn closest(&self, ray: &Ray) -> Option<Found> {
        self.closest_of(&ray.line()?, &mut Steps::default())
    }

    /// Whether a ray hits anything.
    pub fn any(&self, ray: &Ray) -> bool {
        ray.line().is_some_and(|line| self.any_of(&line, &mut Steps::default()))
    }

    /// The front-most hit along `line`; what it took is added to `steps`.
    pub fn closest_of(&self, line: &Line, steps: &mut Steps) -> Option<Found> {
        let mut best: Option<Candidate> = None;
        self.boxes.each_near(line, steps, &mut |tri, corners, steps| {
            if let Some(found) = candidate(line, tri, corners, steps) {
                match &mut best {
                    None => best = Some(found),
                    Some(old) => {
                        if is_before(line, found.exact.as_ref(), &found, old, steps) {
                            best = Some(found);
                        }
                    }
                }
            }
            best.as_ref().map_or(f64::INFINITY, |best| best.t.hi)
        });
        best.map(|best| best.found(line, steps))
    }

    /// Whether `line` hits anything; what it took is added to `steps`.
    pub fn any_of(&self, line: &Line, steps: &mut Steps) -> bool {
        let mut any = false;
        self.boxes.each_near(line, steps, &mut |tri, corners, steps| {
            any = any || candidate(line, tri, corners, steps).is_some();
            // Nothing is nearer than this.
            if any { f64::NEG_INFINITY } else { f64::INFINITY }
        });
        any
    }

    /// Where the front-most hit along `line` lies, without rounding.
    pub fn meeting_of(&self, line: &Line) -> Option<(u32, Meeting)> {
        let mut steps = Steps::default();
        let tri = self.closest_of(line, &mut steps)?.tri;
        let corners = self.boxes.corners(tri)?;
        Meeting::of(line, &corners).map(|meeting| (tri, meeting))
    }
}

/// The hit of `line` on a triangle, if there is one.
fn candidate(line: &Line, tri: u32, corners: &Triangle, steps: &mut Steps) -> Option<Candidate> {
    steps.bounded += 1;
    match bounded::ask(line, corners) {
        Verdict::Miss => None,
        Verdict::Hit(bounded) => Some(Candidate { tri, corners: *corners, t: bounded.t, bounded: Some(bounded), exact: None }),
        Verdict::Unsure => {
            steps.exact += 1;
            let exact = Meeting::of(line, corners)?;
            Some(Candidate { tri, corners: *corners, t: exact.t.near(), bounded: None, exact: Some(exact) })
        }
    }
}

/// Whether hit `new` comes before hit `old`.
fn is_before(line: &Line, exact: Option<&Meeting>, new: &Candidate, old: &Candidate, steps: &mut Steps) -> bool {
    if new.t.hi < old.t.lo || new.t.lo > old.t.hi {
        return new.t.hi < old.t.lo;
    }
    steps.exact += 1;
    let t = |candidate: &Candidate, known: Option<&Meeting>| match known {
        Some(exact) => exact.t.clone(),
        None => Meeting::of(line, &candidate.corners).map_or_else(|| unreachable!("a proved hit"), |exact| exact.t),
    };
    match t(new, exact).cmp(&t(old, old.exact.as_ref())) {
        Ordering::Less => true,
        Ordering::Equal => new.tri < old.tri,
        Ordering::Greater => false,
    }
}

impl Candidate {
    /// T, u and v rounded once.
    fn found(self, line: &Line, steps: &mut Steps) -> Found {
        if let Some(bounded) = &self.bounded
            && let (Some(t), Some(u), Some(v)) = (bounded.t.rounded(), bounded.u().rounded(), bounded.v().rounded())
        {
            return Found { tri: self.tri, t, u, v };
        }
        steps.exact += 1;
        let exact = self.exact.or_else(|| Meeting::of(line, &self.corners));
        let exact = exact.unwrap_or_else(|| unreachable!("a proved hit"));
        Found { tri: self.tri, t: exact.t.to_f32(), u: exact.u.to_f32(), v: exact.v.to_f32() }
    }
}
