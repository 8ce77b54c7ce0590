//! Properties P1 to P24, each over inputs that look for trouble. A failure is shrunk to its core, and its seed is printed and kept.
//!
//! `PROPTEST_CASES=1000000 cargo test --release -p gz-tests --test properties` runs as many cases of each as is asked for.

#[path = "properties/files.rs"]
mod files;
#[path = "properties/frames.rs"]
mod frames;
#[path = "properties/inputs.rs"]
mod inputs;
#[path = "properties/queries.rs"]
mod queries;
#[path = "properties/surfaces.rs"]
mod surfaces;
#[path = "properties/symmetries.rs"]
mod symmetries;
#[path = "properties/trees.rs"]
mod trees;
