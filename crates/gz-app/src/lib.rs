//! Scenes in, pictures out: the parts behind the command `gz`.
#![forbid(unsafe_code)]

pub mod display;
pub mod error;
pub mod homework;
pub mod load;
pub mod mesh;
pub mod teapot;
