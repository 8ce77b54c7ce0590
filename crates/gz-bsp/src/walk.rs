//! The paper's walk, plain: recursive, front to back (its section 4.2).

use crate::slab::{Slabs, Span};
use crate::{MidpointTree, Node, Visits};
use gz_core::kernel::{Closest, is_hit};
use gz_core::{ClassMask, GzRay, Hit, RayBatch, RayQuery, TriBuffer, TriId, with_default_float_control};

/// What is asked of the leaves of a walk.
trait Quest {
    /// Tests a triangle; whether the quest is over.
    fn test(&mut self, tri: TriId) -> bool;
    /// Whether a node that begins at distance `min` can be left out.
    fn is_beyond(&self, min: f64) -> bool;
}

impl MidpointTree<'_> {
    /// Walks node `id` over `span`; whether the quest is over.
    ///
    /// Near is the half that the ray crosses first. For a ray that starts in the node that is the half of its origin, as the paper
    /// has it; ordered by direction the rule also holds for rays that start elsewhere or lie in the plane.
    fn walk(&self, id: u32, span: Span, walker: &Slabs<'_>, quest: &mut impl Quest, visits: &mut impl Visits) -> bool {
        if quest.is_beyond(span.min) {
            return false;
        }
        visits.at(id as usize, span.min, span.max);
        match self.nodes[id as usize] {
            Node::Leaf { first, count, .. } => {
                visits.leaf();
                // A hit counts wherever it lies: it need not be in this voxel, as nothing ends before its distance is reached.
                self.references[first as usize..(first + count) as usize].iter().any(|&tri| {
                    visits.test(tri);
                    quest.test(tri)
                })
            }
            Node::Inner { axis, plane, front, back, .. } => {
                visits.node();
                let along = walker.ray.direction[axis];
                if along == 0.0 {
                    // A triangle that touches the plane is listed in both halves, so for a ray in the plane either would do.
                    let side = if walker.ray.origin[axis] <= f64::from(plane) { back } else { front };
                    return self.walk(side, span, walker, quest, visits);
                }
                let (near, far) = if along > 0.0 { (back, front) } else { (front, back) };
                let (lo, hi) = walker.crossing(axis, plane);
                // The paper's three cases: the plane beyond the span, before it, within it.
                if lo > span.max {
                    self.walk(near, span, walker, quest, visits)
                } else if hi < span.min {
                    self.walk(far, span, walker, quest, visits)
                } else {
                    self.walk(near, Span { max: span.max.min(hi), ..span }, walker, quest, visits)
                        || self.walk(far, Span { min: span.min.max(lo), ..span }, walker, quest, visits)
                }
            }
        }
    }

    /// The front-most hit of one ray, telling `visits` of each step.
    pub fn closest_hit_counted(&self, ray: &GzRay, classes: ClassMask, visits: &mut impl Visits) -> Hit {
        let mut quest = Nearest { tree: self, ray, classes, closest: Closest::default() };
        self.start(ray, &mut quest, visits);
        quest.closest.hit(ray, self.tris.positions())
    }

    /// Whether one ray hits anything, telling `visits` of each step.
    pub fn any_hit_counted(&self, ray: &GzRay, classes: ClassMask, visits: &mut impl Visits) -> bool {
        self.start(ray, &mut Any { tree: self, ray, classes }, visits)
    }

    fn start(&self, ray: &GzRay, quest: &mut impl Quest, visits: &mut impl Visits) -> bool {
        if !ray.is_valid() {
            return false;
        }
        let walker = Slabs::new(ray);
        let Some(span) = walker.through(self.nodes[0].bounds()) else { return false };
        self.walk(0, span, &walker, quest, visits)
    }
}

struct Nearest<'q> {
    tree: &'q MidpointTree<'q>,
    ray: &'q GzRay,
    classes: ClassMask,
    closest: Closest,
}

impl Quest for Nearest<'_> {
    fn test(&mut self, tri: TriId) -> bool {
        if self.classes.has(self.tree.tris.class(tri)) {
            self.closest.consider(self.ray, tri, self.tree.tris.positions());
        }
        false
    }

    fn is_beyond(&self, min: f64) -> bool {
        // A better or equal hit lies at most at the best distance, in a voxel that begins at or before it.
        min > self.closest.distance()
    }
}

struct Any<'q> {
    tree: &'q MidpointTree<'q>,
    ray: &'q GzRay,
    classes: ClassMask,
}

impl Quest for Any<'_> {
    fn test(&mut self, tri: TriId) -> bool {
        self.classes.has(self.tree.tris.class(tri)) && is_hit(self.ray, self.tree.tris.position(tri))
    }

    fn is_beyond(&self, _: f64) -> bool {
        false
    }
}

impl RayQuery for MidpointTree<'_> {
    fn tris(&self) -> &TriBuffer {
        self.tris
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        with_default_float_control(|| {
            for (i, hit) in hits.iter_mut().enumerate() {
                *hit = self.closest_hit_counted(&rays.ray(i), classes, &mut ());
            }
        });
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "one answer a ray");
        with_default_float_control(|| {
            for (i, occluded) in occluded.iter_mut().enumerate() {
                *occluded = self.any_hit_counted(&rays.ray(i), classes, &mut ());
            }
        });
    }
}
