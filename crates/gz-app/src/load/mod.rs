//! Files in.

pub mod asc;
mod mtl;
mod normals;
pub mod obj;
pub mod picture;
mod polygon;
#[cfg(test)]
mod testing;
mod text;
