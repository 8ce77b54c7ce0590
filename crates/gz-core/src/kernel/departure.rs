//! Where rays have hit triangles and go on from, eight hits at a time.
// Axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::answer::{EightPairs, NearWeights, WEIGHT_ERROR};
use super::height::Plane;
use super::leaving::{Leaving, combine};
use super::solution::{Bounded, Solution};
use crate::ray::LEAST_ORIGIN;
use crate::simd::{Doubles, EightDoubles, Simd, Task};
use crate::{EightPoints, GzCoord};

/// The points where rays have hit triangles, as [`crate::SurfacePoint::of`] has them; with places to leave from if `leaving`.
pub(crate) struct FindPoints<'p> {
    pub(crate) origins: &'p [[f64; 3]; 8],
    pub(crate) directions: &'p [[f32; 3]; 8],
    pub(crate) corners: &'p [&'p [GzCoord; 3]; 8],
    pub(crate) leaving: bool,
    pub(crate) points: &'p mut EightPoints,
}

/// The most steps that are taken side by side. The first gets off the plane, as a rule.
const STEPS: usize = 3;

/// All lanes.
const ALL: u32 = 0xff;

impl Task for FindPoints<'_> {
    /// A bit for each point of which f64 has decided all.
    type Output = u32;

    #[inline(always)]
    fn run<S: Simd>(self) -> u32 {
        let pairs = EightPairs::<S>::of(self.origins, self.directions, *self.corners);
        let corners = pairs.wide_corners();

        // Errors that are quickly had do: about what they leave open one hit at a time is asked.
        let solution = Solution::quick(pairs.origin, pairs.direction, &corners);
        let NearWeights { weights, certainty, error } = NearWeights::of(&solution);
        let zero = <S::Doubles>::splat(0.0);
        let mut settled = !certainty.at_most(zero) & error.at_most(<S::Doubles>::splat(WEIGHT_ERROR));
        let point = combine(&corners, weights);
        // D is the direction times the normal.
        let (up, down) = signs(solution.d);
        settled &= up | down;
        let plane = Plane::of(&corners);
        let (normal, lean) = plane.unit();
        let mut starts = [point; 2];
        if self.leaving {
            settled &= step_off(&Leaving::of(plane, &corners, weights), &mut starts);
        }
        let points = self.points;
        store(&mut points.weights, weights);
        store(&mut points.point, point);
        store(&mut points.normal, normal);
        points.lean = lean.array();
        store(&mut points.starts[0], starts[0]);
        store(&mut points.starts[1], starts[1]);
        points.leaving = if self.leaving { ALL } else { 0 };
        for k in 0..8 {
            points.to_side[k] = if up >> k & 1 != 0 { 1 } else { -1 };
        }
        settled & ALL
    }
}

/// Where `x` is proved to be above 0, and where below.
#[inline(always)]
fn signs<D: EightDoubles>(x: Bounded<D>) -> (u32, u32) {
    let minus = D::splat(0.0).minus(x.value);
    // Both ways, as NaN proves nothing.
    let above = x.error.at_most(x.value) & !x.value.at_most(x.error);
    let below = x.error.at_most(minus) & !minus.at_most(x.error);
    (above, below)
}

/// Points off the plane on either side, first on that of the winding's normal; returns where both are proved.
#[inline(always)]
fn step_off<D: EightDoubles>(leaving: &Leaving<D>, starts: &mut [[D; 3]; 2]) -> u32 {
    let (zero, normal) = (D::splat(0.0), leaving.plane.normal);
    let sizes = [normal[0].abs(), normal[1].abs(), normal[2].abs()];
    // The axis of the largest component, and the way on it that leads up.
    let x = sizes[1].at_most(sizes[0]) & sizes[2].at_most(sizes[0]);
    let y = !x & sizes[2].at_most(sizes[1]);
    let along = [x, y, !(x | y)];
    let (mut steps, mut certain) = ([zero; 3], 0);
    for axis in 0..3 {
        certain |= along[axis] & !sizes[axis].at_most(leaving.plane.normal_error(axis));
        let step = leaving.step.select(zero.at_most(normal[axis]), zero.minus(leaving.step));
        steps[axis] = step.select(along[axis], zero);
    }

    let mut first = leaving.point;
    for axis in 0..3 {
        first[axis] = without_tiny(first[axis]);
    }
    let (above, below, known) = sides(leaving, first);
    certain &= known;
    for (side, start) in starts.iter_mut().enumerate() {
        let (mut point, mut step) = (first, steps);
        let mut open = !if side == 0 { above } else { below } & ALL;
        for _ in 0..STEPS {
            if open == 0 {
                break;
            }
            for axis in 0..3 {
                let moved = if side == 0 { point[axis].plus(step[axis]) } else { point[axis].minus(step[axis]) };
                point[axis] = without_tiny(moved).select(open, point[axis]);
                step[axis] = step[axis].plus(step[axis]);
            }
            let (above, below, known) = sides(leaving, point);
            certain &= known | !open;
            open &= !if side == 0 { above } else { below };
        }
        certain &= !open;
        *start = point;
    }
    certain
}

/// Where points are above the plane, where below, and where that is certain.
#[inline(always)]
fn sides<D: EightDoubles>(leaving: &Leaving<D>, point: [D; 3]) -> (u32, u32, u32) {
    let height = leaving.plane.height(point);
    let (above, below) = signs(height);
    let zero = D::splat(0.0);
    let within = height.value.abs().at_most(zero) & height.error.at_most(zero);
    (above, below, above | below | within)
}

#[inline(always)]
fn without_tiny<D: EightDoubles>(x: D) -> D {
    x.select(D::splat(LEAST_ORIGIN).at_most(x.abs()), D::splat(0.0))
}

#[inline(always)]
fn store<D: EightDoubles>(rows: &mut [[f64; 8]; 3], x: [D; 3]) {
    for axis in 0..3 {
        rows[axis] = x[axis].array();
    }
}
