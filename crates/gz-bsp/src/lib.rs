//! An axis-aligned BSP tree over the triangles of gz-core.
#![forbid(unsafe_code)]
