//! Files in.

pub mod asc;
pub mod normals;
pub mod obj;
pub mod picture;
