//! Building a tree whose planes are the triangles' own: the BSP tree of the painter's algorithm.
//!
//! A node is cut by the plane of one of its triangles. Triangles in the plane stay at the node; one that crosses it is cut in two polygons,
//! and both halves list it. Only the polygons decide where a triangle goes; hits are asked of whole triangles, exactly.
//!
//! **Why no hit is lost.** Sides are told in f64 with a slack `pad` far above any rounding there. A part of a triangle goes to the half that
//! it reaches into by more than `pad`, so that what lies within `pad` of the plane may be listed on one side alone, or at the node; the walk
//! takes everything within twice `pad` of the plane to be on both sides and at the node.

use super::shape::{Shape, Tally};
use glam::DVec3;
use gz_core::{TriBuffer, TriId};

/// When to cut, and by which plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PolygonRules {
    /// Deepest level that is cut; the root's is 1.
    pub max_depth: u32,
    /// A node with fewer triangles is not cut.
    pub min_size: usize,
    /// Planes that are tried at each node, evenly over its triangles; 1 takes the first triangle's.
    pub tried: usize,
    /// No node is cut any more when there are so many, as such trees can grow with the square of the triangles.
    pub node_budget: usize,
}

impl Default for PolygonRules {
    /// The paper's MIN_SIZE, twice the levels of its tree, and the best of eight planes.
    fn default() -> Self {
        Self { max_depth: 30, min_size: 5, tried: 8, node_budget: 1 << 20 }
    }
}

/// The points p with `normal . p = at`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: DVec3,
    pub(super) at: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Node {
    /// The triangles `first..first + count` lie in the plane.
    Inner {
        plane: Plane,
        first: u32,
        count: u32,
        front: u32,
        back: u32,
    },
    Leaf {
        first: u32,
        count: u32,
    },
}

/// What there is of a triangle in a cell.
struct Part {
    tri: TriId,
    polygon: Vec<DVec3>,
}

/// Where a polygon is.
enum Side {
    Front,
    Back,
    On,
    Both,
}

impl Plane {
    /// Of a triangle; `None` where rounding leaves no normal.
    fn of(corners: &[gz_core::GzCoord; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let normal = (b - a).cross(c - a).try_normalize()?;
        Some(Self { normal, at: normal.dot(a) })
    }

    /// The signed distance of a point.
    pub(super) fn side(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.at
    }

    fn sort(&self, polygon: &[DVec3], pad: f64) -> Side {
        let sides = polygon.iter().map(|&p| self.side(p));
        let (lo, hi) = sides.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), s| (lo.min(s), hi.max(s)));
        match (lo < -pad, hi > pad) {
            (false, false) => Side::On,
            (false, true) => Side::Front,
            (true, false) => Side::Back,
            (true, true) => Side::Both,
        }
    }

    /// What of `polygon` lies in front, `sign` 1, or behind, -1.
    ///
    /// Source: I. Sutherland, G. Hodgman 1974, "Reentrant Polygon Clipping".
    fn clip(&self, polygon: &[DVec3], sign: f64) -> Vec<DVec3> {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, &p) in polygon.iter().enumerate() {
            let q = polygon[(k + 1) % polygon.len()];
            let (sp, sq) = (sign * self.side(p), sign * self.side(q));
            if sp >= 0.0 {
                kept.push(p);
            }
            if (sp < 0.0) != (sq < 0.0) {
                kept.push(p + (q - p) * (sp / (sp - sq)));
            }
        }
        kept
    }
}

/// A tree being built.
pub(super) struct Build<'b> {
    tris: &'b TriBuffer,
    rules: PolygonRules,
    pad: f64,
    pub(super) nodes: Vec<Node>,
    pub(super) listed: Vec<TriId>,
    kept: usize,
    tally: Tally,
}

impl<'b> Build<'b> {
    pub(super) fn new(tris: &'b TriBuffer, rules: PolygonRules, pad: f64) -> Self {
        Self { tris, rules, pad, nodes: Vec::new(), listed: Vec::new(), kept: 0, tally: Tally::default() }
    }

    /// Builds it all; its shape.
    pub(super) fn run(&mut self) -> Shape {
        // A triangle without area is never hit.
        let has_plane = |tri: &TriId| Plane::of(self.tris.position(*tri)).is_some();
        let whole = |tri: TriId| Part { tri, polygon: self.tris.position(tri).map(|p| p.as_dvec3()).to_vec() };
        let everything: Vec<Part> = (0..self.tris.len() as TriId).filter(has_plane).map(whole).collect();
        // A list instead of recursion, as such trees may be as deep as there are triangles: what is open, and who is to be told its number.
        let mut open = vec![(everything, 1, None)];
        while let Some((held, level, parent)) = open.pop() {
            let id = self.nodes.len() as u32;
            if let Some((parent, is_front)) = parent {
                let Node::Inner { front, back, .. } = &mut self.nodes[parent as usize] else { continue };
                *(if is_front { front } else { back }) = id;
            }
            let waiting = open.len();
            let cut = if self.may_cut(&held, level, waiting) { self.best_plane(&held) } else { None };
            let Some(plane) = cut else {
                self.tally.leaf(level, held.len());
                let first = self.list(held.iter().map(|part| part.tri));
                self.nodes.push(Node::Leaf { first, count: held.len() as u32 });
                continue;
            };
            let (mut of_front, mut of_back, mut on) = (Vec::new(), Vec::new(), Vec::new());
            for part in held {
                match plane.sort(&part.polygon, self.pad) {
                    Side::On => on.push(part.tri),
                    Side::Front => of_front.push(part),
                    Side::Back => of_back.push(part),
                    Side::Both => {
                        of_front.push(Part { tri: part.tri, polygon: plane.clip(&part.polygon, 1.0) });
                        of_back.push(Part { tri: part.tri, polygon: plane.clip(&part.polygon, -1.0) });
                    }
                }
            }
            self.tally.cut(of_front.len(), of_back.len());
            self.kept += on.len();
            let (count, first) = (on.len() as u32, self.list(on.into_iter()));
            self.nodes.push(Node::Inner { plane, first, count, front: 0, back: 0 });
            open.push((of_front, level + 1, Some((id, true))));
            open.push((of_back, level + 1, Some((id, false))));
        }
        let bytes = size_of_val(&self.nodes[..]) + size_of_val(&self.listed[..]);
        let inner = self.nodes.iter().filter(|node| matches!(node, Node::Inner { .. })).count();
        let (stats, tally) = std::mem::take(&mut self.tally).stats(inner, self.kept, bytes);
        tally.shape(stats)
    }

    fn list(&mut self, tris: impl Iterator<Item = TriId>) -> u32 {
        let first = self.listed.len() as u32;
        self.listed.extend(tris);
        first
    }

    fn may_cut(&self, held: &[Part], level: u32, waiting: usize) -> bool {
        level <= self.rules.max_depth
            && held.len() >= self.rules.min_size.max(1)
            && self.nodes.len() + waiting + 2 < self.rules.node_budget
    }

    /// Of the planes tried, that with the least |front - back| + 4 crossing: a cut triangle is paid for on both sides, and again below.
    fn best_plane(&self, held: &[Part]) -> Option<Plane> {
        let step = held.len().div_ceil(self.rules.tried.max(1));
        let price = |plane: &Plane| {
            let (mut front, mut back, mut both) = (0i64, 0i64, 0i64);
            for part in held {
                match plane.sort(&part.polygon, self.pad) {
                    Side::On => {}
                    Side::Front => front += 1,
                    Side::Back => back += 1,
                    Side::Both => both += 1,
                }
            }
            (front - back).abs() + 4 * both
        };
        // The plane's own triangle has to lie in it, or cutting might not end; a sliver's rounded normal may miss it.
        let ends = |(part, plane): (&Part, Plane)| matches!(plane.sort(&part.polygon, self.pad), Side::On).then_some(plane);
        let tried = held
            .iter()
            .step_by(step.max(1))
            .filter_map(|part| Plane::of(self.tris.position(part.tri)).map(|plane| (part, plane)));
        tried.filter_map(ends).min_by_key(price)
    }
}
