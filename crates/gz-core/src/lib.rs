//! The lowest layer of the Gz ray tracer: coordinates, triangles, rays, cameras, and one question asked exactly.
//!
//! The question is [`RayQuery`]: *which triangle does this ray hit first?* Its answer is the one that exact arithmetic gives on
//! the stored numbers, so every implementation of it gives the same bits. [`BruteForce`] is the specification.
//!
//! ```
//! use gz_core::{BruteForce, GzCoord, GzRay, RayQuery, TriBuffer};
//!
//! let corners = [[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [0.0, 4.0, 5.0]].map(GzCoord::from_array);
//! let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2]])?;
//! let brute = BruteForce::new(&tris);
//!
//! let ray = GzRay::new([1.0, 1.0, 0.0].into(), [0.0, 0.0, 1.0].into());
//! let hit = brute.closest_hit(&ray);
//! assert_eq!((hit.tri, hit.t), (0, 5.0));
//! assert_eq!(ray.at(hit.t), [1.0, 1.0, 5.0].into());
//! # Ok::<(), gz_core::TriError>(())
//! ```
#![deny(unsafe_code)]

mod bounds;
mod brute;
mod camera;
mod camera_spec;
mod coord;
mod eight_points;
mod hit;
pub mod kernel;
mod leave;
mod leave_policy;
mod matrix;
mod passages;
mod pixel;
mod primary;
mod query;
mod ray;
pub mod simd;
mod stack;
mod surface;
mod tile;
mod tri;

pub use bounds::Bounds;
pub use brute::BruteForce;
pub use camera::GzCamera;
pub use camera_spec::{CameraError, CameraModel, CameraSpec, View};
pub use coord::{GzColor, GzCoord, GzTextureIndex};
pub use eight_points::EightPoints;
pub use glam;
pub use hit::{Hit, NO_TRI, TriId};
pub use kernel::Kernel;
pub use leave::{leave_surface, side_of};
pub use leave_policy::LeavePolicy;
pub use matrix::GzMatrix;
pub use passages::Passages;
pub use pixel::{GzPixel, TBuffer, TileScratch, tile_hits, trace_tile};
pub use primary::PrimaryRays;
pub use query::{ClassMask, Given, PerRay, RayBatch, RayQuery, Targets};
pub use ray::{GzRay, GzRay32};
pub use simd::{SimdLevel, with_default_float_control};
pub use stack::{MatrixStack, StackError};
pub use surface::SurfacePoint;
pub use tile::{Tile, TileGrid};
pub use tri::{Attributes, GzTri, MaterialId, TriBuffer, TriClass, TriError};
