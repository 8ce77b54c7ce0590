//! The paper's tree once more, with a choice of mistakes: its own first try at insertion, and ways to end a walk that look right.

use super::shape::{Shape, Tally};
use gz_bsp::VisitCount;
use gz_core::kernel::plain;
use gz_core::{Bounds, ClassMask, GzRay, Hit, Kernel, RayBatch, RayQuery, TriBuffer, TriId, with_default_float_control};

/// When a triangle joins a half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Insert {
    /// Its box touches it: right.
    BoxTouches,
    /// One of its corners lies in it: the paper's first try, which leaves holes.
    CornerInside,
}

/// When a hit in a leaf ends the walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// When nothing nearer is possible, distances padded and in f64: right with any test that orders hits rightly.
    Padded,
    /// Always: the near half has some hit, wherever it lies. A triangle that reaches into later voxels hides nearer ones there.
    FirstInLeaf,
    /// When it lies at or before the distance at which the ray leaves the voxel, both in f32 and unpadded. A hit on the voxel's face that
    /// rounds beyond it is lost in both voxels.
    BeforeExit,
    /// When the hit point lies in the voxel's box, in f32: what the paper's program does. A point on a face may round out of both voxels.
    PointInVoxel,
}

/// How a [`PlainMidpoint`] is built and walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlainRules {
    /// The paper's MAX_DEPTH.
    pub max_depth: u32,
    /// The paper's MIN_SIZE.
    pub min_size: usize,
    /// When a triangle joins a half.
    pub insert: Insert,
    /// When a walk ends.
    pub ending: Ending,
    /// The ray-triangle test.
    pub kernel: Kernel,
}

impl Default for PlainRules {
    /// The fastest setting of the paper's tables, and no mistake.
    fn default() -> Self {
        Self { max_depth: 15, min_size: 5, insert: Insert::BoxTouches, ending: Ending::Padded, kernel: Kernel::Certified }
    }
}

/// A tree of the paper's rule.
#[derive(Debug)]
pub struct PlainMidpoint<'a> {
    tris: &'a TriBuffer,
    rules: PlainRules,
    nodes: Vec<Node>,
    references: Vec<TriId>,
    shape: Shape,
}

#[derive(Clone, Copy, Debug)]
enum Node {
    Inner { axis: usize, plane: f32, lower: u32, upper: u32 },
    Leaf { bounds: Bounds, first: u32, count: u32 },
}

impl<'a> PlainMidpoint<'a> {
    /// Builds the tree of `tris`.
    pub fn build(tris: &'a TriBuffer, rules: PlainRules) -> Self {
        let mut tree = Self { tris, rules, nodes: Vec::new(), references: Vec::new(), shape: Shape::default() };
        let mut tally = Tally::default();
        tree.grow((0..tris.len() as TriId).collect(), tris.bounds(), 1, &mut tally);
        let bytes = size_of_val(&tree.nodes[..]) + size_of_val(&tree.references[..]);
        let inner = tree.nodes.iter().filter(|node| matches!(node, Node::Inner { .. })).count();
        let (stats, tally) = tally.stats(inner, 0, bytes);
        tree.shape = tally.shape(stats);
        tree
    }

    /// Its sizes.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    fn grow(&mut self, held: Vec<TriId>, bounds: Bounds, level: u32, tally: &mut Tally) -> u32 {
        let id = self.nodes.len();
        if level > self.rules.max_depth || held.len() < self.rules.min_size || bounds.is_empty() {
            tally.leaf(level, held.len());
            self.nodes.push(Node::Leaf { bounds, first: self.references.len() as u32, count: held.len() as u32 });
            self.references.extend(held);
            return id as u32;
        }
        // Axes by level: z, x, y.
        let axis = (level as usize + 1) % 3;
        let plane = bounds.centre()[axis];
        let (mut lower, mut upper) = (bounds, bounds);
        lower.max[axis] = plane;
        upper.min[axis] = plane;
        let joining = |half: &Bounds| -> Vec<TriId> {
            let joins = |tri: &TriId| match self.rules.insert {
                Insert::BoxTouches => Bounds::of(*self.tris.position(*tri)).overlaps(half),
                Insert::CornerInside => self.tris.position(*tri).iter().any(|&corner| half.holds(corner)),
            };
            held.iter().copied().filter(joins).collect()
        };
        let (of_lower, of_upper) = (joining(&lower), joining(&upper));
        drop(held);
        tally.cut(of_lower.len(), of_upper.len());
        self.nodes.push(Node::Inner { axis, plane, lower: 0, upper: 0 });
        let lower = self.grow(of_lower, lower, level + 1, tally);
        let upper = self.grow(of_upper, upper, level + 1, tally);
        self.nodes[id] = Node::Inner { axis, plane, lower, upper };
        id as u32
    }

    /// The front-most hit as this tree's rules have it, counting the walk.
    pub fn closest_hit_counted(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> Hit {
        if !ray.is_valid() {
            return Hit::MISS;
        }
        let padded = self.rules.ending == Ending::Padded;
        let mut walk = Walk { tree: self, ray, classes, visits, padded, best: Hit::MISS };
        if let Some((near, far)) = walk.through(&self.tris.bounds()) {
            walk.enter(0, near, far);
        }
        walk.best
    }
}

/// One ray on its way.
struct Walk<'w> {
    tree: &'w PlainMidpoint<'w>,
    ray: &'w GzRay,
    classes: ClassMask,
    visits: &'w mut VisitCount,
    padded: bool,
    best: Hit,
}

/// A distance (plane - o) / d passes two roundings of f64; eight times 2^-53 is more than enough.
const PAD: f64 = 4.0 * f64::EPSILON;

impl Walk<'_> {
    /// The distance at which the ray crosses `axis = plane`, as two bounds; without padding they are one rounded number, which is NaN for
    /// a ray in the plane.
    fn crossing(&self, axis: usize, plane: f32) -> (f64, f64) {
        let (origin, along) = (self.ray.origin[axis], self.ray.direction[axis]);
        if self.padded {
            let t = (f64::from(plane) - origin) / f64::from(along);
            return (t - t.abs() * PAD, t + t.abs() * PAD);
        }
        let t = f64::from((plane - origin as f32) / along);
        (t, t)
    }

    /// Where the ray crosses the box of everything.
    fn through(&self, bounds: &Bounds) -> Option<(f64, f64)> {
        let (mut near, mut far) = (f64::from(self.ray.tmin), f64::from(self.ray.tmax));
        for axis in 0..3 {
            let (low, high) = (bounds.min[axis], bounds.max[axis]);
            let along = self.ray.direction[axis];
            if along == 0.0 {
                let origin = self.ray.origin[axis];
                if !(f64::from(low) <= origin && origin <= f64::from(high)) {
                    return None;
                }
                continue;
            }
            let (enter, leave) = if along > 0.0 { (low, high) } else { (high, low) };
            near = near.max(self.crossing(axis, enter).0);
            far = far.min(self.crossing(axis, leave).1);
        }
        (near <= far).then_some((near, far))
    }

    /// Walks a node, which the ray crosses from `near` to `far`; whether the walk is over.
    fn enter(&mut self, id: u32, near: f64, far: f64) -> bool {
        match self.tree.nodes[id as usize] {
            Node::Leaf { bounds, first, count } => self.leaf(&bounds, first as usize..(first + count) as usize, near, far),
            Node::Inner { axis, plane, lower, upper } => {
                self.visits.nodes += 1;
                let (origin, along) = (self.ray.origin[axis], self.ray.direction[axis]);
                if self.padded && along == 0.0 {
                    // What touches the plane is in both halves.
                    return self.enter(if origin <= f64::from(plane) { lower } else { upper }, near, far);
                }
                let (lo, hi) = self.crossing(axis, plane);
                // The right rule goes by direction, the paper's by the half that holds the origin.
                let from_lower = if self.padded { along > 0.0 } else { (origin as f32) < plane };
                let (first, second) = if from_lower { (lower, upper) } else { (upper, lower) };
                // The paper's three cases. (For a plane behind the origin the right rule has the far half alone, as hi < near.)
                if lo > far || (!self.padded && lo < 0.0) {
                    self.enter(first, near, far)
                } else if hi < near {
                    self.enter(second, near, far)
                } else {
                    let until = if self.padded { far.min(hi) } else { hi };
                    let since = if self.padded { near.max(lo) } else { lo };
                    self.enter(first, near, until) || self.enter(second, since, far)
                }
            }
        }
    }

    fn leaf(&mut self, bounds: &Bounds, listed: std::ops::Range<usize>, near: f64, far: f64) -> bool {
        if self.padded && near > f64::from(self.best.t.next_up()) {
            return false;
        }
        self.visits.leaves += 1;
        let tree = self.tree;
        for &tri in &tree.references[listed] {
            self.visits.tests += u64::from(self.visits.excluded != Some(tri));
            if !self.classes.has(tree.tris.class(tri)) {
                continue;
            }
            let Some((t, u, v)) = plain(tree.rules.kernel, self.ray, tree.tris.position(tri)) else { continue };
            let counts = match tree.rules.ending {
                Ending::Padded | Ending::FirstInLeaf => true,
                Ending::BeforeExit => f64::from(t) <= far,
                Ending::PointInVoxel => bounds.holds(self.ray.origin.as_vec3() + self.ray.direction * t),
            };
            if counts && self.is_nearer(t, tri) {
                self.best = Hit { t, tri, u, v };
            }
        }
        !self.padded && self.best.is_hit()
    }

    /// Whether a hit at rounded t comes before the best one. Two exact T-values that round to one number are told apart by brute force
    /// over the two alone.
    fn is_nearer(&self, t: f32, tri: TriId) -> bool {
        let best = &self.best;
        if !best.is_hit() || t != best.t || self.tree.rules.kernel != Kernel::Certified {
            return !best.is_hit() || (t, tri) < (best.t, best.tri);
        }
        let mut closest = gz_core::kernel::Closest::default();
        let positions = self.tree.tris.positions();
        closest.consider(self.ray, best.tri, positions);
        closest.consider(self.ray, tri, positions);
        closest.hit(self.ray, positions).tri == tri
    }
}

impl RayQuery for PlainMidpoint<'_> {
    fn tris(&self) -> &TriBuffer {
        self.tris
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        with_default_float_control(|| {
            for (i, hit) in hits.iter_mut().enumerate() {
                *hit = self.closest_hit_counted(&rays.ray(i), classes, &mut VisitCount::default());
            }
        });
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        let mut hits = vec![Hit::MISS; rays.len()];
        self.closest_hits(rays, classes, &mut hits);
        occluded.iter_mut().zip(&hits).for_each(|(occluded, hit)| *occluded = hit.is_hit());
    }
}
