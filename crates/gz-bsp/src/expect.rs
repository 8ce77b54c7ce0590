//! What a line is expected to visit, by the areas of boxes: what the builder goes by.

use crate::{MidpointTree, Node};
use gz_core::{Bounds, GzCoord, TriBuffer};

/// Visits of a random line through a tree with nothing in its way, expected.
///
/// Of all lines that meet a convex body, each as likely as any other, the share that also meets a second one inside of it is the ratio
/// of their surface areas. So a node is entered by the share of lines that its box's area is of the scene's box's, and the visits of a
/// line are the sum of these shares. It is how the builder prices a cut; a walk to the first hit visits less, as it ends there.
///
/// Source: the ratio is Crofton's; as a cost of trees, J. Goldsmith and J. Salmon 1987, "Automatic Creation of Object Hierarchies for
/// Ray Tracing".
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Expected {
    /// Inner nodes entered, the root included.
    pub nodes: f64,
    /// Leaves entered.
    pub leaves: f64,
    /// Groups of eight triangles in these leaves; 0 for a tree without groups.
    pub groups: f64,
    /// Triangles in these leaves, each as often as it is listed.
    pub triangles: f64,
    /// Triangles that the line meets, whatever the tree: twice their area over that of the scene's box.
    pub met: f64,
}

impl Expected {
    /// Of the paper's tree; `None` when the scene's box has no area.
    pub fn of_midpoint(tree: &MidpointTree<'_>) -> Option<Self> {
        let (mut expected, whole) = Self::begin(tree.tris)?;
        for node in &tree.nodes {
            let share = area(node.bounds()) / whole;
            match *node {
                Node::Inner { .. } => expected.nodes += share,
                Node::Leaf { count, .. } => {
                    expected.leaves += share;
                    expected.triangles += share * f64::from(count);
                }
            }
        }
        Some(expected)
    }

    /// Nothing visited yet but the triangles themselves, and the area of the scene's box.
    pub(crate) fn begin(tris: &TriBuffer) -> Option<(Self, f64)> {
        let whole = area(&tris.bounds());
        if whole <= 0.0 {
            return None;
        }
        let twice_area = |[a, b, c]: &[GzCoord; 3]| {
            let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
            (b - a).cross(c - a).length()
        };
        let met = tris.positions().iter().map(twice_area).sum::<f64>() / whole;
        Some((Self { met, ..Self::default() }, whole))
    }
}

/// Surface area of a box, in f64, which f32 coordinates cannot overflow.
pub(crate) fn area(bounds: &Bounds) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    let size = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
}
