//! What the tests of the whole workspace share, and the measurements behind `cargo xtask verify`, `measure`, `bench` and `report`.
#![forbid(unsafe_code)]

pub mod bench;
pub mod counting;
pub mod failures;
pub mod folder;
pub mod fuzz;
pub mod hard;
pub mod homework;
pub mod judge;
pub mod model;
pub mod needs_scenes;
pub mod needs_time;
pub mod plain_trees;
pub mod rendered;
pub mod report;
pub mod scenes;
pub mod truth;
pub mod verify;
pub mod z_buffer;
