//! Whether the default tree is what it claims to be.

use super::wide::{BspTree, Target};
use gz_core::Bounds;

impl BspTree<'_> {
    /// Checks the structure: every node and group is reached once, the box of a node holds those of its cells, every triangle stands in
    /// some leaf, no leaf lists one twice, and the boxes of the leaves that list a triangle hold its corners.
    ///
    /// # Panics
    ///
    /// If any of it does not hold.
    pub fn assert_well_formed(&self) {
        let positions = self.tris.positions();
        let (mut node_seen, mut group_seen) = (vec![0u32; self.nodes.len()], vec![0u32; self.groups.len()]);
        // Which corners of a triangle lie in a box of a leaf that lists it.
        let mut covered = vec![[false; 3]; positions.len()];
        let everywhere = Bounds { min: gz_core::GzCoord::NEG_INFINITY, max: gz_core::GzCoord::INFINITY };
        let mut open = vec![(0, everywhere)];
        while let Some((at, outer)) = open.pop() {
            node_seen[at] += 1;
            for (slot, child) in self.nodes[at].children.iter().enumerate() {
                if child.is_none() {
                    continue;
                }
                let inner = self.space.shrink(&self.nodes[at].bounds(slot));
                assert!(outer.holds(inner.min) && outer.holds(inner.max), "node {at}: a cell reaches out of its node");
                match child.target() {
                    Target::Node(index) => open.push((index, inner)),
                    Target::Groups { first, count } => {
                        group_seen[first..first + count].iter_mut().for_each(|n| *n += 1);
                        let mut list: Vec<_> = self.groups[first..first + count].iter().flat_map(|group| group.ids()).collect();
                        for &tri in &list {
                            for (k, corner) in positions[tri as usize].iter().enumerate() {
                                covered[tri as usize][k] |= inner.holds(*corner);
                            }
                        }
                        let listed = list.len();
                        list.sort_unstable();
                        list.dedup();
                        assert_eq!(list.len(), listed, "node {at}: a leaf lists a triangle twice");
                    }
                }
            }
        }
        assert!(node_seen.iter().all(|&n| n == 1), "every node is reached once");
        assert!(group_seen.iter().all(|&n| n == 1), "every group is reached once");
        assert!(covered.iter().flatten().all(|&c| c), "every corner of every triangle lies in a leaf that lists it");
    }
}
