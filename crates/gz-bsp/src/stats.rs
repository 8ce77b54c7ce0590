//! What a tree looks like, as a value.

use crate::{MidpointTree, Node};

/// Sizes of a tree: the structure columns of the paper's tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TreeStats {
    /// All nodes, leaves included.
    pub nodes: usize,
    /// Leaves, empty ones included.
    pub leaves: usize,
    /// Leaves without a triangle.
    pub empty_leaves: usize,
    /// Entries in the lists of all leaves; a triangle counts once for each leaf that holds it.
    pub references: usize,
    /// Entries of the longest list.
    pub largest_leaf: usize,
    /// The deepest level; the root's is 1.
    pub depth: u32,
    /// Bytes beyond the triangle buffer.
    pub bytes: usize,
}

impl TreeStats {
    /// Of the paper's tree.
    pub fn of(tree: &MidpointTree<'_>) -> Self {
        let mut stats = Self {
            nodes: tree.nodes.len(),
            references: tree.references.len(),
            bytes: size_of_val(tree.nodes()) + size_of_val(tree.references()),
            ..Self::default()
        };
        for node in &tree.nodes {
            if let Node::Leaf { level, count, .. } = *node {
                stats.leaves += 1;
                stats.empty_leaves += usize::from(count == 0);
                stats.largest_leaf = stats.largest_leaf.max(count as usize);
                stats.depth = stats.depth.max(level);
            }
        }
        stats
    }
}
