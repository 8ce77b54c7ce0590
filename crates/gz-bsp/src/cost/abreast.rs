//! Rays by themselves, step by step side by side.
//!
//! A ray alone waits at each step for what it has just read, and the processor learns late that it has guessed wrong where the ray goes on.
//! Here all rays that want one take their next cell from their stacks; then those at a node are held against its cells, each against those
//! of its own node, then those at a group against its triangles. Hardly anything in it is a guess, and what one ray waits for, the others
//! use. Each ray visits about what it would visit alone, and `slabs.rs` says why no hit is lost.
//!
//! That there are no guesses is not left to chance: a set of rays is a number, so that a ray is put into one by arithmetic, and cells that
//! wait are whole numbers in the order of their distance, of which the compiler takes the least without a branch.

use super::quest::BundleQuest;
use super::slabs::{BundleSlabs, Slabs};
use super::walk;
use super::wide::{BspTree, Child, WIDTH};
use gz_core::kernel::{BUNDLE, Candidates, FilterRay, LANES, RayBundle, Rays};
use gz_core::simd::{Lanes, Simd, Task};

/// Fewer rays than this go alone at once.
const FEW: u32 = 4;
/// Cells of a stack. Where that is too few, a ray goes on alone, which tests are to see.
const DEPTH: usize = if cfg!(test) { 16 } else { 64 };
/// The last of a stack in which there is nothing.
const EMPTY: u32 = 2;

/// Cells still to be visited, each with where the ray enters it in the upper half. Below are three of [`LAST`]: with them a walk ends.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Stack([i64; DEPTH]);

/// No cell, behind all that there can be, also at infinity: what comes after it would stay on the stack for another tree.
const LAST: i64 = (i32::MAX as i64) << 32 | Child::NONE.number() as i64;

/// A ray on its way.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Lone {
    slabs: Slabs,
    filter: FilterRay,
    limit: f32,
    /// The number of the last of its stack.
    last: u32,
    /// The cell that it is at.
    at: Child,
}

/// The rays of a bundle that go by themselves, each at its place in the bundle. Made once.
pub(super) struct Abreast {
    /// Rays that begin at the root.
    roots: u64,
    /// Rays that begin at what is on their stacks.
    started: u64,
    rays: Box<[Lone; BUNDLE]>,
    stacks: Box<[Stack; BUNDLE]>,
    /// What the group was that each ray was held against last, and what was found.
    tested: [u32; BUNDLE],
    found: Box<[Candidates; BUNDLE]>,
}

/// A cell as it waits. Distances are ordered as their bits are; all below 0 come before all others, in whatever order.
#[inline(always)]
fn waiting(child: Child, entry: f32) -> i64 {
    i64::from(entry.to_bits()) << 32 | i64::from(child.number())
}

/// A set of rays as one number.
#[inline(always)]
fn whole(rays: &Rays) -> u64 {
    let mut whole = 0;
    for (p, packet) in rays.iter().enumerate() {
        whole |= u64::from(*packet) << (p * LANES);
    }
    whole
}

/// The number of the first ray of a set, which is taken out.
#[inline(always)]
fn take_first(rays: &mut u64) -> usize {
    let k = rays.trailing_zeros() as usize % BUNDLE;
    *rays &= *rays - 1;
    k
}

impl Stack {
    /// The nearest of the three cells that were left last, and where the ray enters it: nearly the nearest of all.
    #[inline(always)]
    fn pop(&mut self, last: &mut u32) -> (Child, f32) {
        let k = *last as usize;
        let places = [k % DEPTH, k.wrapping_sub(1) % DEPTH, k.wrapping_sub(2) % DEPTH];
        let [a, b, c] = [self.0[places[0]], self.0[places[1]], self.0[places[2]]];
        let (near, far) = (a.min(b), a.max(b));
        self.0[places[1]] = far;
        self.0[places[2]] = near.max(c);
        *last = last.wrapping_sub(1);
        let next = near.min(c);
        (Child::of_number(next as u32), f32::from_bits((next >> 32) as u32))
    }

    /// Room for a node's cells.
    #[inline(always)]
    fn room(&mut self, last: u32) -> Option<&mut [i64; WIDTH]> {
        let from = last as usize + 1;
        self.0.get_mut(from..from + WIDTH)?.first_chunk_mut()
    }
}

impl Lone {
    #[inline(always)]
    fn start(&mut self, bundle: &RayBundle, slabs: &BundleSlabs, p: usize, lane: usize) {
        self.slabs = slabs.alone(p, lane, bundle.tmin[p][lane]);
        self.filter = bundle.filter_ray(p, lane);
        self.last = EMPTY;
        self.at = Child::ROOT;
    }
}

impl Abreast {
    pub(super) fn new() -> Self {
        let ray = Lone { slabs: Slabs::NONE, filter: FilterRay::default(), limit: 0.0, last: EMPTY, at: Child::NONE };
        Self {
            roots: 0,
            started: 0,
            rays: Box::new([ray; BUNDLE]),
            stacks: Box::new([Stack([LAST; DEPTH]); BUNDLE]),
            tested: [0; BUNDLE],
            found: Box::new([Candidates::NONE; BUNDLE]),
        }
    }

    /// Has rays go by themselves from the root.
    // Out of line, like `leave`: the loops that call them have no register to spare.
    #[cold]
    #[inline(never)]
    pub(super) fn send(&mut self, bundle: &RayBundle, slabs: &BundleSlabs, lonely: &Rays) {
        let mut rays = whole(lonely);
        self.roots |= rays;
        while rays != 0 {
            let k = take_first(&mut rays);
            self.rays[k].start(bundle, slabs, k / LANES, k % LANES);
        }
    }

    /// Has a ray visit a cell, which it enters at `entry`, by itself later; tells whether there was room.
    #[cold]
    #[inline(never)]
    pub(super) fn leave(
        &mut self,
        bundle: &RayBundle,
        slabs: &BundleSlabs,
        [p, lane]: [usize; 2],
        child: Child,
        entry: f32,
    ) -> bool {
        let k = (p * LANES + lane) % BUNDLE;
        let ray = &mut self.rays[k];
        if self.started >> k & 1 == 0 {
            self.started |= 1 << k;
            ray.start(bundle, slabs, p, lane);
        }
        let last = ray.last as usize + 1;
        if last == DEPTH {
            return false;
        }
        self.stacks[k].0[last] = waiting(child, entry);
        ray.last = last as u32;
        true
    }
}

impl BspTree<'_> {
    /// Sends the rays that were to go by themselves, but for those that need no more.
    #[inline(always)]
    pub(super) fn send_abreast<S: Simd, Q: BundleQuest>(
        &self,
        slabs: &BundleSlabs,
        abreast: &mut Abreast,
        stack: &mut walk::Stack,
        quest: Q,
    ) {
        if abreast.roots | abreast.started != 0 {
            S::apart(Alone { tree: self, slabs, abreast, stack, quest });
        }
    }

    /// Sends rays until they are done; gives those that have too many cells to visit, each at a node, with what is on its stack.
    #[inline(always)]
    fn step_by_step<S: Simd, Q: BundleQuest>(&self, roots: u64, started: u64, abreast: &mut Abreast, quest: &mut Q) -> u64 {
        let Abreast { rays, stacks, tested, found, .. } = abreast;
        // Rays at a node, rays at a group, those that take a cell next, and those that cannot.
        let (mut nodes, mut leaves, mut next, mut full) = (roots, 0, started, 0);
        while nodes | leaves | next != 0 {
            let mut left = next;
            while left != 0 {
                let k = take_first(&mut left);
                let ray = &mut rays[k];
                let (child, entry) = stacks[k].pop(&mut ray.last);
                ray.at = child;
                let ahead = entry <= ray.limit;
                leaves |= u64::from(child.is_leaf() & ahead) << k;
                nodes |= u64::from(child.is_node() & ahead) << k;
                next &= !(u64::from(child.is_none() | ahead) << k);
            }
            next |= nodes;
            while nodes != 0 {
                let k = take_first(&mut nodes);
                let ray = &mut rays[k];
                let node = &self.nodes[ray.at.index()];
                let Some(room) = stacks[k].room(ray.last) else {
                    full |= 1 << k;
                    continue;
                };
                let (near, crossed) = ray.slabs.cross::<S::Eight>(node, ray.limit);
                near.front(&node.numbers(), crossed, room);
                ray.last += crossed.count_ones();
            }
            next = (next | leaves) & !full;
            let (mut hits, mut again) = (0, 0);
            while leaves != 0 {
                let k = take_first(&mut leaves);
                let ray = &mut rays[k];
                let (group, more, rest) = ray.at.split();
                let here = self.groups[group].all_candidates::<S>(&ray.filter);
                hits |= u64::from(here.possible != 0) << k;
                again |= u64::from(more) << k;
                found[k] = here;
                tested[k] = group as u32;
                ray.at = rest;
            }
            next &= !again;
            leaves = again;
            while hits != 0 {
                let k = take_first(&mut hits);
                match quest.take(&found[k], &self.groups[tested[k] as usize], k / LANES, k % LANES) {
                    Some(limit) => rays[k].limit = limit,
                    None => {
                        next &= !(1 << k);
                        leaves &= !(1 << k);
                    }
                }
            }
        }
        full
    }
}

/// Sending the rays of `abreast`.
struct Alone<'t, Q> {
    tree: &'t BspTree<'t>,
    slabs: &'t BundleSlabs,
    abreast: &'t mut Abreast,
    stack: &'t mut walk::Stack,
    quest: Q,
}

impl<Q: BundleQuest> Task for Alone<'_, Q> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { tree, slabs, abreast, stack, mut quest } = self;
        let (roots, started) = (abreast.roots, abreast.started & !whole(&quest.over()));
        (abreast.roots, abreast.started) = (0, 0);
        let mut all = roots | started;
        while all != 0 {
            let k = take_first(&mut all);
            abreast.rays[k].limit = quest.bundle().limit[k / LANES][k % LANES];
        }
        let mut alone = match (roots | started).count_ones() {
            0..FEW => roots | started,
            _ => tree.step_by_step::<S, Q>(roots, started, abreast, &mut quest),
        };
        while alone != 0 {
            let k = take_first(&mut alone);
            let ray = &mut abreast.rays[k];
            let mut next = (roots >> k & 1 != 0 || ray.at != Child::ROOT).then_some(ray.at);
            loop {
                if let Some(child) = next
                    && quest.alone::<S>(slabs, k / LANES, k % LANES, child, stack)
                {
                    break;
                }
                if ray.last <= EMPTY {
                    break;
                }
                next = Some(abreast.stacks[k].pop(&mut ray.last).0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::glam::DVec3;
    use gz_core::{BruteForce, ClassMask, GzCoord, Hit, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer};

    #[test]
    fn cells_come_nearly_in_order_and_then_none() {
        let mut stack = Abreast::new().stacks[0];
        let mut last = EMPTY;
        let entries = [8.0, 2.0, -0.0, f32::INFINITY, 5.0, -3.0];
        for (k, entry) in entries.into_iter().enumerate() {
            last += 1;
            stack.0[last as usize] = waiting(Child::of_number(k as u32 + 1), entry);
        }
        let mut popped = Vec::new();
        while last > EMPTY {
            let (child, entry) = stack.pop(&mut last);
            assert_eq!(entry.to_bits(), entries[child.index() - 1].to_bits());
            popped.push(child.index());
        }
        assert_eq!(popped, [6, 3, 2, 5, 1, 4]);
        assert!(stack.pop(&mut last).0.is_none());
        assert!(stack.0[..3].iter().all(|&cell| cell == LAST), "the next ray finds none below");
    }

    #[test]
    fn rays_are_taken_from_a_set_in_their_order() {
        let mut rays = 1 << 63 | 1 << 5 | 1;
        let taken: Vec<_> = std::iter::from_fn(|| (rays != 0).then(|| take_first(&mut rays))).collect();
        assert_eq!(taken, [0, 5, 63]);
    }

    /// Needles one behind the other, each across the same square: their boxes are all on the way of rays that meet few of them.
    fn needles(count: usize) -> TriBuffer {
        let corner = |k: usize| {
            let (x, side) = ((k / 3) as f32 * 0.25, if (k / 3).is_multiple_of(2) { 1.0 } else { -1.0 });
            [GzCoord::new(x, -1.0, -side), GzCoord::new(x, 1.0, side), GzCoord::new(x, 1.0, 0.9 * side)][k % 3]
        };
        let corners: Vec<_> = (0..3 * count).map(corner).collect();
        let faces: Vec<_> = (0..count as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        TriBuffer::from_indexed(&corners, &faces).unwrap()
    }

    /// Rays that go everywhere, those at odd places along the row, where their stacks overflow.
    fn rays(count: usize) -> (Vec<DVec3>, Vec<GzCoord>) {
        let mut state = 7u64;
        let mut unit = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 24) as f32 * 2.0 - 1.0
        };
        let each = |k: usize| {
            let origin = GzCoord::new(unit() * 40.0 + 40.0, unit(), unit());
            let direction = GzCoord::new(unit(), unit(), unit());
            if k.is_multiple_of(2) {
                (origin, direction)
            } else {
                (origin - GzCoord::X * 90.0, GzCoord::new(1.0, direction.y * 0.01, direction.z * 0.01))
            }
        };
        (0..count).map(each).map(|(origin, direction)| (origin.as_dvec3(), direction)).unzip()
    }

    #[test]
    fn rays_that_go_everywhere_hit_what_brute_force_finds_also_where_stacks_are_full() {
        let tris = needles(320);
        let brute = BruteForce::new(&tris);
        // Of each length of a bundle, and of more than one.
        for count in (1..=70).chain([640]) {
            let (origins, directions) = rays(count);
            // Also ended within the row.
            for tmax in [f32::INFINITY, 100.0] {
                let batch =
                    RayBatch::new(count, PerRay::Each(&origins), PerRay::Each(&directions), PerRay::One(0.0), PerRay::One(tmax));
                let (mut truth, mut hits) = (vec![Hit::MISS; count], vec![Hit::MISS; count]);
                brute.closest_hits(&batch, ClassMask::ALL, &mut truth);
                for &level in SimdLevel::available() {
                    let tree = BspTree::build(&tris).with_simd(level);
                    tree.closest_hits(&batch, ClassMask::ALL, &mut hits);
                    assert_eq!(hits, truth, "{level:?}, {count} rays");
                    let mut blocked = vec![false; count];
                    tree.any_hits(&batch, ClassMask::ALL, &mut blocked);
                    let blocked_truth: Vec<_> = truth.iter().map(Hit::is_hit).collect();
                    assert_eq!(blocked, blocked_truth, "{level:?}, {count} rays");
                }
            }
        }
    }
}
