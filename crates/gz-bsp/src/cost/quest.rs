//! What is asked of a bundle's rays: their front-most hits, or whether there are any.
// Packets are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::slabs::BundleSlabs;
use super::walk::{Blocked, NearestOf, Quest, Stack};
use super::wide::{BspTree, Child};
use crate::Visits;
use gz_core::kernel::{Asked, Candidates, OnHit, PACKETS, RayBundle, Rays, Spans, TriGroup};
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
        let Self { tree, bundle, rays, targets, visits } = self;
        tree.closest_alone::<S>(rays, bundle, slabs, p, lane, child, stack, targets, &mut **visits);
        false
    }

    #[inline(always)]
    fn take(&mut self, found: &Candidates, group: &TriGroup, p: usize, lane: usize) -> Option<f32> {
        let ray = Asked::new(self.rays, self.bundle.place(p, lane));
        let best = self.bundle.nearest(p, lane);
        let mut quest = NearestOf { ray, tmin: self.bundle.tmin[p][lane], targets: self.targets, best };
        let limit = quest.take_all(found, group, best.limit(), &mut *self.visits);
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
        let Self { tree, bundle, rays, targets, blocked, on_hit, visits } = self;
        let hit = tree.any_alone::<S>(rays, bundle, slabs, p, lane, child, stack, targets, &mut **on_hit, &mut **visits);
        blocked[p] |= u32::from(hit) << lane;
        hit
    }

    #[inline(always)]
    fn take(&mut self, found: &Candidates, group: &TriGroup, p: usize, lane: usize) -> Option<f32> {
        let place = self.bundle.place(p, lane);
        let ends = [self.bundle.tmin[p][lane], self.bundle.limit[p][lane]];
        let mut quest = Blocked {
            ray: Asked::new(self.rays, place),
            ends,
            targets: self.targets,
            leaves: self.rays.left_by(place),
            of: (p, lane),
            on_hit: &mut *self.on_hit,
            found: false,
        };
        let limit = quest.take_all(found, group, ends[1], &mut *self.visits);
        self.blocked[p] |= u32::from(quest.found) << lane;
        limit
    }
}
