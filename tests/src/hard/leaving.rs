//! Rays that leave a surface: where each way to leave goes wrong.
//!
//! The truth of a case is the exact answer from the exact hit point, a point with rational coordinates. On it the triangle that is left, and
//! every other that holds the point, is met at t = 0 and does not count.

use super::Dice;
use super::departures::{Case, Stage};
use crate::judge::{buffer, truth_ray, truth_triangle};
use crate::truth::{Line, Steps, Triangle, Truth};
use gz_bsp::BspTree;
use gz_core::kernel::hit_weights;
use gz_core::{BruteForce, ClassMask, GzRay, Hit, LeavePolicy, PerRay, RayBatch, RayQuery, SimdLevel, TriId};

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
    /// Directions that point to the right side of the surface and yet have no start there by the exact way. They are no cases.
    pub lost: u64,
    /// Rays left by the exact way that the tree, told what they leave, answers otherwise than brute force does, which is not told.
    pub differing: u64,
    /// Wrong answers by policy, in the order of [`LeavePolicy::ALL`].
    pub wrong: [Wrong; LeavePolicy::ALL.len()],
}

impl Outcome {
    /// Wrong answers of the exact way.
    pub fn exact(&self) -> Wrong {
        self.wrong[0]
    }

    /// Whether the exact way is right in every case, and the tree with it.
    pub fn is_clean(&self) -> bool {
        self.exact() == Wrong::default() && self.source_met + self.lost + self.differing == 0
    }
}

impl std::ops::AddAssign for Outcome {
    fn add_assign(&mut self, other: Self) {
        self.cases += other.cases;
        self.blocked += other.blocked;
        self.undecided += other.undecided;
        self.source_met += other.source_met;
        self.lost += other.lost;
        self.differing += other.differing;
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
    let (mut left, mut tried) = (Vec::new(), 0);
    // A few rays miss what they are aimed at, or go on to the other side.
    while (left.len() as u64) < count && tried < 4 * count {
        tried += 1;
        left.extend(judge(&stage.case(dice), &brute, &truth, outcome));
    }
    let level = SimdLevel::available()[dice.below(SimdLevel::available().len())];
    outcome.differing += by_tree(&BspTree::build(&tris).with_simd(level), &left);
}

/// A ray that leaves a triangle by the exact way, and what brute force says to it.
struct Left {
    ray: GzRay,
    source: TriId,
    hit: Hit,
}

/// Judges one case, unless its ray hits nothing or goes on to the wrong side, and then is none.
fn judge(case: &Case, brute: &BruteForce<'_>, truth: &Truth, outcome: &mut Outcome) -> Option<Left> {
    let (tri, meeting) = truth.meeting_of(&truth_ray(&case.ray).line()?)?;
    let corners = brute.tris().position(tri);
    let weights = hit_weights(&case.ray, corners);
    let direction = case.onward(corners)?;
    let onward = Line::from_point(meeting.point, direction.to_array(), case.tmax)?;
    let leave = |policy: LeavePolicy| policy.leave(corners, weights, direction).map(|ray| GzRay { tmax: case.tmax, ..ray });
    let Some(start) = leave(LeavePolicy::Exact) else {
        outcome.lost += 1;
        return None;
    };
    let blocked = truth.any_of(&onward, &mut Steps::default());
    let hit = brute.closest_hit(&start);
    outcome.cases += 1;
    outcome.blocked += u64::from(blocked);
    outcome.source_met += u64::from(hit.tri == tri);
    if truth.any(&truth_ray(&start)) == blocked {
        for (policy, wrong) in LeavePolicy::ALL.into_iter().zip(&mut outcome.wrong) {
            let found = leave(policy).is_some_and(|ray| is_blocked(brute, ray, policy.skips_source().then_some(tri)));
            wrong.acne += u64::from(found && !blocked);
            wrong.leaks += u64::from(!found && blocked);
        }
    } else {
        outcome.undecided += 1;
    }
    Some(Left { ray: start, source: tri, hit })
}

/// Rays to which a tree, asked about all of them together and told what each leaves, has another answer than brute force.
fn by_tree(tree: &BspTree<'_>, left: &[Left]) -> u64 {
    let (origins, directions): (Vec<_>, Vec<_>) = left.iter().map(|left| (left.ray.origin, left.ray.direction)).unzip();
    let (tmax, sources): (Vec<_>, Vec<_>) = left.iter().map(|left| (left.ray.tmax, left.source)).unzip();
    let (origin, direction) = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]));
    let batch = RayBatch::new(left.len(), origin, direction, PerRay::One(0.0), PerRay::Each(&tmax)).leaving(&sources);
    let (mut hits, mut occluded) = (vec![Hit::MISS; left.len()], vec![false; left.len()]);
    tree.closest_hits(&batch, ClassMask::ALL, &mut hits);
    tree.any_hits(&batch, ClassMask::ALL, &mut occluded);
    let bits = |hit: &Hit| [hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits()];
    let differs = |((left, hit), any): &((&Left, &Hit), &bool)| bits(&left.hit) != bits(hit) || **any != left.hit.is_hit();
    left.iter().zip(&hits).zip(&occluded).filter(differs).count() as u64
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
