//! The paper's tree, plain: planes through the middle of each node's box (its sections 3.2 and 3.3).

use crate::params::DEEPEST;
use crate::{BuildError, Midpoint};
use gz_core::{Bounds, TriBuffer, TriId};

/// A node: a box, and either two halves of it or the triangles whose boxes touch it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Node {
    /// Cut by the plane `axis = plane` through the middle of its box.
    Inner {
        /// The node's box.
        bounds: Bounds,
        /// 0 for x, 1 for y, 2 for z.
        axis: usize,
        /// Where the plane cuts the axis.
        plane: f32,
        /// The upper half, `axis >= plane`.
        front: u32,
        /// The lower half, `axis <= plane`.
        back: u32,
    },
    /// Not cut further: a voxel.
    Leaf {
        /// The node's box.
        bounds: Bounds,
        /// Its level; the root's is 1.
        level: u32,
        /// First of its triangles in [`MidpointTree::references`].
        first: u32,
        /// How many there are.
        count: u32,
    },
}

impl Node {
    /// The node's box.
    pub fn bounds(&self) -> &Bounds {
        match self {
            Self::Inner { bounds, .. } | Self::Leaf { bounds, .. } => bounds,
        }
    }
}

/// The paper's tree over a triangle buffer.
#[derive(Debug)]
pub struct MidpointTree<'a> {
    pub(crate) tris: &'a TriBuffer,
    pub(crate) nodes: Vec<Node>,
    pub(crate) references: Vec<TriId>,
    params: Midpoint,
}

/// References allowed for each node of the budget.
const REFERENCES_PER_NODE: usize = 16;

impl<'a> MidpointTree<'a> {
    /// Builds the tree of `tris`.
    ///
    /// The root's box holds all triangles; a scene without any gives one empty leaf.
    ///
    /// # Errors
    ///
    /// If the parameters lead past the node budget.
    pub fn build(tris: &'a TriBuffer, params: Midpoint) -> Result<Self, BuildError> {
        if params.max_depth > DEEPEST {
            return Err(BuildError::TooDeep(params.max_depth));
        }
        // With MIN_SIZE 0 every node down to MAX_DEPTH is cut: the count is known beforehand.
        let full_tree = 1u128.checked_shl(params.max_depth.saturating_add(1)).unwrap_or(u128::MAX);
        if params.min_size == 0 && full_tree > params.node_budget as u128 {
            return Err(BuildError::OverBudget(params));
        }
        let boxes: Vec<Bounds> = tris.positions().iter().map(|corners| Bounds::of(*corners)).collect();
        let mut tree = Self { tris, nodes: Vec::new(), references: Vec::new(), params };
        let everything: Vec<TriId> = (0..tris.len() as TriId).collect();
        tree.grow(&boxes, everything, tris.bounds(), 1)?;
        Ok(tree)
    }

    /// The parameters it was built with.
    pub fn params(&self) -> Midpoint {
        self.params
    }

    /// All nodes; the root is the first.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The triangle lists of all leaves, one behind the other.
    pub fn references(&self) -> &[TriId] {
        &self.references
    }

    /// Appends the node of `held`, the triangles whose boxes touch `bounds`, and what is below it; returns its number.
    fn grow(&mut self, boxes: &[Bounds], held: Vec<TriId>, bounds: Bounds, level: u32) -> Result<u32, BuildError> {
        let id = self.nodes.len();
        if id >= self.params.node_budget {
            return Err(BuildError::OverBudget(self.params));
        }
        if level > self.params.max_depth || held.len() < self.params.min_size || bounds.is_empty() {
            if self.references.len() + held.len() > self.params.node_budget.saturating_mul(REFERENCES_PER_NODE) {
                return Err(BuildError::OverBudget(self.params));
            }
            let (first, count) = (self.references.len() as u32, held.len() as u32);
            self.nodes.push(Node::Leaf { bounds, level, first, count });
            self.references.extend(held);
            return Ok(id as u32);
        }

        // Axes by level: z, x, y.
        let axis = (level as usize + 1) % 3;
        let plane = bounds.centre()[axis];
        let (mut lower, mut upper) = (bounds, bounds);
        lower.max[axis] = plane;
        upper.min[axis] = plane;
        let touching = |half: &Bounds| held.iter().copied().filter(|&tri| boxes[tri as usize].overlaps(half)).collect();
        let (of_front, of_back): (Vec<TriId>, Vec<TriId>) = (touching(&upper), touching(&lower));
        drop(held);

        self.nodes.push(Node::Inner { bounds, axis, plane, front: 0, back: 0 });
        let front = self.grow(boxes, of_front, upper, level + 1)?;
        let back = self.grow(boxes, of_back, lower, level + 1)?;
        self.nodes[id] = Node::Inner { bounds, axis, plane, front, back };
        Ok(id as u32)
    }
}
