//! Sets of rays: those of the paper's program, those of any frame, samples of them, and the answers to them.

use super::recorder::Recorder;
use glam::{DVec2, DVec3};
use gz_app::error::AppError;
use gz_app::random_lines::RandomLines;
use gz_core::{
    Bounds, ClassMask, GzCoord, GzRay, GzRay32, Hit, NO_TRI, PerRay, RayBatch, RayQuery, TileGrid, TriId, leave_surface,
};
use gz_shade::reflection::reflect;
use gz_shade::{MaterialKind, Scene, SceneNeeds, shade_frame};
use rayon::prelude::*;

/// A property of the rays of a batch, owned: the same for all, or one each.
#[derive(Clone, Debug)]
pub(super) enum Values<T> {
    One(T),
    Each(Vec<T>),
}

impl<T: Copy> Values<T> {
    /// One property of `rays`.
    pub(super) fn each(rays: &[GzRay32], property: impl Fn(GzRay) -> T) -> Self {
        Self::Each(rays.iter().map(|&ray| property(ray.into())).collect())
    }

    pub(super) fn of(values: &PerRay<'_, T>) -> Self {
        match *values {
            PerRay::One(value) => Self::One(value),
            PerRay::Each(values) => Self::Each(values.to_vec()),
        }
    }

    fn view(&self) -> PerRay<'_, T> {
        match self {
            Self::One(value) => PerRay::One(*value),
            Self::Each(values) => PerRay::Each(values),
        }
    }

    /// Every `step`-th, from number `first` on.
    fn thinned(&self, first: usize, step: usize) -> Self {
        match self {
            Self::One(value) => Self::One(*value),
            Self::Each(values) => Self::Each(values.iter().skip(first).step_by(step).copied().collect()),
        }
    }
}

/// Rays asked about together, with what they share, and what was asked.
#[derive(Clone, Debug)]
pub struct Asked {
    pub(super) len: usize,
    pub(super) origin: Values<DVec3>,
    pub(super) direction: Values<GzCoord>,
    pub(super) tmin: Values<f32>,
    pub(super) tmax: Values<f32>,
    /// Which triangles were asked about.
    pub classes: ClassMask,
    /// Whether only *that* something is hit was asked, and not what.
    pub any: bool,
    /// The triangle that each ray leaves, [`NO_TRI`] for none; empty where that is not known.
    pub(super) leaves: Vec<TriId>,
}

impl Asked {
    /// The batch to ask.
    pub fn batch(&self) -> RayBatch<'_> {
        let batch = RayBatch::new(self.len, self.origin.view(), self.direction.view(), self.tmin.view(), self.tmax.view());
        if self.leaves.is_empty() { batch } else { batch.leaving(&self.leaves) }
    }

    /// The triangle that ray `i` leaves, where it is known.
    pub fn leaves(&self, i: usize) -> Option<TriId> {
        self.leaves.get(i).copied().filter(|&tri| tri != NO_TRI)
    }

    /// Rays without end, each with the triangle that it leaves.
    fn unbounded(origin: Values<DVec3>, direction: Values<GzCoord>, leaves: Vec<TriId>) -> Self {
        let (tmin, tmax) = (Values::One(0.0), Values::One(f32::INFINITY));
        Self { len: leaves.len(), origin, direction, tmin, tmax, classes: ClassMask::ALL, any: false, leaves }
    }
}

/// Lines in a batch of random ones.
const RANDOM_BATCH: usize = 1024;

/// Rays in the order in which they are asked, batch by batch.
#[derive(Clone, Debug, Default)]
pub struct RaySet {
    /// The batches.
    pub batches: Vec<Asked>,
}

impl RaySet {
    /// The number of rays.
    pub fn len(&self) -> usize {
        self.batches.iter().map(|batch| batch.len).sum()
    }

    /// Whether there is no ray.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// About `most` of the rays, evenly spaced over the set and still in batches; the set itself when it has no more than that.
    #[must_use]
    pub fn sample(&self, most: usize) -> Self {
        let step = self.len().div_ceil(most.max(1)).max(1);
        if step == 1 {
            return self.clone();
        }
        let (mut seen, mut batches) = (0usize, Vec::new());
        for asked in &self.batches {
            // The first ray of this batch whose number in the whole set is a multiple of the step.
            let first = seen.next_multiple_of(step) - seen;
            seen += asked.len;
            if first < asked.len {
                batches.push(Asked {
                    len: (asked.len - first).div_ceil(step),
                    origin: asked.origin.thinned(first, step),
                    direction: asked.direction.thinned(first, step),
                    tmin: asked.tmin.thinned(first, step),
                    tmax: asked.tmax.thinned(first, step),
                    leaves: asked.leaves.iter().skip(first).step_by(step).copied().collect(),
                    ..*asked
                });
            }
        }
        Self { batches }
    }

    /// The same rays, all asked for the front-most hit among all triangles, as the paper's program asks.
    #[must_use]
    pub fn as_closest(mut self) -> Self {
        for asked in &mut self.batches {
            (asked.any, asked.classes) = (false, ClassMask::ALL);
        }
        self
    }

    /// The rays of the camera alone: those that start at one point and ask what they hit.
    #[must_use]
    pub fn primary(&self) -> Self {
        self.only(|asked| !asked.any && matches!(asked.origin, Values::One(_)))
    }

    /// Those that ask only whether something is in the way.
    #[must_use]
    pub fn shadow(&self) -> Self {
        self.only(|asked| asked.any)
    }

    /// Those that leave a surface and ask what they hit: of mirrors and glass.
    #[must_use]
    pub fn bounced(&self) -> Self {
        // Shadow rays on their way through glass ask for hits too, but of glass alone.
        self.only(|asked| !asked.any && asked.classes == ClassMask::ALL && matches!(asked.origin, Values::Each(_)))
    }

    fn only(&self, wanted: impl Fn(&Asked) -> bool) -> Self {
        Self { batches: self.batches.iter().filter(|asked| wanted(asked)).cloned().collect() }
    }

    /// `n` lines through `bounds`, none more likely than another, the same each time; none when the box has no area.
    pub fn random(bounds: &Bounds, n: usize) -> Self {
        let lines: Vec<GzRay> = RandomLines::through(bounds, 1).into_iter().flatten().take(n).collect();
        let batch = |lines: &[GzRay]| Asked {
            tmin: Values::One(f32::NEG_INFINITY),
            ..Asked::unbounded(
                Values::Each(lines.iter().map(|line| line.origin).collect()),
                Values::Each(lines.iter().map(|line| line.direction).collect()),
                vec![NO_TRI; lines.len()],
            )
        };
        Self { batches: lines.chunks(RANDOM_BATCH).map(batch).collect() }
    }

    /// Each ray with the triangle that it leaves.
    pub fn rays(&self) -> impl Iterator<Item = (GzRay, Option<TriId>)> + '_ {
        self.batches.iter().flat_map(|asked| {
            let batch = asked.batch();
            (0..asked.len).map(move |i| (batch.ray(i), asked.leaves(i)))
        })
    }
}

/// What was answered to a batch.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// Front-most hits.
    Hits(Vec<Hit>),
    /// Whether anything is hit.
    Blocked(Vec<bool>),
}

/// Room for the answers to a set of rays.
pub fn room(rays: &RaySet) -> Vec<Answer> {
    let room = |asked: &Asked| match asked.any {
        true => Answer::Blocked(vec![false; asked.len]),
        false => Answer::Hits(vec![Hit::MISS; asked.len]),
    };
    rays.batches.iter().map(room).collect()
}

/// Asks `query` about all rays, the batches spread over the threads of the current pool.
pub fn trace(query: &dyn RayQuery, rays: &RaySet, answers: &mut [Answer]) {
    let ask = |(asked, answer): (&Asked, &mut Answer)| match answer {
        Answer::Hits(hits) => query.closest_hits(&asked.batch(), asked.classes, hits),
        Answer::Blocked(blocked) => query.any_hits(&asked.batch(), asked.classes, blocked),
    };
    if rayon::current_num_threads() == 1 {
        rays.batches.iter().zip(answers).for_each(ask);
    } else {
        rays.batches.par_iter().zip(answers).for_each(ask);
    }
}

/// The answers of `query`.
pub fn answers(query: &dyn RayQuery, rays: &RaySet) -> Vec<Answer> {
    let mut answers = room(rays);
    trace(query, rays, &mut answers);
    answers
}

/// Rays whose answers differ: in t, triangle, u or v, to the bit, or in whether anything is hit.
pub fn differing(one: &[Answer], other: &[Answer]) -> u64 {
    let bits = |hit: &Hit| (hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits());
    let of_batch = |(one, other): (&Answer, &Answer)| match (one, other) {
        (Answer::Hits(one), Answer::Hits(other)) => one.iter().zip(other).filter(|(a, b)| bits(a) != bits(b)).count() as u64,
        (Answer::Blocked(one), Answer::Blocked(other)) => one.iter().zip(other).filter(|(a, b)| a != b).count() as u64,
        (Answer::Hits(all), _) | (_, Answer::Hits(all)) => all.len() as u64,
    };
    one.iter().zip(other).map(of_batch).sum()
}

/// Rays that are answered with another triangle.
pub fn other_triangle(one: &[Answer], other: &[Answer]) -> u64 {
    let of_batch = |(one, other): (&Answer, &Answer)| match (one, other) {
        (Answer::Hits(one), Answer::Hits(other)) => one.iter().zip(other).filter(|(a, b)| a.tri != b.tri).count() as u64,
        _ => 0,
    };
    one.iter().zip(other).map(of_batch).sum()
}

/// Pixels that are worked on together: the side of a tile.
pub const TILE: u32 = 32;

/// The rays of the paper's program: a primary ray a pixel, what mirrors reflect of it, followed while the depth is below 3, and
/// from every hit a shadow ray to each light. All are asked for the front-most hit.
///
/// We differ in where secondary rays start: on the leaving side of their triangle instead of at the rounded hit, so that no triangle
/// has to be excluded. A ray still knows the triangle that it leaves, whose tests the paper's figures leave out.
pub fn paper_rays(scene: &Scene, query: &dyn RayQuery) -> RaySet {
    let mut set = RaySet::default();
    for tile in TileGrid::whole(scene.camera.width(), scene.camera.height(), TILE).tiles() {
        let mut level: Vec<(GzRay, Option<TriId>)> =
            tile.in_squares().map(|(i, j)| (scene.camera.ray(i, j, DVec2::ZERO), None)).collect();
        for depth in 0..=3 {
            if level.is_empty() {
                break;
            }
            let rays = level_batch(&level, depth == 0);
            let mut hits = vec![Hit::MISS; level.len()];
            query.closest_hits(&rays.batch(), ClassMask::ALL, &mut hits);
            set.batches.push(rays);
            shadow_batches(scene, &hits, &mut set);
            let going_on = level.iter().zip(&hits).filter(|(_, hit)| depth < 3 && is_mirror(scene, hit));
            level = going_on.filter_map(|((ray, _), hit)| mirror_ray(scene, ray, hit)).collect();
        }
    }
    set
}

fn level_batch(level: &[(GzRay, Option<TriId>)], primary: bool) -> Asked {
    let directions = Values::Each(level.iter().map(|(ray, _)| ray.direction).collect());
    let origins = match level.first() {
        Some((first, _)) if primary => Values::One(first.origin),
        _ => Values::Each(level.iter().map(|(ray, _)| ray.origin).collect()),
    };
    Asked::unbounded(origins, directions, level.iter().map(|(_, leaves)| leaves.unwrap_or(NO_TRI)).collect())
}

/// The shadow rays of `hits`, one batch a light.
fn shadow_batches(scene: &Scene, hits: &[Hit], set: &mut RaySet) {
    for light in &scene.lights {
        let (mut origins, mut leaves) = (Vec::new(), Vec::new());
        let direction = light.arrive(DVec3::ZERO).direction;
        for hit in hits.iter().filter(|hit| hit.is_hit()) {
            if let Some(origin) = leave_surface(scene.tris.position(hit.tri), hit.weights(), direction) {
                origins.push(origin);
                leaves.push(hit.tri);
            }
        }
        if !origins.is_empty() {
            set.batches.push(Asked::unbounded(Values::Each(origins), Values::One(direction), leaves));
        }
    }
}

fn is_mirror(scene: &Scene, hit: &Hit) -> bool {
    hit.is_hit() && matches!(scene.material(hit.tri).kind, MaterialKind::Mirror { .. })
}

fn mirror_ray(scene: &Scene, ray: &GzRay, hit: &Hit) -> Option<(GzRay, Option<TriId>)> {
    let normal = match scene.tris.normals(hit.tri) {
        Some(normals) => (0..3).map(|k| normals[k].as_dvec3() * hit.weights()[k]).sum::<DVec3>().normalize_or_zero(),
        None => scene.tris.face_normal(hit.tri),
    };
    let direction = reflect(ray.direction.as_dvec3(), normal).as_vec3();
    let origin = leave_surface(scene.tris.position(hit.tri), hit.weights(), direction)?;
    Some((GzRay::from_f64(origin, direction), Some(hit.tri)))
}

/// All rays of a frame, as its render asks about them in tiles of this side; the order does not depend on threads.
///
/// # Errors
///
/// If there is no thread to be had.
pub fn frame_rays(scene: &Scene, needs: SceneNeeds, query: &dyn RayQuery, tile: u32) -> Result<RaySet, AppError> {
    let recorder = Recorder::of(query);
    let grid = TileGrid::whole(scene.camera.width(), scene.camera.height(), tile);
    gz_app::threads::with(1, || {
        shade_frame(scene, needs, &recorder, &grid, &|_| ());
        Ok(())
    })?;
    Ok(RaySet { batches: recorder.taken() })
}
