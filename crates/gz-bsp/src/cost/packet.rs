//! Sixteen rays through the tree together, as long as they go the same way.
//!
//! A node's eight cells are first held against the interval that all sixteen rays span, then each cell that this leaves against the
//! rays one by one; the rays that cross it go on with it as a mask. Leaves are asked ray by ray, eight triangles at a time. Entries and
//! exits are computed as in `walk.rs`, with the same constants, so what is said there of lost hits holds ray by ray. For the interval,
//! rounding is monotone: its entry, rounded twice, is at most what any ray's would be if rounded twice, and that is at most the true one; so
//! with its exit.

use super::walk::{Quest, Slabs};
use super::wide::{BspTree, Child, Target, WideNode};
use gz_core::kernel::FilterRay;
use gz_core::simd::{Lanes, Task};
use gz_core::{GzCoord, GzRay, NO_TRI};

/// Rays of a packet: two times eight lanes.
pub(super) const RAYS: usize = 16;
const HALVES: usize = RAYS / 8;

/// One number for each ray.
type Each = [[f32; 8]; HALVES];

/// Sixteen rays with one sign of direction along each axis.
pub(super) struct Packet {
    near: [usize; 3],
    inverse: [Each; 3],
    enter: [Each; 3],
    leave: [Each; 3],
    tmin: Each,
    /// Least and greatest of `inverse`, greatest of `enter`, least of `leave`, by axis.
    span: [[f32; 4]; 3],
    least_tmin: f32,
    filters: [FilterRay; RAYS],
}

impl Packet {
    /// The packet of these rays; `None` when they are not fit to go together.
    pub(super) fn new(rays: &[GzRay; RAYS], scene_reach: GzCoord) -> Option<Self> {
        // The cheapest reason first: most rays that do not go together differ in a sign.
        let signs = |ray: &GzRay| ray.direction.to_array().map(|d| d < 0.0);
        if rays[1..].iter().any(|ray| signs(ray) != signs(&rays[0])) {
            return None;
        }
        let prepare = |ray: &GzRay| {
            let slabs = Slabs::new(ray, scene_reach).filter(|_| ray.is_valid())?;
            Some((slabs, FilterRay::new(ray, scene_reach)?))
        };
        let (first, filter) = prepare(&rays[0])?;
        let zero = [[0.0; 8]; HALVES];
        let mut packet = Self {
            near: first.near,
            inverse: [zero; 3],
            enter: [zero; 3],
            leave: [zero; 3],
            tmin: zero,
            span: [[f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY, f32::INFINITY]; 3],
            least_tmin: f32::INFINITY,
            filters: [filter; RAYS],
        };
        for (k, ray) in rays.iter().enumerate() {
            let (slabs, filter) = prepare(ray)?;
            // Zeros have signs too.
            if slabs.near != packet.near {
                return None;
            }
            packet.filters[k] = filter;
            packet.tmin[k / 8][k % 8] = slabs.tmin;
            packet.least_tmin = packet.least_tmin.min(slabs.tmin);
            for axis in 0..3 {
                let (inverse, enter, leave) = (slabs.inverse[axis], slabs.enter[axis], slabs.leave[axis]);
                packet.inverse[axis][k / 8][k % 8] = inverse;
                packet.enter[axis][k / 8][k % 8] = enter;
                packet.leave[axis][k / 8][k % 8] = leave;
                let [least, greatest, last_enter, first_leave] = packet.span[axis];
                packet.span[axis] = [least.min(inverse), greatest.max(inverse), last_enter.max(enter), first_leave.min(leave)];
            }
        }
        Some(packet)
    }

    /// Entries of the cells for the interval of all rays, and a bit for each cell that it crosses before `limit`.
    #[inline(always)]
    fn cross_all<L: Lanes>(&self, node: &WideNode, limit: f32) -> (L, u32) {
        let (mut near, mut far) = (L::splat(self.least_tmin), L::splat(limit));
        for axis in 0..3 {
            let [least, greatest, enter, leave] = self.span[axis];
            let (least, greatest) = (L::splat(least), L::splat(greatest));
            let first = L::load(&node.planes[self.near[axis]]);
            let last = L::load(&node.planes[self.near[axis] ^ 1]);
            near = near.max(first.times(least).min(first.times(greatest)).minus(L::splat(enter)));
            far = far.min(last.times(least).max(last.times(greatest)).minus(L::splat(leave)));
        }
        (near, near.at_most(far))
    }

    /// Entries of the rays into one cell, and a bit for each ray that crosses it before its limit.
    #[inline(always)]
    fn cross_one<L: Lanes>(&self, node: &WideNode, slot: usize, limits: &Each) -> (Each, u32) {
        let mut entries = [[0.0; 8]; HALVES];
        let mut crossed = 0;
        for half in 0..HALVES {
            let (mut near, mut far) = (L::load(&self.tmin[half]), L::load(&limits[half]));
            for axis in 0..3 {
                let inverse = L::load(&self.inverse[axis][half]);
                let first = L::splat(node.planes[self.near[axis]][slot]);
                let last = L::splat(node.planes[self.near[axis] ^ 1][slot]);
                near = near.max(first.mul_sub(inverse, L::load(&self.enter[axis][half])));
                far = far.min(last.mul_sub(inverse, L::load(&self.leave[axis][half])));
            }
            entries[half] = near.store();
            crossed |= near.at_most(far) << (8 * half);
        }
        (entries, crossed)
    }
}

/// A cell still to be visited, by which rays, and where each enters it.
pub(super) struct Waiting {
    child: Child,
    rays: u32,
    entries: Each,
}

pub(super) struct PacketWalk<'w, Q> {
    pub(super) tree: &'w BspTree<'w>,
    pub(super) packet: &'w Packet,
    pub(super) stack: &'w mut Vec<Waiting>,
    /// Where each ray ends; lowered as hits are found.
    pub(super) limits: Each,
    pub(super) quests: &'w mut [Q; RAYS],
}

impl<Q: Quest> Task for PacketWalk<'_, Q> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let PacketWalk { tree, packet, stack, mut limits, quests } = self;
        // Rays whose quest is not over.
        let mut live = (1u32 << RAYS) - 1;
        let mut active = live;
        let mut greatest_limit = greatest(&limits);
        stack.clear();
        let mut at = 0;
        loop {
            let node = &tree.nodes[at];
            let (entries, mut crossed) = packet.cross_all::<L>(node, greatest_limit);
            if crossed != 0 {
                let entries = entries.store();
                // The cells in order of the interval's entry, farthest first.
                let (mut order, mut cells) = ([(0.0f32, 0usize); 8], 0);
                while crossed != 0 {
                    let slot = crossed.trailing_zeros() as usize;
                    crossed &= crossed - 1;
                    let mut k = cells;
                    while k > 0 && order[k - 1].0 < entries[slot] {
                        order[k] = order[k - 1];
                        k -= 1;
                    }
                    order[k] = (entries[slot], slot);
                    cells += 1;
                }
                for &(_, slot) in &order[..cells] {
                    let (entries, crossed) = packet.cross_one::<L>(node, slot, &limits);
                    if crossed & active != 0 {
                        stack.push(Waiting { child: node.children[slot], rays: crossed & active, entries });
                    }
                }
            }
            at = loop {
                let Some(waiting) = stack.pop() else { return };
                active = waiting.rays & live & still_near::<L>(&waiting.entries, &limits);
                if active == 0 {
                    continue;
                }
                match waiting.child.target() {
                    Target::Node(index) => break index,
                    Target::Groups { first, count } => {
                        let mut rays = active;
                        while rays != 0 {
                            let k = rays.trailing_zeros() as usize;
                            rays &= rays - 1;
                            let mut over = false;
                            for group in &tree.groups[first..first + count] {
                                let mut survivors = group.survivors::<L>(&packet.filters[k]);
                                while survivors != 0 && !over {
                                    let lane = survivors.trailing_zeros() as usize;
                                    survivors &= survivors - 1;
                                    let tri = group.id(lane);
                                    if tri == NO_TRI {
                                        break;
                                    }
                                    match quests[k].test(tri) {
                                        Some(limit) => limits[k / 8][k % 8] = limits[k / 8][k % 8].min(limit),
                                        None => over = true,
                                    }
                                }
                            }
                            if over {
                                live &= !(1 << k);
                            }
                        }
                        if live == 0 {
                            return;
                        }
                        greatest_limit = greatest(&limits);
                    }
                }
            };
        }
    }
}

/// A bit for each ray that enters at or before its limit.
#[inline(always)]
fn still_near<L: Lanes>(entries: &Each, limits: &Each) -> u32 {
    let mut near = 0;
    for half in 0..HALVES {
        near |= L::load(&entries[half]).at_most(L::load(&limits[half])) << (8 * half);
    }
    near
}

#[inline(always)]
fn greatest(limits: &Each) -> f32 {
    let mut greatest = f32::NEG_INFINITY;
    for half in limits {
        for &limit in half {
            greatest = if limit > greatest { limit } else { greatest };
        }
    }
    greatest
}
