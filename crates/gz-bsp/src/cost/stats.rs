//! What the default tree looks like, as a value.

use super::wide::{BspTree, Target};
use crate::Expected;
use crate::expect::area;
use crate::stats::least_median_most;
use gz_core::Bounds;

/// Sizes of the default tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CostStats {
    /// Nodes of up to eight cells.
    pub nodes: usize,
    /// Cells in use over all nodes.
    pub cells: usize,
    /// Leaves. None is empty: what holds nothing is no cell.
    pub leaves: usize,
    /// Leaves of one to eight groups.
    pub leaves_by_groups: [usize; 8],
    /// Groups of eight triangles.
    pub groups: usize,
    /// Triangles listed, each once for every leaf that lists it.
    pub references: usize,
    /// Triangles of the largest leaf.
    pub largest_leaf: usize,
    /// Triangles of the smallest leaf.
    pub smallest_leaf: usize,
    /// The lower median of the leaves' triangles.
    pub median_leaf: usize,
    /// Nodes on the longest way down.
    pub depth: usize,
    /// Bytes beyond the triangle buffer.
    pub bytes: usize,
    /// Of these, bytes of nodes. The others are of groups.
    pub node_bytes: usize,
}

impl CostStats {
    /// Of the default tree.
    pub fn of(tree: &BspTree<'_>) -> Self {
        let (nodes, node_bytes) = (tree.nodes.len(), size_of_val(&tree.nodes[..]));
        let mut stats = Self { nodes, node_bytes, groups: tree.groups.len(), bytes: tree.bytes(), ..Self::default() };
        let mut sizes = Vec::new();
        stats.depth = usize::from(nodes > 0);
        tree.each_cell(|_, depth, target| {
            stats.cells += 1;
            match target {
                Target::Node(_) => stats.depth = stats.depth.max(depth + 1),
                Target::Groups { first, count } => {
                    let held = tree.triangles_in(first, count);
                    stats.leaves += 1;
                    stats.leaves_by_groups[count - 1] += 1;
                    stats.references += held;
                    sizes.push(held);
                }
            }
        });
        [stats.smallest_leaf, stats.median_leaf, stats.largest_leaf] = least_median_most(sizes);
        stats
    }
}

impl Expected {
    /// Of the default tree; `None` when the scene's box has no area.
    pub fn of(tree: &BspTree<'_>) -> Option<Self> {
        let (mut expected, whole) = Self::begin(tree.tris)?;
        expected.nodes = 1.0;
        tree.each_cell(|bounds, _, target| {
            let share = area(bounds) / whole;
            match target {
                Target::Node(_) => expected.nodes += share,
                Target::Groups { first, count } => {
                    expected.leaves += share;
                    expected.groups += share * count as f64;
                    expected.triangles += share * tree.triangles_in(first, count) as f64;
                }
            }
        });
        Some(expected)
    }
}

impl BspTree<'_> {
    /// Shows each cell in use, in no particular order: its box, its level (that of the root's eight cells is 1), and whether it is a leaf.
    pub fn visit_cells(&self, mut see: impl FnMut(&Bounds, usize, bool)) {
        self.each_cell(|bounds, depth, target| see(bounds, depth, matches!(target, Target::Groups { .. })));
    }

    /// Shows each cell in use: its box, the depth of the node that it is of (the root's is 1), and what is in it.
    fn each_cell(&self, mut see: impl FnMut(&Bounds, usize, Target)) {
        let mut open = vec![(0, 1)];
        while let Some((at, depth)) = open.pop() {
            let node = &self.nodes[at];
            for (slot, child) in node.children.iter().enumerate().filter(|(_, child)| !child.is_none()) {
                let target = child.target();
                see(&self.space.shrink(&node.bounds(slot)), depth, target);
                if let Target::Node(index) = target {
                    open.push((index, depth + 1));
                }
            }
        }
    }

    /// Triangles listed in a run of groups.
    fn triangles_in(&self, first: usize, count: usize) -> usize {
        self.groups[first..first + count].iter().flat_map(|group| group.ids()).count()
    }
}
