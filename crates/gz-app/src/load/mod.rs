//! Files in.

pub mod asc;
mod mtl;
pub mod obj;
mod polygon;
#[cfg(test)]
mod testing;
mod text;
