//! A tree cut by the triangles' own planes, walked.

use super::polygon_build::{Build, Node, PolygonRules};
use super::shape::Shape;
use gz_bsp::VisitCount;
use gz_core::glam::DVec3;
use gz_core::kernel::Closest;
use gz_core::{Bounds, ClassMask, GzRay, Hit, RayBatch, RayQuery, TriBuffer, TriId, with_default_float_control};

/// A BSP tree whose planes are taken from its triangles. Its answers are exact.
#[derive(Debug)]
pub struct PolygonBsp<'a> {
    tris: &'a TriBuffer,
    nodes: Vec<Node>,
    listed: Vec<TriId>,
    /// Slack of all sides, a share of the scene's reach.
    pad: f64,
    shape: Shape,
}

impl<'a> PolygonBsp<'a> {
    /// Builds the tree of `tris`.
    pub fn build(tris: &'a TriBuffer, rules: PolygonRules) -> Self {
        // f64 places points of the scene to some 2^-50 of its reach; a thousand million times that is still nothing to see.
        let pad = 1e-9 * f64::from(tris.bounds().reaches().max_element());
        let mut build = Build::new(tris, rules, pad);
        let shape = build.run();
        Self { tris, nodes: build.nodes, listed: build.listed, pad, shape }
    }

    /// Its sizes.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The front-most hit, counting the walk: the lists of inner nodes are tested triangle by triangle like those of leaves.
    pub fn closest_hit_counted(&self, ray: &GzRay, classes: ClassMask, visits: &mut VisitCount) -> Hit {
        let mut closest = Closest::default();
        let Some(span) = ray.is_valid().then(|| through(ray, &self.tris.bounds())).flatten() else { return Hit::MISS };
        let (o, d) = (ray.origin, ray.direction.as_dvec3());
        // Distances from planes are formed from the origin, which may be far away.
        let pad = 2.0 * self.pad + 1e-12 * o.abs().max_element();
        let mut open = vec![Open { what: What::Node(0), near: span.0, far: span.1 }];
        while let Some(Open { what, near, far }) = open.pop() {
            if near > closest.distance() {
                continue;
            }
            let list = match what {
                What::List(first, count) => (first, count),
                What::Node(id) => match self.nodes[id as usize] {
                    Node::Leaf { first, count } => {
                        visits.leaves += 1;
                        (first, count)
                    }
                    Node::Inner { plane, first, count, front, back } => {
                        visits.nodes += 1;
                        let (side, along) = (plane.side(o), plane.normal.dot(d));
                        let (since, until) = within(side, along, pad);
                        // The ray comes from behind when it goes to the front.
                        let (first_half, second_half) = if along > 0.0 { (back, front) } else { (front, back) };
                        let mut later = |what, near: f64, far: f64| {
                            if near <= far {
                                open.push(Open { what, near, far });
                            }
                        };
                        later(What::Node(second_half), near.max(since), far);
                        if count > 0 {
                            later(What::List(first, count), near.max(since), far.min(until));
                        }
                        later(What::Node(first_half), near, far.min(until));
                        continue;
                    }
                },
            };
            for &tri in &self.listed[list.0 as usize..(list.0 + list.1) as usize] {
                visits.tests += u64::from(visits.excluded != Some(tri));
                if classes.has(self.tris.class(tri)) {
                    closest.consider(ray, tri, self.tris.positions());
                }
            }
        }
        closest.hit(ray, self.tris.positions())
    }
}

/// Something to be looked at, and the distances between which the ray is there.
struct Open {
    what: What,
    near: f64,
    far: f64,
}

#[derive(Clone, Copy)]
enum What {
    Node(u32),
    List(u32, u32),
}

/// The distances between which a ray, `side` away from a plane and going `along` towards its front, is within `pad` of it.
fn within(side: f64, along: f64, pad: f64) -> (f64, f64) {
    let (a, b) = ((-pad - side) / along, (pad - side) / along);
    match (along == 0.0, side.abs() <= pad) {
        (true, true) => (f64::NEG_INFINITY, f64::INFINITY),
        // Never: `front` comes first for a ray that does not move, and is all there is for one in front.
        (true, false) if side > 0.0 => (f64::INFINITY, f64::INFINITY),
        (true, false) => (f64::NEG_INFINITY, f64::NEG_INFINITY),
        (false, _) => (a.min(b), a.max(b)),
    }
}

/// Where the ray crosses the box, padded; `None` when it does not.
fn through(ray: &GzRay, bounds: &Bounds) -> Option<(f64, f64)> {
    let (low, high, o, d) = (bounds.min.as_dvec3(), bounds.max.as_dvec3(), ray.origin, ray.direction.as_dvec3());
    let (mut near, mut far) = (f64::from(ray.tmin), f64::from(ray.tmax));
    let grown = |p: DVec3, sign: f64| p + sign * 1e-12 * (p.abs() + o.abs());
    let (low, high) = (grown(low, -1.0), grown(high, 1.0));
    for axis in 0..3 {
        if d[axis] == 0.0 {
            if !(low[axis] <= o[axis] && o[axis] <= high[axis]) {
                return None;
            }
            continue;
        }
        let (a, b) = ((low[axis] - o[axis]) / d[axis], (high[axis] - o[axis]) / d[axis]);
        (near, far) = (near.max(a.min(b)), far.min(a.max(b)));
    }
    (near <= far).then_some((near, far))
}

impl RayQuery for PolygonBsp<'_> {
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
