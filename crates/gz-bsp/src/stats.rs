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
    /// Entries of the shortest list that has any.
    pub smallest_leaf: usize,
    /// The lower median of the lists that have any.
    pub median_leaf: usize,
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
        let mut sizes = Vec::new();
        for node in &tree.nodes {
            if let Node::Leaf { level, count, .. } = *node {
                stats.leaves += 1;
                stats.empty_leaves += usize::from(count == 0);
                stats.depth = stats.depth.max(level);
                sizes.extend((count > 0).then_some(count as usize));
            }
        }
        [stats.smallest_leaf, stats.median_leaf, stats.largest_leaf] = least_median_most(sizes);
        stats
    }
}

/// The least, the lower median and the greatest of `sizes`; zeros when there are none.
pub(crate) fn least_median_most(mut sizes: Vec<usize>) -> [usize; 3] {
    sizes.sort_unstable();
    let (Some(&least), Some(&most)) = (sizes.first(), sizes.last()) else { return [0; 3] };
    [least, sizes[(sizes.len() - 1) / 2], most]
}

#[cfg(test)]
mod tests {
    use super::least_median_most;

    #[test]
    fn the_median_is_one_of_the_sizes() {
        assert_eq!(least_median_most(vec![7, 1, 3, 2]), [1, 2, 7]);
        assert_eq!(least_median_most(vec![4]), [4; 3]);
        assert_eq!(least_median_most(Vec::new()), [0; 3]);
    }
}
