//! The walk of one ray through the default tree, step by step.
//!
//! The same walk once more, plain and in f64: near cells first, none beyond the best hit. The real one crosses boxes in f32, a little
//! wider, and so may enter a cell now and then that the ray just misses.

use super::wide::{BspTree, Target};
use crate::Step;
use crate::slab::{Slabs, Span};
use gz_core::kernel::Closest;
use gz_core::{Bounds, ClassMask, GzRay, Hit, with_default_float_control};

/// Something to be entered.
struct Open {
    target: Target,
    bounds: Bounds,
    span: Span,
}

impl BspTree<'_> {
    /// The front-most hit of one ray among the triangles of `classes`, and the walk that finds it.
    pub fn steps(&self, ray: &GzRay, classes: ClassMask) -> (Hit, Vec<Step>) {
        with_default_float_control(|| self.walk_in_steps(ray, classes))
    }

    fn walk_in_steps(&self, ray: &GzRay, classes: ClassMask) -> (Hit, Vec<Step>) {
        let (mut steps, mut closest) = (Vec::new(), Closest::default());
        if !ray.is_valid() {
            return (Hit::MISS, steps);
        }
        let slabs = Slabs::new(ray);
        let whole = self.tris.bounds();
        // The root is entered whatever the ray is: its box is not asked for.
        let span = Span { min: f64::from(ray.tmin), max: f64::from(ray.tmax) };
        let mut open = vec![Open { target: Target::Node(0), bounds: whole, span }];
        while let Some(Open { target, bounds, span }) = open.pop() {
            if span.min > closest.distance() {
                continue;
            }
            let mut step = Step { number: 0, bounds, enter: span.min, leave: span.max, triangles: None };
            match target {
                Target::Node(index) => {
                    let node = &self.nodes[index];
                    let first = open.len();
                    for (slot, child) in node.children.iter().enumerate().filter(|(_, child)| !child.is_none()) {
                        let bounds = self.space.shrink(&node.bounds(slot));
                        if let Some(span) = slabs.through(&bounds).filter(|span| span.min <= closest.distance()) {
                            open.push(Open { target: child.target(), bounds, span });
                        }
                    }
                    // The nearest on top.
                    open[first..].sort_by(|a, b| b.span.min.total_cmp(&a.span.min));
                    step.number = index;
                }
                Target::Groups { first, count } => {
                    let listed: Vec<_> = self.groups[first..first + count].iter().flat_map(|group| group.ids()).collect();
                    for &tri in listed.iter().filter(|&&tri| classes.has(self.tris.class(tri))) {
                        closest.consider(ray, tri, self.tris.positions());
                    }
                    (step.number, step.triangles) = (first, Some(listed));
                }
            }
            steps.push(step);
        }
        (closest.hit(ray, self.tris.positions()), steps)
    }
}
