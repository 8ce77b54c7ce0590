//! Inputs that are hard on the arithmetic: meshes, rays, and ways off a surface, all from a seed.

pub mod classes;
pub mod company;
mod departures;
pub mod dice;
pub mod leaving;
pub mod meshes;

pub use dice::Dice;
