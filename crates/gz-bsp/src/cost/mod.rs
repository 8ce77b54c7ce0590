//! The tree that tunes itself: no MAX_DEPTH, no MIN_SIZE.
//!
//! It is the paper's tree with other planes: a node is still cut by an axis-aligned plane, and a triangle that crosses it stands on both
//! sides, or on one whose box then grows around it where that is cheaper. Where to cut and when to stop is decided by expected cost,
//! boxes are tight around what a cell holds, which prices and cuts off empty space, and up to seven cuts are kept as one node of eight cells.

mod abreast;
mod batch;
mod build;
mod check;
mod clip;
mod forest;
#[cfg(feature = "plain-f32")]
mod plain_f32;
mod quest;
mod queue;
mod slabs;
mod split;
mod stats;
mod steps;
mod tight;
mod together;
mod walk;
mod wide;

#[cfg(feature = "plain-f32")]
pub use plain_f32::PlainF32Tree;
pub use split::CostModel;
pub use stats::CostStats;
pub use wide::BspTree;
