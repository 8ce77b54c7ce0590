//! Whether a tree is what it claims to be.

use crate::{MidpointTree, Node};
use gz_core::Bounds;

impl MidpointTree<'_> {
    /// Checks the whole structure.
    ///
    /// Halves tile their node, every node but the root has one parent, every triangle is listed once in each leaf that its closed box
    /// touches and in no other.
    ///
    /// # Panics
    ///
    /// If any of it does not hold.
    pub fn assert_well_formed(&self) {
        let boxes: Vec<Bounds> = self.tris.positions().iter().map(|corners| Bounds::of(*corners)).collect();
        let mut parents = vec![0u32; self.nodes.len()];
        let mut listed = 0;
        for (id, node) in self.nodes.iter().enumerate() {
            match *node {
                Node::Inner { bounds, axis, plane, front, back } => {
                    let (mut lower, mut upper) = (bounds, bounds);
                    lower.max[axis] = plane;
                    upper.min[axis] = plane;
                    assert!(bounds.min[axis] <= plane && plane <= bounds.max[axis], "node {id}: the plane leaves the box");
                    assert_eq!(self.nodes[front as usize].bounds(), &upper, "node {id}: front half");
                    assert_eq!(self.nodes[back as usize].bounds(), &lower, "node {id}: back half");
                    parents[front as usize] += 1;
                    parents[back as usize] += 1;
                }
                Node::Leaf { bounds, first, count, .. } => {
                    assert_eq!(first as usize, listed, "node {id}: lists follow each other");
                    listed += count as usize;
                    let list = &self.references[first as usize..listed];
                    assert!(list.is_sorted_by(|a, b| a < b), "node {id}: a triangle is listed once");
                    let touching = boxes.iter().filter(|b| b.overlaps(&bounds)).count();
                    assert_eq!(list.len(), touching, "node {id}: every triangle that touches the leaf");
                    assert!(list.iter().all(|&tri| boxes[tri as usize].overlaps(&bounds)), "node {id}: and no other");
                }
            }
        }
        assert_eq!(listed, self.references.len(), "all lists belong to leaves");
        assert_eq!(parents[0], 0, "the root has no parent");
        assert!(parents[1..].iter().all(|&n| n == 1), "every other node has one");
    }
}
