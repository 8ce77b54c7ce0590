//! The walk through nodes of eight cells.
//!
//! e = 2^-24. A cell's box is crossed between t = (p - o) / d for its planes p. It is computed as p r - (c -+ E) in f32, with r = 1/d and c =
//! o/d rounded from f64. Against the true t the product is off by at most 2 e |p/d| (r and the product), c by e |o/d|, the subtraction by
//! e (|p/d| + |o/d|)(1 + 3e): in all at most 4 e (|p| + |o|) / |d|. E is 8 e (max |p| + |o|) / |d| along the axis, put into the two constants of an axis once per ray
//! and rounded outward, so every entry is at most the true one and every exit at least. A fused multiply-add only removes a rounding.
//!
//! **Why no hit is lost.** A hit lies at the exact t* in a point P of the triangle. By construction P lies in the box of a leaf that lists
//! the triangle and so in all boxes above it; each is entered at or before t* and left at or after, so the walk reaches that leaf unless
//! t* is beyond the best hit so far. A node is left out only when its entry is beyond that hit, rounded up.

use super::packet::{Packet, PacketWalk, RAYS, Waiting};
use super::wide::{BspTree, Child, Target, WideNode};
use crate::Visits;
use gz_core::kernel::{Closest, FilterRay, is_hit};
use gz_core::simd::{Lanes, Task, dispatch};
use gz_core::{ClassMask, GzCoord, GzRay, Hit, NO_TRI, RayBatch, RayQuery, TriBuffer, with_default_float_control};

/// A ray as the nodes see it.
pub(super) struct Slabs {
    /// Index into a node's planes of the end where the ray enters, by axis.
    pub(super) near: [usize; 3],
    pub(super) inverse: [f32; 3],
    pub(super) enter: [f32; 3],
    pub(super) leave: [f32; 3],
    pub(super) tmin: f32,
}

const E: f64 = (f32::EPSILON / 2.0) as f64;
/// The f32 constants neither over- nor underflow for coordinates up to 2^40 and directions between 2^-20 and 2^20; other rays take the
/// f64 walk.
const GREATEST_REACH: f64 = (1u64 << 40) as f64;
const GREATEST_DIRECTION: f32 = (1u32 << 20) as f32;
/// A direction component below 2^-40 of the largest counts as that. Within the scene |t| is at most twice the reach by the largest
/// component, so the ray then moves along the axis by at most 2^-39 of the reach, and a box widened by twice that is crossed at all such t.
const LEAST_COMPONENT: f32 = 1.0 / (1u64 << 40) as f32;
const STILL_PAD: f64 = 1.0 / (1u64 << 38) as f64;

impl Slabs {
    pub(super) fn new(ray: &GzRay, scene_reach: GzCoord) -> Option<Self> {
        let largest = ray.direction.abs().max_element();
        let reach = f64::from(scene_reach.max_element()) + ray.origin.abs().max_element();
        if reach > GREATEST_REACH || !(1.0 / GREATEST_DIRECTION..=GREATEST_DIRECTION).contains(&largest) {
            return None;
        }
        let mut slabs = Self { near: [0; 3], inverse: [0.0; 3], enter: [0.0; 3], leave: [0.0; 3], tmin: ray.tmin };
        for axis in 0..3 {
            let least = largest * LEAST_COMPONENT;
            let d = ray.direction[axis];
            let (d, still) = if d.abs() < least { (least.copysign(d), STILL_PAD * reach) } else { (d, 0.0) };
            let inverse = 1.0 / f64::from(d);
            let c = ray.origin[axis] * inverse;
            let pad = (8.0 * E * (f64::from(scene_reach[axis]) + ray.origin[axis].abs()) + still) * inverse.abs();
            slabs.near[axis] = 2 * axis + usize::from(d < 0.0);
            slabs.inverse[axis] = inverse as f32;
            slabs.enter[axis] = ((c + pad) as f32).next_up();
            slabs.leave[axis] = ((c - pad) as f32).next_down();
        }
        Some(slabs)
    }

    /// Entries of all cells, and a bit for each that is crossed before `limit`.
    #[inline(always)]
    fn cross<L: Lanes>(&self, node: &WideNode, limit: f32) -> (L, u32) {
        let (mut near, mut far) = (L::splat(self.tmin), L::splat(limit));
        for axis in 0..3 {
            let inverse = L::splat(self.inverse[axis]);
            let first = self.near[axis];
            near = near.max(L::load(&node.planes[first]).mul_sub(inverse, L::splat(self.enter[axis])));
            far = far.min(L::load(&node.planes[first ^ 1]).mul_sub(inverse, L::splat(self.leave[axis])));
        }
        (near, near.at_most(far))
    }
}

/// What is still to be visited: a cell and the distance at which the ray enters it.
pub(crate) type Stack = Vec<(Child, f32)>;

/// What is asked of a walk. `limit` is the distance beyond which nothing matters.
pub(super) trait Quest {
    /// Tests a triangle and returns the new limit, or `None` when the quest is over.
    fn test(&mut self, tri: u32) -> Option<f32>;
}

struct Walk<'w, Q, V> {
    tree: &'w BspTree<'w>,
    slabs: &'w Slabs,
    filter: &'w FilterRay,
    tmax: f32,
    stack: &'w mut Stack,
    quest: &'w mut Q,
    visits: &'w mut V,
}

impl<Q: Quest, V: Visits> Task for Walk<'_, Q, V> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Walk { tree, slabs, filter, tmax, stack, quest, visits } = self;
        let mut limit = tmax;
        stack.clear();
        let mut at = 0;
        loop {
            visits.node();
            let node = &tree.nodes[at];
            let (entries, mut crossed) = slabs.cross::<L>(node, limit);
            if crossed != 0 {
                let entries = entries.store();
                let base = stack.len();
                while crossed != 0 {
                    let slot = crossed.trailing_zeros() as usize;
                    crossed &= crossed - 1;
                    stack.push((node.children[slot], entries[slot]));
                }
                sort_far_first(&mut stack[base..]);
            }
            // Leaves off the stack are tested on the spot, until a node comes up.
            at = loop {
                let Some((child, entry)) = stack.pop() else { return };
                if entry > limit {
                    continue;
                }
                match child.target() {
                    Target::Node(index) => break index,
                    Target::Groups { first, count } => {
                        visits.leaf();
                        for group in &tree.groups[first..first + count] {
                            visits.group();
                            let mut survivors = group.survivors::<L>(filter);
                            while survivors != 0 {
                                let lane = survivors.trailing_zeros() as usize;
                                survivors &= survivors - 1;
                                let tri = group.id(lane);
                                if tri == NO_TRI {
                                    break;
                                }
                                visits.test(tri);
                                match quest.test(tri) {
                                    Some(new) => limit = limit.min(new),
                                    None => return,
                                }
                            }
                        }
                    }
                }
            };
        }
    }
}

/// Sorts by falling entry: the nearest comes off the stack first. One to eight elements.
#[inline(always)]
fn sort_far_first(cells: &mut [(Child, f32)]) {
    for i in 1..cells.len() {
        let cell = cells[i];
        let mut k = i;
        while k > 0 && cells[k - 1].1 < cell.1 {
            cells[k] = cells[k - 1];
            k -= 1;
        }
        cells[k] = cell;
    }
}

struct Nearest<'q> {
    tris: &'q TriBuffer,
    ray: GzRay,
    classes: ClassMask,
    closest: Closest,
}

impl Quest for Nearest<'_> {
    #[inline(always)]
    fn test(&mut self, tri: u32) -> Option<f32> {
        if self.classes.has(self.tris.class(tri)) {
            self.closest.consider(&self.ray, tri, self.tris.positions());
        }
        Some((self.closest.distance() as f32).next_up())
    }
}

struct Any<'q> {
    tris: &'q TriBuffer,
    ray: GzRay,
    classes: ClassMask,
    found: bool,
}

impl Quest for Any<'_> {
    #[inline(always)]
    fn test(&mut self, tri: u32) -> Option<f32> {
        self.found = self.classes.has(self.tris.class(tri)) && is_hit(&self.ray, self.tris.position(tri));
        (!self.found).then_some(f32::INFINITY)
    }
}

impl BspTree<'_> {
    /// The front-most hit of one ray, telling `visits` of each step.
    pub fn closest_hit_counted(&self, ray: &GzRay, classes: ClassMask, visits: &mut impl Visits) -> Hit {
        self.closest(ray, classes, &mut Stack::new(), visits)
    }

    /// Whether one ray hits anything, telling `visits` of each step.
    pub fn any_hit_counted(&self, ray: &GzRay, classes: ClassMask, visits: &mut impl Visits) -> bool {
        self.any(ray, classes, &mut Stack::new(), visits)
    }

    fn closest(&self, ray: &GzRay, classes: ClassMask, stack: &mut Stack, visits: &mut impl Visits) -> Hit {
        let mut quest = Nearest { tris: self.tris, ray: *ray, classes, closest: Closest::default() };
        self.send(ray, stack, &mut quest, visits);
        quest.closest.hit(ray, self.tris.positions())
    }

    fn any(&self, ray: &GzRay, classes: ClassMask, stack: &mut Stack, visits: &mut impl Visits) -> bool {
        let mut quest = Any { tris: self.tris, ray: *ray, classes, found: false };
        self.send(ray, stack, &mut quest, visits);
        quest.found
    }

    /// Sends a ray through the tree.
    fn send(&self, ray: &GzRay, stack: &mut Stack, quest: &mut impl Quest, visits: &mut impl Visits) {
        if !ray.is_valid() {
            return;
        }
        let (Some(slabs), Some(filter)) = (Slabs::new(ray, self.reach), FilterRay::new(ray, self.reach)) else {
            return self.send_wide(ray, quest, visits);
        };
        let walk = Walk { tree: self, slabs: &slabs, filter: &filter, tmax: ray.tmax, stack, quest, visits };
        dispatch(self.level, walk);
    }

    /// The walk for rays whose numbers are beyond f32 constants: boxes in f64, every triangle of a leaf to the exact test.
    #[cold]
    fn send_wide(&self, ray: &GzRay, quest: &mut impl Quest, visits: &mut impl Visits) {
        let mut limit = ray.tmax;
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            visits.node();
            let node = &self.nodes[at];
            for (slot, child) in node.children.iter().enumerate() {
                if child.is_none() || !crate::slab::crosses(ray, &node.bounds(slot), limit) {
                    continue;
                }
                match child.target() {
                    Target::Node(index) => open.push(index),
                    Target::Groups { first, count } => {
                        visits.leaf();
                        for tri in self.groups[first..first + count].iter().flat_map(|group| group.ids()) {
                            visits.test(tri);
                            match quest.test(tri) {
                                Some(new) => limit = limit.min(new),
                                None => return,
                            }
                        }
                    }
                }
            }
        }
    }
}

impl RayQuery for BspTree<'_> {
    fn tris(&self) -> &TriBuffer {
        self.tris
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        with_default_float_control(|| {
            let mut room = Room::default();
            for (from, hits) in (0..).step_by(RAYS).zip(hits.chunks_mut(RAYS)) {
                let start = |ray: &GzRay| Nearest { tris: self.tris, ray: *ray, classes, closest: Closest::default() };
                self.ask(rays, from, hits, &mut room, start, |ray, quest| quest.closest.hit(ray, self.tris.positions()));
            }
        });
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "one answer a ray");
        with_default_float_control(|| {
            let mut room = Room::default();
            for (from, occluded) in (0..).step_by(RAYS).zip(occluded.chunks_mut(RAYS)) {
                let start = |ray: &GzRay| Any { tris: self.tris, ray: *ray, classes, found: false };
                self.ask(rays, from, occluded, &mut room, start, |_, quest| quest.found);
            }
        });
    }
}

/// Stacks, kept from ray to ray.
#[derive(Default)]
struct Room {
    single: Stack,
    packet: Vec<Waiting>,
}

impl BspTree<'_> {
    /// Answers rays `from..` of a batch, as many as there are `answers`: together when there are sixteen that go the same way, else one by
    /// one.
    fn ask<Q: Quest, A>(
        &self,
        rays: &RayBatch<'_>,
        from: usize,
        answers: &mut [A],
        room: &mut Room,
        start: impl Fn(&GzRay) -> Q,
        answer: impl Fn(&GzRay, &Q) -> A,
    ) {
        if answers.len() == RAYS {
            let together: [GzRay; RAYS] = std::array::from_fn(|k| rays.ray(from + k));
            if let Some(packet) = Packet::new(&together, self.reach) {
                let mut quests = std::array::from_fn(|k| start(&together[k]));
                let limits = std::array::from_fn(|half| std::array::from_fn(|lane| together[8 * half + lane].tmax));
                let walk = PacketWalk { tree: self, packet: &packet, stack: &mut room.packet, limits, quests: &mut quests };
                dispatch(self.level, walk);
                for (to, (ray, quest)) in answers.iter_mut().zip(together.iter().zip(&quests)) {
                    *to = answer(ray, quest);
                }
                return;
            }
        }
        for (k, to) in answers.iter_mut().enumerate() {
            let ray = rays.ray(from + k);
            let mut quest = start(&ray);
            self.send(&ray, &mut room.single, &mut quest, &mut ());
            *to = answer(&ray, &quest);
        }
    }
}
