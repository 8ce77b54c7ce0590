//! The Utah teapot: Newell's 32 patches and their tessellation.

mod bezier;
mod patches;
mod tessellate;

pub use tessellate::{MAX_SEGMENTS, tessellate, triangle_count};
