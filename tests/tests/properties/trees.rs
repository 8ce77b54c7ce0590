//! P19: what trees list.

use super::inputs::triangles;
use gz_bsp::{BspTree, CostStats, Midpoint, MidpointTree, TreeStats};
use gz_tests::judge::buffer;
use proptest::prelude::*;

proptest! {
    #[test]
    fn p19_trees_list_every_triangle_where_it_belongs(triangles in triangles(), max_depth in 0u32..12, min_size in 0usize..12) {
        let n = triangles.len();
        let tris = buffer(triangles.iter().copied());
        let tree = BspTree::build(&tris);
        // Every leaf's boxes hold the corners it lists, every triangle is in some leaf, no leaf lists one twice.
        tree.assert_well_formed();
        let stats = CostStats::of(&tree);
        // Cutting adds four references a triangle and 64 at most.
        prop_assert!(stats.references >= n && stats.references <= 5 * n + 64 && stats.nodes <= 64 * n.max(1), "{:?}", stats);
        let setting = Midpoint { max_depth, min_size, node_budget: 1 << 13 };
        if let Ok(paper) = MidpointTree::build(&tris, setting) {
            // The paper's rule: a triangle stands in every leaf whose closed cell its closed box touches, and in no other.
            paper.assert_well_formed();
            let stats = TreeStats::of(&paper);
            prop_assert!(stats.nodes <= setting.node_budget && stats.depth <= max_depth + 1, "{:?}", stats);
            // A binary tree: one leaf more than inner nodes.
            prop_assert_eq!(stats.leaves * 2, stats.nodes + 1);
            prop_assert!(stats.references >= n || stats.leaves == 0);
        }
    }
}
