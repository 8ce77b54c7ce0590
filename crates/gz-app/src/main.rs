//! The command gz.
#![forbid(unsafe_code)]
fn main() {}
