//! Shadows, the plain version: the paper's section 2.3.4.
//!
//! From a point P of a surface the shadow ray is P + t L with L the direction to the light; whatever it hits drops that light, while
//! ambient light stays. We differ from the paper in that glass may tint instead of block, rays to a point light end before it, and P
//! lies provably on the side that L points to instead of the triangle being skipped by its number.

use crate::source::{any_hits, closest_hits, passages};
use crate::{Scene, ShadowRule};
use glam::DVec3;
use gz_core::{ClassMask, GzColor, GzCoord, Hit, LeavePolicy, Passages, PerRay, RayBatch, RayQuery, TriClass, TriId};

/// A ray from a surface to a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowRay {
    /// Where it starts, on the side of the triangle that it goes to; shading space.
    pub origin: DVec3,
    /// To the light.
    pub direction: GzCoord,
    /// Where it ends, t in lengths of `direction`: infinite for a directional light.
    pub tmax: f32,
    /// The triangle that it leaves.
    pub leaves: TriId,
}

/// The shadow rays of one light: one direction and no end for a directional light, one of each per ray for a point light.
#[derive(Debug, Default)]
pub(crate) struct ShadowRays {
    /// All directions are equal, and without end: only the first is kept.
    common_direction: bool,
    origins: Vec<DVec3>,
    directions: Vec<GzCoord>,
    tmax: Vec<f32>,
    /// The triangles that they leave.
    leaves: Vec<TriId>,
}

impl ShadowRays {
    /// Forgets all rays; the next ones are of another light.
    pub(crate) fn clear(&mut self, common_direction: bool) {
        self.common_direction = common_direction;
        self.origins.clear();
        self.directions.clear();
        self.tmax.clear();
        self.leaves.clear();
    }

    /// Adds a ray.
    #[inline]
    pub(crate) fn push(&mut self, ray: &ShadowRay) {
        if !self.common_direction || self.origins.is_empty() {
            self.directions.push(ray.direction);
            self.tmax.push(ray.tmax);
        }
        self.origins.push(ray.origin);
        self.leaves.push(ray.leaves);
    }

    pub(crate) fn len(&self) -> usize {
        self.origins.len()
    }

    /// The rays as a batch.
    fn batch(&self, policy: LeavePolicy) -> RayBatch<'_> {
        let (origins, tmin) = (PerRay::Each(&self.origins[..]), PerRay::One(policy.tmin()));
        let (directions, tmax) = match self.directions.first() {
            Some(&direction) if self.common_direction => (PerRay::One(direction), PerRay::One(f32::INFINITY)),
            _ => (PerRay::Each(&self.directions[..]), PerRay::Each(&self.tmax[..])),
        };
        RayBatch::new(self.len(), origins, directions, tmin, tmax).leaving(&self.leaves)
    }
}

/// Whether there is glass for shadow rays to go through.
fn has_glass(scene: &Scene) -> bool {
    scene.materials.iter().zip(&scene.used).any(|(material, &used)| used > 0 && material.class() == TriClass::Glass)
}

/// The triangles that let no light through.
fn blockers(scene: &Scene) -> ClassMask {
    match scene.rules.shadow {
        ShadowRule::Tinted => ClassMask::only(TriClass::Opaque),
        _ => ClassMask::ALL,
    }
}

/// What one shadow ray finds: the share of the light that reaches its start, and the first triangle that lets none through, if any.
pub(crate) fn look(scene: &Scene, query: &dyn RayQuery, ray: &ShadowRay) -> (GzColor, Hit) {
    let mut rays = ShadowRays::default();
    rays.push(ray);
    let mut shadows = Shadows::default();
    shadows.trace(scene, query, &rays);
    let (policy, mut blocker) = (scene.rules.leave, [Hit::MISS]);
    closest_hits(query, policy, &rays.batch(policy), blockers(scene), &mut blocker);
    (shadows.shares[0], blocker[0])
}

/// What share of one light reaches the start of each of its shadow rays, and the room that finding it takes.
#[derive(Debug, Default)]
pub(crate) struct Shadows {
    /// The answer: 0 where something opaque is in the way, 1 where nothing is, else the product of tints.
    pub(crate) shares: Vec<GzColor>,
    passages: Passages,
}

impl Shadows {
    /// Traces `rays`; returns how many further questions it takes to ask about glass in the way one by one.
    pub(crate) fn trace(&mut self, scene: &Scene, query: &dyn RayQuery, rays: &ShadowRays) -> u64 {
        let policy = scene.rules.leave;
        let batch = rays.batch(policy);
        let Passages { blocked, met } = &mut self.passages;
        let tinted = scene.rules.shadow == ShadowRule::Tinted && has_glass(scene);
        if tinted {
            passages(query, policy, &batch, ClassMask::only(TriClass::Glass), &mut self.passages);
        } else {
            met.clear();
            blocked.clear();
            blocked.resize(batch.len(), false);
            any_hits(query, policy, &batch, ClassMask::ALL, blocked);
        }
        self.shares.clear();
        self.shares.extend(self.passages.blocked.iter().map(|&blocked| if blocked { GzColor::ZERO } else { GzColor::ONE }));
        if tinted { self.tint(scene) } else { 0 }
    }

    /// Multiplies the shares of rays by the tint of each glass triangle that they meet, nearest first. Light goes straight through: no
    /// refraction, hence no caustics.
    fn tint(&mut self, scene: &Scene) -> u64 {
        // Whatever is in the way is asked whether it is opaque; then each ray that only glass is in the way of asks once for each
        // triangle of it and once more to learn that there is no other.
        let mut questions = self.passages.blocked.iter().filter(|&&blocked| blocked).count() as u64;
        let mut last = None;
        for &(ray, tri) in &self.passages.met {
            self.shares[ray as usize] *= scene.material(tri).tint;
            questions += if last == Some(ray) { 1 } else { 3 };
            last = Some(ray);
        }
        questions
    }
}
