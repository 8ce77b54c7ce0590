//! What the default tree looks like, as a value.

use super::wide::{BspTree, Target};

/// Sizes of the default tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CostStats {
    /// Nodes of up to eight cells.
    pub nodes: usize,
    /// Cells in use over all nodes.
    pub cells: usize,
    /// Leaves.
    pub leaves: usize,
    /// Groups of eight triangles.
    pub groups: usize,
    /// Triangles listed, each once for every leaf that lists it.
    pub references: usize,
    /// Triangles of the largest leaf.
    pub largest_leaf: usize,
    /// Nodes on the longest way down.
    pub depth: usize,
    /// Bytes beyond the triangle buffer.
    pub bytes: usize,
}

impl CostStats {
    /// Of the default tree.
    pub fn of(tree: &BspTree<'_>) -> Self {
        let mut stats = Self { nodes: tree.nodes.len(), groups: tree.groups.len(), bytes: tree.bytes(), ..Self::default() };
        let mut open = vec![(0, 1)];
        while let Some((at, depth)) = open.pop() {
            stats.depth = stats.depth.max(depth);
            for child in tree.nodes[at].children.iter().filter(|child| !child.is_none()) {
                stats.cells += 1;
                match child.target() {
                    Target::Node(index) => open.push((index, depth + 1)),
                    Target::Groups { first, count } => {
                        let held = tree.groups[first..first + count].iter().flat_map(|group| group.ids()).count();
                        stats.leaves += 1;
                        stats.references += held;
                        stats.largest_leaf = stats.largest_leaf.max(held);
                    }
                }
            }
        }
        stats
    }
}
