//! The homework's coordinate types over glam.
//!
//! Spaces are told by names, never by types: `image_from_world` takes world to image. Handedness differs by camera model and is
//! stated in [`crate::CameraModel`]; nothing in this crate depends on the winding of a triangle.

/// A point or direction, three f32: x, y, z.
pub type GzCoord = glam::Vec3;

/// A linear colour, three f32: red, green, blue. 1 is full intensity; shading may exceed it before a picture is written.
pub type GzColor = glam::Vec3;

/// A texture coordinate, two f32: u, v. One texture spans 0 to 1.
pub type GzTextureIndex = glam::Vec2;
