//! Which cells of a binary tree stand side by side in a node of eight, so that a ray is expected to meet as few nodes as can be.
//!
//! A node is met with a probability that goes by the area of its box. A cell may be one of the eight of the node above it and a node by
//! itself, or give way to cells below it; found from below for each number of places, as Ylitie, Karras and Laine have it ("Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1). Leaves cost the same wherever they stand.

use super::wide::WIDTH;
use gz_core::Bounds;

/// For each number of places, from 1: the areas of all nodes of a cell's tree, if it takes at most so many places in the node above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Forest {
    nodes: [f32; WIDTH],
    /// How many of the places the lower half takes; 0 where the cell stands there itself.
    lower: [u8; WIDTH],
}

impl Forest {
    /// A leaf takes one place, whatever is offered.
    pub(crate) const LEAF: Self = Self { nodes: [0.0; WIDTH], lower: [0; WIDTH] };

    /// Of a cell with this box and two halves.
    pub(crate) fn of(bounds: &Bounds, lower: &Self, upper: &Self) -> Self {
        let mut forest = Self::LEAF;
        for places in 2..=WIDTH {
            let of = |below: usize| lower.nodes[below - 1] + upper.nodes[places - below - 1];
            // The most even one of equal ones, so that a tree of equal cells is not a list.
            let best =
                (1..places).min_by(|&a, &b| of(a).total_cmp(&of(b)).then(a.abs_diff(places - a).cmp(&b.abs_diff(places - b))));
            let below = best.unwrap_or(1);
            (forest.nodes[places - 1], forest.lower[places - 1]) = (of(below), below as u8);
        }
        let alone = bounds.area() + forest.nodes[WIDTH - 1];
        for places in 1..WIDTH {
            if places == 1 || alone <= forest.nodes[places - 1] {
                (forest.nodes[places - 1], forest.lower[places - 1]) = (alone, 0);
            }
        }
        forest
    }

    /// How many of `places` the lower half takes; `None` where the cell stands there itself. Of all eight places it never does: they are
    /// its own node's.
    pub(crate) fn lower(&self, places: usize) -> Option<usize> {
        Some(usize::from(self.lower[places - 1])).filter(|&lower| lower != 0)
    }
}
