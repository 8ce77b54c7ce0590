//! A mesh as loaded or tessellated, in model space, before it is placed.

use gz_core::{GzCoord, GzTextureIndex};

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
    /// `map_Kd`, resolved beside the MTL file.
    pub map_kd: Option<std::path::PathBuf>,
}
