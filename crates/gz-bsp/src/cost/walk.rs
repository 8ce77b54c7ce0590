//! One ray through nodes of eight cells.
//!
//! **Why no hit is lost.** A hit lies at the exact t* in a point P of the triangle. By construction P lies in the box of a leaf that lists
//! the triangle and so in all boxes above it; each is entered at or before t* and left at or after (`slabs.rs`), so the walk reaches that
//! leaf unless t* is beyond the best hit so far. A node is left out only when its entry is beyond that hit, rounded up.

use super::build::MOST_LEVELS;
use super::slabs::Slabs;
use super::wide::{BspTree, Child, Target};
use crate::Visits;
use gz_core::kernel::{Asked, Candidates, FilterRay, Nearest, OnHit, RayBundle, TriGroup, is_hit};
use gz_core::simd::{Lanes, Simd};
use gz_core::{GzRay, NO_TRI, RayBatch, Targets, TriId};

/// What is still to be visited: cells and the distances at which the ray enters them. Made once.
pub(super) struct Stack {
    cells: Box<[(Child, f32); STACK]>,
    len: usize,
}

/// Cells that can wait: a power of two, above seven for each level of the deepest tree.
const STACK: usize = 1024;
const _: () = assert!(7 * MOST_LEVELS < STACK);

impl Stack {
    pub(super) fn new() -> Self {
        Self { cells: Box::new([(Child::NONE, 0.0); STACK]), len: 0 }
    }

    #[inline(always)]
    fn push(&mut self, child: Child, entry: f32) {
        self.cells[self.len % STACK] = (child, entry);
        self.len += 1;
    }

    /// The cell pushed last that is entered before `limit`; forgets all after it.
    #[inline(always)]
    fn pop(&mut self, limit: f32) -> Option<Child> {
        while self.len != 0 {
            self.len -= 1;
            let (child, entry) = self.cells[self.len % STACK];
            if entry <= limit {
                return Some(child);
            }
        }
        None
    }

    /// Pushes three cells or more, the farthest first.
    #[inline(always)]
    fn push_sorted(&mut self, children: &[Child; 8], entries: &[f32; 8], mut crossed: u32) {
        let base = self.len;
        while crossed != 0 {
            let slot = crossed.trailing_zeros() as usize & 7;
            crossed &= crossed - 1;
            let entry = entries[slot];
            let mut k = self.len;
            while k > base && self.cells[(k - 1) % STACK].1 < entry {
                self.cells[k % STACK] = self.cells[(k - 1) % STACK];
                k -= 1;
            }
            self.cells[k % STACK] = (children[slot], entry);
            self.len += 1;
        }
    }
}

/// What a walk is after.
pub(super) trait Quest {
    /// Where the ray ends at first.
    fn start(&self) -> f32;

    /// Tests triangle `tri`, lane `lane` of `found`, and gives the distance beyond which nothing matters any more; `None` ends the walk.
    fn take(&mut self, found: &Candidates, lane: usize, tri: TriId) -> Option<f32>;

    /// The same for a triangle of which nothing is known.
    fn test(&mut self, tri: TriId) -> Option<f32>;

    /// The same for all that is possible in a group, after which nothing matters beyond `limit`.
    #[inline(always)]
    fn take_all(&mut self, found: &Candidates, group: &TriGroup, mut limit: f32, visits: &mut impl Visits) -> Option<f32> {
        let mut possible = found.possible;
        while possible != 0 {
            let lane = possible.trailing_zeros() as usize & 7;
            possible &= possible - 1;
            let tri = group.id(lane);
            if tri == NO_TRI {
                break;
            }
            visits.test(tri);
            limit = self.take(found, lane, tri)?;
        }
        Some(limit)
    }
}

/// The front-most hit of a ray.
pub(super) struct NearestOf<'q> {
    pub(super) ray: Asked<'q>,
    pub(super) tmin: f32,
    pub(super) targets: &'q Targets<'q>,
    pub(super) best: Nearest,
}

impl<'q> NearestOf<'q> {
    /// For a ray of a bundle, with the best hit that it has so far.
    #[inline(always)]
    pub(super) fn of(bundle: &RayBundle, rays: &'q RayBatch<'q>, targets: &'q Targets<'q>, p: usize, lane: usize) -> Self {
        let ray = Asked::new(rays, bundle.place(p, lane));
        Self { ray, tmin: bundle.tmin[p][lane], targets, best: bundle.nearest(p, lane) }
    }
}

impl Quest for NearestOf<'_> {
    #[inline(always)]
    fn start(&self) -> f32 {
        self.best.limit()
    }

    #[inline(always)]
    fn take(&mut self, found: &Candidates, lane: usize, tri: TriId) -> Option<f32> {
        if self.targets.sees(tri) {
            self.best.take(self.ray, self.tmin, found, lane, tri, self.targets.positions());
        }
        Some(self.best.limit())
    }

    fn test(&mut self, tri: TriId) -> Option<f32> {
        if self.targets.sees(tri) {
            self.best.settle(&self.ray.ray(), tri, self.targets.positions());
        }
        Some(self.best.limit())
    }
}

/// Whether a ray hits anything that it ends at.
pub(super) struct Blocked<'q, K> {
    pub(super) ray: Asked<'q>,
    /// Between which t.
    pub(super) ends: [f32; 2],
    pub(super) targets: &'q Targets<'q>,
    pub(super) leaves: TriId,
    /// Its packet and lane in its bundle.
    pub(super) of: (usize, usize),
    pub(super) on_hit: &'q mut K,
    pub(super) found: bool,
}

impl<'q, K: OnHit> Blocked<'q, K> {
    /// For a ray of a bundle.
    #[inline(always)]
    pub(super) fn of(
        bundle: &RayBundle,
        rays: &'q RayBatch<'q>,
        targets: &'q Targets<'q>,
        on_hit: &'q mut K,
        p: usize,
        lane: usize,
    ) -> Self {
        let (place, ends) = (bundle.place(p, lane), [bundle.tmin[p][lane], bundle.limit[p][lane]]);
        let (ray, leaves) = (Asked::new(rays, place), bundle.left_by(p, lane));
        Self { ray, ends, targets, leaves, of: (p, lane), on_hit, found: false }
    }

    #[inline(always)]
    fn ends_at(&mut self, tri: TriId) -> bool {
        self.on_hit.ends(tri, self.of.0, 1 << self.of.1, self.targets) != 0
    }
}

impl<K: OnHit> Quest for Blocked<'_, K> {
    #[inline(always)]
    fn start(&self) -> f32 {
        self.ends[1]
    }

    #[inline(always)]
    fn take(&mut self, found: &Candidates, lane: usize, tri: TriId) -> Option<f32> {
        self.found = tri != self.leaves
            && self.targets.sees(tri)
            && found.is_hit(lane, self.ray, self.ends, self.targets.position(tri))
            && self.ends_at(tri);
        (!self.found).then_some(self.ends[1])
    }

    fn test(&mut self, tri: TriId) -> Option<f32> {
        self.found = self.targets.sees(tri) && is_hit(&self.ray.ray(), self.targets.position(tri)) && self.ends_at(tri);
        (!self.found).then_some(self.ends[1])
    }
}

impl BspTree<'_> {
    /// Sends one ray through what hangs under `child`.
    #[inline(always)]
    pub(super) fn send_alone<S: Simd>(
        &self,
        slabs: &Slabs,
        filter: &FilterRay,
        child: Child,
        stack: &mut Stack,
        quest: &mut impl Quest,
        visits: &mut impl Visits,
    ) {
        let mut limit = quest.start();
        stack.len = 0;
        let mut child = child;
        loop {
            match child.target() {
                Target::Node(index) => {
                    visits.node();
                    let node = &self.nodes[index];
                    let (entries, crossed) = slabs.cross::<S::Eight>(node, limit);
                    let others = crossed & crossed.wrapping_sub(1);
                    if crossed != 0 {
                        let first = crossed.trailing_zeros() as usize & 7;
                        child = node.children[first];
                        if others == 0 {
                            continue;
                        }
                        let entries = entries.array();
                        if others & (others - 1) == 0 {
                            let second = others.trailing_zeros() as usize & 7;
                            let mut far = node.children[second];
                            self.prefetch::<S>(far);
                            if entries[second] < entries[first] {
                                std::mem::swap(&mut child, &mut far);
                            }
                            stack.push(far, entries[first].max(entries[second]));
                            continue;
                        }
                        let mut rest = others;
                        while rest != 0 {
                            self.prefetch::<S>(node.children[rest.trailing_zeros() as usize & 7]);
                            rest &= rest - 1;
                        }
                        stack.push_sorted(&node.children, &entries, crossed);
                    }
                }
                Target::Groups { first, count } => {
                    visits.leaf();
                    for group in &self.groups[first..first + count] {
                        visits.group();
                        let Some(found) = group.candidates::<S>(filter) else { continue };
                        match quest.take_all(&found, group, limit, visits) {
                            Some(new) => limit = new,
                            None => return,
                        }
                    }
                }
            }
            child = match stack.pop(limit) {
                Some(next) => next,
                None => return,
            };
        }
    }

    /// The walk for rays whose numbers are beyond f32 constants: boxes in f64, every triangle of a leaf to the exact test.
    #[cold]
    #[inline(never)]
    pub(super) fn send_far(&self, ray: &GzRay, quest: &mut impl Quest, visits: &mut impl Visits) {
        let mut limit = quest.start();
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            visits.node();
            let node = &self.nodes[at];
            for (slot, child) in node.children.iter().enumerate() {
                if child.is_none() || !crate::slab::crosses(ray, &self.space.shrink(&node.bounds(slot)), limit) {
                    continue;
                }
                match child.target() {
                    Target::Node(index) => open.push(index),
                    Target::Groups { first, count } => {
                        visits.leaf();
                        for tri in self.groups[first..first + count].iter().flat_map(|group| group.ids()) {
                            visits.test(tri);
                            match quest.test(tri) {
                                Some(new) => limit = new,
                                None => return,
                            }
                        }
                    }
                }
            }
        }
    }
}
