//! Nodes of eight cells, and leaves of groups of eight triangles.

use super::build::{Cell, Content, build};
use super::split::CostModel;
use gz_core::kernel::{FilterSpace, TriGroup};
use gz_core::simd::Pages;
use gz_core::{Bounds, SimdLevel, TriBuffer, TriId};
#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// Cells of a node.
pub(crate) const WIDTH: usize = 8;

/// Eight cells with their tight boxes, 224 bytes. Unused cells have a box that no ray crosses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct WideNode {
    /// `planes[2 * axis]` are the lower ends, `planes[2 * axis + 1]` the upper ones.
    pub(crate) planes: [[f32; WIDTH]; 6],
    pub(crate) children: [Child; WIDTH],
}

/// Where a row of a node's planes begins among their numbers. The type has no other values, so that a walk needs neither a check nor a
/// multiplication to find one.
#[derive(Clone, Copy)]
#[repr(usize)]
enum Start {
    LowX = 0,
    HighX = 8,
    LowY = 16,
    HighY = 24,
    LowZ = 32,
    HighZ = 40,
}

/// Which way rays go along each axis, as the rows of planes where they enter cells and leave them: a reference into a table, as what is
/// worked out from the directions the optimizer likes to work out anew at every node.
#[derive(Clone, Copy)]
pub(super) struct Way(&'static [[Start; 2]; 3]);

impl Way {
    pub(super) const UP: Self = Self(&WAYS[0]);

    /// By whether rays go down along each axis.
    #[inline(always)]
    pub(super) fn new(down: [bool; 3]) -> Self {
        Self(&WAYS[usize::from(down[0]) | usize::from(down[1]) << 1 | usize::from(down[2]) << 2])
    }
}

static WAYS: [[[Start; 2]; 3]; 8] = {
    use Start::*;
    const X: [[Start; 2]; 2] = [[LowX, HighX], [HighX, LowX]];
    const Y: [[Start; 2]; 2] = [[LowY, HighY], [HighY, LowY]];
    const Z: [[Start; 2]; 2] = [[LowZ, HighZ], [HighZ, LowZ]];
    let mut ways = [[X[0], Y[0], Z[0]]; 8];
    let mut way = 0;
    while way < 8 {
        ways[way] = [X[way & 1], Y[way >> 1 & 1], Z[way >> 2]];
        way += 1;
    }
    ways
};

/// What a cell holds: nothing, a node, or a run of groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Child(u32);

/// A child taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    Node(usize),
    Groups { first: usize, count: usize },
}

impl Child {
    const LEAF: u32 = 1 << 31;
    const COUNT_SHIFT: u32 = 28;
    const FIRST_MASK: u32 = (1 << Self::COUNT_SHIFT) - 1;
    /// The root, which is nobody's child, stands for no child at all.
    pub(crate) const NONE: Self = Self(0);
    pub(crate) const ROOT: Self = Self(0);

    fn node(index: usize) -> Self {
        assert!(index != 0 && index < Self::LEAF as usize, "a tree of {index} nodes is beyond what an index holds");
        Self(index as u32)
    }

    fn groups(first: usize, count: usize) -> Self {
        assert!(first <= Self::FIRST_MASK as usize, "a tree of {first} groups is beyond what an index holds");
        assert!((1..=8).contains(&count), "a leaf has one to eight groups");
        Self(Self::LEAF | ((count - 1) as u32) << Self::COUNT_SHIFT | first as u32)
    }

    #[inline(always)]
    pub(crate) fn target(self) -> Target {
        if self.0 & Self::LEAF == 0 {
            Target::Node(self.0 as usize)
        } else {
            let count = (self.0 >> Self::COUNT_SHIFT & 7) as usize + 1;
            Target::Groups { first: (self.0 & Self::FIRST_MASK) as usize, count }
        }
    }

    /// The number that stands for it.
    #[inline(always)]
    pub(super) const fn number(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(super) fn of_number(number: u32) -> Self {
        Self(number)
    }

    #[inline(always)]
    pub(super) fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    pub(super) fn is_node(self) -> bool {
        self.0 as i32 > 0
    }

    /// The number of a node.
    #[inline(always)]
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }

    /// A leaf's first group, whether there are more, and the leaf that they are. All of this without a branch.
    #[inline(always)]
    pub(super) fn split(self) -> (usize, bool, Self) {
        let rest = Self(self.0.wrapping_sub(1 << Self::COUNT_SHIFT).wrapping_add(1));
        ((self.0 & Self::FIRST_MASK) as usize, self.0 >> Self::COUNT_SHIFT & 7 != 0, rest)
    }

    pub(crate) fn is_none(self) -> bool {
        self == Self::NONE
    }
}

impl WideNode {
    const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        children: [Child::NONE; WIDTH],
    };

    fn set(&mut self, slot: usize, bounds: &Bounds, child: Child) {
        for axis in 0..3 {
            self.planes[2 * axis][slot] = bounds.min[axis];
            self.planes[2 * axis + 1][slot] = bounds.max[axis];
        }
        self.children[slot] = child;
    }

    /// The numbers that stand for the cells.
    #[inline(always)]
    pub(super) fn numbers(&self) -> [u32; WIDTH] {
        let c = &self.children;
        [c[0].0, c[1].0, c[2].0, c[3].0, c[4].0, c[5].0, c[6].0, c[7].0]
    }

    /// The planes of all cells where rays that go `way` enter and leave them along an axis.
    #[inline(always)]
    pub(super) fn ends(&self, way: &Way, axis: usize) -> [&[f32; WIDTH]; 2] {
        let [first, last] = way.0[axis];
        [self.row(first), self.row(last)]
    }

    #[inline(always)]
    fn row(&self, start: Start) -> &[f32; WIDTH] {
        match self.planes.as_flattened()[start as usize..].first_chunk() {
            Some(row) => row,
            None => unreachable!("eight numbers follow every start"),
        }
    }

    pub(crate) fn bounds(&self, slot: usize) -> Bounds {
        let at = |end: usize| [0, 1, 2].map(|axis| self.planes[2 * axis + end][slot]).into();
        Bounds { min: at(0), max: at(1) }
    }
}

/// The default tree: a BSP tree whose planes, depth and leaves are chosen by expected cost.
#[derive(Debug)]
pub struct BspTree<'a> {
    pub(crate) tris: &'a TriBuffer,
    pub(crate) level: SimdLevel,
    /// The root is the first; a tree without triangles has one node without cells.
    pub(crate) nodes: Pages<WideNode>,
    pub(crate) groups: Pages<TriGroup>,
    /// Boxes and groups are in its coordinates.
    pub(crate) space: FilterSpace,
}

impl<'a> BspTree<'a> {
    /// Builds the tree of `tris`, over all cores with the feature `rayon`; its bytes do not depend on their number.
    pub fn build(tris: &'a TriBuffer) -> Self {
        Self::with_cost(tris, CostModel::default())
    }

    /// The same by another cost model.
    pub fn with_cost(tris: &'a TriBuffer, model: CostModel) -> Self {
        let space = FilterSpace::new(tris.bounds().reaches());
        let root = build(tris, model);
        let mut plan = Plan { space, nodes: Vec::new(), groups: Vec::new() };
        plan.place(&root);
        let nodes = Pages::copy_of(&plan.nodes);
        plan.nodes = Vec::new();
        let group = |ids: &&[TriId]| TriGroup::new(ids, tris.positions(), &space);
        #[cfg(feature = "rayon")]
        let groups: Vec<TriGroup> = plan.groups.par_iter().map(group).collect();
        #[cfg(not(feature = "rayon"))]
        let groups: Vec<TriGroup> = plan.groups.iter().map(group).collect();
        drop(root);
        Self { tris, level: SimdLevel::best(), nodes, groups: Pages::copy_of(&groups), space }
    }

    /// The same tree walked with another set of vector instructions; where this machine lacks it, the best that it has.
    #[must_use]
    pub fn with_simd(self, level: SimdLevel) -> Self {
        Self { level: level.or_best(), ..self }
    }

    /// Whether both trees are equal to the last bit, as builds of one buffer are.
    pub fn same_bytes(&self, other: &Self) -> bool {
        self.nodes == other.nodes && self.groups == other.groups
    }

    /// Bytes beyond the triangle buffer.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.groups[..])
    }
}

/// A tree on its way from cells to nodes.
struct Plan<'c> {
    space: FilterSpace,
    nodes: Vec<WideNode>,
    /// The triangles of each group, in the order of groups.
    groups: Vec<&'c [TriId]>,
}

impl<'c> Plan<'c> {
    /// Appends the node of `cell` and all below; returns its index.
    fn place(&mut self, cell: &'c Cell) -> usize {
        let index = self.nodes.len();
        self.nodes.push(WideNode::EMPTY);
        let mut cells = Vec::with_capacity(WIDTH);
        side_by_side(cell, WIDTH, &mut cells);
        for (slot, cell) in cells.into_iter().enumerate() {
            let child = match &cell.content {
                Content::Leaf(ids) if ids.is_empty() => continue,
                Content::Leaf(ids) => {
                    let first = self.groups.len();
                    self.groups.extend(ids.chunks(8));
                    Child::groups(first, self.groups.len() - first)
                }
                Content::Halves(_) => Child::node(self.place(cell)),
            };
            let bounds = self.space.stretch(&cell.bounds);
            self.nodes[index].set(slot, &bounds, child);
        }
        index
    }
}

/// The cells that take the `places` of a node which `cell` is given.
fn side_by_side<'c>(cell: &'c Cell, places: usize, cells: &mut Vec<&'c Cell>) {
    match (&cell.content, cell.forest.lower(places)) {
        (Content::Halves(halves), Some(lower)) => {
            let [below, above] = &**halves;
            side_by_side(below, lower, cells);
            side_by_side(above, places - lower, cells);
        }
        _ => cells.push(cell),
    }
}
