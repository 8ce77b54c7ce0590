//! Scenes in, pictures out: the parts behind the command `gz`.
#![forbid(unsafe_code)]

pub mod accel;
pub mod args;
pub mod cells;
pub mod cli;
pub mod color_scale;
pub mod compare;
pub mod display;
pub mod error;
pub mod explain;
pub mod heat;
pub mod hits_file;
pub mod homework;
pub mod info;
pub mod job;
pub mod load;
pub mod mesh;
pub mod new_file;
pub mod output;
pub mod pfm;
pub mod picture;
pub mod pixel_report;
pub mod progress;
pub mod projection;
pub mod query;
pub mod random_lines;
pub mod rays_file;
pub mod render;
pub mod sheet;
pub mod show;
pub mod stats;
pub mod teapot;
pub mod threads;
pub mod tree_report;
pub mod view;

/// The README's Rust code, run with the documentation's tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
