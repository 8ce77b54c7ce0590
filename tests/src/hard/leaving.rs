//! Rays that leave a surface: where each way to leave goes wrong.
//!
//! The truth of a case is the exact answer from the exact hit point, a point with rational coordinates. On it the triangle that is left, and
//! every other that holds the point, is met at t = 0 and does not count.

use super::Dice;
use super::departures::{Case, Stage};
use crate::judge::{buffer, truth_ray, truth_triangle};
use crate::truth::{Line, Steps, Triangle, Truth};
use gz_core::kernel::hit_weights;
use gz_core::{BruteForce, GzRay, LeavePolicy, RayQuery, TriId};

pub use super::departures::Label;

/// Wrong answers of one way to leave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wrong {
    /// Something is hit, and in truth nothing is.
    pub acne: u64,
    /// Nothing is hit, and in truth something is.
    pub leaks: u64,
}

/// What came of the cases of a label.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Cases: a hit, and a direction in which a ray leaves it.
    pub cases: u64,
    /// Of these, cases in which the leaving ray truly hits something.
    pub blocked: u64,
    /// Cases in which the exact answer from the exact way's own starting point differs from that from the hit point: moving the start by a
    /// few roundings of f64 matters. They count for no policy.
    pub undecided: u64,
    /// Rays left by the exact way that meet the triangle they leave as the first thing.
    pub source_met: u64,
    /// Wrong answers by policy, in the order of [`LeavePolicy::ALL`].
    pub wrong: [Wrong; LeavePolicy::ALL.len()],
}

impl Outcome {
    /// Wrong answers of the exact way.
    pub fn exact(&self) -> Wrong {
        self.wrong[0]
    }
}

impl std::ops::AddAssign for Outcome {
    fn add_assign(&mut self, other: Self) {
        self.cases += other.cases;
        self.blocked += other.blocked;
        self.undecided += other.undecided;
        self.source_met += other.source_met;
        for (sum, wrong) in self.wrong.iter_mut().zip(other.wrong) {
            sum.acne += wrong.acne;
            sum.leaks += wrong.leaks;
        }
    }
}

/// Cases on one stage before the next is built.
const A_STAGE: u64 = 64;

/// `count` cases of `label`, from a seed.
pub fn run(label: Label, seed: u64, count: u64) -> Outcome {
    let mut dice = Dice::new(seed);
    let mut outcome = Outcome::default();
    while outcome.cases < count {
        let stage = label.stage(&mut dice);
        on_stage(&stage, &mut dice, A_STAGE.min(count - outcome.cases), &mut outcome);
    }
    outcome
}

fn on_stage(stage: &Stage, dice: &mut Dice, count: u64, outcome: &mut Outcome) {
    let tris = buffer(stage.triangles.iter().copied());
    let brute = BruteForce::new(&tris);
    let triangles: Vec<Triangle> = stage.triangles.iter().map(truth_triangle).collect();
    let truth = Truth::new(&triangles);
    let (mut done, mut tried) = (0, 0);
    // A few rays miss what they are aimed at, or have no way out in their direction.
    while done < count && tried < 4 * count {
        tried += 1;
        done += u64::from(judge(&stage.case(dice), &brute, &truth, outcome));
    }
}

/// Judges one case, unless its ray hits nothing or has no way out; says whether it was one.
fn judge(case: &Case, brute: &BruteForce<'_>, truth: &Truth, outcome: &mut Outcome) -> bool {
    let Some(line) = truth_ray(&case.ray).line() else { return false };
    let Some((tri, meeting)) = truth.meeting_of(&line) else { return false };
    let corners = brute.tris().position(tri);
    let weights = hit_weights(&case.ray, corners);
    let Some(direction) = case.onward(corners) else { return false };
    let leave = |policy: LeavePolicy| policy.leave(corners, weights, direction).map(|ray| GzRay { tmax: case.tmax, ..ray });
    let Some(start) = leave(LeavePolicy::Exact) else { return false };
    let Some(onward) = Line::from_point(meeting.point, direction.to_array(), case.tmax) else { return false };
    let blocked = truth.any_of(&onward, &mut Steps::default());
    outcome.cases += 1;
    outcome.blocked += u64::from(blocked);
    outcome.source_met += u64::from(brute.closest_hit(&start).tri == tri);
    if truth.any(&truth_ray(&start)) != blocked {
        outcome.undecided += 1;
        return true;
    }
    for (policy, wrong) in LeavePolicy::ALL.into_iter().zip(&mut outcome.wrong) {
        let found = leave(policy).is_some_and(|ray| is_blocked(brute, ray, policy.skips_source().then_some(tri)));
        wrong.acne += u64::from(found && !blocked);
        wrong.leaks += u64::from(!found && blocked);
    }
    true
}

/// Whether a ray hits anything, `skipped` not counted.
fn is_blocked(query: &dyn RayQuery, mut ray: GzRay, skipped: Option<TriId>) -> bool {
    let Some(own) = skipped else { return query.any_hit(&ray) };
    loop {
        let hit = query.closest_hit(&ray);
        if !hit.is_hit() || hit.tri != own {
            return hit.is_hit();
        }
        ray.tmin = hit.t.next_up();
    }
}
