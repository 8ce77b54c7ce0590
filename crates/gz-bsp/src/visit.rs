//! Counting what a walk visits, at no cost where nobody asks.

use gz_core::TriId;

/// Told of each step of a walk.
pub trait Visits {
    /// The walk of the paper's tree enters a node or leaf, of this number, between these distances.
    fn at(&mut self, _number: usize, _enter: f64, _leave: f64) {}
    /// An inner node is entered.
    fn node(&mut self) {}
    /// A leaf is entered.
    fn leaf(&mut self) {}
    /// A group of eight triangles is filtered.
    fn group(&mut self) {}
    /// A triangle is tested in f64.
    fn test(&mut self, _tri: TriId) {}
}

/// Nobody asks.
impl Visits for () {}

/// The number of visits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VisitCount {
    /// Inner nodes entered.
    pub nodes: u64,
    /// Leaves entered.
    pub leaves: u64,
    /// Groups of eight triangles filtered.
    pub groups: u64,
    /// Triangles tested in f64, each time counted.
    pub tests: u64,
    /// A triangle whose tests are not counted: the one that a ray leaves, where the paper's figures leave it out.
    pub excluded: Option<TriId>,
}

impl Visits for VisitCount {
    fn node(&mut self) {
        self.nodes += 1;
    }

    fn leaf(&mut self) {
        self.leaves += 1;
    }

    fn group(&mut self) {
        self.groups += 1;
    }

    fn test(&mut self, tri: TriId) {
        self.tests += u64::from(self.excluded != Some(tri));
    }
}
