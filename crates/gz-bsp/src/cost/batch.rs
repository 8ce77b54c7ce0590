//! The questions, a bundle of rays at a time.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::abreast::Abreast;
use super::quest::{AnyOf, BundleQuest, ClosestOf};
use super::queue::Queue;
use super::slabs::BundleSlabs;
use super::walk::{Blocked, NearestOf, Stack};
use super::wide::BspTree;
use crate::Visits;
use gz_core::kernel::{
    Asked, BUNDLE, GoingThrough, LANES, Nearest, OnHit, PACKETS, RayBundle, Rays, Stopped, count, first, is_none, packets,
};
use gz_core::simd::{Simd, Task, dispatch};
use gz_core::{ClassMask, GzRay, Hit, Passages, PerRay, RayBatch, RayQuery, Targets, TriBuffer, with_default_float_control};

use std::cell::Cell;
use std::ops::{Deref, DerefMut};

/// Rays that go the same way go together from this number on ...
const COMPANY: u32 = 8;
/// ... when so many are in each packet that has any, in the mean.
const DENSE: u32 = 5;

/// Whether rays are enough to go together.
#[inline(always)]
fn are_enough(rays: &Rays) -> bool {
    count(rays) >= COMPANY.max(DENSE * packets(rays))
}

/// Part `i` of a company: all of it, and then each packet, as neighbours may go together where not all do.
#[inline(always)]
fn part(company: &Rays, i: usize) -> Rays {
    let mut part = *company;
    for p in 0..PACKETS {
        part[p] = if i == 0 || i == p + 1 { company[p] } else { 0 };
    }
    part
}

/// Takes the rays of `part` out of `company`.
#[inline(always)]
fn take_out(part: &Rays, company: &mut Rays) {
    for p in 0..PACKETS {
        company[p] &= !part[p];
    }
}

/// Puts the rays of `part` into `company`.
#[inline(always)]
fn add(part: &Rays, company: &mut Rays) {
    for p in 0..PACKETS {
        company[p] |= part[p];
    }
}

impl RayQuery for BspTree<'_> {
    fn tris(&self) -> &TriBuffer {
        self.tris
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        let targets = Targets::new(self.tris, classes);
        with_default_float_control(|| dispatch(self.level, ClosestTask { tree: self, rays, targets, hits, visits: &mut () }));
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "one answer a ray");
        let targets = Targets::new(self.tris, classes);
        let task = AnyTask { tree: self, rays, targets, occluded, on_hit: Stopped, visits: &mut () };
        with_default_float_control(|| dispatch(self.level, task));
    }

    fn passages(&self, rays: &RayBatch<'_>, through: ClassMask, passages: &mut Passages) {
        let Passages { blocked, met } = passages;
        blocked.clear();
        blocked.resize(rays.len(), false);
        met.clear();
        let targets = Targets::new(self.tris, ClassMask::ALL);
        let on_hit = GoingThrough::new(through, met);
        let task = AnyTask { tree: self, rays, targets, occluded: blocked, on_hit, visits: &mut () };
        with_default_float_control(|| dispatch(self.level, task));
    }
}

impl BspTree<'_> {
    /// The front-most hit of one ray, telling `visits` of each step.
    pub fn closest_hit_counted(&self, ray: &GzRay, classes: ClassMask, visits: &mut impl Visits) -> Hit {
        let mut hit = [Hit::MISS];
        let (rays, targets) = (of_one(ray), Targets::new(self.tris, classes));
        let task = ClosestTask { tree: self, rays: &rays, targets, hits: &mut hit, visits };
        with_default_float_control(|| dispatch(self.level, task));
        hit[0]
    }

    /// Whether one ray hits anything, telling `visits` of each step.
    pub fn any_hit_counted(&self, ray: &GzRay, classes: ClassMask, visits: &mut impl Visits) -> bool {
        let mut occluded = [false];
        let (rays, targets) = (of_one(ray), Targets::new(self.tris, classes));
        let task = AnyTask { tree: self, rays: &rays, targets, occluded: &mut occluded, on_hit: Stopped, visits };
        with_default_float_control(|| dispatch(self.level, task));
        occluded[0]
    }
}

fn of_one(ray: &GzRay) -> RayBatch<'static> {
    RayBatch::new(1, PerRay::One(ray.origin), PerRay::One(ray.direction), PerRay::One(ray.tmin), PerRay::One(ray.tmax))
}

/// What a batch is worked on with: memory alone, kept by each thread from batch to batch, as filling it anew would take longer than many
/// a batch.
struct Desk {
    bundle: RayBundle,
    slabs: BundleSlabs,
    queue: Queue,
    stack: Stack,
    abreast: Box<Abreast>,
}

thread_local! {
    static DESK: Cell<Option<Box<Desk>>> = const { Cell::new(None) };
}

/// A desk on loan.
struct Loan(Option<Box<Desk>>);

impl Desk {
    fn take() -> Loan {
        let new = || {
            Box::new(Self {
                bundle: RayBundle::empty(),
                slabs: BundleSlabs::empty(),
                queue: Queue::new(),
                stack: Stack::new(),
                abreast: Box::new(Abreast::new()),
            })
        };
        Loan(Some(DESK.take().unwrap_or_else(new)))
    }
}

impl Deref for Loan {
    type Target = Desk;

    fn deref(&self) -> &Desk {
        self.0.as_ref().expect("a loan holds its desk until it ends")
    }
}

impl DerefMut for Loan {
    fn deref_mut(&mut self) -> &mut Desk {
        self.0.as_mut().expect("a loan holds its desk until it ends")
    }
}

impl Drop for Loan {
    fn drop(&mut self) {
        DESK.set(self.0.take());
    }
}

pub(super) struct ClosestTask<'t, V> {
    pub(super) tree: &'t BspTree<'t>,
    pub(super) rays: &'t RayBatch<'t>,
    pub(super) targets: Targets<'t>,
    pub(super) hits: &'t mut [Hit],
    pub(super) visits: &'t mut V,
}

impl<V: Visits> Task for ClosestTask<'_, V> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { tree, rays, targets, hits, visits } = self;
        let mut desk = Desk::take();
        let Desk { bundle, slabs, queue, stack, abreast } = &mut *desk;
        let (mut from, mut later) = (0, hits);
        while !later.is_empty() {
            let hits;
            (hits, later) = later.split_at_mut(later.len().min(BUNDLE));
            for hit in later.iter().take(BUNDLE).step_by(4) {
                S::prefetch(hit);
            }
            let fit = bundle.gather::<S>(rays, from, hits.len(), &tree.space);
            slabs.gather::<S>(bundle, hits.len().div_ceil(LANES), tree.space.reach);
            let quest = ClosestOf { tree, bundle: &mut *bundle, rays, targets: &targets, visits: &mut *visits };
            tree.send_all::<S, _>(slabs, &fit, queue, stack, abreast, quest);
            bundle.hits::<S>(rays, targets.positions(), hits);
            if count(&fit) as usize != hits.len() {
                tree.far_hits(rays, from, &fit, &targets, hits, visits);
            }
            from += BUNDLE;
        }
    }
}

pub(super) struct AnyTask<'t, K, V> {
    pub(super) tree: &'t BspTree<'t>,
    pub(super) rays: &'t RayBatch<'t>,
    pub(super) targets: Targets<'t>,
    pub(super) occluded: &'t mut [bool],
    pub(super) on_hit: K,
    pub(super) visits: &'t mut V,
}

impl<K: OnHit, V: Visits> Task for AnyTask<'_, K, V> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { tree, rays, targets, occluded, mut on_hit, visits } = self;
        let mut desk = Desk::take();
        let Desk { bundle, slabs, queue, stack, abreast } = &mut *desk;
        for (from, occluded) in (0..).step_by(BUNDLE).zip(occluded.chunks_mut(BUNDLE)) {
            let fit = bundle.gather::<S>(rays, from, occluded.len(), &tree.space);
            slabs.gather::<S>(bundle, occluded.len().div_ceil(LANES), tree.space.reach);
            let mut blocked = [0; PACKETS];
            let (targets, visits) = (&targets, &mut *visits);
            let quest =
                AnyOf { tree, bundle: &*bundle, rays, targets, blocked: &mut blocked, on_hit: &mut on_hit, visits: &mut *visits };
            tree.send_all::<S, _>(slabs, &fit, queue, stack, abreast, quest);
            if count(&fit) as usize != occluded.len() {
                tree.far_answers(rays, from, &fit, targets, &mut blocked, occluded.len(), &mut on_hit, visits);
            }
            for (p, occluded) in occluded.chunks_mut(LANES).enumerate() {
                for (lane, occluded) in occluded.iter_mut().enumerate() {
                    *occluded = blocked[p] >> lane & 1 != 0;
                }
            }
            on_hit.settle::<S>(rays, from, &blocked, targets.positions());
        }
    }
}

impl BspTree<'_> {
    /// Sends the rays of `fit`, together where they go the same way and alone elsewhere.
    #[inline(always)]
    fn send_all<S: Simd, Q: BundleQuest>(
        &self,
        slabs: &BundleSlabs,
        fit: &Rays,
        queue: &mut Queue,
        stack: &mut Stack,
        abreast: &mut Abreast,
        mut quest: Q,
    ) {
        let (mut left, mut lonely) = (*fit, [0; PACKETS]);
        while let Some((p, lane)) = first(&left) {
            let mut company = slabs.company(p, lane, &left);
            take_out(&company, &mut left);
            let way = slabs.way(p, lane);
            let parts = if company[p].count_ones() == count(&company) { 1 } else { 1 + PACKETS };
            for i in 0..parts {
                let part = part(&company, i);
                if are_enough(&part) && self.send_together::<S, _>(slabs, way, &part, queue, abreast, &mut quest) {
                    take_out(&part, &mut company);
                    if is_none(&company) {
                        break;
                    }
                }
            }
            add(&company, &mut lonely);
        }
        if !is_none(&lonely) {
            abreast.send(quest.bundle(), slabs, &lonely);
        }
        self.send_abreast::<S, Q>(slabs, abreast, stack, quest);
    }

    /// The hits of valid rays that the f32 kernels cannot take: those not in `fit`.
    #[cold]
    #[inline(never)]
    fn far_hits(
        &self,
        rays: &RayBatch<'_>,
        from: usize,
        fit: &Rays,
        targets: &Targets<'_>,
        hits: &mut [Hit],
        visits: &mut impl Visits,
    ) {
        for (lane, hit) in hits.iter_mut().enumerate().filter(|(lane, _)| fit[lane / LANES] >> (lane % LANES) & 1 == 0) {
            let ray = rays.ray(from + lane);
            if ray.is_valid() {
                let best = Nearest::before(&ray, rays.left_by(from + lane));
                let mut quest = NearestOf { ray: Asked::new(rays, from + lane), tmin: ray.tmin, targets, best };
                self.send_far(&ray, &mut quest, visits);
                *hit = quest.best.hit(&ray, targets.positions());
            }
        }
    }

    /// Which of these rays end at something that they hit, into `blocked`.
    #[allow(clippy::too_many_arguments)]
    #[cold]
    #[inline(never)]
    fn far_answers(
        &self,
        rays: &RayBatch<'_>,
        from: usize,
        fit: &Rays,
        targets: &Targets<'_>,
        blocked: &mut Rays,
        len: usize,
        on_hit: &mut impl OnHit,
        visits: &mut impl Visits,
    ) {
        for (p, lane) in (0..len).map(|k| (k / LANES, k % LANES)).filter(|&(p, lane)| fit[p] >> lane & 1 == 0) {
            let place = from + p * LANES + lane;
            let ray = rays.ray(place);
            if ray.is_valid() {
                let (asked, leaves, ends) = (Asked::new(rays, place), rays.left_by(place), [ray.tmin, ray.tmax]);
                let mut quest = Blocked { ray: asked, ends, targets, leaves, of: (p, lane), on_hit, found: false };
                self.send_far(&ray, &mut quest, visits);
                blocked[p] |= u32::from(quest.found) << lane;
            }
        }
    }
}
