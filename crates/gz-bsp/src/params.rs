//! What the paper's tree is built with.

/// MAX_DEPTH and MIN_SIZE, the paper's two static metrics (its section 3.2.1), and how far a build may go.
///
/// The root has level 1. A node is not split when its level is above `max_depth` or when it holds fewer than `min_size` triangles, so
/// leaves can lie at level `max_depth + 1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Midpoint {
    /// MAX_DEPTH, at most 64. The paper's tables use 5 to 20.
    pub max_depth: u32,
    /// MIN_SIZE. The paper's tables use 3 to 30; 0 splits even empty nodes.
    pub min_size: usize,
    /// The rule has no stop of its own, so a build that would pass this many nodes, or 16 times as many references, is refused.
    pub node_budget: usize,
}

impl Default for Midpoint {
    /// MAX_DEPTH 15 and MIN_SIZE 5, the fastest setting of the paper's tables, and 2^24 nodes.
    fn default() -> Self {
        Self { max_depth: 15, min_size: 5, node_budget: 1 << 24 }
    }
}

/// A tree was not built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuildError {
    /// These parameters lead to more nodes or references than the budget.
    OverBudget(Midpoint),
    /// MAX_DEPTH is above 64.
    TooDeep(u32),
}

/// The greatest MAX_DEPTH: halving 64 times is beyond what f32 boxes can tell apart.
pub(crate) const DEEPEST: u32 = 64;

impl std::fmt::Display for BuildError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::OverBudget(Midpoint { max_depth, min_size, node_budget }) => write!(
                f,
                "MAX_DEPTH {max_depth} with MIN_SIZE {min_size} makes more than {node_budget} nodes of this scene: lower MAX_DEPTH or raise MIN_SIZE"
            ),
            Self::TooDeep(max_depth) => write!(f, "MAX_DEPTH {max_depth} is above {DEEPEST}"),
        }
    }
}

impl std::error::Error for BuildError {}
