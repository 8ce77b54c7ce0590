//! What the tests of the whole workspace share, and the measurements behind `cargo xtask verify`.
#![forbid(unsafe_code)]

pub mod bench;
pub mod homework;
pub mod rendered;
