//! A mesh as loaded or tessellated, in model space, before it is placed.

use gz_core::{GzCoord, GzTextureIndex};
use std::path::PathBuf;

/// The smoothing group of triangles that the file puts in none: the crease angle alone decides.
pub const UNGROUPED: u32 = u32::MAX;

/// The smoothing group that is not smoothed (`s off`).
pub const FLAT: u32 = 0;

/// Indexed triangles. Triangle numbers are final: nothing is dropped or reordered after loading.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex positions, finite.
    pub positions: Vec<GzCoord>,
    /// Normals. Those that triangles use are finite and not zero: unit length, but from an `.asc` file of the length that it gives.
    pub normals: Vec<GzCoord>,
    /// Texture coordinates.
    pub uvs: Vec<GzTextureIndex>,
    /// Triangles, in file order over all groups.
    pub triangles: Vec<MeshTri>,
    /// The smoothing group of each triangle, which computed normals follow: [`UNGROUPED`], [`FLAT`], or another number, across
    /// whose border nothing is smoothed. Empty when no triangle is in one.
    pub smoothing: Vec<u32>,
    /// The materials that the file itself brings (MTL), named by [`MeshTri::material`].
    pub materials: Vec<MeshMaterial>,
    /// What was odd but usable, one line each with file and line number; the command prints them once.
    pub warnings: Vec<String>,
}

/// One triangle of a mesh: indices into its arrays, all in range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshTri {
    /// Corner positions.
    pub position: [u32; 3],
    /// Corner normals, if the file has them for all three.
    pub normal: Option<[u32; 3]>,
    /// Corner texture coordinates, if the file has them for all three.
    pub uv: Option<[u32; 3]>,
    /// Which of [`Mesh::materials`], if any.
    pub material: Option<u16>,
}

/// A material of an MTL file, its values checked and kept as the file has them.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshMaterial {
    /// `newmtl`.
    pub name: String,
    /// `Ka`, if given.
    pub ka: Option<[f32; 3]>,
    /// `Kd`, if given.
    pub kd: Option<[f32; 3]>,
    /// `Ks`, if given.
    pub ks: Option<[f32; 3]>,
    /// `Ns`, if given; at least 0.
    pub ns: Option<f32>,
    /// `Ni`, if given; above 0.
    pub ni: Option<f32>,
    /// `Tf`, if given.
    pub tf: Option<[f32; 3]>,
    /// `illum`, if given.
    pub illum: Option<u32>,
    /// `map_Kd`, if given.
    pub map_kd: Option<MeshTexture>,
}

/// A texture that an MTL file names, and where it does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshTexture {
    /// The picture, resolved beside the MTL file; it need not exist.
    pub file: PathBuf,
    /// The MTL file.
    pub library: PathBuf,
    /// The line in it, counting from 1.
    pub line: usize,
    /// Options before the file name, which are not supported.
    pub dropped: Vec<String>,
}
