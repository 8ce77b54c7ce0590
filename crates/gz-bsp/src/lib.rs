//! An axis-aligned BSP tree over the triangles of [`gz_core`]: the paper's tree, asked the same question as brute force and giving the
//! same bits.
//!
//! ```
//! use gz_bsp::{Midpoint, MidpointTree};
//! use gz_core::{BruteForce, GzCoord, GzRay, RayQuery, TriBuffer};
//!
//! let corners = [[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [0.0, 4.0, 5.0], [1.0, 1.0, 9.0]].map(GzCoord::from_array);
//! let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [1, 2, 3]])?;
//! let tree = MidpointTree::build(&tris, Midpoint { max_depth: 15, min_size: 10, ..Midpoint::default() })?;
//!
//! let ray = GzRay::new(GzCoord::new(1.0, 1.0, 0.0), GzCoord::Z);
//! assert_eq!(tree.closest_hit(&ray), BruteForce::new(&tris).closest_hit(&ray));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod check;
mod cost;
mod expect;
mod midpoint;
mod params;
mod slab;
mod stats;
mod steps;
mod visit;
mod walk;

#[cfg(feature = "plain-f32")]
pub use cost::PlainF32Tree;
pub use cost::{BspTree, CostModel, CostStats};
pub use expect::Expected;
pub use midpoint::{MidpointTree, Node};
pub use params::{BuildError, Midpoint};
pub use stats::TreeStats;
pub use steps::Step;
pub use visit::{VisitCount, Visits};
