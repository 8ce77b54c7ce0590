//! A walk step by step, for who wants to follow one ray.

use crate::{MidpointTree, Node, Visits};
use gz_core::{Bounds, ClassMask, GzRay, Hit, TriId, with_default_float_control};

/// A node or leaf that a walk entered.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Its number: of the node, or in the tree that tunes itself of a leaf's first group.
    pub number: usize,
    /// Its box in trace space.
    pub bounds: Bounds,
    /// The distance at which the ray enters it, rounded down.
    pub enter: f64,
    /// The distance at which it leaves, rounded up.
    pub leave: f64,
    /// The triangles of a leaf, in the order in which they are looked at; `None` for an inner node.
    pub triangles: Option<Vec<TriId>>,
}

impl MidpointTree<'_> {
    /// The front-most hit of one ray among the triangles of `classes`, and the walk that finds it.
    pub fn steps(&self, ray: &GzRay, classes: ClassMask) -> (Hit, Vec<Step>) {
        let mut spans = Spans::default();
        let hit = with_default_float_control(|| self.closest_hit_counted(ray, classes, &mut spans));
        let step = |&(number, enter, leave): &(usize, f64, f64)| {
            let node = &self.nodes[number];
            let triangles = match *node {
                Node::Inner { .. } => None,
                Node::Leaf { first, count, .. } => Some(self.references[first as usize..(first + count) as usize].to_vec()),
            };
            Step { number, bounds: *node.bounds(), enter, leave, triangles }
        };
        (hit, spans.0.iter().map(step).collect())
    }
}

/// The nodes entered and the distances between which the ray is in them.
#[derive(Default)]
struct Spans(Vec<(usize, f64, f64)>);

impl Visits for Spans {
    fn at(&mut self, number: usize, enter: f64, leave: f64) {
        self.0.push((number, enter, leave));
    }
}
