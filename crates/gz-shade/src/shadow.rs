//! Shadows, the plain version: the paper's section 2.3.4.
//!
//! From a point P of a surface the shadow ray is P + t L with L the direction to the light; whatever it hits drops that light, while
//! ambient light stays. We differ from the paper in that glass may tint instead of block, rays to a point light end before it, and P
//! lies provably on the side that L points to instead of the triangle being skipped by its number.

use crate::source::{leaving, skip_sources};
use crate::{Scene, ShadowRule};
use glam::DVec3;
use gz_core::{ClassMask, GzColor, GzCoord, Hit, LeavePolicy, PerRay, RayBatch, RayQuery, TriClass, TriId};

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
    pub(crate) origins: Vec<DVec3>,
    pub(crate) directions: Vec<GzCoord>,
    pub(crate) tmax: Vec<f32>,
    /// The triangles that they leave.
    leaves: Vec<TriId>,
}

impl ShadowRays {
    /// Forgets all rays.
    pub(crate) fn clear(&mut self) {
        self.origins.clear();
        self.directions.clear();
        self.tmax.clear();
        self.leaves.clear();
    }

    /// Adds a ray.
    pub(crate) fn push(&mut self, ray: &ShadowRay) {
        self.origins.push(ray.origin);
        self.directions.push(ray.direction);
        self.tmax.push(ray.tmax);
        self.leaves.push(ray.leaves);
    }

    /// The ray of this number.
    fn ray(&self, k: usize) -> ShadowRay {
        ShadowRay { origin: self.origins[k], direction: self.directions[k], tmax: self.tmax[k], leaves: self.leaves[k] }
    }

    /// The rays as a batch. `common_direction`: all directions are equal, and without end.
    fn batch(&self, common_direction: bool, policy: LeavePolicy) -> RayBatch<'_> {
        let (len, origins, tmin) = (self.origins.len(), PerRay::Each(&self.origins[..]), PerRay::One(policy.tmin()));
        let batch = match self.directions.first() {
            Some(&direction) if common_direction => {
                RayBatch::new(len, origins, PerRay::One(direction), tmin, PerRay::One(f32::INFINITY))
            }
            _ => RayBatch::new(len, origins, PerRay::Each(&self.directions), tmin, PerRay::Each(&self.tmax)),
        };
        leaving(batch, policy, &self.leaves)
    }

    /// The front-most hits of the rays among `classes`, their own triangles left out where the rules say so.
    fn closest(&self, scene: &Scene, query: &dyn RayQuery, batch: &RayBatch<'_>, classes: ClassMask, hits: &mut Vec<Hit>) {
        hits.clear();
        hits.resize(batch.len(), Hit::MISS);
        query.closest_hits(batch, classes, hits);
        if scene.rules.leave.skips_source() {
            skip_sources(query, batch, classes, &self.leaves, hits);
        }
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
    shadows.trace(scene, query, &rays, false);
    let mut blocker = Vec::new();
    rays.closest(scene, query, &rays.batch(false, scene.rules.leave), blockers(scene), &mut blocker);
    (shadows.shares[0], blocker[0])
}

/// What share of one light reaches the start of each of its shadow rays, and the room that finding it takes.
#[derive(Debug, Default)]
pub(crate) struct Shadows {
    /// The answer: 0 where something opaque is in the way, 1 where nothing is, else the product of tints.
    pub(crate) shares: Vec<GzColor>,
    blocked: Vec<bool>,
    /// Rays still on their way through glass: their number in the light's rays, and the rays themselves.
    on_way: Vec<u32>,
    rest: ShadowRays,
    tmin: Vec<f32>,
    hits: Vec<Hit>,
}

impl Shadows {
    /// Traces `rays`; returns how many further questions were asked about glass in the way.
    pub(crate) fn trace(&mut self, scene: &Scene, query: &dyn RayQuery, rays: &ShadowRays, common_direction: bool) -> u64 {
        let tinted = scene.rules.shadow == ShadowRule::Tinted && has_glass(scene);
        let policy = scene.rules.leave;
        let batch = rays.batch(common_direction, policy);
        self.blocked.clear();
        if policy.skips_source() {
            // *That* something is hit is not enough: it may be the triangle left.
            rays.closest(scene, query, &batch, blockers(scene), &mut self.hits);
            self.blocked.extend(self.hits.iter().map(Hit::is_hit));
        } else {
            self.blocked.resize(batch.len(), false);
            query.any_hits(&batch, ClassMask::ALL, &mut self.blocked);
        }
        self.shares.clear();
        self.shares.extend(self.blocked.iter().map(|&blocked| if blocked { GzColor::ZERO } else { GzColor::ONE }));
        if !tinted {
            return 0;
        }
        self.on_way.clear();
        if policy.skips_source() {
            self.on_way.extend((0..rays.origins.len() as u32).filter(|&k| !self.blocked[k as usize]));
            return self.tint(scene, query, rays);
        }
        self.meet_glass_alone(scene, query, rays, common_direction) + self.tint(scene, query, rays)
    }

    /// Of the rays that something is in the way of, finds those that only glass is in the way of, and gives them their light back. Most
    /// rays meet nothing at all, and have been asked about once by now.
    fn meet_glass_alone(&mut self, scene: &Scene, query: &dyn RayQuery, rays: &ShadowRays, common_direction: bool) -> u64 {
        self.on_way.extend((0..rays.origins.len() as u32).filter(|&k| self.blocked[k as usize]));
        if self.on_way.is_empty() {
            return 0;
        }
        self.rest.clear();
        for &k in &self.on_way {
            self.rest.push(&rays.ray(k as usize));
        }
        let batch = self.rest.batch(common_direction, scene.rules.leave);
        self.blocked.clear();
        self.blocked.resize(batch.len(), false);
        query.any_hits(&batch, blockers(scene), &mut self.blocked);
        let questions = self.on_way.len() as u64;
        let mut place = 0;
        self.on_way.retain(|&k| {
            let blocked = self.blocked[place];
            place += 1;
            if !blocked {
                self.shares[k as usize] = GzColor::ONE;
            }
            !blocked
        });
        questions
    }

    /// Multiplies the shares of the rays on their way by the tint of each glass triangle that they meet, nearest first. Light
    /// goes straight through: no refraction, hence no caustics.
    fn tint(&mut self, scene: &Scene, query: &dyn RayQuery, rays: &ShadowRays) -> u64 {
        let mut questions = 0;
        self.tmin.clear();
        self.tmin.resize(self.on_way.len(), scene.rules.leave.tmin());
        while !self.on_way.is_empty() {
            self.rest.clear();
            for &k in &self.on_way {
                self.rest.push(&rays.ray(k as usize));
            }
            let batch = RayBatch::new(
                self.on_way.len(),
                PerRay::Each(&self.rest.origins),
                PerRay::Each(&self.rest.directions),
                PerRay::Each(&self.tmin),
                PerRay::Each(&self.rest.tmax),
            );
            let batch = leaving(batch, scene.rules.leave, &self.rest.leaves);
            self.rest.closest(scene, query, &batch, ClassMask::only(TriClass::Glass), &mut self.hits);
            questions += self.on_way.len() as u64;
            // Keep the rays that met glass, to ask again behind it.
            let mut kept = 0;
            for i in 0..self.hits.len() {
                let hit = self.hits[i];
                if !hit.is_hit() {
                    continue;
                }
                let share = &mut self.shares[self.on_way[i] as usize];
                *share *= scene.material(hit.tri).tint;
                // The exact t rounds to hit.t, so it lies below the next f32: the triangle is not met twice. Of several within
                // one step, such as two coinciding walls, the first counts for all.
                if *share != GzColor::ZERO && hit.t.is_finite() {
                    self.on_way[kept] = self.on_way[i];
                    self.tmin[kept] = hit.t.next_up();
                    kept += 1;
                }
            }
            self.on_way.truncate(kept);
            self.tmin.truncate(kept);
        }
        questions
    }
}
