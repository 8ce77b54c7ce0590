//! What is asked of a bundle's rays: their front-most hits, or whether there are any.
// Packets are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::slabs::BundleSlabs;
use super::walk::{Blocked, NearestOf, Quest, Stack};
use super::wide::{BspTree, Child};
use crate::Visits;
use gz_core::kernel::{Candidates, OnHit, PACKETS, RayBundle, Rays, Spans, TriGroup};
use gz_core::simd::Simd;
use gz_core::{RayBatch, Targets};

/// What is asked of a bundle's rays.
pub(super) trait BundleQuest {
    /// Whether nearer cells are to be visited first.
    const ORDERED: bool;

    /// Tests a group for the rays of `active`; returns those that need no more.
    fn test<S: Simd>(&mut self, group: &TriGroup, active: &Rays, spans: &Spans) -> Rays;

    /// Rays that need no more.
    fn over(&self) -> Rays;

    /// The rays; where each ends is lowered as hits are found.
    fn bundle(&self) -> &RayBundle;

    /// Sends one ray by itself through what hangs under `child`; returns whether it needs no more.
    fn alone<S: Simd>(&mut self, slabs: &BundleSlabs, p: usize, lane: usize, child: Child, stack: &mut Stack) -> bool;

    /// Takes what a group's test has found for one ray: where the ray ends now, `None` if it needs no more.
    fn take(&mut self, found: &Candidates, group: &TriGroup, p: usize, lane: usize) -> Option<f32>;
}

/// The front-most hits.
pub(super) struct ClosestOf<'q, V> {
    pub(super) tree: &'q BspTree<'q>,
    pub(super) bundle: &'q mut RayBundle,
    pub(super) rays: &'q RayBatch<'q>,
    pub(super) targets: &'q Targets<'q>,
    /// Hears of the steps of rays by themselves.
    pub(super) visits: &'q mut V,
}

impl<V: Visits> BundleQuest for ClosestOf<'_, V> {
    const ORDERED: bool = true;

    #[inline(always)]
    fn test<S: Simd>(&mut self, group: &TriGroup, active: &Rays, spans: &Spans) -> Rays {
        self.bundle.closest::<S>(self.rays, group, active, spans, self.targets);
        [0; PACKETS]
    }

    #[inline(always)]
    fn over(&self) -> Rays {
        [0; PACKETS]
    }

    #[inline(always)]
    fn bundle(&self) -> &RayBundle {
        self.bundle
    }

    #[inline(always)]
    fn alone<S: Simd>(&mut self, slabs: &BundleSlabs, p: usize, lane: usize, child: Child, stack: &mut Stack) -> bool {
        let mut quest = NearestOf::of(self.bundle, self.rays, self.targets, p, lane);
        let (own, filter) = (slabs.alone(p, lane, quest.tmin), self.bundle.filter_ray(p, lane));
        self.tree.send_alone::<S>(&own, &filter, child, stack, &mut quest, &mut *self.visits);
        self.bundle.set_nearest(p, lane, quest.best);
        false
    }

    #[inline(always)]
    fn take(&mut self, found: &Candidates, group: &TriGroup, p: usize, lane: usize) -> Option<f32> {
        let mut quest = NearestOf::of(self.bundle, self.rays, self.targets, p, lane);
        let limit = quest.take_all(found, group, quest.start(), &mut *self.visits);
        self.bundle.set_nearest(p, lane, quest.best);
        limit
    }
}

/// Whether there are hits that rays end at.
pub(super) struct AnyOf<'q, K, V> {
    pub(super) tree: &'q BspTree<'q>,
    pub(super) bundle: &'q RayBundle,
    pub(super) rays: &'q RayBatch<'q>,
    pub(super) targets: &'q Targets<'q>,
    /// Rays that ended.
    pub(super) blocked: &'q mut Rays,
    pub(super) on_hit: &'q mut K,
    /// Hears of the steps of rays by themselves.
    pub(super) visits: &'q mut V,
}

impl<K: OnHit, V: Visits> BundleQuest for AnyOf<'_, K, V> {
    const ORDERED: bool = false;

    #[inline(always)]
    fn test<S: Simd>(&mut self, group: &TriGroup, active: &Rays, spans: &Spans) -> Rays {
        let hit = self.bundle.any::<S>(self.rays, group, active, spans, self.targets, self.on_hit);
        for p in 0..PACKETS {
            self.blocked[p] |= hit[p];
        }
        hit
    }

    #[inline(always)]
    fn over(&self) -> Rays {
        *self.blocked
    }

    #[inline(always)]
    fn bundle(&self) -> &RayBundle {
        self.bundle
    }

    #[inline(always)]
    fn alone<S: Simd>(&mut self, slabs: &BundleSlabs, p: usize, lane: usize, child: Child, stack: &mut Stack) -> bool {
        let mut quest = Blocked::of(self.bundle, self.rays, self.targets, &mut *self.on_hit, p, lane);
        let (own, filter) = (slabs.alone(p, lane, quest.ends[0]), self.bundle.filter_ray(p, lane));
        self.tree.send_alone::<S>(&own, &filter, child, stack, &mut quest, &mut *self.visits);
        self.blocked[p] |= u32::from(quest.found) << lane;
        quest.found
    }

    #[inline(always)]
    fn take(&mut self, found: &Candidates, group: &TriGroup, p: usize, lane: usize) -> Option<f32> {
        let mut quest = Blocked::of(self.bundle, self.rays, self.targets, &mut *self.on_hit, p, lane);
        let limit = quest.take_all(found, group, quest.start(), &mut *self.visits);
        self.blocked[p] |= u32::from(quest.found) << lane;
        limit
    }
}
