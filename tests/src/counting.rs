//! Queries that watch what is asked of another query, at the border between shading and visibility.

use gz_core::{ClassMask, GzRay, Hit, RayBatch, RayQuery, TriBuffer};
use gz_shade::FrameStats;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Counts the rays that pass to another query.
#[derive(Debug)]
pub struct Counting<'a, Q: ?Sized> {
    inner: &'a Q,
    closest: AtomicU64,
    through_glass: AtomicU64,
    any: AtomicU64,
}

impl<'a, Q: RayQuery + ?Sized> Counting<'a, Q> {
    /// Counts, from 0, what is asked of `inner`.
    pub fn new(inner: &'a Q) -> Self {
        Self { inner, closest: AtomicU64::new(0), through_glass: AtomicU64::new(0), any: AtomicU64::new(0) }
    }

    /// Rays asked for their front-most hit among all triangles: primary, mirror and glass rays.
    pub fn closest(&self) -> u64 {
        self.closest.load(Ordering::Relaxed)
    }

    /// Rays asked about some classes only: shadow rays on their way through glass.
    pub fn through_glass(&self) -> u64 {
        self.through_glass.load(Ordering::Relaxed)
    }

    /// Rays asked whether they hit anything: shadow rays.
    pub fn any(&self) -> u64 {
        self.any.load(Ordering::Relaxed)
    }

    /// What was counted, beside what `stats` says was traced: (name, counted, told) for each kind of question.
    pub fn against(&self, stats: &FrameStats) -> [(&'static str, u64, u64); 3] {
        [
            ("primary, mirror and glass rays", self.closest(), stats.primary_rays + stats.mirror_rays + stats.glass_rays),
            ("shadow rays", self.any(), stats.shadow_rays),
            ("questions about glass", self.through_glass(), stats.tint_queries),
        ]
    }
}

impl<Q: RayQuery + ?Sized> RayQuery for Counting<'_, Q> {
    fn tris(&self) -> &TriBuffer {
        self.inner.tris()
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        let counter = if classes == ClassMask::ALL { &self.closest } else { &self.through_glass };
        counter.fetch_add(rays.len() as u64, Ordering::Relaxed);
        self.inner.closest_hits(rays, classes, hits);
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        // Rays that something is in the way of are asked again whether something opaque is.
        let counter = if classes == ClassMask::ALL { &self.any } else { &self.through_glass };
        counter.fetch_add(rays.len() as u64, Ordering::Relaxed);
        self.inner.any_hits(rays, classes, occluded);
    }
}

/// A batch that was asked, ray by ray, with its answers.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The rays.
    pub rays: Vec<GzRay>,
    /// The triangles that counted.
    pub classes: ClassMask,
    /// The front-most hits; `None` for a batch that only asked whether anything is hit.
    pub hits: Option<Vec<Hit>>,
}

/// Keeps every batch that passes to another query, in the order in which they come.
#[derive(Debug)]
pub struct Recording<'a, Q: ?Sized> {
    inner: &'a Q,
    asked: Mutex<Vec<Asked>>,
}

impl<'a, Q: RayQuery + ?Sized> Recording<'a, Q> {
    /// Records what is asked of `inner`.
    pub fn new(inner: &'a Q) -> Self {
        Self { inner, asked: Mutex::new(Vec::new()) }
    }

    /// The record.
    pub fn into_asked(self) -> Vec<Asked> {
        self.asked.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    fn record(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: Option<Vec<Hit>>) {
        let rays = (0..rays.len()).map(|i| rays.ray(i)).collect();
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).push(Asked { rays, classes, hits });
    }
}

impl<Q: RayQuery + ?Sized> RayQuery for Recording<'_, Q> {
    fn tris(&self) -> &TriBuffer {
        self.inner.tris()
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        self.inner.closest_hits(rays, classes, hits);
        self.record(rays, classes, Some(hits.to_vec()));
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        self.inner.any_hits(rays, classes, occluded);
        self.record(rays, classes, None);
    }
}
