//! The product before the truth: its answers, from whatever gives them, against those of [`crate::truth`].

mod frame;

pub use frame::{questions, shaded};

use crate::truth::{Found, Ray, Triangle, Truth};
use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, GzTri, Hit, Passages, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer};

/// A ray as the truth takes it.
pub fn truth_ray(ray: &GzRay) -> Ray {
    Ray { origin: ray.origin.to_array(), direction: ray.direction.to_array(), tmin: ray.tmin, tmax: ray.tmax }
}

/// Corners as the truth takes them.
pub fn truth_triangle(corners: &[GzCoord; 3]) -> Triangle {
    corners.map(|corner| corner.to_array())
}

/// The triangles of a buffer as the truth takes them.
pub fn truth_triangles(tris: &TriBuffer) -> Vec<Triangle> {
    tris.positions().iter().map(truth_triangle).collect()
}

/// A buffer of positions only.
///
/// # Panics
///
/// If a corner is not finite.
pub fn buffer(triangles: impl IntoIterator<Item = [GzCoord; 3]>) -> TriBuffer {
    let mut tris = TriBuffer::new();
    for positions in triangles {
        tris.push(&GzTri { positions, ..GzTri::default() }).expect("finite corners");
    }
    tris
}

/// How one answer compares with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Hit or miss, triangle and T are the true ones, u and v within one step of f32 or 2^-40.
    Right,
    /// A hit where there is none.
    FalseHit,
    /// A miss where there is a hit.
    FalseMiss,
    /// Another triangle.
    Triangle,
    /// The right triangle with another T, in steps of f32.
    T(u32),
    /// Right so far, with weights too far off.
    Weights,
}

/// Judges one answer.
pub fn judge(found: &Hit, truth: Option<Found>) -> Verdict {
    let Some(truth) = truth else {
        return if found.is_hit() { Verdict::FalseHit } else { Verdict::Right };
    };
    if !found.is_hit() {
        Verdict::FalseMiss
    } else if found.tri != truth.tri {
        Verdict::Triangle
    } else if found.t.to_bits() != truth.t.to_bits() {
        Verdict::T(steps(found.t, truth.t))
    } else if !(near(found.u, truth.u) && near(found.v, truth.v)) {
        Verdict::Weights
    } else {
        Verdict::Right
    }
}

/// Steps of f32 from one number to another; 0 and -0 are none apart, and NaN is as far away as it gets.
pub fn steps(a: f32, b: f32) -> u32 {
    if a.is_nan() || b.is_nan() {
        return u32::MAX;
    }
    let place = |x: f32| {
        let magnitude = i64::from(x.to_bits() & 0x7fff_ffff);
        if x.is_sign_negative() { -magnitude } else { magnitude }
    };
    place(a).abs_diff(place(b)) as u32
}

/// Within one step of f32, or 2^-40.
fn near(found: f32, truth: f32) -> bool {
    steps(found, truth) <= 1 || (f64::from(found) - f64::from(truth)).abs() <= 2f64.powi(-40)
}

/// Verdicts counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Answers judged.
    pub rays: u64,
    /// Of these, rays that truly hit.
    pub hits: u64,
    /// [`Verdict::FalseHit`].
    pub false_hits: u64,
    /// [`Verdict::FalseMiss`].
    pub false_misses: u64,
    /// [`Verdict::Triangle`].
    pub triangles: u64,
    /// [`Verdict::T`].
    pub t: u64,
    /// [`Verdict::Weights`].
    pub weights: u64,
    /// The greatest error of T where the triangle is right, in steps of f32.
    pub worst_t: u32,
}

impl Tally {
    /// Judges and counts one answer.
    pub fn add(&mut self, found: &Hit, truth: Option<Found>) {
        self.rays += 1;
        self.hits += u64::from(truth.is_some());
        match judge(found, truth) {
            Verdict::Right => {}
            Verdict::FalseHit => self.false_hits += 1,
            Verdict::FalseMiss => self.false_misses += 1,
            Verdict::Triangle => self.triangles += 1,
            Verdict::T(steps) => {
                self.t += 1;
                self.worst_t = self.worst_t.max(steps);
            }
            Verdict::Weights => self.weights += 1,
        }
    }

    /// Whether everything was right.
    pub fn is_clean(&self) -> bool {
        self.false_hits + self.false_misses + self.triangles + self.t + self.weights == 0
    }
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.false_hits += other.false_hits;
        self.false_misses += other.false_misses;
        self.triangles += other.triangles;
        self.t += other.t;
        self.weights += other.weights;
        self.worst_t = self.worst_t.max(other.worst_t);
    }
}

/// MAX_DEPTH and MIN_SIZE of the paper's tree that everyone is asked with: hardly cut, cut early, cut to the bottom.
pub const SETTINGS: [(u32, usize); 3] = [(1, 0), (5, 1), (12, 3)];

/// Calls `ask` with everything that answers rays: brute force and the tree that tunes itself at every SIMD level of this machine, and the
/// paper's tree at each of [`SETTINGS`] that stays within a budget.
pub fn everyone(tris: &TriBuffer, mut ask: impl FnMut(&str, &dyn RayQuery)) {
    for &level in SimdLevel::available() {
        ask(&format!("brute force, {level:?}"), &BruteForce::new(tris).with_simd(level));
        let tree = BspTree::build(tris).with_simd(level);
        tree.assert_well_formed();
        ask(&format!("tree, {level:?}"), &tree);
    }
    for (max_depth, min_size) in SETTINGS {
        let setting = Midpoint { max_depth, min_size, node_budget: 1 << 16 };
        if let Ok(tree) = MidpointTree::build(tris, setting) {
            ask(&format!("midpoint tree ({max_depth}, {min_size})"), &tree);
        }
    }
}

/// Asks everyone about `rays`, one by one and as a batch, for the front-most hit and for any, and returns the answers, which are the
/// true ones.
///
/// # Panics
///
/// If an answer is not the true one, or two answers differ in a bit.
pub fn settled(name: &str, tris: &TriBuffer, rays: &[GzRay]) -> Vec<Hit> {
    let truth = Truth::new(&truth_triangles(tris));
    let expected: Vec<Option<Found>> = rays.iter().map(|ray| truth.closest(&truth_ray(ray))).collect();
    let (origins, directions): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.origin, ray.direction)).unzip();
    let (tmin, tmax): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.tmin, ray.tmax)).unzip();
    let (origin, direction) = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]));
    let batch = RayBatch::new(rays.len(), origin, direction, PerRay::Each(&tmin), PerRay::Each(&tmax));
    let mut answers: Option<Vec<Hit>> = None;
    // All that rays meet if nothing stops them.
    let mut passages: Option<Passages> = None;
    everyone(tris, |who, query| {
        let mut met = Passages::default();
        query.passages(&batch, ClassMask::ALL, &mut met);
        assert!(passages.as_ref().is_none_or(|before| *before == met), "{name}, {who}: passages differ from those before");
        passages = Some(met);
        let mut together = vec![Hit::MISS; rays.len()];
        query.closest_hits(&batch, ClassMask::ALL, &mut together);
        let mut any_together = vec![false; rays.len()];
        query.any_hits(&batch, ClassMask::ALL, &mut any_together);
        for (i, (ray, expected)) in rays.iter().zip(&expected).enumerate() {
            let alone = query.closest_hit(ray);
            let verdict = judge(&alone, *expected);
            assert_eq!(verdict, Verdict::Right, "{name}, {who}: {alone:?} for {expected:?}, {ray:?}");
            assert_eq!(bits(&together[i]), bits(&alone), "{name}, {who}: in a batch and alone, {ray:?}");
            let any = (any_together[i], query.any_hit(ray));
            assert_eq!(any, (alone.is_hit(), alone.is_hit()), "{name}, {who}: any hit, {ray:?}");
        }
        let same = |answers: &Vec<Hit>| answers.iter().map(bits).eq(together.iter().map(bits));
        assert!(answers.as_ref().is_none_or(same), "{name}, {who}: u or v differ from those before");
        answers = Some(together);
    });
    answers.unwrap_or_default()
}

/// All of a hit.
fn bits(hit: &Hit) -> [u32; 4] {
    [hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_wrong_answer_is_told() {
        let truth = Found { tri: 3, t: 1.0, u: 0.25, v: 0.0 };
        let hit = Hit { t: 1.0, tri: 3, u: 0.25f32.next_up(), v: 1e-13 };
        assert_eq!(judge(&hit, Some(truth)), Verdict::Right);
        assert_eq!(judge(&Hit::MISS, Some(truth)), Verdict::FalseMiss);
        assert_eq!((judge(&hit, None), judge(&Hit::MISS, None)), (Verdict::FalseHit, Verdict::Right));
        assert_eq!(judge(&Hit { tri: 2, ..hit }, Some(truth)), Verdict::Triangle);
        assert_eq!(judge(&Hit { t: 1f32.next_down(), ..hit }, Some(truth)), Verdict::T(1));
        assert_eq!(judge(&Hit { t: f32::NAN, ..hit }, Some(truth)), Verdict::T(u32::MAX));
        assert_eq!(judge(&Hit { u: 0.2501, ..hit }, Some(truth)), Verdict::Weights);
        assert_eq!(judge(&Hit { v: 1e-6, ..hit }, Some(truth)), Verdict::Weights);
        let mut tally = Tally::default();
        tally.add(&hit, Some(truth));
        assert!(tally.is_clean() && (tally.rays, tally.hits) == (1, 1));
        for wrong in [Hit::MISS, Hit { tri: 2, ..hit }, Hit { t: 1.5, ..hit }, Hit { v: 0.5, ..hit }] {
            tally.add(&wrong, Some(truth));
        }
        tally.add(&hit, None);
        assert_eq!((tally.false_misses, tally.triangles, tally.t, tally.weights, tally.false_hits), (1, 1, 1, 1, 1));
        assert!(!tally.is_clean() && tally.worst_t == 1 << 22);
    }

    #[test]
    fn steps_count_f32_numbers() {
        assert_eq!((steps(1.0, 1.0f32.next_up()), steps(0.0, -0.0), steps(f32::from_bits(1), -f32::from_bits(2))), (1, 0, 3));
        assert_eq!(steps(f32::MAX, f32::INFINITY), 1);
        assert_eq!(steps(f32::INFINITY, f32::NEG_INFINITY), 2 * 0x7f80_0000);
    }

    #[test]
    fn a_triangle_that_a_query_does_not_know_is_missed() {
        let wall = [[-9.0, -9.0, 2.0], [9.0, -9.0, 2.0], [0.0, 9.0, 2.0]].map(GzCoord::from_array);
        let ray = GzRay::new(GzCoord::ZERO, GzCoord::Z);
        let expected = Truth::new(&[truth_triangle(&wall)]).closest(&truth_ray(&ray));
        assert_eq!(judge(&BruteForce::new(&buffer([wall])).closest_hit(&ray), expected), Verdict::Right);
        assert_eq!(judge(&BruteForce::new(&buffer([])).closest_hit(&ray), expected), Verdict::FalseMiss);
    }
}
