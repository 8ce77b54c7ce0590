//! A bundle's rays through the tree together, as long as they go the same way.
//!
//! A node's eight cells are held against the interval that all rays span. Each cell that this leaves waits, and when its turn has come and it
//! is not behind all that was found meanwhile, it is held against the rays one by one; those that cross it go on with it as a set. Entries
//! and exits are computed as `slabs.rs` says, with the same constants, so what is said there of lost hits holds ray by ray. For the interval,
//! rounding is monotone: its entry, rounded twice, is at most what any ray's would be if rounded twice, and that is at most the true one; so
//! with its exit.
// Packets, axes and lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::abreast::Abreast;
use super::quest::BundleQuest;
use super::queue::{Queue, Visit};
use super::slabs::BundleSlabs;
use super::wide::{BspTree, Child, Target, WIDTH, Way, WideNode};
use gz_core::kernel::{LANES, PACKETS, RayBundle, Rays, Spans, count, extremes, greatest, is_none, least, packets, span};
use gz_core::simd::{Lanes, Simd};

/// Fewer rays than this go on by themselves, when all others are done ...
const FEW: u32 = 5;
/// ... and so do those that look for their front-most hits from here and there, when fewer than this are in each packet that has any, in the
/// mean. One more for each doubling of the tree beyond [`NEAR_BYTES`]: the more there still is below, the further they part.
const SPARSE: u32 = 4;
/// A tree up to this size, in bytes, is not asked for ahead: it costs more than it saves where most of it is in the cache of a core.
const NEAR_BYTES: usize = 8 << 20;
/// Rays of several packets go together when two samples of them have at least this share, in percent, of those of the root's cells in common
/// that either crosses. Those of one packet always do: their boxes cost one step of lanes each.
const ALIKE: u32 = 30;

/// What the rays of `company` span: least and greatest reciprocal, last entry and first exit constant, by axis.
struct Beam {
    way: Way,
    span: [[f32; 4]; 3],
    tmin: f32,
}

impl Beam {
    #[inline(always)]
    fn of<S: Simd>(bundle: &RayBundle, slabs: &BundleSlabs, way: Way, company: &Rays) -> Self {
        let mut beam = Self { way, span: [[0.0; 4]; 3], tmin: least::<S>(&bundle.tmin, company) };
        let inverse = span::<S>(&slabs.inverse, bundle.common_direction, company);
        let [leave, enter] = extremes::<S>(&slabs.leave, &slabs.enter, company);
        for axis in 0..3 {
            beam.span[axis] = [inverse[0][axis], inverse[1][axis], enter[axis], leave[axis]];
        }
        beam
    }

    /// The planes where rays enter a cell and leave it.
    #[inline(always)]
    fn ends<L: Lanes<LANES>>(&self, node: &WideNode, slot: usize) -> [[L; 2]; 3] {
        let mut ends = [[L::splat(0.0); 2]; 3];
        for axis in 0..3 {
            let [first, last] = node.ends(&self.way, axis);
            ends[axis] = [L::splat(first[slot]), L::splat(last[slot])];
        }
        ends
    }

    /// Entries of the cells for the interval of all rays, and a bit for each cell that it crosses before `limit`.
    #[inline(always)]
    fn cross<L: Lanes<8>>(&self, node: &WideNode, limit: f32) -> (L, u32) {
        let (mut near, mut far) = (L::splat(self.tmin), L::splat(limit));
        for axis in 0..3 {
            let [least, greatest, enter, leave] = self.span[axis];
            let (least, greatest) = (L::splat(least), L::splat(greatest));
            let [first, last] = node.ends(&self.way, axis);
            let (first, last) = (L::load(first), L::load(last));
            near = near.max(first.times(least).min(first.times(greatest)).minus(L::splat(enter)));
            far = far.min(last.times(least).max(last.times(greatest)).minus(L::splat(leave)));
        }
        (near, near.at_most(far))
    }
}

/// Entries of a packet's rays into the cell with these planes, and a bit for each ray that crosses it before its limit.
#[inline(always)]
fn cross_one<L: Lanes<LANES>>(bundle: &RayBundle, slabs: &BundleSlabs, ends: &[[L; 2]; 3], p: usize) -> (L, u32) {
    let (mut enter, mut leave) = (L::load(&bundle.tmin[p]), L::load(&bundle.limit[p]));
    for axis in 0..3 {
        let inverse = L::load(&slabs.inverse[axis][p]);
        let [first, last] = ends[axis];
        enter = enter.max(first.mul_sub(inverse, L::load(&slabs.enter[axis][p])));
        leave = leave.min(last.mul_sub(inverse, L::load(&slabs.leave[axis][p])));
    }
    (enter, enter.at_most(leave))
}

/// Makes `active` those of `rays` and `live` that cross the cell with these planes; tells whether there are any.
#[inline(always)]
fn crossing<L: Lanes<LANES>>(
    bundle: &RayBundle,
    slabs: &BundleSlabs,
    ends: &[[L; 2]; 3],
    [rays, live]: [&Rays; 2],
    active: &mut Rays,
) -> bool {
    let mut any = 0;
    for p in 0..PACKETS {
        active[p] = rays[p] & live[p];
        if active[p] != 0 {
            active[p] &= cross_one(bundle, slabs, ends, p).1;
        }
        any |= active[p];
    }
    any != 0
}

impl BspTree<'_> {
    /// Sends the rays of `company`, which go the same way along each axis as `way` says; gives up, before anything is tested, when they
    /// seem to part at the root.
    #[inline(always)]
    pub(super) fn send_together<S: Simd, Q: BundleQuest>(
        &self,
        slabs: &BundleSlabs,
        way: Way,
        company: &Rays,
        queue: &mut Queue,
        abreast: &mut Abreast,
        quest: &mut Q,
    ) -> bool {
        if !self.seem_together::<S>(slabs, company, quest.bundle()) {
            return false;
        }
        let beam = Beam::of::<S>(quest.bundle(), slabs, way, company);
        // In memory, or its splats are held, and spilled, all through the loop over packets.
        let beam = std::hint::black_box(&beam);
        let mut greatest_limit = greatest::<S>(&quest.bundle().limit, company);
        let mut spans = Spans::default();
        // Rays whose quest is not over, and those of them that cross the node.
        let (mut live, mut active) = (*company, *company);
        queue.clear();
        let size = self.bytes() / NEAR_BYTES;
        let (is_far, sparse) = (size > 0, SPARSE + usize::BITS - size.leading_zeros());
        let each = if Q::ORDERED && !quest.bundle().common_origin { sparse } else { 0 };
        let mut at = 0;
        loop {
            let node = &self.nodes[at];
            let (entries, crossed) = beam.cross::<S::Eight>(node, greatest_limit);
            queue.push(at, &active, entries, crossed);
            let mut coming = if is_far { crossed } else { 0 };
            while coming != 0 {
                self.prefetch::<S>(node.children[coming.trailing_zeros() as usize % WIDTH]);
                coming &= coming - 1;
            }
            if at == 0 {
                // Only now, as what comes first is waited for.
                spans = Spans::of::<S>(quest.bundle(), company);
            }
            at = loop {
                let Some((entry, Visit { rays, node }, slot)) = queue.pop(Q::ORDERED) else { return true };
                if Q::ORDERED && entry > greatest_limit {
                    continue;
                }
                let node = &self.nodes[node as usize];
                let ends = beam.ends::<S::Sixteen>(node, slot);
                if !crossing(quest.bundle(), slabs, &ends, [&rays, &live], &mut active) {
                    continue;
                }
                let child = node.children[slot];
                match child.target() {
                    Target::Node(index) => {
                        if count(&active) >= FEW.max(each * packets(&active)) {
                            break index;
                        }
                        active = leave_few(&ends, child, &active, slabs, abreast, quest);
                        if !is_none(&active) {
                            break index;
                        }
                    }
                    Target::Groups { first, count } => {
                        for group in &self.groups[first..first + count] {
                            let over = quest.test::<S>(group, &active, &spans);
                            if !Q::ORDERED {
                                for p in 0..PACKETS {
                                    live[p] &= !over[p];
                                    active[p] &= !over[p];
                                }
                                if is_none(&active) {
                                    break;
                                }
                            }
                        }
                    }
                }
                if Q::ORDERED {
                    greatest_limit = greatest::<S>(&quest.bundle().limit, company);
                } else if is_none(&live) {
                    return true;
                }
            };
        }
    }

    /// Whether a ray of the first packet and one of the last cross about the same of the root's cells: measuring all rays costs more than it
    /// saves.
    #[inline(always)]
    fn seem_together<S: Simd>(&self, slabs: &BundleSlabs, company: &Rays, bundle: &RayBundle) -> bool {
        let [Some(first), Some(last)] = [(0..PACKETS).find(|&p| company[p] != 0), (0..PACKETS).rfind(|&p| company[p] != 0)]
        else {
            return false;
        };
        if first == last {
            return true;
        }
        let (one, other) = (self.sample::<S>(slabs, company, bundle, first), self.sample::<S>(slabs, company, bundle, last));
        (one & other).count_ones() * 100 >= (one | other).count_ones() * ALIKE
    }

    /// The root's cells that the first ray of a packet's company crosses.
    #[inline(always)]
    fn sample<S: Simd>(&self, slabs: &BundleSlabs, company: &Rays, bundle: &RayBundle, p: usize) -> u32 {
        let lane = company[p].trailing_zeros() as usize % LANES;
        let own = slabs.alone(p, lane, bundle.tmin[p][lane]);
        own.cross::<S::Eight>(&self.nodes[0], bundle.limit[p][lane]).1
    }

    /// Asks for what a walk will read next.
    #[inline(always)]
    pub(super) fn prefetch<S: Simd>(&self, child: Child) {
        match child.target() {
            Target::Node(index) => S::prefetch(&self.nodes[index]),
            Target::Groups { first, .. } => S::prefetch(&self.groups[first]),
        }
    }
}

/// Leaves a cell, of these planes, to each of the rays of `active` by itself; gives those for which there is no room.
#[inline(always)]
fn leave_few<L: Lanes<LANES>, Q: BundleQuest>(
    ends: &[[L; 2]; 3],
    child: Child,
    active: &Rays,
    slabs: &BundleSlabs,
    abreast: &mut Abreast,
    quest: &Q,
) -> Rays {
    let (bundle, mut left) = (quest.bundle(), *active);
    for p in 0..PACKETS {
        let mut few = active[p];
        if few == 0 {
            continue;
        }
        let entries = cross_one(bundle, slabs, ends, p).0.array();
        while few != 0 {
            let lane = few.trailing_zeros() as usize;
            few &= few - 1;
            let entry = if Q::ORDERED { entries[lane] } else { bundle.tmin[p][lane] };
            if abreast.leave(bundle, slabs, [p, lane], child, entry) {
                left[p] &= !(1 << lane);
            }
        }
    }
    left
}
