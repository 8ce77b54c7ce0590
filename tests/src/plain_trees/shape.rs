//! How even a tree is.

use gz_bsp::TreeStats;

/// Sizes of a binary tree, and how evenly its planes share out what a node holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shape {
    /// Sizes. References are all entries of lists, those that polygon planes keep at inner nodes too.
    pub stats: TreeStats,
    /// Mean level of the leaves; the root's is 1. The least that this number of leaves allows is 1 + its logarithm to base 2.
    pub mean_level: f64,
    /// Of what the two children of a node hold, the share of the lesser one, over all inner nodes together: 0.5 is perfectly even.
    pub balance: f64,
}

impl Shape {
    /// Mean level that a perfectly even tree of as many leaves has.
    pub fn even_level(&self) -> f64 {
        1.0 + (self.stats.leaves.max(1) as f64).log2()
    }
}

/// Counts on the way through a tree.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    levels: u64,
    lesser: u64,
    both: u64,
    depth: u32,
    empty: usize,
    sizes: Vec<usize>,
}

impl Tally {
    /// A leaf at this level with this many entries.
    pub(super) fn leaf(&mut self, level: u32, count: usize) {
        self.levels += u64::from(level);
        self.depth = self.depth.max(level);
        match count {
            0 => self.empty += 1,
            _ => self.sizes.push(count),
        }
    }

    /// An inner node whose children hold so many.
    pub(super) fn cut(&mut self, front: usize, back: usize) {
        self.lesser += front.min(back) as u64;
        self.both += (front + back) as u64;
    }

    /// The shape of a tree whose sizes are known.
    pub(super) fn shape(&self, stats: TreeStats) -> Shape {
        let leaves = (self.sizes.len() + self.empty).max(1) as f64;
        Shape { stats, mean_level: self.levels as f64 / leaves, balance: self.lesser as f64 / self.both.max(1) as f64 }
    }

    /// The sizes as far as they were counted here: leaves and the lists of `inner` nodes, which hold `kept` entries themselves.
    pub(super) fn stats(mut self, inner: usize, kept: usize, bytes: usize) -> (TreeStats, Self) {
        self.sizes.sort_unstable();
        let leaves = self.sizes.len() + self.empty;
        let at = |k: usize| self.sizes.get(k).copied().unwrap_or(0);
        let last = self.sizes.len().saturating_sub(1);
        let stats = TreeStats {
            nodes: inner + leaves,
            leaves,
            empty_leaves: self.empty,
            references: self.sizes.iter().sum::<usize>() + kept,
            largest_leaf: at(last),
            smallest_leaf: at(0),
            median_leaf: at(last / 2),
            depth: self.depth,
            bytes,
        };
        (stats, self)
    }
}
