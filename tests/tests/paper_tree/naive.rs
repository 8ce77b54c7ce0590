//! The paper's building rule once more, in its own words and with nothing of ours.

use gz_core::GzCoord;

/// Sizes of a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) nodes: usize,
    pub(crate) leaves: usize,
    pub(crate) empty_leaves: usize,
    pub(crate) references: usize,
    pub(crate) largest_leaf: usize,
}

/// Three pairs of min and max.
type Box3 = [(f32, f32); 3];

/// Counts the tree without making it: the root, level 1, holds everything; a node is cut while its level is at most MAX_DEPTH and it
/// holds at least MIN_SIZE triangles, through the middle of its box, by z, x, y in turn; a triangle goes to each half that its box
/// touches.
pub(crate) fn count(triangles: &[[GzCoord; 3]], max_depth: u32, min_size: usize) -> Counts {
    let boxes: Vec<Box3> = triangles.iter().map(box_of).collect();
    let mut root = [(f32::MAX, f32::MIN); 3];
    for b in &boxes {
        for k in 0..3 {
            root[k] = (if b[k].0 < root[k].0 { b[k].0 } else { root[k].0 }, if b[k].1 > root[k].1 { b[k].1 } else { root[k].1 });
        }
    }
    let mut counts = Counts::default();
    visit(&boxes, root, 1, max_depth, min_size, &mut counts);
    counts
}

fn box_of(corners: &[GzCoord; 3]) -> Box3 {
    [0, 1, 2].map(|k| {
        let c = corners.map(|p| p[k]);
        let (mut lo, mut hi) = (c[0], c[0]);
        for x in c {
            if x < lo {
                lo = x;
            }
            if x > hi {
                hi = x;
            }
        }
        (lo, hi)
    })
}

fn visit(held: &[Box3], node: Box3, level: u32, max_depth: u32, min_size: usize, counts: &mut Counts) {
    counts.nodes += 1;
    if level > max_depth || held.len() < min_size {
        counts.leaves += 1;
        counts.empty_leaves += usize::from(held.is_empty());
        counts.references += held.len();
        counts.largest_leaf = counts.largest_leaf.max(held.len());
        return;
    }
    let axis = match level % 3 {
        1 => 2,
        2 => 0,
        _ => 1,
    };
    let middle = (node[axis].0 + node[axis].1) / 2.0;
    for half in [(node[axis].0, middle), (middle, node[axis].1)] {
        let mut child = node;
        child[axis] = half;
        let inside = |b: &&Box3| (0..3).all(|k| b[k].0 <= child[k].1 && child[k].0 <= b[k].1);
        let below: Vec<Box3> = held.iter().filter(inside).copied().collect();
        visit(&below, child, level + 1, max_depth, min_size, counts);
    }
}
